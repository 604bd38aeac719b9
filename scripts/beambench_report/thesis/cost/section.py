"""The cost formulas as a part of the report."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from functools import partial

import numpy as np

from beambench_report.quantities import number
from beambench_report.thesis.cells import Cell
from beambench_report.thesis.cost.fitting import Fit, fit
from beambench_report.thesis.cost.formulas import Formula, sums_of_auto, thesis_formulas
from beambench_report.thesis.cost.plot import draw_fits
from beambench_report.thesis.section import Column, Field, Section, SectionFigure, SectionTable
from beambench_report.thesis.texts import DASH

_WORDS = (
    "Section 5.3.3 gives the time of the beams as two sums of counts, each times a cost of its "
    "own. Both are fitted here to every cell of beams with the thesis's parameters, whatever its "
    "scene, level, resolution and samples, by least squares of the relative error and without "
    "negative costs; counts and times are of the counting pass, which takes the time of each beam "
    "by itself. Intervals are of 95%, by drawing the scenes again, with replacement, a thousand "
    "times: they tell how far a cost depends on which scenes were measured. A cost of 0 means that "
    "the other terms tell the times as well without it.",
    "The sums below them are those by which max_level=auto weighs the levels. Their costs are the "
    "constants of accel/octree/choose_octree.cpp and accel/beam/beam_cost.cpp; they are fitted to "
    "the timed passes.",
)
_CAPTION = (
    "Every point is a cell; on the line, the counts tell its time exactly, and in the grey band "
    "within a quarter."
)


def cost_section(cells: Iterable[Cell]) -> Section | None:
    """The fits and their figures; None where nothing can be fitted."""
    cells = list(cells)
    thesis, sums = _fits(thesis_formulas(), cells), _fits(sums_of_auto(), cells)
    fits = [*thesis, *sums]
    if not fits:
        return None
    figures = (
        SectionFigure(stem, title, _CAPTION, partial(draw_fits, stem, shown))
        for stem, title, shown in (
            ("cost-formulas", "The two formulas of section 5.3.3: time of an image", thesis),
            ("cost-sums", "The sums of max_level=auto: time of building and of tracing", sums),
        )
        if shown
    )
    return Section(
        "costs",
        "The cost formulas of section 5.3.3",
        _WORDS,
        (_costs(fits), _quality(fits)),
        tuple(figures),
        tuple(_finding(one) for one in thesis),
    )


def _fits(formulas: Iterable[Formula], cells: Sequence[Cell]) -> list[Fit]:
    found = (fit(formula, formula.observe(cells)) for formula in formulas)
    return [one for one in found if one is not None]


def _costs(fits: Iterable[Fit]) -> SectionTable:
    heads = ("formula", "what is counted", "in the thesis")
    columns = (*(Column(head, False) for head in heads), Column("ns each"), Column("interval"))
    rows = [
        tuple(
            Field(text)
            for text in (
                one.formula.title,
                term.words,
                term.symbol or DASH,
                number(cost.value),
                DASH if math.isnan(cost.low) else f"{number(cost.low)} to {number(cost.high)}",
            )
        )
        for one in fits
        for term, cost in zip(one.formula.terms, one.coefficients, strict=True)
    ]
    return SectionTable("Costs, fitted", columns, tuple(rows))


def _quality(fits: Iterable[Fit]) -> SectionTable:
    heads = ("cells", "scenes", "R2", "median error", "90% below", "median, scene left out")
    rows = []
    for one in fits:
        texts = (
            f"{one.formula.title}: time {one.formula.time}",
            f"{len(one.observations):,}",
            f"{one.scenes}",
            f"{one.r_squared:.3f}",
            *(_percent(np.percentile(one.errors, part)) for part in (50, 90)),
            _percent(np.median(one.errors_of_strangers)) if one.errors_of_strangers else DASH,
        )
        rows.append(tuple(Field(text) for text in texts))
    columns = (Column("formula", False), *(Column(head) for head in heads))
    return SectionTable("How well the sums tell the times", columns, tuple(rows))


def _finding(one: Fit) -> str:
    middle, most = np.percentile(one.errors, (50, 90))
    return (
        f"{one.formula.title}: the sum tells half of {len(one.observations):,} times to "
        f"{_percent(middle)}, nine of ten to {_percent(most)}; R2 {one.r_squared:.3f}."
    )


def _percent(share: float) -> str:
    return f"{100 * share:.1f}%"
