"""results/published/decision: which structure for which rays."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from beambench.analysis import Ratio, geometric_mean
from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.tuned_embree import STREAMS, TILE_BEAM, instruction_set
from beambench_report.base.cell_files import ratio_of
from beambench_report.base.names import parameter_items

SINGLE = "sah-bvh:builder=spatial,lists=single"
_OWN = {TILE_BEAM: "`tile-beam`", STREAMS: "`sah-bvh`, streams", SINGLE: "`sah-bvh`, ray by ray"}


@dataclass(frozen=True)
class Row:
    """The speeds relative to Embree for one ray kind, by contender."""

    best: dict[str, Ratio]  # over Embree's fastest correct mode
    watertight: dict[str, Ratio]  # over its fastest watertight mode
    by_scene: dict[str, dict[str, Ratio]]  # by scene: over Embree's fastest correct mode
    shown: str  # the contender with the largest mean, whose ratios are shown
    tied: list[str]  # contenders that are not clearly slower than the one shown

    @property
    def winner(self) -> str:
        """The contender with the largest mean over Embree; `embree` if all are slower."""
        return self.shown if self.best[self.shown].value > 1 else "embree"


def figures(folder: Path) -> dict[str, Any]:
    """Returns the ratios to Embree by ray kind and contender."""
    cells = Cells(folder)
    kinds = list(dict.fromkeys(cells.rows["kind"]))
    return {
        "rows": {kind: _row(cells, kind) for kind in kinds},
        "names": _OWN | {"embree": "`embree`"},
        "contenders": list(_OWN),
        "streams": STREAMS,
        "single": SINGLE,
        "scenes": cells.scenes,
        "size": cells.sizes[0],
        "cells": len(cells.rows),
        "wrong": cells.wrong.to_dict("records"),
        "isa": instruction_set(cells),
    }


def _row(cells: Cells, kind: str) -> Row:
    embree = cells.having("embree", kind=kind)
    embree = embree[embree["timed"]]
    watertight = embree[embree["parameters"].map(_is_watertight)]
    over_best, over_watertight = (
        {name: _over(cells, name, kind, rows) for name in _OWN} for rows in (embree, watertight)
    )
    best = {name: geometric_mean(list(own.values())) for name, own in over_best.items()}
    shown = max(best, key=lambda name: best[name].value)
    others = [name for name in _OWN if name != shown]
    return Row(
        best,
        {name: geometric_mean(list(own.values())) for name, own in over_watertight.items()},
        {scene: {name: over_best[name][scene] for name in _OWN} for scene in cells.scenes},
        shown,
        [name for name in others if cells.mean(name, shown, kind=kind).rank != "behind"],
    )


def _over(cells: Cells, name: str, kind: str, rows: pd.DataFrame) -> dict[str, Ratio]:
    """Returns the time of the fastest of these rows over a contender's, by scene."""
    fastest = rows.loc[rows.groupby("scene")["trace_ms"].idxmin()].set_index("scene", drop=False)
    return {
        scene: ratio_of(
            "trace", fastest.loc[scene], cells.row(name, scene=scene, kind=kind), cells.files
        )
        for scene in cells.scenes
    }


def _is_watertight(parameters: str) -> bool:
    return parameter_items(parameters).get("robust") == "true"
