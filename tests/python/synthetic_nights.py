"""Invented nights: runs of one sweep, night after night, with noise and planted changes."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from beambench_operations.history.alarms import find_alarms
from beambench_operations.history.night import night_of
from beambench_operations.history.store import History
from beambench_operations.nightly.home import Home
from beambench_report.base.records import read_run
from synthetic_run import synthetic_rows, without_times, write_repeated_cell, write_run

SCENES = ("escena1", "tetra:n=5")
NOISE = 0.01
BLOCKS = 4

Row = dict[str, object]
Plant = Callable[[int, Row], Row]


def nothing(_night: int, row: Row) -> Row:
    """Plants nothing."""
    return row


def slower(structure: str, scene: str, factor: float, since: int) -> Plant:
    """Slows down one structure in one scene, from one night on."""

    def plant(night: int, row: Row) -> Row:
        hit = row["structure"] == structure and row["scene"] == scene and night >= since
        return _timed(row, factor) if hit else row

    return plant


def wrong(structure: str, scene: str, since: int) -> Plant:
    """Makes one structure's hits wrong in one scene."""

    def plant(night: int, row: Row) -> Row:
        hit = row["structure"] == structure and row["scene"] == scene and night >= since
        return without_times(row, "mismatch") if hit else row

    return plant


def counting(structure: str, scene: str, factors: Iterable[float]) -> Plant:
    """Changes the steps of one structure in one scene: a factor for each night."""
    known = list(factors)

    def plant(night: int, row: Row) -> Row:
        hit = row["structure"] == structure and row["scene"] == scene
        steps = row["traversal_steps_per_ray"]
        return {**row, "traversal_steps_per_ray": steps * known[night]} if hit else row

    return plant


def write_nights(
    home: Home, count: int, plant: Plant = nothing, seed: int = 7, old: int = 0
) -> list[Path]:
    """Writes the folders of runs into a home; the first `old` of them are from before blocks."""
    random = np.random.default_rng(seed)
    return [
        write_night(home, night, random, plant, blocks=0 if night < old else BLOCKS)
        for night in range(count)
    ]


def write_night(
    home: Home, night: int, random: np.random.Generator, plant: Plant, *, blocks: int = BLOCKS
) -> Path:
    """Writes one finished run, either in blocks or as runs were before blocks."""
    run_id = f"2026{1 + night // 28:02d}{1 + night % 28:02d}T030000Z"
    folder = home.folder / run_id
    folder.mkdir(parents=True)
    rows = []
    for row in synthetic_rows():
        labels = {
            "run_id": run_id,
            "time_utc": f"{run_id[:4]}-{run_id[4:6]}-{run_id[6:8]}T03:00:00Z",
            "commit": f"{night:07x}def5678",
            "scene_hash": "1",
            "rays_hash": "2",
        }
        row = plant(night, _timed(row | labels, float(np.exp(random.normal(0, NOISE)))))
        if blocks:
            times = {name: row[f"{name}_median"] for name in ("trace_ms", "total_ms")}
            row |= {"blocks": blocks, "schema_version": 2} | times
        rows.append(row)
        if blocks and row["total_ms"] != "":
            write_repeated_cell(folder, row, _repetitions(row, random.normal(0, NOISE, blocks)))
    write_run(folder, rows)
    (folder / "manifest.json").write_text(
        json.dumps({"run_id": run_id, "finished_utc": labels["time_utc"], "sweep": "made-up"})
    )
    return folder


def add_all(home: Home, folders: Iterable[Path]) -> list[list]:
    """Adds runs to the history, judging each; returns the alarms of each."""
    with History(home.history) as history:
        numbers = [
            history.add(night_of(read_run(folder)), folder, find_alarms) for folder in folders
        ]
        alarms = history.alarms()
    return [[alarm for alarm in alarms if alarm.night == number] for number in numbers]


def _timed(row: Row, factor: float) -> Row:
    return row | {name: float(row[name]) * factor for name in row if is_time(name, row)}


def is_time(name: str, row: Row) -> bool:
    """Returns whether this member of the row is a time."""
    return ("_ms" in name or "_mcycles_" in name) and row[name] != ""


def _repetitions(row: Row, noise: np.ndarray) -> list[dict[str, float]]:
    """Returns one repetition per block; the geometric mean of their times is the row's time."""
    parts = [(name, float(row[f"{name}_ms_median"])) for name in ("build", "trace")]
    return [
        {"round": block, "block": block, "position": 0}
        | {f"{name}{end}": ms * factor for name, ms in parts for end in ("_ms", "_cpu_ms")}
        for block, factor in enumerate(np.exp(noise - noise.mean()))
    ]
