"""Draws every repetition of every contender of a view: how far a median can be trusted."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from beambench_report.base.figure import Look, Plot
from beambench_report.base.names import file_stems
from beambench_report.base.palette import GRID, INK
from beambench_report.base.quantities import number
from beambench_report.base.records import size_of
from beambench_report.base.svg import hover
from beambench_report.run.measured import Measured, between, ns_in_words
from beambench_report.run.panels import MOST_ROWS, finish, panels_with_legend, scale_axis

_MOST_DOTS = 700  # of a figure, or its file grows large
_FARTHEST = 30  # percent; repetitions beyond are drawn at the end
_EXPLANATION = (
    "Each dot is one repetition, the first trace after a build. The stroke is the median, and the "
    "bar behind it is the 95% confidence interval. Left: as measured. Right: deviation from the "
    "contender's own median, in %; triangles mark repetitions beyond the axis.{thinned}"
)


def distributions(measured: Measured) -> list[Plot]:
    """Returns a figure for each view in which two contenders have two repetitions."""
    plots = []
    for view, stem in file_stems(measured.run.views).items():
        rows = measured.finest(view)
        rows = rows[rows["repeated"].map(len) > 1].head(MOST_ROWS)
        if len(rows) > 1:
            plots.append(_distributions(measured, view, f"distributions-{stem}", rows))
    return plots


def _distributions(measured: Measured, view: str, stem: str, rows: pd.DataFrame) -> Plot:
    figure, (left, right) = panels_with_legend(
        2, 2, 0.7 + 0.24 * len(rows), {}, width_ratios=(1, 1.35)
    )
    most = max(2, _MOST_DOTS // (2 * len(rows)))
    reach = _reach(rows)
    scale_axis(left, "x", [ns for repeated in rows["repeated"] for ns in repeated])
    for place, (_, row) in enumerate(rows.iterrows()):
        look = measured.looks[row["contender"]]
        dots = np.array(thinned(row["repeated"], most))
        least, *_, most_ns = row["repeated"]
        text = (
            f"{row['contender']}: {ns_in_words(row)}; {len(row['repeated'])} repetitions, "
            f"all{between(least, most_ns)}"
        )
        ends = np.array([row["ns_low"], row["ns"], row["ns_high"]])
        hover(_draw_row(left, place, dots, ends, look), text)
        percents = 100 * (dots / row["ns"] - 1)
        off = 100 * (ends / row["ns"] - 1)
        hover(_draw_row(right, place, percents, off, look, reach), text)
    for panel in (left, right):
        panel.set_ylim(len(rows) - 0.5, -0.5)
        panel.grid(axis="x", linewidth=0.6)
        panel.tick_params(axis="y", length=0)
    left.set_yticks(
        range(len(rows)),
        [f"{c}  {number(ns)}" for c, ns in zip(rows["contender"], rows["ns"], strict=True)],
        fontsize=7.5,
    )
    right.set_yticks(range(len(rows)), [""] * len(rows))
    left.set_xlabel("ns per ray (lower is better)")
    right.set_xlabel("% off the median (narrower is better)")
    right.set_xlim(-1.06 * reach, 1.06 * reach)
    right.axvline(0, color=GRID, linewidth=0.8, zorder=0)
    is_thinned = rows["repeated"].map(len).max() > most
    return Plot(
        stem,
        finish(
            figure,
            f"{view}, {size_of(rows.iloc[0])}: every repetition",
            measured.run.view(view),
            _EXPLANATION.format(
                thinned=f" Of more than {most} repetitions, {most} appear, evenly spread by rank."
                if is_thinned
                else ""
            ),
        ),
        f"{view}: the repetitions of every contender",
        view,
    )


def thinned(values: Sequence[float], most: int) -> list[float]:
    """Returns at most `most` of the sorted values, evenly spread, with both ends."""
    if len(values) <= most:
        return list(values)
    return [values[round(place)] for place in np.linspace(0, len(values) - 1, most)]


def _reach(rows: pd.DataFrame) -> float:
    """Returns the percentage that the axis covers: most repetitions, but not the outliers."""
    off = [abs(100 * (ns / row["ns"] - 1)) for _, row in rows.iterrows() for ns in row["repeated"]]
    usual = float(np.quantile(off, 0.97))
    return min(_FARTHEST, max(1.0, 1.3 * usual))


def _draw_row(
    panel: Axes,
    place: int,
    dots: np.ndarray,
    ends: np.ndarray,
    look: Look,
    reach: float = np.inf,
) -> Line2D:
    low, middle, high = ends
    if not np.isnan(low) and not np.isnan(high):
        panel.plot(
            [low, high], [place, place], color=look.color, linewidth=7, alpha=0.3,
            solid_capstyle="butt",
        )  # fmt: skip
    within = np.abs(dots) <= reach
    (drawn,) = panel.plot(
        dots[within],
        place + _jitter(len(dots))[within],
        "o",
        color=look.color,
        markersize=2.6,
        markeredgewidth=0,
        alpha=0.75,
    )
    for side, marker in ((-1, "<"), (1, ">")):
        beyond = dots[~within & (np.sign(dots) == side)]
        if len(beyond):
            (outside,) = panel.plot(
                side * reach, place, marker, color=look.color, markersize=4, markeredgewidth=0
            )
            values = ", ".join(f"{value:+.0f}%" for value in beyond[:8])
            hover(outside, f"{len(beyond)} beyond the axis: {values}")
    panel.plot([middle, middle], [place - 0.36, place + 0.36], color=INK, linewidth=1.2, zorder=3)
    return drawn


def _jitter(count: int) -> np.ndarray:
    """Returns fixed random offsets, the same for every run, that keep neighboring dots apart."""
    return ((np.arange(count) * 0.618) % 1 - 0.5) * 0.5
