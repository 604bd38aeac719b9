"""Figures of horizontal bars from zero: a panel for each view, a bar for each contender."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from beambench_report.base.figure import Look, Plot, caption, new_figure
from beambench_report.base.records import Run

BAR_HEIGHT = 0.26  # inches
_FAR = 12  # a bar this many times the median one runs off the axis, or it would flatten the others
_ROOM_FOR_TEXT = 1.45
_LONG_LABEL = 24  # characters


@dataclass(frozen=True)
class Bar:
    """A contender's bar: its parts, laid end to end, and the text beside it."""

    contender: str
    parts: Sequence[float]
    text: str


# The first of several parts is light, so that the second stands out in the structure's color.
_PART_ALPHAS = {1: (1.0,), 2: (0.4, 1.0)}


def draw_bars(panel: Axes, bars: Sequence[Bar], looks: Mapping[str, Look], unit: str) -> None:
    """Draws the bars from the top down in the order given; the longest may run off the axis."""
    totals = np.array([sum(bar.parts) for bar in bars])
    end = _axis_end(totals)
    for place, bar in enumerate(bars):
        start = 0.0
        for part, alpha in zip(bar.parts, _PART_ALPHAS[len(bar.parts)], strict=True):
            color = looks[bar.contender].color
            panel.barh(place, part, left=start, height=0.7, color=color, alpha=alpha)
            start += part
        off = start > end
        panel.annotate(
            f"{bar.text}  (off the axis)" if off else bar.text,
            (end if off else start, place),
            xytext=(-4 if off else 4, 0),
            textcoords="offset points",
            ha="right" if off else "left",
            va="center",
            fontsize=7.5,
            bbox={"boxstyle": "square,pad=0.15", "fc": "white", "ec": "none"} if off else None,
        )
    panel.set_yticks(
        range(len(bars)), [in_two_lines(bar.contender) for bar in bars], linespacing=0.9
    )
    panel.set_ylim(len(bars) - 0.4, -0.6)
    panel.set_xlim(0, end)
    panel.set_xlabel(unit)
    panel.grid(axis="x", color="#dddddd", linewidth=0.6)
    panel.tick_params(axis="y", length=0)


def in_two_lines(label: str) -> str:
    """A long label broken once, or it would take the room of the bars."""
    words = label.split()
    if len(label) <= _LONG_LABEL or len(words) < 2:
        return label
    breaks = [(" ".join(words[:at]), " ".join(words[at:])) for at in range(1, len(words))]
    return "\n".join(min(breaks, key=lambda lines: max(map(len, lines))))


def _axis_end(totals: np.ndarray) -> float:
    positive = totals[totals > 0]  # zeros would make the median too small
    near = totals[totals <= _FAR * np.median(positive)] if positive.size else totals
    longest = near.max() if near.size else 0.0
    return _ROOM_FOR_TEXT * longest if longest > 0 else 1.0


PANEL_MARGIN = 0.75  # inches: a panel's title and axis


def panel_per_view(
    run: Run,
    *,
    stem: str,
    select: Callable[[str], pd.DataFrame],
    draw: Callable[[Axes, pd.DataFrame], None],
    explanation: str,
    summary: str,
    times: bool,
) -> list[Plot]:
    """One figure over the views for which `select` gives rows; an empty list if there is none."""
    shown = {title: rows for title in run.views if not (rows := select(title)).empty}
    if not shown:
        return []
    heights = [PANEL_MARGIN + BAR_HEIGHT * len(rows) for rows in shown.values()]
    figure, panels = new_figure(sum(heights) + 0.3, len(shown), height_ratios=heights)
    for panel, (title, rows) in zip(panels, shown.items(), strict=True):
        finest = rows.loc[rows["rays"].idxmax()]
        panel.set_title(f"{title} ({finest['width']:.0f}x{finest['height']:.0f})")
        draw(panel, rows)
    caption(figure, run.rows, explanation, times=times)
    return [Plot(stem, figure, summary)]
