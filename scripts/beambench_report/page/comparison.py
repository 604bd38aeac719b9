"""The overview: every contender against the reference, in every view, at its finest resolution."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import log2

from beambench_report.page.ratios import Compared
from beambench_report.page.table import Field
from beambench_report.page.view_table import MISSING, ratio_field
from beambench_report.ratio import Ratio
from beambench_report.style import structure_colour

_DEEPEST = 4.0  # doublings at which the shade is full


@dataclass(frozen=True)
class Mark:
    """A field of the overview, shaded by how far it is from the reference."""

    field: Field
    verdict: str
    side: str
    depth: float


@dataclass(frozen=True)
class Comparison:
    """Contenders down, views across."""

    reference: str
    views: tuple[str, ...]
    lines: tuple[tuple[str, str, tuple[Mark, ...]], ...]
    """Contender, its colour, its marks in the order of the views."""


def compare(reference: str, finest: Mapping[str, Compared]) -> Comparison:
    """The overview of all views, each at its highest resolution."""
    structures: dict[str, str] = {}
    verdicts: dict[tuple[str, str], str] = {}
    for view, shown in finest.items():
        for row in shown.rows.itertuples():
            structures.setdefault(row.contender, row.structure)
            verdicts[row.contender, view] = row.verdict
    lines = tuple(
        (
            contender,
            structure_colour(structure),
            tuple(
                _mark(shown.ratios.get(contender), verdicts.get((contender, view)))
                for view, shown in finest.items()
            ),
        )
        for contender, structure in structures.items()
    )
    return Comparison(reference, tuple(finest), lines)


def _mark(ratio: Ratio | None, verdict: str | None) -> Mark:
    if verdict is None:
        return Mark(MISSING, "", "", 0.0)
    if ratio is None or ratio.value <= 0 or verdict == "baseline":
        return Mark(ratio_field(ratio), verdict, "", 0.0)
    doublings = log2(ratio.value)
    side = "slower" if doublings > 0 else "faster"
    return Mark(ratio_field(ratio), verdict, side, min(abs(doublings) / _DEEPEST, 1.0))
