"""results/published/default: the default run, and whether a second one finds it again."""

from pathlib import Path
from typing import Any

from beambench_operations.publish.figures.cells import Cells
from beambench_report.base.analysis import read_analysis
from beambench_report.base.records import read_run
from beambench_report.run.repeatability import repeatability

_LEVEL_6 = ("beam:max_level=6", "samet:max_level=6")
_TETRA = "tetra:n=6"


def figures(folder: Path) -> dict[str, Any]:
    """Who is fastest at the highest resolution; beams beside single rays; the second run."""
    cells = Cells(folder)
    analysis = read_analysis(folder)
    (of_primary,) = analysis.means
    return {
        "cells": len(cells.rows),
        "about_backs": cells.about_backs,
        "wrong": len(cells.wrong),
        "views": analysis.views,
        "means": of_primary.means,
        "size": analysis.views[0].size,
        "beams": {
            scene: {
                size: cells.ratio(_LEVEL_6[1], _LEVEL_6[0], "total", scene=scene, size=size)
                for size in cells.sizes
            }
            for scene in cells.scenes
        },
        "sizes": cells.sizes,
        "tetra": {
            size: cells.ratio(*_LEVEL_6, "total", scene=_TETRA, size=size) for size in cells.sizes
        },
        "again": _again(folder),
    }


def _again(folder: Path) -> dict[str, Any]:
    """The medians of each of two runs that lie in the intervals that the other one states."""
    first, second = read_run(folder), read_run(folder / "again")
    there, back = repeatability(first, second), repeatability(second, first)
    return {
        "folders": (str(first.directory.name), str(second.directory.name)),
        "cells": len(there.cells),
        "within": int(there.cells["within"].sum()),
        "share": there.share,
        "swapped": int(back.cells["within"].sum()),
        "swapped_share": back.share,
        "half": float(there.cells["change"].abs().quantile(0.5)),
        "most": float(there.cells["change"].abs().quantile(0.9)),
    }
