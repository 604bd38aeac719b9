"""results/published/robustness: results of campaigns of random inputs, rays and kills."""

from pathlib import Path
from typing import Any

from beambench_report.base.files import read_table

_AIMS = {
    "fuzz": {"cpu_seconds": 4 * 3600},
    "rays": {"rays": 1e9, "scenes": 10_000},
    "sweep": {"kills": 1000},
    "nights": {"kills": 300},
    "cluster": {"kills": 50},
}
"""The aims of the campaigns; for kills, by subject."""


_COUNTS = ["executions", "scenes", "rays", "kills", "runs", "cpu_seconds", "findings"]


def figures(folder: Path) -> dict[str, Any]:
    """Returns sums over the subjects of each campaign, and its aims."""
    columns = ("command", "subject", "commits", *_COUNTS)
    rows = read_table(folder / "campaigns.csv", columns, "write it with scripts/campaign --report")
    done = {}
    for part in (*_AIMS, "embree"):
        own = rows[(rows["command"] == part) | (rows["subject"] == part)]
        done[part] = own[_COUNTS].sum().to_dict() | {"subjects": len(own)}
    return {
        "done": done,
        "aims": _AIMS,
        "met": {
            part: all(done[part][what] >= least for what, least in aim.items())
            for part, aim in _AIMS.items()
        },
        "commits": sorted({commit for text in rows["commits"] for commit in text.split()}),
    }
