"""Invented runs of the thesis's sweeps: every cell by a formula, correct or corrupted."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from beambench_report.base.published import primitives_by_scene, rays
from beambench_thesis.report.plan import Plan, PlannedCell, Sweep, keep_plan
from beambench_thesis.report.write import MARKDOWN
from synthetic_run import write_cell, write_manifest, write_run

Row = dict[str, object]
Change = Callable[[Row], Row]

_OCTREE = "max_level=6,max_objects=0,root=cube,assign=surface,pad=1e-06,max_references=50000000"
CANONICAL = {
    "beam": f"{_OCTREE},handover=0,continue=rays,share_corners=false,leaf=exact",
    "samet": _OCTREE,
    "samet-net": _OCTREE,
    "voxel-grid": "resolution=auto,density=4,fill=eager,mailboxes=false,max_voxels=100000000",
    "goldsmith-salmon": "order=given,seed=1,queue=heap,insert=everywhere",
    "sah-bvh": "max_leaf=8,parallel=false",
    "embree": "mode=single,quality=high,robust=true,coherent=true",
}
# Build ms, and ms for each 10,000 rays.
COSTS = {
    "beam": (5.0, 1.0),
    "samet": (4.0, 2.0),
    "samet-net": (6.0, 1.8),
    "voxel-grid": (20.0, 1.5),
    "goldsmith-salmon": (1.0, 9.0),
    "sah-bvh": (2.0, 0.5),
    "embree": (3.0, 0.4),
}


def write_runs(
    directory: Path, plan: Plan, change: Change = dict, only: Callable[[Sweep], bool] = bool
) -> Path:
    """Writes a finished run for each sweep of a plan, and the plan; returns DIRECTORY."""
    directory.mkdir(exist_ok=True)
    keep_plan(plan, directory)
    for sweep in plan.every_sweep:
        if only(sweep):
            folder = directory / sweep.name
            folder.mkdir(parents=True)
            rows = [change(row_of(cell)) for cell in sweep.cells()]
            write_run(folder, rows)
            write_manifest(folder, sweep=sweep.source["name"])
            for row in rows:
                write_cell(folder, row)
    return directory


def canonical(cell: PlannedCell) -> dict[str, str]:
    """Returns all parameters of a cell, as the program prints them."""
    defaults = dict(item.split("=") for item in CANONICAL[cell.structure].split(","))
    assert defaults.keys() >= dict(cell.parameters).keys(), cell
    return defaults | dict(cell.parameters)


def row_of(cell: PlannedCell) -> Row:
    """Returns a row as written by `beambench run`; level 6 and 24 voxels are the best."""
    given = canonical(cell)
    width, height = cell.resolution.split("x")
    count = rays(cell.resolution) * cell.samples
    build, per_ray = COSTS[cell.structure]
    worse = 1 + 0.5 * abs(int(given.get("max_level", 6)) - 6)
    worse += 0.01 * int(given.get("max_objects", 0))
    cells = given.get("resolution", "24")
    worse += 0.05 * abs((int(cells) if cells.isdecimal() else 40) - 24)
    trace = per_ray * worse * count / 1e4
    total = build + trace
    beams = {
        "beams_per_ray": 0.1,
        "beams_nonterminal_per_ray": 0.05,
        "beams_occupied_per_ray": 0.03,
        "beams_made_per_ray": 0.06,
        "beams_divided_per_ray": 0.025,
        "samples_leaving_per_ray": 0.2,
    }
    return {
        "schema_version": 1,
        "run_id": "20260102T030405Z-abc1234",
        "commit": "abc1234def5678",
        "dirty": "false",
        "machine_id": "0123456789abcdef",
        "threads": 1,
        "scene": "escena1:seed=1999,spheres=430" if cell.scene == "escena1" else cell.scene,
        "camera": "default",
        "primitives": primitives_by_scene()[cell.scene.split(":")[0]],
        "structure": cell.structure,
        "parameters": ",".join(f"{name}={value}" for name, value in given.items()),
        "width": int(width),
        "height": int(height),
        "samples": cell.samples,
        "ray_kind": "primary",
        "query": "closest",
        "rays": count,
        "repetitions": 9,
        "stop_reason": "precision",
        "build_ms_median": build,
        "trace_ms_median": trace,
        "trace_ms_min": trace,
        "total_ms_median": total,
        "total_ms_ci_low": 0.99 * total,
        "total_ms_ci_high": 1.01 * total,
        "total_mcycles_median": 3.0 * total,
        "total_mcycles_pi_low": 2.97 * total,
        "total_mcycles_pi_high": 3.03 * total,
        "memory_bytes": 100_000,
        "nodes": 900,
        "leaves": 1000,
        "empty_leaves": 400,
        "tree_cost": 4.5 if cell.structure == "goldsmith-salmon" else "",
        "traversal_steps_per_ray": 12.5,
        "primitive_tests_per_ray": 3.25,
        **(beams if cell.structure == "beam" else dict.fromkeys(beams, "")),
        "verdict": "ok",
    }


def pages_of(run: Path) -> str:
    """Returns the report and its details as pages, joined."""
    return "".join((run / f"{name}.html").read_text() for name in ("report", "details"))


def texts_of(run: Path) -> str:
    """Returns the report and its details as Markdown, joined."""
    return "".join((run / name).read_text() for name in MARKDOWN)
