"""Makes break-even plots and their table: the cost of a ray, with its share of the build."""

import itertools
from math import isfinite
from textwrap import fill

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import EngFormatter

from beambench.analysis import break_even_rays
from beambench_report.base.figure import Plot
from beambench_report.base.names import brief_name
from beambench_report.base.palette import INK, PAPER, structure_color
from beambench_report.base.quantities import number
from beambench_report.base.records import OK, Run, size_of
from beambench_report.base.svg import hover
from beambench_report.run.labels import End, name_ends, share_for_names
from beambench_report.run.measured import Measured, short_title
from beambench_report.run.panels import (
    hide_repeated_labels,
    panels_with_legend,
    parts_by_kind,
    plot_of_views,
    scale_axis,
    set_title,
    share_limits,
)

_MOST_PANELS = 4
_MOST_LINES = 12
_FEWEST, _MOST = 1e3, 1e9
_RAYS = np.logspace(3, 9, 49)
_TICKS = (1e3, 1e5, 1e7, 1e9)
_PANEL_WIDTHS = (6.3, 3.0)  # inches, of figures of one and of two columns

_READING = (
    "Build time / number of rays + trace time of a ray, by the medians at the resolution in the "
    "title. Thick: contenders that are ahead of all others at some number of rays, build included. "
    "Circles: the contender with the fastest trace overtakes another; dark: the last that it "
    "overtakes. All pairs: break-even.csv."
)


def crossings(measured: Measured) -> list[Plot]:
    """Returns the figures of all views in which two contenders have times."""
    found = {view: _contenders(measured, view) for view in measured.run.views}
    several = [view for view, rows in found.items() if len(rows) > 1]
    parts = parts_by_kind(measured.run.rows, several, "break-even", _MOST_PANELS)
    return [
        _crossings(measured, kind, {view: found[view] for view in views}, stem)
        for kind, views, stem in parts
    ]


def cost_of_a_ray(build_ms: float, ns_per_ray: float, rays: np.ndarray) -> np.ndarray:
    """Returns the time of a ray in ns, including its share of the build."""
    return 1e6 * build_ms / rays + ns_per_ray


def _contenders(measured: Measured, view: str) -> pd.DataFrame:
    """Returns the contenders to draw, the fastest first; null is excluded: it finds nothing."""
    rows = measured.finest(view).dropna(subset=["build_ms_median"])
    rows = rows[rows["structure"] != "null"]
    # exhaustive builds nothing and is slow everywhere: it is not drawn alone.
    if rows["is_reference"].all():
        return rows.iloc[:0]
    shown = leaders(rows) | set(rows["contender"].head(_MOST_LINES - len(leaders(rows))))
    return rows[rows["contender"].isin(shown)]


def leaders(rows: pd.DataFrame) -> set[str]:
    """Returns the contenders that are ahead of all others at some number of rays."""
    costs = [cost_of_a_ray(row["build_ms_median"], row["ns"], _RAYS) for _, row in rows.iterrows()]
    return set(rows["contender"].iloc[np.argmin(costs, axis=0)])


def _crossings(measured: Measured, kind: str, shown: dict[str, pd.DataFrame], stem: str) -> Plot:
    columns = min(2, len(shown))
    figure, panels = panels_with_legend(len(shown), columns, 2.6 if columns > 1 else 3.8, {})
    names = [brief_name(name) for rows in shown.values() for name in rows["contender"]]
    share = share_for_names(names, _PANEL_WIDTHS[columns - 1])
    ends: list[list[End]] = []
    for panel, (view, rows) in zip(panels, shown.items(), strict=True):
        title = f"{short_title(measured.run.rows, view)}, {size_of(rows.iloc[0])}"
        set_title(panel, title)
        ahead = leaders(rows)
        ends.append(
            [_draw_line(panel, row, row["contender"] in ahead) for _, row in rows.iterrows()]
        )
        _mark_crossings(panel, rows)
        panel.set(xscale="log", yscale="log")
        panel.set_xlim(_FEWEST, _FEWEST * (_MOST / _FEWEST) ** (1 / (1 - share)))
        panel.spines["bottom"].set_bounds(_FEWEST, _MOST)
        panel.set_xlabel("number of rays")
        panel.set_ylabel("ns per ray, with build\n(lower is better)")
        panel.grid(linewidth=0.6)
        panel.minorticks_off()
        panel.set_xticks(_TICKS)
        panel.xaxis.set_major_formatter(EngFormatter(sep=" "))
    share_limits(panels, "y")
    least, most = panels[0].get_ylim()
    for panel in panels:
        scale_axis(panel, "y", (least, most), ticks=7)
        panel.set_ylim(least, most)
    hide_repeated_labels(panels, columns)
    what = (
        f"Ray counts from which a build pays off, {kind}",
        f"ns per ray, build included, against the number of rays, {kind}",
    )
    plot = plot_of_views(measured.run, stem, figure, list(shown), what, _READING)
    for panel, own in zip(panels, ends, strict=True):
        name_ends(panel, own)
    return plot


