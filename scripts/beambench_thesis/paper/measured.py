"""Reads measurements of runs and censuses in the form of the thesis's tables.

A folder of censuses holds two outputs of `beambench census --json` on the same scenes: `scan.json`,
with pixels shaded one after the other along the rows, and `beams.json`, beam by beam. Each has one
shadow cache for the picture (`--shadows cache --order scan` and `--order beams`).
"""

from collections.abc import Sequence
from dataclasses import asdict
from math import hypot, isnan, nan, sqrt
from pathlib import Path
from typing import Any

import pandas as pd

from beambench_report.base.analysis import block_totals
from beambench_report.base.cell_files import name_of
from beambench_report.base.columns import COUNTER_SUFFIX
from beambench_report.base.fastest import with_fastest
from beambench_report.base.files import Problem, load_json
from beambench_report.base.machine import require_one_machine
from beambench_report.base.names import parameter_items
from beambench_report.base.published import RESOLUTIONS, primitives_by_scene
from beambench_report.base.records import Run, read_run, size_of
from beambench_thesis.paper.evidence import (
    HIERARCHY,
    NO_BLOCKS,
    NOTHING,
    OCTREES,
    PAPER_HIERARCHY,
    PICTURE,
    PLAIN_HIERARCHY,
    SETTING,
    TIMES,
    WORK,
    Blocks,
    Evidence,
    Measured,
    Setting,
    share,
)

# The thesis's settings where it varied nothing. Rows with other values belong to contenders that
# the claims do not concern. Level, objects and voxels are separate settings.
_OCTREE = {"root": "cube", "assign": "surface"}
_THESIS = {
    # The thesis's beams test the samples of a leaf as rays are tested; SIMD is our addition
    # (leaf=simd).
    "beam": _OCTREE
    | {"handover": "0", "continue": "rays", "share_corners": "false", "leaf": "exact"},
    "samet": _OCTREE | {"outside": "0"},
    "samet-net": _OCTREE | {"outside": "0"},
    "voxel-grid": {"fill": "lazy", "mailboxes": "false"},
    HIERARCHY: {"order": "given"},
}

# Between two runs the virtual machine's clock differed by up to 14% (results/published/README.md).
# A task of beams that was measured too seldom to have an interval may be off by as much.
UNKNOWN_SPREAD = 0.15

_HIERARCHIES = {
    ("terminal", "heap"): HIERARCHY,
    ("everywhere", "heap"): PAPER_HIERARCHY,
    ("terminal", "stack"): PLAIN_HIERARCHY,
}
"""Variants of the hierarchy, by insertion and by order of traversal."""

# The variation of one task relative to the others between counting passes of two runs. Found by
# repeating a sweep of 84 cells twice on a disturbed machine: 95% of these ratios were reproduced to
# within 16% to 20%, but 95% of the seconds of the pass only to within 37% to 50%.
SPREAD_OF_PARTS = 0.17

# The variation between processes, whose memory layouts differ (kBetweenRuns of the harness).
BETWEEN_RUNS = 0.015

_TASKS = ("nonterminal", "occupied", "leaving")
_BEAM_COUNTS = ("beams", "beams_nonterminal", "beams_occupied", "beams_made", "beams_divided")


def measured_evidence(
    directories: Sequence[Path],
    resolutions: tuple[str, ...] = RESOLUTIONS,
) -> Evidence:
    """Returns the correct rows of one or more runs that have the thesis's scenes and contenders.

    If several runs measured a cell, the repetitions of all count. Raises Problem if a run cannot be
    read or has rows of several machines.
    """
    runs = [read_run(directory) for directory in directories]
    if not runs:
        return NOTHING
    for run in runs:
        require_one_machine(run.rows, run.directory)
    every = [_compared(rows) for rows in with_fastest(runs)]
    # One clock rate for all runs, so that differences in cycles become differences in seconds.
    cycles, ms = (
        pd.concat(rows[f"total_{name}_median"] for rows in every) for name in ("mcycles", "ms")
    )
    clock = float((cycles / ms).median())
    parts = [_evidence_of(rows, clock, resolutions[-1]) for rows in every]
    times, work, octrees = (
        pd.concat([getattr(part, name) for part in parts], ignore_index=True)
        for name in ("times", "work", "octrees")
    )
    # The tasks' shares of the time differ between the counting passes of two runs: those of the
    # first run are used.
    is_time = work["quantity"].str.startswith("seconds_").astype(bool)
    once = ~work.duplicated([*SETTING, "quantity"])
    return Evidence(
        times.drop_duplicates(list(SETTING)),
        work[once | ~is_time],
        octrees,
        blocks=_blocks(runs),
        resolutions=resolutions,
    )


