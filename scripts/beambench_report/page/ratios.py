"""Ratios of times to those of a reference contender: see beambench_report.ratio."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import pandas as pd

from beambench_report.page.cell_files import CellFile, Identity, identity
from beambench_report.problem import Problem
from beambench_report.ratio import Ratio, median_of, paired_ratio, unpaired_ratio
from beambench_report.records import Run

_FAVOURITE = "embree"


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
        return _chosen(wanted, contenders)
    views = right.groupby("contender")["view"].nunique()
    return max(
        contenders, key=lambda name: (views[name], name.split()[0] == _FAVOURITE), default=None
    )


def _chosen(wanted: str, contenders: list[str]) -> str:
    """The contender of that name, or the only one of that structure."""
    if wanted in contenders:
        return wanted
    variants = [name for name in contenders if name.split()[0] == wanted]
    if len(variants) == 1:
        return variants[0]
    if variants:
        listed = " or ".join(f"'{name}'" for name in variants)
        raise Problem(f"'{wanted}' is the structure of {len(variants)} contenders; name {listed}")
    raise Problem(f"no contender '{wanted}' was right; there are: {', '.join(contenders)}")


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
        elif file and base_file and (ratio := paired_ratio(file.total_ms, base_file.total_ms)):
            result[contender] = ratio
        elif base["total_ms_median"] > 0:
            result[contender] = unpaired_ratio(median_of(row, "total"), median_of(base, "total"))
    return result
