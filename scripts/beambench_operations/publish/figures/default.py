"""results/published/default: the default run, and whether a second run confirms it."""

from pathlib import Path
from typing import Any

from beambench.analysis import Ratio
from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.formats import is_ahead, is_behind
from beambench_report.base.analysis import read_analysis

_BEAMS = "beam:max_level=6,leaf=exact"
"""These beams test samples one by one, as single rays are tested."""
_BEAMS_SIMD = "beam:max_level=6,leaf=simd"
_RAYS = "samet:max_level=6"


def figures(folder: Path) -> dict[str, Any]:
    """Returns who is fastest at the highest resolution, and the speed of beams over single rays."""
    cells = Cells(folder)
    analysis = read_analysis(folder)
    (of_primary,) = analysis.means
    beams = _speedups(cells, _BEAMS)
    return {
        "cells": len(cells.rows),
        "wrong": len(cells.wrong),
        "views": analysis.views,
        "means": of_primary.means,
        "size": analysis.views[0].size,
        "beams": beams,
        "won": {size: sum(is_ahead(own[size]) for own in beams.values()) for size in cells.sizes},
        "lost": {size: sum(is_behind(own[size]) for own in beams.values()) for size in cells.sizes},
        "beams_simd": _speedups(cells, _BEAMS_SIMD),
        "sizes": cells.sizes,
    }


def _speedups(cells: Cells, beams: str) -> dict[str, dict[str, Ratio]]:
    """Returns the speedup of beams over single rays, by scene and size."""
    return {
        scene: {
            size: cells.ratio(_RAYS, beams, "total", scene=scene, size=size) for size in cells.sizes
        }
        for scene in cells.scenes
    }