def _blocks(runs: Sequence[Run]) -> dict[Setting, Blocks]:
    """Returns the times of each cell by the blocks of all runs."""
    numbers: dict[tuple, int] = {}
    found: dict[Setting, Blocks] = {}
    for run in runs:
        totals = block_totals(run)
        for row in _compared(run.rows).to_dict("records") if totals else ():
            at = setting_of(row)
            if at is None:
                continue
            view = (run.directory, at["scene"], at["resolution"], at["samples"])
            own = {
                numbers.setdefault((*view, block), len(numbers)): ms
                for block, ms in totals.get(name_of(row), {}).items()
            }
            before = found.get(key := tuple(at[name] for name in SETTING), NO_BLOCKS)
            found[key] = Blocks({**before.ms, **own})
    return found


def _compared(rows: pd.DataFrame) -> pd.DataFrame:
    """Returns timed rows of camera rays from each scene's first camera."""
    rows = rows[rows["timed"] & rows["ray_kind"].eq("primary")]
    return rows[rows["camera"].eq(rows.groupby("scene")["camera"].transform("first"))]


def _evidence_of(rows: pd.DataFrame, clock: float, finest: str) -> Evidence:
    times: list[dict[str, object]] = []
    work: list[dict[str, object]] = []
    octrees: list[dict[str, object]] = []
    for row in rows.to_dict("records"):
        setting = setting_of(row)
        if setting is None:
            continue
        times.append({"table": ""} | setting | _at_clock(row, clock))
        work += _work(row, setting)
        if (
            setting["contender"] == "beam"
            and setting["samples"] == 1
            and setting["resolution"] == finest
        ):
            octrees += _octree(row, setting)
    return Evidence(
        pd.DataFrame(times, columns=list(TIMES)),
        pd.DataFrame(work, columns=list(WORK)),
        pd.DataFrame(octrees, columns=list(OCTREES)),
    )


def setting_of(row: dict[str, object]) -> dict[str, object] | None:
    """Returns the setting of a row; None unless scene and contender are the thesis's."""
    contender = str(row["structure"])
    scene = str(row["scene"]).split(":")[0]
    if contender not in _THESIS or row["primitives"] != primitives_by_scene().get(scene):
        return None
    given = parameter_items(row["parameters"])
    thesis = _THESIS[contender]
    if any(given.get(name, value) != value for name, value in thesis.items()):
        return None
    numbers = {
        "level": given.get("max_level", "0"),
        "objects": given.get("max_objects", "0"),
        "cells": _cells_per_axis(given.get("resolution", "0")),
    }
    if not all(value.isdecimal() for value in numbers.values()):
        return None  # chosen automatically
    if contender == HIERARCHY:
        contender = _HIERARCHIES.get(
            (given.get("insert", "everywhere"), given.get("queue", "heap")), ""
        )
    if not contender:
        return None
    return {
        "scene": scene,
        "contender": contender,
        **{name: int(value) for name, value in numbers.items()},
        "resolution": size_of(row),
        "samples": int(float(str(row["samples"]))),
    }


def _cells_per_axis(resolution: str) -> str:
    """Returns `32` for `32` and for `32x32x32`; other shapes are returned unchanged."""
    sides = set(resolution.split("x"))
    return sides.pop() if len(sides) == 1 else resolution


