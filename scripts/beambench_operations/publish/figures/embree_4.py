"""results/published/embree-4: tile beams and sah-bvh compared with every mode of Embree 4."""

from pathlib import Path
from typing import Any

from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.comparison import figures_of, read_pairings


def figures(folder: Path) -> dict[str, Any]:
    """Returns the ratios of groups of scenes, and sah-bvh relative to Embree's single rays."""
    cells = Cells(folder)
    return figures_of(read_pairings(folder, (".",))) | {
        "cells": len(cells.rows),
        "wrong": cells.wrong.to_dict("records"),
        "single": {
            size: cells.mean("sah-bvh", "embree:mode=single", size=size) for size in cells.sizes
        },
        "scenes": cells.scenes,
    }
