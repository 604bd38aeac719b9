"""results/published/beat-embree: images by tile beams and by Embree's fastest mode."""

from pathlib import Path
from typing import Any

import pandas as pd

from beambench.analysis import Ratio
from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.comparison import figures_of, read_pairings
from beambench_operations.publish.reports import BEAT_EMBREE
from beambench_report.embree_comparison.pairings import in_one_way

_MILLION = "bumpy:triangles=1000000"
_FEWER = "bumpy:triangles=200000"
_EQUALLY_DENSE = {"320x200": "143x89", "1280x1024": "572x458"}
"""For each resolution over a million triangles, the resolution that has as many pixels per triangle
over 200,000 triangles.
"""


def figures(folder: Path) -> dict[str, Any]:
    """Returns the groups with their ratios, the growth with triangles, and builds."""
    found = read_pairings(folder, BEAT_EMBREE)
    best = [one for one in found if one.isa == "best"]
    bumpy = [one for one in best if one.scene.startswith("bumpy:")]
    growing = in_one_way(
        [one for one in bumpy if one.resolution == "1280x1024"], lambda one: one.primitives
    )
    million = [one for one in bumpy if one.scene == _MILLION]
    return figures_of(found) | {
        "growing": sorted(growing, key=lambda one: one.primitives),
        "build": {
            "tile_beam": [one.tile.build for one in million],
            "embree": [one.embree.build for one in million],
        },
        "memory": _memory(folder / "memory"),
        "xeon": _xeon(folder / "xeon.csv"),
        "fastest": sorted({one.embree.contender for one in best}),
    }


def _xeon(file: Path) -> dict[str, Ratio]:
    """Returns an earlier run's geometric means over the scenes of triangles, by resolution."""
    return {
        row.resolution: Ratio(row.ratio, row.low, row.high)
        for row in pd.read_csv(file).itertuples()
    }


def _memory(run: Path) -> dict[str, float]:
    """Returns the second trace's time per ray over a million triangles, divided by that over
    200,000.

    Both images have as many pixels per triangle, so the work is alike while the memory differs.
    Empty if it was not measured.
    """
    if not run.is_dir():
        return {}
    cells = Cells(run)

    def per_ray(scene: str, size: str) -> float:
        row = cells.row("tile-beam", scene=scene, size=size)
        return float(row["trace_warm_ms_median"] / row["rays"])

    return {
        size: per_ray(_MILLION, size) / per_ray(_FEWER, fewer)
        for size, fewer in _EQUALLY_DENSE.items()
    }
