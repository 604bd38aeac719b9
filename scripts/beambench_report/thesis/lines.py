"""Lines of points for the figures: the thesis's seconds and ours, over the number of rays."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from beambench_report.ledger.comparisons import rays
from beambench_report.ledger.evidence import RESOLUTIONS, SETTING
from beambench_report.ledger.measured import Measured
from beambench_report.ledger.published import published_evidence
from beambench_report.thesis.cells import Cells, Setting

ACROSS = "rays / 10,000"
TICKS = tuple(round(rays(resolution) / 1e4, 2) for resolution in RESOLUTIONS)

_RESOLUTION = SETTING.index("resolution")

Line = list[tuple[float, Measured]]


def measured(cells: Cells, keys: Iterable[Setting]) -> Line:
    """Our seconds, where there are any."""
    found = ((key, cells.at(key)) for key in keys)
    return [(place(key), cell.time) for key, cell in found if cell and cell.time]


def seconds_told(keys: Iterable[Setting]) -> Line:
    """The thesis's seconds, where some table has them."""
    line = []
    for scene, contender, level, objects, cells, resolution, samples in keys:
        told = published_evidence().time(
            scene,
            contender,
            resolution,
            level=level,
            objects=objects,
            cells=cells,
            samples=samples,
        )
        if told:
            line.append((rays(resolution) / 1e4, told))
    return line


def place(key: Setting) -> float:
    """Ten thousands of rays of one sample a pixel, as the thesis counts them."""
    return rays(str(key[_RESOLUTION])) / 1e4


def over(line: Sequence[tuple[float, Measured]], base: float) -> Line:
    """The line as multiples of a figure."""
    return [(at, figure.times(1 / base)) for at, figure in line]
