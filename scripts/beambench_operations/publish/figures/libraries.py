"""results/published/libraries: tinybvh and madmann91/bvh compared with sah-bvh and Embree."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from beambench.analysis import Ratio, geometric_mean
from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.net_ratios import paired_net_ratio
from beambench_operations.publish.figures.tuned_embree import STREAMS, fastest_embree

_BASE = "embree:mode=single,robust=true"
_TINYBVH = "tinybvh:layout=bvh8,builder=binned,optimize=0,exact_t=true"
_MADMANN91 = "madmann91-bvh"
_CONTENDERS = {
    "`sah-bvh:builder=spatial,collapse=cost`, streams": STREAMS,
    "`sah-bvh` (the default), streams": "sah-bvh:builder=binned,lists=streams",
    "`sah-bvh:builder=spatial,lists=single`": "sah-bvh:builder=spatial,lists=single",
    "`sah-bvh:lists=single`": "sah-bvh:builder=binned,lists=single",
    "`tinybvh:layout=bvh8` (the default)": f"{_TINYBVH},normalize=true",
    "the same, `normalize=false`": f"{_TINYBVH},normalize=false",
    "the same, `normalize=false,optimize=50`": (
        "tinybvh:layout=bvh8,builder=binned,normalize=false,optimize=50"
    ),
    "the same, `normalize=false,builder=spatial`": "tinybvh:builder=spatial",
    "`tinybvh:layout=bvh4`": "tinybvh:layout=bvh4",
    "`madmann91-bvh`": _MADMANN91,
    "Embree's single rays, not watertight": "embree:mode=single,robust=false",
}
_KINDS = ("primary", "shadow", "diffuse", "ao:samples=4")
_SINGLE_RAYS = ("sah-bvh:builder=spatial,lists=single", "sah-bvh:builder=binned,lists=single")


def figures(folder: Path) -> dict[str, Any]:
    """Returns geometric means relative to watertight Embree, and the speedup of streams over
    others.
    """
    cells = Cells(folder)
    return {
        "scenes": cells.scenes,
        "size": cells.sizes[0],
        "cells": len(cells.rows),
        "wrong": cells.wrong.to_dict("records"),
        "versions": sorted(set(cells.rows["library_version"]) - {""}),
        "kinds": _KINDS,
        "means": {
            name: own
            for name, contender in _CONTENDERS.items()
            if (own := _means(cells, contender))
        },
        "streams": {
            "the fastest of tinybvh's configurations": _gain(cells, "tinybvh"),
            "`madmann91-bvh`": _gain(cells, _MADMANN91),
            "single rays through the fastest of `sah-bvh`'s hierarchies": _gain(
                cells, *_SINGLE_RAYS
            ),
            "tuned Embree, the list in its faster order": _gain(cells, "embree"),
        },
    }


def _means(cells: Cells, contender: str) -> dict[str, Ratio]:
    """Returns a contender's time over watertight Embree's, by ray kind with only correct scenes."""
    found = {}
    for kind in _KINDS:
        views = [{"scene": scene, "ray_kind": kind} for scene in cells.scenes]
        if all(cells.having(contender, **view)["timed"].any() for view in views):
            found[kind] = geometric_mean(
                [
                    paired_net_ratio(cells, cells.row(contender, **view), cells.row(_BASE, **view))
                    for view in views
                ]
            )
    return found


def _gain(cells: Cells, *others: str) -> dict[str, dict[str, Ratio]]:
    """Returns the time of the fastest of the others, chosen in each view, over that of streams.

    The result is by ray kind and scene, with the mean as `mean`. Only Embree has lists in two
    orders.
    """
    found: dict[str, dict[str, Ratio]] = {}
    for kind in _KINDS:
        by_scene = {
            scene: paired_net_ratio(
                cells,
                fastest_embree(cells, scene=scene, kind=kind)
                if others == ("embree",)
                else _fastest(cells, others, scene=scene, ray_kind=kind),
                cells.row(STREAMS, scene=scene, ray_kind=kind),
            )
            for scene in cells.scenes
        }
        found[kind] = by_scene | {"mean": geometric_mean(list(by_scene.values()))}
    return found


def _fastest(cells: Cells, contenders: Sequence[str], **columns: str) -> pd.Series:
    rows = pd.concat([cells.having(contender, **columns) for contender in contenders])
    rows = rows[rows["timed"]]
    return rows.loc[rows["trace_ms"].idxmin()]
