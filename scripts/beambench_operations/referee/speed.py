"""The speed of libraries in one run of harness/plugin/outside/speed.json."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

COLUMNS = ("contender", "version", "ray_kind", "scene", "rays", "verdict", "blocks", "mrays",
           "mrays_low", "mrays_high", "commit", "cpu", "other_work", "utc")  # fmt: skip
"""The columns of speed.csv; mrays_low and mrays_high are the 95% interval, or empty."""


def named_parameters(sweep: dict[str, Any]) -> dict[str, list[str]]:
    """Returns the names of the parameters that a sweep states, for each structure."""
    names: dict[str, list[str]] = {}
    for each in sweep["structures"]:
        if isinstance(each, str):
            structure, _, text = each.partition(":")
            found = [pair.partition("=")[0] for pair in text.split(",") if pair]
        else:
            structure, found = each["structure"], list(each["parameters"])
        known = names.setdefault(structure, [])
        known += [name for name in found if name not in known]
    return names


def contender(structure: str, parameters: str, named: list[str]) -> str:
    """Returns a structure with the named parameters: "tinybvh:layout=bvh8,exact_t=false"."""
    values = dict(pair.split("=", 1) for pair in parameters.split(",") if pair)
    kept = ",".join(f"{name}={values[name]}" for name in sorted(named, key=list(values).index))
    return f"{structure}:{kept}" if kept else structure


def speed_rows(run: Path) -> list[dict[str, Any]]:
    """Returns the rows of speed.csv. Only a cell whose hits are all right has a speed."""
    sweep = json.loads((run / "config.json").read_text("utf-8"))
    manifest = json.loads((run / "manifest.json").read_text("utf-8"))
    named = named_parameters(sweep)
    rows = []
    with (run / "results.csv").open(encoding="utf-8", newline="") as file:
        for cell in csv.DictReader(file):
            times = [cell[name] for name in ("trace_ms", "trace_ms_ci_high", "trace_ms_ci_low")]
            speeds = [f"{int(cell['rays']) / float(ms) / 1e3:.4g}" if ms else "" for ms in times]
            rows.append(
                {
                    "contender": contender(
                        cell["structure"], cell["parameters"], named[cell["structure"]]
                    ),
                    "version": cell["library_version"],
                    "ray_kind": cell["ray_kind"],
                    "scene": cell["scene"],
                    "rays": cell["rays"],
                    "verdict": cell["verdict"],
                    "blocks": cell["blocks"],
                    "mrays": speeds[0],
                    "mrays_low": speeds[1],
                    "mrays_high": speeds[2],
                    "commit": manifest["program"]["commit"][:8],
                    "cpu": manifest["machine"]["cpu"],
                    "other_work": f"{manifest['measurement']['other_work']:.2f}",
                    "utc": manifest["time_utc"],
                }
            )
    return rows


def write_speed(run: Path, path: Path) -> None:
    """Writes speed.csv from a finished run."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(speed_rows(run))


def read_speed(path: Path) -> list[dict[str, str]]:
    """Returns the rows of speed.csv; none if there is no such file."""
    if not path.exists():
        return []
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))
