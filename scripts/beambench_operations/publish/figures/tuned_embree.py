"""Tuned Embree, with lists in both orders, compared with other contenders of one run."""

from collections.abc import Mapping
from dataclasses import dataclass

import pandas as pd

from beambench.analysis import Ratio, geometric_mean
from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.net_ratios import paired_net_ratio
from beambench_report.base.cell_files import ratio_of
from beambench_report.base.files import Problem
from beambench_report.embree_comparison.pairings import mode_name
from beambench_report.embree_comparison.results import Result

STREAMS = "sah-bvh:builder=spatial,collapse=cost"
TILE_BEAM = "tile-beam"


@dataclass(frozen=True)
class Line:
    """Embree's time over that of one contender, scene by scene and as a geometric mean."""

    scenes: Mapping[str, Ratio]
    mean: Result


def instruction_set(cells: Cells) -> str:
    """Returns the machine's instruction set, as the targets name it."""
    names = set(cells.having(STREAMS)["structure_isa"])
    return "AVX-512" if all(name.startswith("AVX3") for name in names) else "AVX2"


def line(cells: Cells, contender: str, target: float | None, **columns: str) -> Line:
    """Returns Embree's time over a contender's, over the scenes where Embree's hits are correct."""
    scenes = {
        scene: to_embree(cells, contender, scene=scene, **columns)
        for scene in cells.scenes
        if not timed_embree(cells, scene=scene, **columns).empty
    }
    mean = geometric_mean(list(scenes.values()))
    return Line(scenes, Result(mean, target, scenes=len(scenes)))


def to_embree(cells: Cells, contender: str, **columns: str) -> Ratio:
    """Returns the time of Embree's fastest correct mode and list order over a contender's.

    For whole pictures, both times exclude shading.
    """
    over = fastest_embree(cells, **columns)
    under = cells.row(contender, **columns)
    if under["kind"] != "whitted":
        return ratio_of("trace", over, under, cells.files)
    return paired_net_ratio(cells, over, under)


def fastest_embree(cells: Cells, **columns: str) -> pd.Series:
    """Returns the row of Embree's fastest correct mode. Raises Problem if there is none."""
    rows = timed_embree(cells, **columns)
    if rows.empty:
        raise Problem(f"{cells.folder}/results.csv: Embree has no time at {columns}")
    return rows.loc[rows["trace_ms"].idxmin()]


def timed_embree(cells: Cells, **columns: str) -> pd.DataFrame:
    """Returns Embree's rows that have times: those with correct hits."""
    rows = cells.having("embree", **columns)
    return rows[rows["timed"]]


def modes(cells: Cells, kind: str) -> dict[str, str]:
    """Returns Embree's fastest mode by scene."""
    return {
        scene: mode_name(fastest_embree(cells, kind=kind, scene=scene)) for scene in cells.scenes
    }
