"""The analysis.json of invented runs, as beambench makes it from a log of their rows."""

from __future__ import annotations

import csv
import json
import tempfile
from pathlib import Path
from typing import Any

from beambench.analysis import analyze
from beambench_report.base.cell_files import IDENTITY, identity
from beambench_report.base.columns import dictionary
from beambench_report.base.run_log import logged_cells

Row = dict[str, str]
_SIZES = ("width", "height", "samples")
_TIMES = [c.name for c in dictionary().columns if c.group in ("effort", "times") and c.is_number]


def write_analysis(folder: Path) -> Path:
    """Writes FOLDER/analysis.json from results.csv, run.jsonl and manifest.json beside it."""
    with (folder / "results.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    with tempfile.TemporaryDirectory() as temporary:
        log = Path(temporary) / "run.jsonl"
        log.write_text("".join(json.dumps(event) + "\n" for event in _events(folder, rows)))
        path = folder / "analysis.json"
        path.write_text(json.dumps(analyze(temporary)))
    return path


def _events(folder: Path, rows: list[Row]) -> list[dict[str, Any]]:
    machines = list(dict.fromkeys(row["machine_id"] for row in rows))
    config = _read(folder / "config.json")
    events = [
        {
            "event": "header",
            "schema_version": 1,
            "manifest": _manifest(_read(folder / "manifest.json"), machines),
            "config": {"exclude": config.get("exclude", [])},
            "plan": [],
        }
    ]
    kept = {identity(cell.facts): cell for cell in logged_cells(folder)}
    for index, row in enumerate(rows):
        cell = kept.get(tuple(row[name] for name in IDENTITY))
        own = [_cell(row, machines.index(row["machine_id"]) + 1, with_times=not cell)]
        own += [
            {"event": "repetition", "build_cpu_ms": 0, "trace_cpu_ms": 0, "clock_ghz": 1, **one}
            for one in (cell.repetitions if cell else [])
        ]
        finish = {"time_utc": row.get("time_utc", ""), "verdict": row["verdict"] or "error"}
        if row.get("stop_reason"):
            finish["stop_reason"] = row["stop_reason"]
        own.append({"event": "finished", **finish, "message": cell.message if cell else ""})
        events += [{"index": index, **event} for event in own]
    return events


def _manifest(source: dict[str, Any], machines: list[str]) -> dict[str, Any]:
    measurement = {"isa": "", "threads": 1, "noise": None, **source.get("measurement", {})}
    program = {"commit": "", "dirty": False, "build_type": "", "flags": ""}
    return {
        "run_id": "",
        "finished_utc": "2026-01-02T03:08:15Z",
        "program": program,
        "machine": {**source.get("machine", {}), "id": machines[0]},
        "measurement": measurement,
        "uncontrolled": [],
        "shards": [
            {"number": number, "machine": {"id": machine}, "measurement": measurement}
            for number, machine in enumerate(machines, 1)
        ],
    }


def _cell(row: Row, shard: int, *, with_times: bool) -> dict[str, Any]:
    names = {name: row[name].removeprefix("'") for name in IDENTITY}
    return {
        "event": "cell",
        **{name: int(text) if name in _SIZES else text for name, text in names.items()},
        "ray_set": {
            "scene_hash": "0",
            "rays_hash": "0",
            "seed": 0,
            "primitives": int(row["primitives"] or 0),
            "rays": int(row["rays"]),
            "query": "closest",
        },
        "counters": {},
        "columns": {
            name: float(row[name])
            for name in _TIMES
            if with_times and row.get(name) not in (None, "", "nan")
        },
        "shard": shard,
    }


def _read(path: Path) -> dict[str, Any]:
    return json.loads(path.read_text()) if path.exists() else {}
