"""Build and trace, stacked, for each view at its highest resolution."""

from __future__ import annotations

import pandas as pd
from matplotlib.patches import Patch

from beambench_report.bars import Bar, draw_bars
from beambench_report.figure import Plot
from beambench_report.panels import panel_per_view
from beambench_report.quantities import number
from beambench_report.records import Run
from beambench_report.style import looks


def build_and_trace(run: Run) -> list[Plot]:
    """One figure, a panel a view; none when nothing was timed."""
    all_looks = looks(run.rows)
    plots = panel_per_view(
        run,
        stem="build-and-trace",
        select=lambda title: _timed(run.finest(title)),
        draw=lambda panel, rows: draw_bars(panel, _bars(rows), all_looks, "time in ms"),
        explanation="Medians of one build and one image of primary rays at each view's highest "
        "resolution. The medians of the parts need not add up to the median of the whole.",
        summary="build and trace time of each structure at the highest resolution",
        times=True,
    )
    for plot in plots:
        plot.figure.legend(
            handles=[Patch(color="#555555", alpha=0.4), Patch(color="#555555")],
            labels=["build", "trace"],
            loc="outside upper right",
            ncols=2,
            frameon=False,
        )
    return plots


def _timed(rows: pd.DataFrame) -> pd.DataFrame:
    return rows[rows["timed"]].dropna(subset=["build_ms_median", "trace_ms_median"])


def _bars(rows: pd.DataFrame) -> list[Bar]:
    return [
        Bar(
            row.contender,
            (row.build_ms_median, row.trace_ms_median),
            f"{number(row.build_ms_median)} + {number(row.trace_ms_median)}",
        )
        for row in rows.itertuples()
    ]
