"""results/published/beat-embree-everywhere: streams of rays that share no point, and Embree."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from beambench.analysis import Ratio, geometric_mean
from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.comparison import with_target
from beambench_report.base.cell_files import identity, ratio_of, unpaired_ratio_of
from beambench_report.base.files import Problem
from beambench_report.embree_comparison.pairings import mode_name
from beambench_report.embree_comparison.results import Result

STREAMS = "sah-bvh:builder=spatial,collapse=cost"
BINNED = "sah-bvh:builder=binned,collapse=cost"
SINGLE = "sah-bvh:builder=spatial,lists=single"
TILE_BEAM = "tile-beam"
KINDS = ("diffuse", "path:bounces=3", "ao:samples=4", "reflection")
_TARGETS = {
    "AVX2": {"diffuse": 1.9, "path:bounces=3": 1.9, "ao:samples=4": 1.4, "reflection": 1.4},
    "AVX-512": {"diffuse": 2.6, "path:bounces=3": 2.6, "ao:samples=4": 1.9, "reflection": 1.8},
}
_DEFAULT_BATCH = 32768  # of pictures (harness/rays/ray_kind.hpp)
_PICTURES = {"AVX2": 1.5, "AVX-512": 2.0}


@dataclass(frozen=True)
class Line:
    """Embree's time over that of one contender, scene by scene and in geometric mean."""

    scenes: Mapping[str, Ratio]
    mean: Result


def figures(folder: Path) -> dict[str, Any]:
    """Returns the ratios to Embree by kind of rays, and what lengths, batches and threads do."""
    lists, pictures = Cells(folder / "lists"), Cells(folder / "pictures")
    isa = instruction_set(lists)
    own = {kind: line(lists, STREAMS, target, kind=kind) for kind, target in _TARGETS[isa].items()}
    return {
        "isa": isa,
        "scenes": lists.scenes,
        "kinds": KINDS,
        "lists": own,
        "others": {
            name: {kind: line(lists, name, None, kind=kind).mean.ratio for kind in KINDS}
            for name in (BINNED, TILE_BEAM, SINGLE)
        },
        "large": _large(Cells(folder / "large")),
        "embree": {kind: modes(lists, kind) for kind in KINDS},
        "pictures": {
            size: {
                name: line(pictures, name, _PICTURES[isa] if name == TILE_BEAM else None, size=size)
                for name in (TILE_BEAM, STREAMS)
            }
            for size in pictures.sizes
        },
        "no_embree": {
            size: [
                scene
                for scene in pictures.scenes
                if _embree(pictures, scene=scene, size=size).empty
            ]
            for size in pictures.sizes
        },
        "lengths": _lengths(Cells(folder / "lengths")),
        "batches": _batches(Cells(folder / "batches")),
        "threads": _threads(Cells(folder / "threads-1"), Cells(folder / "threads-2")),
        "builds": _builds(lists),
        "wrong": [row for one in (lists, pictures) for row in one.wrong.to_dict("records")],
        "cells": len(lists.rows) + len(pictures.rows),
        "with_target": with_target,
    }


def _large(cells: Cells) -> dict[str, dict[str, Ratio]]:
    """Returns the ratios over one large mesh, by contender and kind of rays."""
    kinds = dict.fromkeys(cells.rows["kind"])
    return {
        name: {kind: _to_embree(cells, name, scene=cells.scenes[0], kind=kind) for kind in kinds}
        for name in (STREAMS, TILE_BEAM)
    }


def instruction_set(cells: Cells) -> str:
    """Returns the name of the aims that the machine's instruction set has."""
    names = set(cells.having(STREAMS)["structure_isa"])
    return "AVX-512" if all(name.startswith("AVX3") for name in names) else "AVX2"


