"""The cost of a ray over the number of rays: small multiples of all views."""

from collections.abc import Sequence
from math import nan

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter, NullLocator

from beambench_report.base.figure import Look, Plot
from beambench_report.base.records import size_of
from beambench_report.base.svg import hover
from beambench_report.run.measured import Measured, ns_in_words, short_title
from beambench_report.run.panels import (
    MOST_LINES,
    hide_repeated_labels,
    panels_with_legend,
    parts_by_kind,
    plot_of_views,
    scale_axis,
    set_title,
    share_limits,
)

_MOST_PANELS = 6
_MANY_VARIANTS = 4
"""Of a structure with more, only the fastest are drawn: lines of one color hide one another."""
_SHOWN_VARIANTS = 2
_FEWER = f" Of a structure with more than {_MANY_VARIANTS} variants the {_SHOWN_VARIANTS} fastest."
_APART = 0.13  # of the axis, between two sizes that are named


def resolutions(measured: Measured) -> list[Plot]:
    """Returns the figures of all views with times at two resolutions at least."""
    timed = measured.timed
    sizes = timed.groupby(["view", "contender"])["rays"].nunique()
    several = sizes[sizes > 1].index.get_level_values("view")
    views = [view for view in measured.run.views if view in several]
    parts = parts_by_kind(measured.run.rows, views, "resolutions", _MOST_PANELS)
    return [_resolutions(measured, *part) for part in parts]


def _resolutions(measured: Measured, kind: str, views: Sequence[str], stem: str) -> Plot:
    rows = measured.timed[measured.timed["view"].isin(views)]
    # The fastest first, by their last place over the views.
    fastest = rows.sort_values("ns").drop_duplicates("contender")
    place = fastest.groupby("structure").cumcount()
    variants = fastest.groupby("structure")["contender"].transform("size")
    shown = fastest[(variants <= _MANY_VARIANTS) | (place < _SHOWN_VARIANTS)].head(MOST_LINES)
    order = shown["contender"]
    rows = rows[rows["contender"].isin(order)]
    columns = min(2, len(views))
    legend = {contender: measured.looks[contender] for contender in order}
    figure, panels = panels_with_legend(len(views), columns, 2.5 if columns > 1 else 3.4, legend)
    sizes = {size_of(row): row["rays"] for _, row in rows.sort_values("rays").iterrows()}
    for panel, view in zip(panels, views, strict=True):
        set_title(panel, short_title(measured.run.rows, view))
        panel.set_xscale("log")
        scale_axis(panel, "y", rows["ns"])
        for contender, line in rows[rows["view"] == view].groupby("contender", sort=False):
            _draw_line(panel, line.sort_values("rays"), legend[contender])
        panel.set_xlabel("resolution, number of rays")
        panel.set_ylabel("ns per ray (lower is better)")
        panel.grid(axis="y", linewidth=0.6)
    share_limits(panels)
    for panel in panels:
        _name_sizes(panel, sizes)
    hide_repeated_labels(panels, columns)
    what = (
        f"Trace time of a ray against resolution, {kind}",
        f"ns per ray against resolution, {kind}",
    )
    reading = "First trace after a build, build not included; bars: its 95% confidence interval."
    fewer = _FEWER if len(shown) < len(fastest) else ""
    return plot_of_views(measured.run, stem, figure, views, what, reading + fewer)


def _draw_line(panel: Axes, line: pd.DataFrame, look: Look) -> None:
    strokes = [
        (row["rays"], end)
        for _, row in line.iterrows()
        for end in (row["ns_low"], row["ns_high"], nan)  # nan: where the next stroke begins
    ]
    panel.plot(*zip(*strokes, strict=True), color=look.color, linewidth=2.2)
    (joined,) = panel.plot(
        line["rays"],
        line["ns"],
        **look.line,
    )
    values = [f"{size_of(row)} {ns_in_words(row)}" for _, row in line.iterrows()]
    hover(joined, f"{line['contender'].iloc[0]}: {'; '.join(values)}")


def _name_sizes(panel: Axes, sizes: dict[str, float]) -> None:
    """Names those that do not stand too close to the last one that was named."""
    to_axis = panel.transScale + panel.transLimits
    named: dict[str, float] = {}
    last = -1.0
    for size, rays in sizes.items():
        place = to_axis.transform((rays, panel.get_ylim()[0]))[0]
        if place - last >= _APART:
            named[size] = rays
            last = place
    panel.set_xticks(
        list(named.values()),
        [f"{size}\n{rays:,.0f}" for size, rays in named.items()],
        fontsize=7,
    )
    panel.xaxis.set_minor_locator(NullLocator())
    panel.xaxis.set_minor_formatter(NullFormatter())
