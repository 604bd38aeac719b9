"""Invented small runs of several sweeps and machines, for the site over them."""

from __future__ import annotations

import json
from pathlib import Path

from synthetic_run import synthetic_rows, write_cell, write_manifest, write_run

_COMMITS = [f"{place:07x}def5678" for place in range(1, 100)]


def write_small_run(
    folder: Path,
    place: int,
    *,
    sweep: str = "quick",
    machine: str = "a",
    factor: float = 1.0,
    scene: str = "escena1",
    cells: bool = False,
) -> Path:
    """Writes a run of one scene and resolution; `factor` slows samet, `cells` adds cell files."""
    time = f"2026-{1 + place // 28:02d}-{1 + place % 28:02d}T03:00:00Z"
    run_id = f"{time.replace('-', '').replace(':', '')}-{sweep}-{machine}"
    rows = []
    for row in synthetic_rows():
        if row["scene"] != "escena1" or row["width"] != 320:
            continue
        slow = factor if row["structure"] == "samet" else 1.0
        times = {
            name: slow * float(value)
            for name, value in row.items()
            if ("_ms_" in name or "_mcycles_" in name) and value != ""
        }
        labels = {
            "run_id": run_id,
            "scene": scene,
            "time_utc": time,
            "commit": _COMMITS[place % len(_COMMITS)],
            "machine_id": machine * 16,
            "scene_hash": "1",
            "rays_hash": "2",
        }
        rows.append(row | times | labels)
    folder.mkdir(parents=True)
    write_run(folder, rows)
    for row in rows if cells else ():
        total = float(row["total_ms_median"])
        write_cell(folder, row, {turn: total * (1 + 0.001 * turn) for turn in range(9)})
    write_manifest(
        folder,
        run_id=run_id,
        sweep=sweep,
        time_utc=time,
        finished_utc=time,
        machine={"cpu": f"Processor {machine.upper()}"},
    )
    return folder


def break_run(folder: Path) -> Path:
    """Writes a run whose record cannot be read."""
    folder.mkdir(parents=True)
    (folder / "results.csv").write_text("no,columns\n1,2\n")
    (folder / "manifest.json").write_text(json.dumps({"run_id": "broken"}))
    return folder