def seconds_of(row: dict[str, object]) -> dict[str, float]:
    """Returns seconds, building included, with the interval for the figure of a repeated run.

    They are the median of the fastest repetitions (base/fastest.py), or of all if the fastest are
    unknown.
    """
    fastest = _number(row, "fastest_ms")
    return _seconds_by(row, "total_ms", 1e3) if isnan(fastest) else _fastest(row, fastest / 1e3)


def _at_clock(row: dict[str, object], gigahertz: float) -> dict[str, float]:
    """Returns the seconds that the row's cycles take at another clock rate."""
    fastest = _number(row, "fastest_mcycles")
    if not isnan(fastest):
        return _fastest(row, fastest / (1e3 * gigahertz))
    if pd.notna(_number(row, "total_mcycles_ci_low")):
        return _seconds_by(row, "total_mcycles", 1e3 * gigahertz)
    # Older rows have no interval for the cycles: that of the milliseconds is at least as wide.
    cycles, own = _number(row, "total_mcycles_median"), _number(row, "total_ms_median")
    scale = cycles / gigahertz / own
    return {name: seconds * scale for name, seconds in seconds_of(row).items()}


def _fastest(row: dict[str, object], seconds: float) -> dict[str, float]:
    """Returns seconds of the fastest repetitions, with the interval for a repeated run."""
    error = seconds * error_between_runs(_number(row, "fastest_error"))
    return {"seconds": seconds, "low": seconds - error, "high": seconds + error}


def error_between_runs(error: float) -> float:
    """Returns the relative difference to expect from the fastest repetitions of another process.

    NaN if the error of this process is not known.
    """
    return hypot(error, BETWEEN_RUNS)


def _seconds_by(row: dict[str, object], figure: str, per_second: float) -> dict[str, float]:
    """Returns the seconds of the figure's median.

    A repeated run's median differs by the errors of both runs and by the difference between
    processes, so the interval is that of the median times the root of two, widened by BETWEEN_RUNS.
    """
    seconds = _number(row, f"{figure}_median") / per_second
    low, high = (_number(row, f"{figure}_ci_{end}") / per_second for end in ("low", "high"))
    below, above = (
        hypot(sqrt(2) * error, BETWEEN_RUNS * seconds) for error in (seconds - low, high - seconds)
    )
    return {"seconds": seconds, "low": seconds - below, "high": seconds + above}


def _work(row: dict[str, object], setting: dict[str, object]) -> list[dict[str, object]]:
    """Returns counts for the whole image, times of its tasks, and sizes of a hierarchy."""
    if row["structure"] == HIERARCHY:
        sizes = {"boxes": _number(row, "nodes"), "cost": _number(row, "tree_cost")}
        return _entries(setting | {"resolution": ""}, _exact(sizes))
    if row["structure"] != "beam" or pd.isna(_number(row, f"beams{COUNTER_SUFFIX}")):
        return []
    counts = {
        name.removesuffix(COUNTER_SUFFIX): _number(row, name) * _number(row, "rays")
        for name in row
        if name.endswith(COUNTER_SUFFIX)
    }
    own = {name: count for name, count in counts.items() if not name.endswith("_ns")}
    # Beams should not depend on the resolution (C09 tests this), so one count represents all.
    every = {name: figure.value for name, figure in _exact(counts).items() if name in _BEAM_COUNTS}
    whole = {name: round(count) for name, count in every.items()}
    tasks = {task: counts.get(f"beams_{task}_ns", nan) / 1e9 for task in _TASKS}
    return [
        *_entries(setting, _exact(own)),
        *_entries(setting | {"resolution": ""}, _exact(whole)),
        *_entries(setting, _seconds_of_tasks(row, tasks)),
    ]


