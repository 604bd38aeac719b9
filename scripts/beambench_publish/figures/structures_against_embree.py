"""results/published/structures-against-embree: up to a million triangles."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from beambench_publish.figures.cells import Cells
from beambench_publish.figures.net_ratios import net_ratios

_BASE = "embree:robust=true"
_CONTENDERS = {
    "`embree`, watertight": _BASE,
    "`embree`, not watertight": "embree:robust=false",
    "`sah-bvh`": "sah-bvh",
    "`goldsmith-salmon:order=shuffled`": "goldsmith-salmon",
    "`samet:max_level=7`": "samet:max_level=7",
    "`samet:max_level=8`": "samet:max_level=8",
    "`samet-net:max_level=8`": "samet-net",
    "`voxel-grid`": "voxel-grid",
}


def figures(folder: Path) -> dict[str, Any]:
    """Ratios to watertight Embree, and builds."""
    cells = Cells(folder)
    return {
        "scenes": cells.scenes,
        "size": cells.sizes[0],
        "cells": len(cells.rows),
        "wrong": len(cells.wrong),
        "ratios": net_ratios(cells, _BASE, _CONTENDERS),
        "build": {
            name: {
                scene: float(
                    cells.row(contender, scene=scene, ray_kind="primary")["build_ms_median"]
                )
                for scene in cells.scenes
            }
            for name, contender in _CONTENDERS.items()
        },
    }
