"""results/published/area-lights: soft shadows, compared with Embree."""

from pathlib import Path
from typing import Any

from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.comparison import with_target
from beambench_operations.publish.figures.tuned_embree import (
    TILE_BEAM,
    instruction_set,
    line,
    modes,
)

AREA = "area"
_TARGETS = {"AVX2": 1.7, "AVX-512": 2.5}
_LEAST = {"AVX2": 1.1, "AVX-512": 1.5}


def figures(folder: Path) -> dict[str, Any]:
    """Returns the ratios of `tile-beam` to Embree, and the number of rays."""
    cells = Cells(folder / "lists")
    isa = instruction_set(cells)
    area = line(cells, TILE_BEAM, _TARGETS[isa], kind=AREA)
    return {
        "isa": isa,
        "scenes": cells.scenes,
        "ratios": area.scenes,
        "area": area.mean,
        "least": _LEAST[isa],
        "below": {scene: one for scene, one in area.scenes.items() if one.value < _LEAST[isa]},
        "rays": {
            scene: int(cells.row(TILE_BEAM, scene=scene, kind=AREA)["rays"])
            for scene in cells.scenes
        },
        "embree": modes(cells, AREA),
        "wrong": len(cells.wrong),
        "cells": len(cells.rows),
        "with_target": with_target,
    }
