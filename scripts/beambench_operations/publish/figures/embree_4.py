"""results/published/embree-4: tile beams and sah-bvh beside every mode of Embree 4."""

from pathlib import Path
from typing import Any

from beambench.analysis import geometric_mean
from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.comparison import figures_of, read_pairings


def figures(folder: Path) -> dict[str, Any]:
    """The groups of scenes with their ratios, and sah-bvh over Embree's single rays."""
    cells = Cells(folder)
    single = {
        size: geometric_mean(
            [
                cells.ratio("sah-bvh", "embree:mode=single", scene=scene, size=size)
                for scene in cells.scenes
            ]
        )
        for size in cells.sizes
    }
    return figures_of(read_pairings(folder, (".",))) | {
        "cells": len(cells.rows),
        "wrong": cells.wrong.to_dict("records"),
        "single": single,
        "scenes": cells.scenes,
    }
