"""Work a ray: the counters of each structure, a figure a view, a panel a counter."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from beambench_report.bars import BAR_HEIGHT, Bar, draw_bars
from beambench_report.dictionary import COUNTER_SUFFIX
from beambench_report.figure import Plot, caption, new_figure
from beambench_report.names import file_stems
from beambench_report.panels import PANEL_MARGIN
from beambench_report.quantities import number
from beambench_report.records import Run
from beambench_report.style import looks

_COLUMNS = 2


def counters(run: Run) -> list[Plot]:
    """The figures of all views for which anything was counted; whole pictures have two."""
    plots = []
    for title, stem in file_stems(run.views).items():
        finest = run.finest(title)
        for names, words, prefix in (
            (run.counters, "work a ray", "counters"),
            (run.counters_by_kind, "work a ray by kind of rays", "counters-by-kind"),
        ):
            shown = _worth_showing(finest, names)
            if not shown:
                continue
            figure = _draw(run, finest, shown, f"{title}: {words}")
            plots.append(Plot(f"{prefix}-{stem}", figure, f"{title}: {words}", title))
    return plots


def _worth_showing(finest: pd.DataFrame, names: list[str]) -> dict[str, pd.DataFrame]:
    """The rows that have a counter, by its name."""
    having = {name: finest.dropna(subset=[name]) for name in names}
    return {name: rows for name, rows in having.items() if (rows[name] != 0).any()}


def _draw(run: Run, finest: pd.DataFrame, shown: dict[str, pd.DataFrame], heading: str) -> Figure:
    all_looks = looks(run.rows)
    lines = -(-len(shown) // _COLUMNS)
    bars = max(len(rows) for rows in shown.values())
    figure, panels = new_figure(lines * (PANEL_MARGIN + BAR_HEIGHT * bars), lines, _COLUMNS)
    for panel in panels[len(shown) :]:
        panel.set_axis_off()
    for panel, (name, rows) in zip(panels, shown.items(), strict=False):
        panel.set_title(name.removesuffix(COUNTER_SUFFIX).replace("_", " "))
        draw_bars(panel, _bars(rows, name), all_looks, "a ray")
    first = finest.iloc[0]
    size = f"{first['width']:.0f}x{first['height']:.0f}"
    figure.suptitle(f"{heading} at {size}", x=0.01, ha="left", weight="bold")
    caption(
        figure,
        finest,
        "Counted in a pass of its own, not in the timed code. A structure that does not count "
        "its work is left out.",
        times=False,
    )
    return figure


def _bars(rows: pd.DataFrame, name: str) -> list[Bar]:
    return [
        Bar(contender, (value,), number(value))
        for contender, value in zip(rows["contender"], rows[name], strict=True)
    ]
