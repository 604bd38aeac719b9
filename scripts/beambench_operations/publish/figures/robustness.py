"""results/published/robustness: what campaigns of random inputs, rays and kills came to."""

import csv
from pathlib import Path
from typing import Any

from beambench_report.base.files import Problem

_AIMS = {
    "fuzz": {"cpu_seconds": 4 * 3600},
    "rays": {"rays": 1e9, "scenes": 10_000},
    "sweep": {"kills": 1000},
    "nights": {"kills": 300},
    "cluster": {"kills": 50},
}
"""What part 20 of the plan asks for; of kills by what is killed."""


def figures(folder: Path) -> dict[str, Any]:
    """Sums over the subjects of each campaign, and how much was aimed at."""
    rows = _rows(folder / "campaigns.csv")
    parts = {
        part: [row for row in rows if part in (row["command"], row["subject"])] for part in _AIMS
    }
    return {
        "done": {part: _sums(own) for part, own in parts.items()}
        | {"embree": _sums([row for row in rows if row["subject"] == "embree"])},
        "aims": _AIMS,
        "met": {
            part: all(_sums(parts[part])[what] >= least for what, least in aim.items())
            for part, aim in _AIMS.items()
        },
        "commits": sorted({commit for row in rows for commit in row["commits"].split()}),
    }


def _sums(rows: list[dict[str, str]]) -> dict[str, float]:
    names = ("executions", "scenes", "rays", "kills", "runs", "cpu_seconds", "findings")
    return {name: sum(float(row[name]) for row in rows) for name in names} | {"subjects": len(rows)}


def _rows(file: Path) -> list[dict[str, str]]:
    try:
        with file.open(encoding="utf-8", newline="") as table:
            return list(csv.DictReader(table))
    except FileNotFoundError:
        raise Problem(f"{file}: is missing; write it with scripts/campaign --report") from None
