"""Plots the cost of a ray against the number of rays: small multiples of all views."""

from collections.abc import Sequence
from math import log10, nan

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter, NullLocator

from beambench_report.base.figure import Look, Plot
from beambench_report.base.names import brief_name
from beambench_report.base.records import size_of
from beambench_report.base.svg import hover
from beambench_report.run.labels import End, name_ends, share_for_names
from beambench_report.run.measured import Measured, ns_in_words, short_title
from beambench_report.run.panels import (
    hide_repeated_labels,
    panels_with_legend,
    parts_by_kind,
    plot_of_views,
    scale_axis,
    set_title,
)

_MOST_PANELS = 6
_SHOWN_VARIANTS = 2
"""The most contenders of a structure: lines of one color hide one another."""
_MOST_LINES = 12
_PANEL_WIDTHS = (6.3, 3.0)  # inches, of figures of one and of two columns
_APART = 0.2  # of the axis, between two sizes that are named


def resolutions(measured: Measured) -> list[Plot]:
    """Returns the figures of all views with times at two or more resolutions."""
    timed = measured.timed
    sizes = timed.groupby(["view", "contender"])["rays"].nunique()
    several = sizes[sizes > 1].index.get_level_values("view")
    views = [view for view in measured.run.views if view in several]
    parts = parts_by_kind(measured.run.rows, views, "resolutions", _MOST_PANELS)
    return [_resolutions(measured, *part) for part in parts]


def _resolutions(measured: Measured, kind: str, views: Sequence[str], stem: str) -> Plot:
    rows = measured.timed[measured.timed["view"].isin(views)]
    # The fastest first, by their least time of a ray in any view.
    fastest = rows.sort_values("ns").drop_duplicates("contender")
    place = fastest.groupby("structure").cumcount()
    shown = fastest[place < _SHOWN_VARIANTS].head(_MOST_LINES)
    rows = rows[rows["contender"].isin(shown["contender"])]
    columns = min(2, len(views))
    figure, panels = panels_with_legend(len(views), columns, 2.5 if columns > 1 else 3.4, {})
    share = share_for_names(map(brief_name, shown["contender"]), _PANEL_WIDTHS[columns - 1])
    sizes = {size_of(row): row["rays"] for _, row in rows.sort_values("rays").iterrows()}
    ends: list[list[End]] = []
    for panel, view in zip(panels, views, strict=True):
        set_title(panel, short_title(measured.run.rows, view))
        panel.set_xscale("log")
        own = rows[rows["view"] == view]
        scale_axis(panel, "y", own["ns"])
        ends.append(
            [
                _draw_line(panel, line.sort_values("rays"), measured.looks[contender])
                for contender, line in own.groupby("contender", sort=False)
            ]
        )
        panel.set_xlabel("resolution, number of rays")
        panel.set_ylabel("ns per ray (lower is better)")
        panel.grid(axis="y", linewidth=0.6)
        if panel.get_yscale() == "linear":
            panel.set_ylim(bottom=0)
        _name_sizes(panel, sizes, share)
    hide_repeated_labels(panels, columns, is_shared="x")
    what = (
        f"Trace time of a ray against resolution, {kind}",
        f"ns per ray against resolution, {kind}",
    )
    reading = (
        "First trace after a build, build not included; bars: its 95% confidence interval. Each "
        "panel has its own vertical axis."
    )
    if len(shown) < len(fastest):
        reading += (
            f" Left out: {len(fastest) - len(shown)} slower contenders; of each structure, the "
            f"{_SHOWN_VARIANTS} fastest variants are shown."
        )
    plot = plot_of_views(measured.run, stem, figure, views, what, reading)
    for panel, own_ends in zip(panels, ends, strict=True):
        name_ends(panel, own_ends)
    return plot


def _draw_line(panel: Axes, line: pd.DataFrame, look: Look) -> End:
    """Draws one contender; returns the place of its name."""
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
    contender = line["contender"].iloc[0]
    hover(joined, f"{contender}: {'; '.join(values)}")
    return line["rays"].iloc[-1], line["ns"].iloc[-1], brief_name(contender), look.color


def _name_sizes(panel: Axes, sizes: dict[str, float], share: float) -> None:
    """Labels the sizes that are not too close to the last labeled one.

    The names of lines take `share` of the panel, at the right.
    """
    least, most = min(sizes.values()), max(sizes.values())
    extent = log10(most / least)
    # A tenth of the remaining width is left free on each side.
    panel.set_xlim(
        least / 10 ** (0.1 * extent), most * 10 ** ((0.1 + 1.2 * share / (1 - share)) * extent)
    )
    panel.spines["bottom"].set_bounds(least, most)
    named: dict[str, float] = {}
    for size, rays in sizes.items():
        if not named or log10(rays / [*named.values()][-1]) >= _APART / (1 - share) * extent:
            named[size] = rays
    panel.set_xticks(
        list(named.values()),
        [f"{size}\n{rays:,.0f}" for size, rays in named.items()],
        fontsize=7,
    )
    panel.xaxis.set_minor_locator(NullLocator())
    panel.xaxis.set_minor_formatter(NullFormatter())
