"""results/published/beat-embree-everywhere: streams of incoherent rays, compared with Embree."""

from pathlib import Path
from typing import Any

from beambench.analysis import Ratio
from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.comparison import with_target
from beambench_operations.publish.figures.origins import require_one_origin
from beambench_operations.publish.figures.tuned_embree import (
    STREAMS,
    TILE_BEAM,
    fastest_embree,
    instruction_set,
    line,
    modes,
    timed_embree,
    to_embree,
)
from beambench_report.base.cell_files import unpaired_ratio_of

BINNED = "sah-bvh:builder=binned,collapse=cost"
SINGLE = "sah-bvh:builder=spatial,lists=single"
KINDS = ("diffuse", "path:bounces=3", "ao:samples=4", "reflection")
_TARGETS = {
    "AVX2": {"diffuse": 1.9, "path:bounces=3": 1.9, "ao:samples=4": 1.4, "reflection": 1.4},
    "AVX-512": {"diffuse": 2.6, "path:bounces=3": 2.6, "ao:samples=4": 1.9, "reflection": 1.8},
}
_DEFAULT_BATCH = 32768  # the batch size of pictures (harness/rays/ray_kind.hpp)
_PICTURES = {"AVX2": 1.5, "AVX-512": 2.0}


def figures(folder: Path) -> dict[str, Any]:
    """Returns the ratios to Embree by ray kind, and the effects of list lengths, batches and
    threads.
    """
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
                if timed_embree(pictures, scene=scene, size=size).empty
            ]
            for size in pictures.sizes
        },
        "lengths": _lengths(Cells(folder / "lengths")),
        "batches": _batches(Cells(folder / "batches")),
        "threads": _threads(Cells(folder / "threads-1"), Cells(folder / "threads-2")),
        "builds": _builds(lists),
        "wrong": [row for one in (lists, pictures) for row in one.wrong.to_dict("records")],
        "cells": len(lists.rows) + len(pictures.rows),
        "embree_4": _embree_4(folder / "embree-4"),
        "with_target": with_target,
    }


def _embree_4(folder: Path) -> dict[str, Any]:
    """Returns the ratios to Embree 4 by ray kind; empty if it was not measured."""
    if not (folder / "results.csv").is_file():
        return {}
    cells = Cells(folder)
    (version,) = set(cells.having("embree")["library_version"])
    return {
        "version": version,
        "scenes": cells.scenes,
        "lists": {kind: line(cells, STREAMS, None, kind=kind) for kind in KINDS},
        "tile_beam": {kind: line(cells, TILE_BEAM, None, kind=kind).mean.ratio for kind in KINDS},
        "cells": len(cells.rows),
        "wrong": len(cells.wrong),
    }


def _large(cells: Cells) -> dict[str, dict[str, Ratio]]:
    """Returns the ratios over one large mesh, by contender and ray kind."""
    kinds = dict.fromkeys(cells.rows["kind"])
    return {
        name: {kind: to_embree(cells, name, scene=cells.scenes[0], kind=kind) for kind in kinds}
        for name in (STREAMS, TILE_BEAM)
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
    """Returns the time of pictures in batches of 4,096 over that in batches of other sizes, by
    scene and contender.
    """
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
    """Returns the speedup of two threads over one, by scene and ray kind."""
    require_one_origin(one.folder, two.folder)
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
                fastest_embree(cells, scene=scene, **view)
                if name == "embree"
                else cells.row(name, scene=scene, **view),
            )
        }
        for name in (STREAMS, BINNED, TILE_BEAM, "embree")
    }
