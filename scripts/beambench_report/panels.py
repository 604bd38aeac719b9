"""Figures with a panel of bars for each view, one above the other."""

from __future__ import annotations

from collections.abc import Callable

import pandas as pd
from matplotlib.axes import Axes

from beambench_report.bars import BAR_HEIGHT
from beambench_report.figure import Plot, caption, new_figure
from beambench_report.records import Run

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
