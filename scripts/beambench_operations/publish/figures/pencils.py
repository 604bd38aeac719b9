"""results/published/pencils: shadow and mirror rays and whole pictures by tile beams and Embree."""

from pathlib import Path
from typing import Any

from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.comparison import figures_of, read_pairings
from beambench_operations.publish.reports import PENCILS


def figures(folder: Path) -> dict[str, Any]:
    """Returns the groups with their ratios, and the cells whose hits are wrong."""
    runs = [folder / name for name in PENCILS if (folder / name / "results.csv").is_file()]
    cells = [Cells(run) for run in runs]
    return figures_of(read_pairings(folder, PENCILS)) | {
        "cells": sum(len(one.rows) for one in cells),
        "wrong": [row for one in cells for row in one.wrong.to_dict("records")],
    }
