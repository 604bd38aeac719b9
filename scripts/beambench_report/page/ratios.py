"""Ratios of times to those of a reference contender, paired round by round.

Contenders take turns, so the repetitions of one round ran side by side: a slow moment of the
machine is in both of them, and their ratio knows less noise than the ratio of the medians.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import comb
from statistics import median

import pandas as pd

from beambench_report.page.cell_files import CellFile, Identity, identity
from beambench_report.problem import Problem
from beambench_report.records import Run

_FAVOURITE = "embree"


@dataclass(frozen=True)
class Ratio:
    """How many times the reference's time; the interval where there were rounds enough for one."""

    value: float
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True)
class Compared:
    """The rows of one view at one resolution, and each contender's ratio to the reference."""

    rows: pd.DataFrame
    ratios: Mapping[str, Ratio]


def choose_reference(run: Run, wanted: str | None = None) -> str | None:
    """The contender others are compared with: right in the most views, Embree rather than others.

    None when no contender was right anywhere. Raises Problem for a name the run does not have.
    """
    right = run.rows[run.rows["timed"] & (run.rows["verdict"] == "ok")]
    contenders = list(dict.fromkeys(right["contender"]))
    if wanted is not None:
        if wanted not in contenders:
            raise Problem(f"no contender '{wanted}' was right; there are: {', '.join(contenders)}")
        return wanted
    views = right.groupby("contender")["view"].nunique()
    return max(
        contenders, key=lambda name: (views[name], name.split()[0] == _FAVOURITE), default=None
    )


def compared(
    run: Run, view: str, reference: str | None, files: Mapping[Identity, CellFile]
) -> list[Compared]:
    """A view at each of its resolutions, the finest first."""
    groups = [rows for _, rows in run.view(view).groupby(["rays", "width", "height"])]
    return [Compared(rows, _ratios(rows, reference, files)) for rows in reversed(groups)]


def _ratios(
    rows: pd.DataFrame, reference: str | None, files: Mapping[Identity, CellFile]
) -> dict[str, Ratio]:
    timed = rows[rows["timed"]].drop_duplicates("contender", keep="last").set_index("contender")
    if reference not in timed.index:
        return {}
    base = timed.loc[reference]
    base_file = files.get(identity(base))
    result = {}
    for contender, row in timed.iterrows():
        file = files.get(identity(row))
        if contender == reference:
            result[contender] = Ratio(1.0)
        elif file and base_file and (rounds := file.total_ms.keys() & base_file.total_ms.keys()):
            result[contender] = _summary(
                [file.total_ms[turn] / base_file.total_ms[turn] for turn in rounds]
            )
        elif base["total_ms_median"] > 0:
            result[contender] = Ratio(row["total_ms_median"] / base["total_ms_median"])
    return result


def _summary(samples: Sequence[float]) -> Ratio:
    ordered = sorted(samples)
    rank = interval_rank(len(ordered))
    if rank == 0:
        return Ratio(median(ordered))
    return Ratio(median(ordered), ordered[rank - 1], ordered[-rank])


def interval_rank(count: int) -> int:
    """The rank of the lower end of the median's 95% interval; 0 where there is none.

    The number of samples below the median is binomial, whatever their distribution.
    """
    rank, below = 0, 0.0
    while rank < count:
        below += comb(count, rank) / 2**count
        if below > 0.025:
            break
        rank += 1
    return rank
