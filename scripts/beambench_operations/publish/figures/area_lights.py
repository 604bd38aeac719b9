"""results/published/area-lights: soft shadows and ambient occlusion, compared with Embree."""

from pathlib import Path
from typing import Any

from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.comparison import with_target
from beambench_operations.publish.figures.tuned_embree import (
    STREAMS,
    TILE_BEAM,
    instruction_set,
    line,
    modes,
)

AREA = "area"
OCCLUSION = "ao:samples=4"
_TARGETS = {"AVX2": (1.7, 1.6), "AVX-512": (2.5, 2.2)}
_LEAST = {"AVX2": 1.1, "AVX-512": 1.5}


def figures(folder: Path) -> dict[str, Any]:
    """Returns the ratios to Embree by contender and ray kind, and the number of rays."""
    cells = Cells(folder / "lists")
    isa = instruction_set(cells)
    of_area, of_occlusion = _TARGETS[isa]
    area = line(cells, TILE_BEAM, of_area, kind=AREA)
    occlusion = line(cells, STREAMS, of_occlusion, kind=OCCLUSION)
    return {
        "isa": isa,
        "scenes": cells.scenes,
        "lines": {
            "area lights, `tile-beam`": area,
            "ambient occlusion, `sah-bvh`": occlusion,
            "ambient occlusion, `tile-beam`": line(cells, TILE_BEAM, None, kind=OCCLUSION),
        },
        "area": area.mean,
        "occlusion": occlusion.mean,
        "least": _LEAST[isa],
        "below": {scene: one for scene, one in area.scenes.items() if one.value < _LEAST[isa]},
        "rays": {
            scene: int(cells.row(TILE_BEAM, scene=scene, kind=AREA)["rays"])
            for scene in cells.scenes
        },
        "embree": {kind: modes(cells, kind) for kind in (AREA, OCCLUSION)},
        "wrong": len(cells.wrong),
        "cells": len(cells.rows),
        "with_target": with_target,
    }
