"""Time against the number of rays, a figure a view: the thesis's way of showing its results."""

from __future__ import annotations

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, NullFormatter, NullLocator

from beambench_report.figure import Plot, caption, new_figure
from beambench_report.names import file_stems
from beambench_report.records import Run
from beambench_report.style import Look, looks


def time_over_rays(run: Run) -> list[Plot]:
    """The figures of all views that have times."""
    all_looks = looks(run.rows)
    plots = []
    for title, stem in file_stems(run.views).items():
        rows = run.view(title)
        if not rows["timed"].any():
            continue
        figure, (panel,) = new_figure(4.0)
        for contender, line in rows[rows["timed"]].groupby("contender", sort=False):
            _draw_line(panel, str(contender), line.sort_values("rays"), all_looks[contender])
        panel.set_title(f"{title}: time against number of rays")
        _label_axes(panel, rows)
        figure.legend(loc="outside right center", frameon=False)
        caption(
            figure,
            rows,
            "Median of build and trace together; the bars are the median's 95% interval. "
            "Both axes are logarithmic.",
            times=True,
        )
        summary = f"{title}: time, build included, against number of rays"
        plots.append(Plot(f"time-{stem}", figure, summary, title))
    return plots


def _draw_line(panel: Axes, contender: str, line: pd.DataFrame, look: Look) -> None:
    median = line["total_ms_median"]
    # An interval that was not measured is drawn as none.
    below = (median - line["total_ms_ci_low"]).fillna(0).clip(lower=0)
    above = (line["total_ms_ci_high"] - median).fillna(0).clip(lower=0)
    panel.errorbar(
        line["rays"],
        median,
        yerr=[below, above],
        label=contender,
        color=look.colour,
        marker=look.marker,
        linestyle=look.dashes,
        markersize=4.5,
        capsize=2.5,
        linewidth=1.4,
    )


def _label_axes(panel: Axes, rows: pd.DataFrame) -> None:
    panel.set_xscale("log")
    panel.set_yscale("log")
    sizes = rows.drop_duplicates("rays").sort_values("rays")
    panel.set_xticks(
        sizes["rays"],
        [f"{row.width:.0f}x{row.height:.0f}\n{row.rays:,.0f}" for row in sizes.itertuples()],
    )
    panel.xaxis.set_minor_locator(NullLocator())
    panel.xaxis.set_minor_formatter(NullFormatter())
    panel.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}"))
    panel.set_xlabel("resolution, number of rays")
    panel.set_ylabel("time in ms (build + trace)")
    panel.grid(axis="y", which="major", color="#dddddd", linewidth=0.6)
