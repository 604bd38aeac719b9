"""Chooses the reference: the contender to which the ratios of a page relate."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf

import numpy as np
import pandas as pd

from beambench.analysis import Ratio
from beambench_report.base.cell_files import CellFile, Identity, ratio_of
from beambench_report.base.files import Problem
from beambench_report.base.records import OK, Run, finest_rays


@dataclass(frozen=True)
class Compared:
    """The rows of one view at one resolution, and each contender's ratio to the reference."""

    rows: pd.DataFrame
    ratios: Mapping[str, Ratio]


def choose_reference(run: Run, wanted: str | None = None) -> str | None:
    """Returns the reference: the contender with correct hits in the most views.

    Among equals, Embree's contenders come first, and of these the one with the least geometric mean
    of trace times; without Embree, the first. None if no contender has correct hits. Raises Problem
    for a name that the run does not have.
    """
    right = run.rows[run.rows["timed"] & (run.rows["verdict"] == OK)]
    contenders = list(dict.fromkeys(right["contender"]))
    if wanted is not None:
        return _chosen(wanted, contenders)
    views = right.groupby("contender")["view"].nunique()
    most = [name for name in contenders if views[name] == views.max()]
    finest = pd.concat([run.finest(view) for view in run.views])
    finest = finest[finest["timed"] & (finest["trace_ms"] > 0)]
    times = np.log(finest["trace_ms"] / finest["rays"]).groupby(finest["contender"]).mean()
    return min(
        (name for name in most if _is_embree(name)),
        key=lambda name: times.get(name, inf),
        default=most[0] if most else None,
    )


def why_reference(reference: str, wanted: str | None) -> str:
    """Returns why the reference was chosen, as the end of a sentence."""
    if wanted is not None:
        return "chosen by --reference"
    if _is_embree(reference):
        return "Embree's fastest with correct hits in the most views"
    return "the first contender with correct hits in the most views"


def _is_embree(contender: str) -> bool:
    return contender.split()[0] == "embree"


def _chosen(wanted: str, contenders: list[str]) -> str:
    """Returns the contender of that name, or the only one of that structure."""
    if wanted in contenders:
        return wanted
    variants = [name for name in contenders if name.split()[0] == wanted]
    if len(variants) == 1:
        return variants[0]
    if variants:
        listed = " or ".join(f"'{name}'" for name in variants)
        raise Problem(f"'{wanted}' is the structure of {len(variants)} contenders; name {listed}")
    raise Problem(f"no contender '{wanted}' has correct hits; these have: {', '.join(contenders)}")


def compared(
    run: Run, view: str, reference: str | None, files: Mapping[Identity, CellFile]
) -> list[Compared]:
    """Returns a view at each resolution: the `finest_rays` first, then by the number of rays."""
    rows = run.view(view)
    finest = finest_rays(rows)
    groups = [(key[0], own) for key, own in rows.groupby(["rays", "width", "height"])]
    groups.sort(key=lambda group: (group[0] == finest, group[0]), reverse=True)
    return [Compared(own, _ratios(own, reference, files)) for _, own in groups]


def _ratios(
    rows: pd.DataFrame, reference: str | None, files: Mapping[Identity, CellFile]
) -> dict[str, Ratio]:
    timed = rows[rows["timed"]].drop_duplicates("contender", keep="last").set_index("contender")
    if reference not in timed.index:
        return {}
    base = timed.loc[reference]
    others = timed.drop(reference) if base["total_ms_median"] > 0 else timed.iloc[:0]
    found = {name: ratio_of("total", row, base, files) for name, row in others.iterrows()}
    return found | {reference: Ratio(1.0)}