def _seconds_of_tasks(row: dict[str, object], counted: dict[str, float]) -> dict[str, Measured]:
    """Returns the seconds of each task, from its share of the least trace time, and of building.

    The shares are those of the counting pass. Its seconds are not used: the pass is made once, and
    other work on the machine can slow one cell by half and spare another, but it slows most tasks
    of a cell alike.
    """
    build, spread = _number(row, "build_ms_median") / 1e3, UNKNOWN_SPREAD
    known = Measured(build, build * (1 - spread), build * (1 + spread))
    found = {} if isnan(build) else {"seconds_build": known}
    fastest = _number(row, "fastest_trace_ms")
    trace = (_number(row, "trace_ms_min") if isnan(fastest) else fastest) / 1e3
    if any(map(isnan, (trace, *counted.values()))) or sum(counted.values()) <= 0:
        return found
    error = error_between_runs(_number(row, "fastest_error"))
    error = UNKNOWN_SPREAD if isnan(error) else error
    inverse = Measured(1 / trace, 1 / trace / (1 + error), (1 + error) / trace)
    for task, seconds in counted.items():
        rest = Measured.exact(sum(counted.values()) - seconds)
        part = Measured(seconds, seconds / (1 + SPREAD_OF_PARTS), seconds * (1 + SPREAD_OF_PARTS))
        found[f"seconds_{task}"] = share(part, rest) / inverse
    return found


def _exact(figures: dict[str, float]) -> dict[str, Measured]:
    """Returns the known counts as exact figures."""
    return {name: Measured.exact(value) for name, value in figures.items() if pd.notna(value)}


def _entries(setting: dict[str, object], figures: dict[str, Measured]) -> list[dict[str, object]]:
    """Returns rows of `evidence.WORK`."""
    return [setting | {"quantity": name} | asdict(one) for name, one in figures.items()]


def _octree(row: dict[str, object], setting: dict[str, object]) -> list[dict[str, object]]:
    leaves = _number(row, "leaves") - _number(row, "empty_leaves")
    pixels = _number(row, f"samples_leaving{COUNTER_SUFFIX}") * _number(row, "rays")
    if pd.isna(leaves) or pd.isna(pixels):
        return []
    counts = {"occupied_leaves": round(leaves), "exit_pixels": round(pixels)}
    return [{name: setting[name] for name in ("scene", "level", "objects")} | counts]


def _number(row: dict[str, object], name: str) -> float:
    value = row.get(name)
    return nan if value is None else float(str(value))


ORDERS = ("scan", "beams")
"""The orders in which pixels are shaded, with a file each."""


def is_census_folder(folder: Path) -> bool:
    """Returns whether the folder holds the files of both orders."""
    return all(census_file(folder, order).exists() for order in ORDERS)


def census_file(folder: Path, order: str) -> Path:
    """Returns `FOLDER/scan.json` or `FOLDER/beams.json`."""
    return folder / f"{order}.json"


def census_work(folder: Path) -> pd.DataFrame:
    """Returns rows of `evidence.WORK`: rays by kind, and the hidden shadow rays found by the cache.

    Raises Problem if a file is not output of `beambench census --json`.
    """
    rows: list[dict[str, object]] = []
    for order in ORDERS:
        for scene, counts in _scenes(census_file(folder, order), order).items():
            quantities = {f"shadow_cached_{order}": counts["shadow_cached"]}
            if order == ORDERS[0]:
                quantities |= {
                    "eye_rays": counts["eye_rays"],
                    "secondary_rays": counts["reflected_rays"] + counts["refracted_rays"],
                    "shadow_hidden": counts["shadow_hidden"],
                }
            setting = {"scene": scene, "contender": PICTURE, "resolution": "", "samples": 1}
            numbers = {"level": 0, "objects": 0, "cells": 0}
            rows += _entries(setting | numbers, _exact(quantities))
    return pd.DataFrame(rows, columns=list(WORK))


def _scenes(path: Path, order: str) -> dict[str, dict[str, Any]]:
    """Returns the thesis's scenes in a file, by their plain names."""
    try:
        source = load_json(path)
        if (source["shadows"], source["order"]) != ("cache", order):
            raise ValueError(f"not counted with --shadows cache --order {order}")
        named = {str(entry["scene"]).split(":")[0]: entry for entry in source["scenes"]}
        return {scene: named[scene] for scene in primitives_by_scene() if scene in named}
    except (ValueError, KeyError, TypeError, OSError) as error:
        raise Problem(f"{path}: is not what `beambench census --json` prints ({error})") from None