def _draw_line(panel: Axes, row: pd.Series, is_ahead: bool) -> End:
    """Draws the cost of one contender; returns the place of its name."""
    costs = cost_of_a_ray(row["build_ms_median"], row["ns"], _RAYS)
    color = structure_color(row["structure"])
    (line,) = panel.plot(_RAYS, costs, color=color, linewidth=2.2 if is_ahead else 0.9)
    words = f"build {number(row['build_ms_median'])} ms, then {number(row['ns'])} ns per ray"
    hover(line, f"{row['contender']}: {words}")
    return _MOST, costs[-1], brief_name(row["contender"]), color


def _mark_crossings(panel: Axes, rows: pd.DataFrame) -> None:
    fastest = rows.iloc[0]
    found = overtakes(rows)
    for index, (rays, other) in enumerate(found):
        is_last = index == len(found) - 1
        if not _FEWEST <= rays <= _MOST:
            continue
        (mark,) = panel.plot(
            rays,
            cost_of_a_ray(fastest["build_ms_median"], fastest["ns"], np.array([rays])),
            "o",
            color=INK,
            markersize=6 if is_last else 4,
            markerfacecolor=INK if is_last else PAPER,
            markeredgewidth=0.8,
            zorder=4,
        )
        ahead = f"{fastest['contender']} is ahead of {other} from {rays_in_words(rays)} rays on"
        hover(mark, f"{ahead}, and of all others" if is_last else ahead)
    since = f"{rays_in_words(found[-1][0])} rays" if found else "the first ray"
    panel.text(
        0.98,
        0.97,
        fill(f"{fastest['contender']} is first from {since} on", 40),
        transform=panel.transAxes,
        ha="right",
        va="top",
        fontsize=7.5,
    )


def overtakes(rows: pd.DataFrame) -> list[tuple[float, str]]:
    """Returns the ray counts at which the first row overtakes others, and these, in order."""
    first = rows.iloc[0]
    found = []
    for _, other in rows.iloc[1:].iterrows():
        rays = break_even_rays(
            first["build_ms_median"], first["ns"], other["build_ms_median"], other["ns"]
        )
        if rays > 0 and isfinite(rays):
            found.append((rays, other["contender"]))
    return sorted(found)


def rays_in_words(rays: float) -> str:
    """Formats a number of rays: 250, 10.0 k, 3.2 M."""
    return EngFormatter(places=None if rays < 1000 else 1, sep=" ")(round(rays))


def break_even_table(run: Run) -> pd.DataFrame:
    """Returns the break-even of each ordered pair of contenders in each view, except null."""
    records = []
    for title in run.views:
        rows = run.view(title)
        rows = rows[rows["timed"] & (rows["verdict"] == OK)]
        rows = rows.dropna(subset=["build_ms_median", "trace_ms"])
        rows = rows.drop_duplicates(["contender", "rays"])
        contenders = {name: own.set_index("rays") for name, own in rows.groupby("contender")}
        for one, other in itertools.permutations(rows["contender"].unique(), 2):
            common = contenders[one].index.intersection(contenders[other].index)
            if common.empty:
                continue
            mine, theirs = (contenders[name].loc[common.max()] for name in (one, other))
            records.append(
                (title, one, other, size_of(mine), *break_even(_cost(mine), _cost(theirs)))
            )
    return pd.DataFrame(
        records,
        columns=["view", "contender", "baseline", "resolution", "break_even_rays", "in_words"],
    )


Cost = tuple[float, float]
"""A contender's build time in ms and its trace time in ns per ray."""


def _cost(row: pd.Series) -> Cost:
    return row["build_ms_median"], 1e6 * row["trace_ms"] / row.name


def break_even(mine: Cost, other: Cost) -> tuple[float | None, str]:
    """Returns the ray count from or up to which `mine` is ahead, if any, and a description."""
    since, until = break_even_rays(*mine, *other), break_even_rays(*other, *mine)
    if since == 0:
        return None, "at once"
    if isfinite(since):
        return since, f"from {rays_in_words(since)}"
    if 0 < until < since:
        return until, f"up to {rays_in_words(until)}"
    return None, "never"