def line(cells: Cells, contender: str, target: float | None, **columns: str) -> Line:
    """Returns Embree's time over a contender's, over the scenes where Embree's hits are correct."""
    scenes = {
        scene: _to_embree(cells, contender, scene=scene, **columns)
        for scene in cells.scenes
        if not _embree(cells, scene=scene, **columns).empty
    }
    mean = geometric_mean(list(scenes.values()))
    return Line(scenes, Result(mean, target, scenes=len(scenes)))


def _to_embree(cells: Cells, contender: str, **columns: str) -> Ratio:
    """Returns the time of Embree's fastest correct way, in either order, over a contender's.

    Of whole pictures, both without the time of shading.
    """
    over = _fastest_embree(cells, **columns)
    under = cells.row(contender, **columns)
    if under["kind"] != "whitted":
        return ratio_of("trace", over, under, cells.files)
    paired = cells.files[identity(over)].ratio(
        "trace_ms",
        cells.files[identity(under)],
        (float(over["harness_ms"]), float(under["harness_ms"])),
    )
    if paired is None:
        raise Problem(f"{cells.folder}: no block has both {contender} and Embree at {columns}")
    return paired


def _fastest_embree(cells: Cells, **columns: str) -> pd.Series:
    rows = _embree(cells, **columns)
    if rows.empty:
        raise Problem(f"{cells.folder}/results.csv: Embree has no time at {columns}")
    return rows.loc[rows["trace_ms"].idxmin()]


def _embree(cells: Cells, **columns: str) -> pd.DataFrame:
    """Returns Embree's rows that have times: those with correct hits."""
    rows = cells.having("embree", **columns)
    return rows[rows["timed"]]


def modes(cells: Cells, kind: str) -> dict[str, str]:
    """Returns Embree's fastest way by scene."""
    return {
        scene: mode_name(_fastest_embree(cells, kind=kind, scene=scene)) for scene in cells.scenes
    }


def _lengths(cells: Cells) -> dict[str, dict[int, Ratio]]:
    """Returns the time of single rays over that of streams, by scene and length of the list."""
    return {
        scene: {
            int(cells.row(STREAMS, scene=scene, size=size)["rays"]): cells.ratio(
                SINGLE, STREAMS, scene=scene, size=size
            )
            for size in cells.sizes
        }
        for scene in cells.scenes
    }


def _batches(cells: Cells) -> dict[str, dict[str, dict[int, Ratio]]]:
    """Returns the time of pictures in batches of 4,096 over that in others: scene, contender."""
    kinds = list(dict.fromkeys(cells.rows["kind"]))
    least = next(kind for kind in kinds if kind.endswith("batch=4096"))
    return {
        scene: {
            name: {
                int(kind.partition("=")[2] or _DEFAULT_BATCH): unpaired_ratio_of(
                    "trace", *(cells.row(name, scene=scene, kind=one) for one in (least, kind))
                )
                for kind in kinds
                if kind != least
            }
            for name in dict.fromkeys(cells.rows["structure"])
        }
        for scene in cells.scenes
    }


def _threads(one: Cells, two: Cells) -> dict[str, dict[str, Ratio]]:
    """Returns how many times as fast two threads are, by scene and kind of rays."""
    return {
        scene: {
            kind: unpaired_ratio_of(
                "trace", *(at.row(STREAMS, scene=scene, kind=kind) for at in (one, two))
            )
            for kind in dict.fromkeys(one.rows["kind"])
        }
        for scene in one.scenes
    }


def _builds(cells: Cells) -> dict[str, dict[str, float]]:
    """Returns build times over those of spatial splits without streams, by contender and scene."""
    view = {"kind": KINDS[0]}
    return {
        name: {
            scene: float(own["build_ms_median"])
            / float(cells.row(SINGLE, scene=scene, **view)["build_ms_median"])
            for scene in cells.scenes
            for own in (
                _fastest_embree(cells, scene=scene, **view)
                if name == "embree"
                else cells.row(name, scene=scene, **view),
            )
        }
        for name in (STREAMS, BINNED, TILE_BEAM, "embree")
    }
