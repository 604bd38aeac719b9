"""The cost of a cell, from the repetitions that other work on the machine disturbed least.

Other work only ever adds to a time. On a shared machine it adds to more than half of the
repetitions, so that medians of equal work differ by half (Chen and Revels, Robust benchmarking in
noisy environments, 2016, section III). Therefore only the fastest few repetitions count.

They are chosen by their wall time, and their cost is counted in clock cycles, since the clock of
two runs may differ. Choosing by cycles would be wrong: the clock's rate is read before and after a
repetition, and where a disturbance coincides with a reading, there are too few cycles. On a
disturbed machine, the least cycles of two runs differed several times as much as the cycles of
their fastest repetitions.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import comb, nan
from statistics import median

import pandas as pd

from beambench_report.base.cell_files import CellFile, Identity, identity, read_cell_files
from beambench_report.base.records import Run


@dataclass(frozen=True)
class Fastest:
    """Medians of the fastest repetitions of a cell, building included."""

    ms: float
    trace_ms: float
    mcycles: float
    error: float
    """The relative difference to expect if this process made as many repetitions again.

    NaN for fewer than four repetitions; then only the fastest counts. The bound depends on the
    distribution: results/published/thesis states how often a second run was within it.
    """


_UNKNOWN = Fastest(nan, nan, nan, nan)


def fastest_of(files: Sequence[CellFile]) -> Fastest | None:
    """Returns the figures of one cell from its fastest repetitions in the files of several runs.

    None if no clock rate is known. The error is the range of the fastest repetitions' cycles or of
    their wall times, whichever is less: a misread clock widens only the former, a clock whose
    rate changed only the latter.
    """
    repetitions = sorted(
        (ms, ms * file.clock_ghz[turn], file.trace_ms[turn])
        for file in files
        for turn, ms in file.total_ms.items()
        if turn in file.clock_ghz
    )
    if not repetitions:
        return None
    count = _rank(len(repetitions))
    ms, cycles, trace = zip(*repetitions[: count or 1], strict=True)
    middle = median(cycles)
    error = min((max(cycles) - min(cycles)) / middle, (ms[-1] - ms[0]) / ms[0]) if count else nan
    return Fastest(median(ms), median(trace), middle, error)


def _rank(count: int) -> int | None:
    """Returns the number of repetitions that count.

    It is the least rank whose time an equal number of further repetitions all exceed with a
    probability of at most 2.5%: None for fewer than four repetitions, five for six to twenty-four
    (repeat_spread_of_minimum in the harness).
    """
    exceeded = ((rank, comb(2 * count - rank, count)) for rank in range(1, count + 1))
    return next((rank for rank, ways in exceeded if ways <= 0.025 * comb(2 * count, count)), None)


def with_fastest(runs: Sequence[Run]) -> list[pd.DataFrame]:
    """Returns the rows of each run with the fields of Fastest as columns, such as `fastest_ms`.

    They are NaN if the repetitions of a row are not known. If several runs measured a cell, its
    rows have the same figures, from the repetitions of all these runs.
    """
    files: dict[Identity, list[CellFile]] = {}
    for run in runs:
        for cell, file in read_cell_files(run.directory).items():
            files.setdefault(cell, []).append(file)
    figures = {cell: fastest_of(own) for cell, own in files.items()}
    tables = []
    for run in runs:
        found = [figures.get(identity(row)) or _UNKNOWN for row in run.rows.to_dict("records")]
        added = pd.DataFrame(found, index=run.rows.index).add_prefix("fastest_")
        tables.append(pd.concat([run.rows, added], axis="columns"))
    return tables
