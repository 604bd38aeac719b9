"""Plots the effect of a swept parameter: ratios of structures at equal parameter values."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import nan

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullLocator

from beambench.analysis import Ratio
from beambench_report.base.cell_files import ratio_of
from beambench_report.base.figure import Look, Plot, variant_look
from beambench_report.base.names import file_stems, parameter_items, varying_parameters
from beambench_report.base.palette import INK
from beambench_report.base.quantities import number
from beambench_report.base.records import size_of
from beambench_report.base.svg import hover
from beambench_report.run.measured import Measured, between, short_title
from beambench_report.run.panels import (
    hide_repeated_labels,
    panels_with_legend,
    parts_by_kind,
    plot_of_views,
    scale_axis,
    set_title,
    share_limits,
)

_COLUMNS = 3
_MOST_PANELS = 12
_PANEL_HEIGHT = 1.85  # inches
_LEAST_VALUES = 2
"""The fewest values of a parameter for a line."""


@dataclass(frozen=True)
class _Sweep:
    """The parameter that several structures sweep, and their variants with this parameter."""

    parameter: str
    base: str
    """A structure that sweeps nothing else; others are compared with it at the same value."""
    rows: pd.DataFrame
    """The timed rows, with the columns `value` and `line`, the contender without the parameter."""


def swept(measured: Measured) -> list[Plot]:
    """Returns figures of the parameter that most structures sweep, for each kind of rays."""
    sweep = _sweep(measured.timed)
    if sweep is None:
        return []
    sizes = sweep.rows.groupby("view")["rays"].nunique()
    most = max(1, _MOST_PANELS // int(sizes.max()))
    views = [view for view in measured.run.views if view in set(sweep.rows["view"])]
    (stem,) = file_stems([f"by {sweep.parameter}"]).values()
    plots = (
        _figure(measured, sweep, *part)
        for part in parts_by_kind(measured.run.rows, views, stem, most)
    )
    return [plot for plot in plots if plot is not None]


def _sweep(rows: pd.DataFrame) -> _Sweep | None:
    rows = rows[~rows["is_reference"] & ~rows["is_tuned"]]
    varying = {
        structure: varying_parameters(own["parameters"])
        for structure, own in rows.groupby("structure", sort=False)
    }
    values: dict[str, dict[str, set[str]]] = {}
    for structure, text in zip(rows["structure"], rows["parameters"], strict=True):
        for name, value in parameter_items(text).items():
            if name in varying[structure] and value.isdecimal():
                values.setdefault(name, {}).setdefault(structure, set()).add(value)
    found = {
        name: [one for one, seen in by_structure.items() if len(seen) >= _LEAST_VALUES]
        for name, by_structure in values.items()
    }
    name = max(found, key=lambda one: len(found[one]), default="")
    base = next((one for one in found.get(name, ()) if varying[one] == {name}), None)
    if base is None or len(found[name]) < _LEAST_VALUES:
        return None
    rows = rows[rows["structure"].isin(found[name])]
    items = [parameter_items(text) for text in rows["parameters"]]
    rows = rows.assign(
        value=[float(own[name]) if own.get(name, "").isdecimal() else nan for own in items],
        line=[
            " ".join(
                [structure]
                + [f"{k}={v}" for k, v in own.items() if k in varying[structure] and k != name]
            )
            for structure, own in zip(rows["structure"], items, strict=True)
        ],
    )
    return _Sweep(name, base, rows.dropna(subset=["value"]))


def _figure(
    measured: Measured, sweep: _Sweep, kind: str, views: Sequence[str], stem: str
) -> Plot | None:
    rows = sweep.rows[sweep.rows["view"].isin(views)]
    images = [
        (view, rays)
        for rays in sorted(rows["rays"].unique())
        for view in views
        if ((rows["view"] == view) & (rows["rays"] == rays)).any()
    ]
    lines: dict[tuple[str, float], dict[str, _Line]] = {}
    for view, rays in images:
        at = rows[(rows["view"] == view) & (rows["rays"] == rays)]
        if own := _lines(measured, sweep, at):
            lines[view, rays] = own
    if not lines:
        return None
    looks = _looks(rows[rows["line"].isin({name for own in lines.values() for name in own})])
    columns = min(_COLUMNS, len(lines))
    figure, panels = panels_with_legend(len(lines), columns, _PANEL_HEIGHT, looks)
    for panel, ((view, rays), own) in zip(panels, lines.items(), strict=True):
        at = rows[(rows["view"] == view) & (rows["rays"] == rays)].iloc[0]
        set_title(panel, f"{short_title(measured.run.rows, view)}, {size_of(at)}", 30)
        for name, line in own.items():
            _draw_line(panel, name, line, looks[name], sweep)
        panel.axhline(1, color=INK, linewidth=0.8, zorder=1)
        panel.set_xticks(sorted(rows["value"].unique()))
        panel.xaxis.set_minor_locator(NullLocator())
        panel.xaxis.set_major_formatter("{x:g}")
        panel.set_xlabel(sweep.parameter)
        panel.set_ylabel(f"speed relative to\n{sweep.base} (higher is better)", fontsize=7.5)
        panel.grid(axis="y", linewidth=0.6)
        panel.margins(x=0.1)
    for part in _rows_of_panels(dict(zip(panels, lines.items(), strict=True)), columns):
        _share_scale(part)
    hide_repeated_labels(panels, columns)
    what = (
        f"Speed of a trace relative to {sweep.base} of the same {sweep.parameter}, {kind}",
        f"speed relative to {sweep.base} by {sweep.parameter}, {kind}",
    )
    reading = (
        f"The trace time of {sweep.base} over that of each other contender with the same "
        f"{sweep.parameter}; medians of the first trace after a build, build not included. "
        "Bars: 95% confidence interval of the ratio, where there is one."
    )
    return plot_of_views(measured.run, stem, figure, views, what, reading)


_Line = list[tuple[float, Ratio]]


def _rows_of_panels(
    panels: Mapping[Axes, tuple[tuple[str, float], Mapping[str, _Line]]], columns: int
) -> list[dict[Axes, Mapping[str, _Line]]]:
    """Returns the panels by resolution if each resolution fills whole rows, else all panels."""
    parts: dict[float, dict[Axes, Mapping[str, _Line]]] = {}
    for panel, ((_, rays), own) in panels.items():
        parts.setdefault(rays, {})[panel] = own
    if all(len(part) % columns == 0 for part in parts.values()):
        return list(parts.values())
    return [{panel: own for panel, (_, own) in panels.items()}]


def _share_scale(panels: Mapping[Axes, Mapping[str, _Line]]) -> None:
    """Gives the panels one vertical scale; between resolutions, values would differ too much."""
    values = [ratio.value for own in panels.values() for line in own.values() for _, ratio in line]
    for panel in panels:
        if scale_axis(panel, "y", values):
            panel.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5), numticks=9))
    share_limits(list(panels))
    if not any(panel.get_yscale() == "log" for panel in panels):
        for panel in panels:
            panel.set_ylim(bottom=0)


def _lines(measured: Measured, sweep: _Sweep, rows: pd.DataFrame) -> dict[str, _Line]:
    """Returns the lines of one image that have enough values, as ratios to the base."""
    bases = {row["value"]: row for _, row in rows[rows["structure"] == sweep.base].iterrows()}
    found: dict[str, _Line] = {}
    for name, own in rows[rows["structure"] != sweep.base].groupby("line", sort=False):
        line = [
            (row["value"], ratio_of("trace", bases[row["value"]], row, measured.files))
            for _, row in own.sort_values("value").iterrows()
            if row["value"] in bases
        ]
        if len(line) >= _LEAST_VALUES:
            found[str(name)] = line
    return found


def _looks(rows: pd.DataFrame) -> Mapping[str, Look]:
    """Returns a look for each line: the color of its structure, and a marker by its position."""
    return {
        name: variant_look(structure, index)
        for structure, own in rows.groupby("structure", sort=False)
        for index, name in enumerate(dict.fromkeys(own["line"]))
    }


def _draw_line(panel: Axes, name: str, line: _Line, look: Look, sweep: _Sweep) -> None:
    for value, ratio in line:
        if ratio.interval:
            panel.plot([value, value], ratio.interval, color=look.color, linewidth=1.8)
    (joined,) = panel.plot(
        [value for value, _ in line],
        [ratio.value for _, ratio in line],
        **look.line,
    )
    texts = [
        f"{sweep.parameter}={value:g} {number(ratio.value)}"
        f"{between(*ratio.interval) if ratio.interval else ''}"
        for value, ratio in line
    ]
    hover(joined, f"{name}, speed relative to {sweep.base}: {'; '.join(texts)}")
