"""Draws the work per ray: small multiples of the structures' counters."""

from collections.abc import Sequence

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beambench_report.base.columns import COUNTER_SUFFIX
from beambench_report.base.figure import Look, Plot
from beambench_report.base.names import file_stems
from beambench_report.base.palette import PAPER
from beambench_report.base.quantities import number
from beambench_report.base.records import size_of
from beambench_report.base.svg import hover
from beambench_report.run.measured import Measured
from beambench_report.run.panels import (
    MOST_ROWS,
    TALLEST,
    chunks,
    finish,
    numbered,
    panels_with_legend,
    scale_axis,
    set_title,
)

_COLUMNS = 4
_MOST_LINES = 3  # of panels; more would make a large file
_ROW, _HEAD = 0.17, 0.62  # inches
_ROOM = TALLEST - 1.1  # for panels, beside heading and caption


def counters(measured: Measured) -> list[Plot]:
    """Returns the figures of all views with counters; whole pictures have two kinds."""
    run = measured.run
    plots = []
    for view, stem in file_stems(run.views).items():
        finest = run.finest(view).drop_duplicates("contender", keep="last")
        finest = finest.sort_values("trace_ms", kind="stable")
        for names, words, prefix in (
            (run.counters, "work per ray", "counters"),
            (run.counters_by_kind, "work per ray by kind of rays", "counters-by-kind"),
        ):
            shown = counters_in_common(finest, names)
            if not shown:
                continue
            rows = finest[finest[shown].notna().any(axis="columns")].head(MOST_ROWS)
            lines = max(1, min(_MOST_LINES, int(_ROOM / (_HEAD + _ROW * len(rows)))))
            for index, part in enumerate(chunks(shown, _COLUMNS * lines)):
                figure = _counters(
                    measured, rows, part, f"{view}, {size_of(rows.iloc[0])}: {words}"
                )
                name = numbered(f"{prefix}-{stem}", index)
                plots.append(Plot(name, figure, f"{view}: {words}", view))
    return plots


def counters_in_common(rows: pd.DataFrame, names: Sequence[str]) -> list[str]:
    """Returns the counters that at least two contenders have, unless they are 0 for all."""
    return [
        name for name in names if rows[name].notna().sum() > 1 and (rows[name].fillna(0) != 0).any()
    ]


def _counters(measured: Measured, rows: pd.DataFrame, names: Sequence[str], heading: str) -> Figure:
    columns = min(_COLUMNS, len(names))
    figure, panels = panels_with_legend(len(names), columns, _HEAD + _ROW * len(rows), {})
    for place, (panel, name) in enumerate(zip(panels, names, strict=True)):
        set_title(panel, name.removesuffix(COUNTER_SUFFIX).replace("_", " "), 19)
        _draw(panel, rows, name, measured.looks)
        panel.set_ylim(len(rows) - 0.5, -0.5)
        shown = rows["contender"] if place % columns == 0 else [""] * len(rows)
        panel.set_yticks(range(len(rows)), shown, fontsize=7.5)
        panel.tick_params(axis="y", length=0)
        panel.tick_params(axis="x", labelsize=7)
        panel.grid(linewidth=0.5)
        panel.spines["left"].set_visible(False)
    return finish(
        figure,
        heading,
        rows,
        "Counts per ray (less work is better), from a separate pass, not from the timed code; "
        'logarithmic where they differ by a factor of more than 20. "none": counted, and 0. Blank: '
        "not counted. Counters of a single contender are left out.",
        times=False,
    )


def _draw(panel: Axes, rows: pd.DataFrame, name: str, looks: dict[str, Look]) -> None:
    values = rows[name].dropna()
    is_log = scale_axis(panel, "x", values, ticks=4)
    above = values[values > 0]
    panel.set_xlim(*((above.min() / 3, above.max() * 2) if is_log else (0, 1.12 * above.max())))
    for place, (contender, value) in enumerate(zip(rows["contender"], rows[name], strict=True)):
        if pd.isna(value):
            continue
        look = looks[contender]
        if value == 0:  # a logarithmic axis has no 0
            words = panel.text(
                0.02,
                place,
                "none",
                transform=panel.get_yaxis_transform(),
                va="center",
                fontsize=6.5,
                style="italic",
                color=look.color,
            )
            hover(words, f"{contender}: counted, and 0")
            continue
        (dot,) = panel.plot(
            value,
            place,
            look.marker,
            color=look.color,
            markersize=5.5,
            markeredgecolor=PAPER,
            markeredgewidth=0.5,
            clip_on=False,
        )
        hover(dot, f"{contender}: {number(value)} per ray")
        is_right = panel.transLimits.transform(panel.transScale.transform((value, place)))[0] > 0.55
        panel.annotate(
            number(value),
            (value, place),
            (-5 if is_right else 5, 0),
            textcoords="offset points",
            ha="right" if is_right else "left",
            va="center",
            fontsize=6.5,
        )
