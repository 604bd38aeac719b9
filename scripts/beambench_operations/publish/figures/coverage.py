"""results/published/coverage: how well the second runs of two sweeps agree with the first."""

from pathlib import Path
from typing import Any

import pandas as pd

from beambench.analysis import Ratio
from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.origins import require_one_origin
from beambench_report.base.analysis import read_analysis
from beambench_report.base.cell_files import IDENTITY
from beambench_report.base.files import read_json
from beambench_report.base.records import Run, read_run
from beambench_report.run.coverage import coverage


def figures(folder: Path) -> dict[str, Any]:
    """Returns the coverage of each sweep, and the rasterizer's time over that of tile-beam."""
    default = folder.parent / "default"
    first = folder / "primary-rays/first"
    return {
        "sweeps": {
            "default": _coverage(default, default / "again"),
            "primary-rays": _coverage(first, folder / "primary-rays/second"),
        },
        "rasterizer": _rasterizer(first),
    }


def _coverage(*folders: Path) -> dict[str, Any]:
    require_one_origin(*folders)
    wanted = float(read_json(folders[0] / "config.json")["precision"])
    runs = [(read_run(folder), read_analysis(folder)) for folder in folders]
    rows = coverage(*runs)
    times = [row for row in rows if row.what.startswith("times")]
    changes = _changes(*(run for run, _ in runs))
    return {
        "rows": rows,
        "within": sum(row.within for row in times),
        "count": sum(row.count for row in times),
        "reasons": [analysis.reasons_for_care for _, analysis in runs],
        "precise": [_precise(run, wanted) for run, _ in runs],
        "wanted": wanted,
        "half": float(changes.quantile(0.5)),
        "most": float(changes.quantile(0.9)),
    }


def _changes(first: Run, second: Run) -> pd.Series:
    """Returns the relative change of each cell's time."""
    times = [
        run.rows[run.rows["timed"]].set_index(list(IDENTITY))["trace_ms"] for run in (first, second)
    ]
    return (times[1] / times[0] - 1).abs().dropna()


def _precise(run: Run, wanted: float) -> tuple[int, int]:
    """Returns how many timed cells are as precise as the sweep demands, and how many there are."""
    timed = run.rows[run.rows["timed"]]
    width = (timed["trace_ms_pi_high"] - timed["trace_ms_pi_low"]) / timed["trace_ms"]
    return int((width <= 2 * wanted).sum()), len(timed)


def _rasterizer(folder: Path) -> dict[str, Ratio]:
    """Returns the rasterizer's time over that of tile-beam, by scene."""
    cells = Cells(folder)
    other = cells.having("z-buffer")
    return {
        scene: cells.ratio("z-buffer", "tile-beam:backface_culling=false", scene=scene)
        for scene in other.loc[other["timed"], "scene"]
    }
