"""Runs that never happened: folders with a results.csv as `beambench run` writes it."""

from __future__ import annotations

import csv
from pathlib import Path

COLUMNS = (
    "run_id time_utc commit dirty machine_id build_type flags isa threads "
    "scene camera scene_hash rays_hash seed primitives "
    "structure parameters width height samples ray_kind rays repetitions stop_reason "
    "build_ms_median build_ms_min build_ms_mad trace_ms_median trace_ms_min trace_ms_mad "
    "total_ms_median total_ms_min total_ms_mad total_ms_ci_low total_ms_ci_high "
    "build_cpu_ms_median trace_cpu_ms_median mrays_per_s "
    "memory_bytes nodes leaves empty_leaves references depth "
    "traversal_steps_per_ray leaves_per_ray empty_leaves_per_ray box_tests_per_ray "
    "primitive_tests_per_ray hits agree tie graze engine_error embree_error verdict"
).split()

# build ms, trace ms a ray, bytes, traversal steps a ray
_STRUCTURES = {
    ("exhaustive", ""): (0.001, 2e-3, 64, 0),
    ("samet", "max_level=5,max_objects=0"): (1.5, 2.2e-4, 200_000, 11.5),
    ("samet", "max_level=6,max_objects=0"): (4.0, 1.6e-4, 900_000, 17.25),
    ("embree", "mode=single"): (0.6, 6e-5, 150_000, ""),
    ("null", ""): (0.0, 4e-6, 0, 0),
}
_RESOLUTIONS = ((320, 200), (640, 480), (1280, 1024))
_SCENES = ("escena1", "tetra:n=6")


def made_up_rows() -> list[dict[str, object]]:
    """Two scenes, five contenders, three resolutions; times in proportion to the rays."""
    return [
        _row(scene, structure, parameters, width, height)
        for scene in _SCENES
        for structure, parameters in _STRUCTURES
        for width, height in _RESOLUTIONS
    ]


def write_run(folder: Path, rows: list[dict[str, object]], without: tuple[str, ...] = ()) -> Path:
    """Writes rows (fields not given stay empty) into FOLDER/results.csv; returns FOLDER."""
    columns = [name for name in COLUMNS if name not in without]
    columns += [name for name in rows[0] if name not in COLUMNS] if rows else []
    with (folder / "results.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
    return folder


def without_times(row: dict[str, object], verdict: str) -> dict[str, object]:
    """The row as beambench writes it when the hits were not right."""
    times = {name: "" for name in COLUMNS if "_ms_" in name or name == "mrays_per_s"}
    return {**row, **times, "verdict": verdict}


def _row(scene: str, structure: str, parameters: str, width: int, height: int) -> dict[str, object]:
    build, per_ray, memory, steps = _STRUCTURES[structure, parameters]
    rays = width * height
    trace = per_ray * rays
    total = build + trace
    return {
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
        "rays": rays,
        "repetitions": 5,
        "stop_reason": "precision",
        "build_ms_median": build,
        "trace_ms_median": trace,
        "total_ms_median": total,
        "total_ms_ci_low": 0.98 * total,
        "total_ms_ci_high": 1.03 * total,
        "memory_bytes": memory,
        "traversal_steps_per_ray": steps,
        "primitive_tests_per_ray": 430 if structure == "exhaustive" else steps,
        "verdict": "baseline" if structure == "null" else "ok",
    }
