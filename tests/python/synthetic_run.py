"""Invented runs: folders with a results.csv as written by `beambench run`."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from PIL import Image

from beambench_report.base.columns import dictionary
from beambench_report.run.plots import write_plots
from synthetic_analysis import write_analysis

COLUMNS = [column.name for column in dictionary().columns if not column.is_pattern]

# build ms, trace ms per ray, bytes, traversal steps per ray
_STRUCTURES = {
    ("exhaustive", ""): (0.001, 2e-3, 64, 0),
    ("samet", "max_level=5,max_objects=0"): (1.5, 2.2e-4, 200_000, 11.5),
    ("samet", "max_level=6,max_objects=0"): (4.0, 1.6e-4, 900_000, 17.25),
    ("embree", "mode=single"): (0.6, 6e-5, 150_000, ""),
    ("null", ""): (0.0, 4e-6, 0, 0),
}
_RESOLUTIONS = ((320, 200), (640, 480), (1280, 1024))
_SCENES = ("escena1", "tetra:n=5")

# The entry of a cell's file for a ray whose hit was wrong.
EXAMPLE = (
    "pixel (3, 4) sample 0: structure_error, another primitive\n"
    "  structure miss\n"
    "  replay beambench trace 'tetra:n=5' --accel samet:max_level=6 --pixel 3,4\n"
)


def synthetic_rows() -> list[dict[str, object]]:
    """Returns rows of two scenes, five contenders and three resolutions; times grow with rays."""
    return [
        _row(scene, structure, parameters, width, height)
        for scene in _SCENES
        for structure, parameters in _STRUCTURES
        for width, height in _RESOLUTIONS
    ]


def write_run(folder: Path, rows: list[dict[str, object]], without: tuple[str, ...] = ()) -> Path:
    """Writes FOLDER/results.csv, with missing fields empty, and the analysis; returns FOLDER."""
    of_blocks = {"trace_ms", "total_ms"} - set(rows[0] if rows else ())
    columns = [name for name in COLUMNS if name not in {*without, *of_blocks}]
    columns += [name for name in rows[0] if name not in COLUMNS] if rows else []
    with (folder / "results.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
    _analyze(folder)
    return folder


def without_times(row: dict[str, object], verdict: str) -> dict[str, object]:
    """Returns the row as beambench writes it for wrong hits."""
    times = {name: "" for name in COLUMNS if dictionary().find(name).group in ("times", "hardware")}
    return {**row, **times, "verdict": verdict}


def write_cell(
    folder: Path,
    row: dict[str, object],
    total_ms: dict[int, float] | None = None,
    message: str = "",
    examples: tuple[str, ...] = (),
) -> None:
    """Adds one cell to the log, as `beambench run` does."""
    repetitions = [
        {"round": turn, "position": 0, "build_ms": 0.25 * total, "trace_ms": 0.75 * total}
        for turn, total in (total_ms or {}).items()
    ]
    write_repeated_cell(folder, row, repetitions, message, examples)


def write_trace_cell(
    folder: Path, row: dict[str, object], trace: Sequence[float], warm: Sequence[float]
) -> None:
    """Adds a cell with the given first traces, and second traces for the first rounds."""
    repetitions: list[dict[str, float]] = [
        {"round": turn, "position": 0, "build_ms": 1.0, "trace_ms": time}
        for turn, time in enumerate(trace)
    ]
    for repetition, time in zip(repetitions, warm, strict=False):
        repetition["warm_trace_ms"] = time
    write_repeated_cell(folder, row, repetitions)


def write_repeated_cell(
    folder: Path,
    row: dict[str, object],
    repetitions: list[dict[str, float]],
    message: str = "",
    examples: tuple[str, ...] = (),
) -> None:
    log = folder / "run.jsonl"
    index = log.read_text().count('"event": "cell"') if log.exists() else 0
    events: list[dict[str, object]] = [{"event": "cell", **row}]
    events += [{"event": "repetition", **repetition} for repetition in repetitions]
    finish = {"verdict": row["verdict"], "message": message, "examples": list(examples)}
    events.append({"event": "finished", **finish})
    with log.open("a") as file:
        file.writelines(json.dumps({**event, "index": index}) + "\n" for event in events)


def write_manifest(folder: Path, **changes: object) -> None:
    """Writes a manifest with the kinds of members that beambench writes."""
    manifest = {
        "run_id": "20260102T030405Z-abc1234",
        "sweep": "made-up",
        "time_utc": "2026-01-02T03:04:05Z",
        "finished_utc": "2026-01-02T03:08:15Z",
        "program": {"build_type": "Release", "dirty": False, "libraries": {"embree": "3.13.5"}},
        "machine": {"cpu": "A Made-Up Processor", "memory_bytes": 2**34, "governor": None},
        "scenes": [{"name": "escena1", "primitives": 430}],
        "uncontrolled": ["The system does not tell its frequency governor."],
        "notes": ["A note."],
    }
    (folder / "manifest.json").write_text(json.dumps(manifest | changes))
    _analyze(folder)


def _analyze(folder: Path) -> None:
    """Writes the analysis, which depends on all other files; a faulty table has none."""
    with suppress(FileNotFoundError, IndexError, KeyError, ValueError):
        write_analysis(folder)


def write_full_run(folder: Path) -> Path:
    """Writes a run with everything that scripts/run produces, and one wrong structure."""
    rows = [
        without_times(row, "mismatch")
        if row["parameters"] == "max_level=6,max_objects=0" and row["scene"] == "tetra:n=5"
        else row
        for row in synthetic_rows()
    ]
    write_run(folder, rows)
    for row in rows:
        wrong = row["verdict"] == "mismatch"
        write_cell(
            folder,
            row,
            {} if wrong else {turn: float(row["total_ms_median"]) for turn in range(7)},
            "3 of 64000 hits were wrong" if wrong else "",
            (EXAMPLE,) if wrong else (),
        )
    write_manifest(folder)
    write_plots(folder)
    (folder / "pictures").mkdir()
    for name in ("escena1", "tetra-n-5", "tetra-n-5-samet-traversal_steps"):
        Image.new("RGB", (8, 6), "teal").save(folder / "pictures" / f"{name}.png")
    return folder


def _row(scene: str, structure: str, parameters: str, width: int, height: int) -> dict[str, object]:
    build, per_ray, memory, steps = _STRUCTURES[structure, parameters]
    rays = width * height
    trace = per_ray * rays
    total = build + trace
    return {
        "schema_version": 1,
        "run_id": "20260102T030405Z-abc1234",
        "time_utc": "2026-01-02T03:04:05Z",
        "commit": "abc1234def5678",
        "dirty": "false",
        "machine_id": "0123456789abcdef",
        "threads": 1,
        "scene": scene,
        "camera": "default",
        "scene_hash": "00000000000000ff",
        "primitives": 430,
        "structure": structure,
        "parameters": parameters,
        "width": width,
        "height": height,
        "samples": 1,
        "ray_kind": "primary",
        "query": "closest",
        "rays": rays,
        "hit_share": 0.43,
        "coherence": 0.999,
        "repetitions": 5,
        "stop_reason": "precision",
        "build_ms_median": build,
        "trace_ms_median": trace,
        "total_ms_median": total,
        "total_ms_ci_low": 0.98 * total,
        "total_ms_ci_high": 1.03 * total,
        "total_mcycles_median": 3.0 * total,
        "total_mcycles_pi_low": 2.94 * total,
        "total_mcycles_pi_high": 3.09 * total,
        "memory_bytes": memory,
        "traversal_steps_per_ray": steps,
        "primitive_tests_per_ray": 430 if structure == "exhaustive" else steps,
        "verdict": "baseline" if structure == "null" else "ok",
    }
