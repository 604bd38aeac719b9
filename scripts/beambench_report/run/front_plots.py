"""Plots build time against trace time with its Pareto front, a panel for each scene of a run."""

from collections.abc import Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator
from matplotlib.transforms import Affine2D, Bbox

from beambench_report.base.analysis import Standing
from beambench_report.base.figure import Plot, house_style, write_plot
from beambench_report.base.files import Problem
from beambench_report.base.names import brief_name, file_stems
from beambench_report.base.palette import INK, PAPER, SOFT, structure_color
from beambench_report.base.quantities import number
from beambench_report.base.svg import hover
from beambench_report.run.crossings import rays_in_words
from beambench_report.run.fronts import Front, fronts
from beambench_report.run.labels import place_labels, spread
from beambench_report.run.measured import Measured, read_measured
from beambench_report.run.panels import (
    chunks,
    finish,
    numbered,
    panels_with_legend,
    set_title,
)

_MOST_PANELS = 6
_PANEL_HEIGHT = 2.9  # inches
_READING = (
    "Lower and further left is better. The line joins the Pareto front: no other contender is both "
    "built and traced in less time. Filled: the best choice for some number of rays, build "
    "included; hollow: never the best choice. Builders without a structure's name are of sah-bvh. "
    "embree without the word robust is not watertight (robust=false). Other names are left out "
    "where there is no room."
)
_ROOM = 0.75  # of the extent of the logarithms of trace times, for names at the left
_NAMED_LEFT = 0.5  # of the same extent: points further right have their names beside them
_LABEL_SIZE = 6.5
_LABEL_STEP = 7.6  # points


def write_fronts(directory: Path) -> list[Path]:
    """Writes DIRECTORY/plots/fronts-*.svg and .png. Raises Problem if there is nothing to draw.

    There is a figure, or several for many scenes, for each kind of rays.
    """
    measured = read_measured(directory)
    found = fronts(measured.analysis)
    if not found:
        raise Problem(f"{directory}: no contender has times; a run with correct hits is needed")
    folder = directory / "plots"
    folder.mkdir(exist_ok=True)
    with house_style():
        return [path for plot in front_plots(measured, found) for path in write_plot(plot, folder)]


def front_plots(measured: Measured, found: Sequence[Front]) -> list[Plot]:
    """Returns the figures of the given fronts."""
    kinds = file_stems(dict.fromkeys(front.view.ray_kind for front in found))
    plots = []
    for kind, stem in kinds.items():
        own = [front for front in found if front.view.ray_kind == kind]
        for index, part in enumerate(chunks(own, _MOST_PANELS)):
            figure = _figure(measured, kind, part)
            scenes = ", ".join(front.scene for front in part)
            summary = f"build time against trace time, {kind} rays: {scenes}"
            plots.append(Plot(numbered(f"fronts-{stem}", index), figure, summary))
    return plots


def _figure(measured: Measured, kind: str, found: Sequence[Front]) -> Figure:
    figure, panels = panels_with_legend(len(found), min(2, len(found)), _PANEL_HEIGHT, {})
    for panel, front in zip(panels, found, strict=True):
        _draw(panel, front)
    rows = measured.run.rows
    rows = rows[rows["view"].isin([front.view.view for front in found])]
    finish(figure, f"Build or trace? {kind} rays", rows, _READING)
    for panel, front in zip(panels, found, strict=True):
        names = [_name(one) for one in front.others]
        points = [_place(one) for one in front.others]
        line = [_place(one) for one in front.members]
        numbers = [""] * len(points)
        place_labels(panel, points, names, numbers, [line], taken=_name_members(panel, front))
    return figure


def _name(one: Standing) -> str:
    return brief_name(one.name).removeprefix("sah-bvh ").removesuffix(" robust=false")


def _name_members(panel: Axes, front: Front) -> list[Bbox]:
    """Labels the front, mostly in a column at the left; returns the boxes of names and points."""
    scale = 72 / panel.figure.dpi
    left = min(one.ns_per_ray for one in front.view.ranked)
    right = max(one.ns_per_ray for one in front.view.ranked)
    at = {
        one: [float(end) * scale for end in panel.transData.transform(_place(one))]
        for one in front.members
    }
    in_column = [one for one in at if one.ns_per_ray <= left * (right / left) ** _NAMED_LEFT]
    edge = min(x for x, _ in at.values()) - 16
    low, high = (float(end) * scale for end in (panel.bbox.y0, panel.bbox.y1))
    heights = spread([at[one][1] for one in in_column], low + 6, high - 6, _LABEL_STEP)
    offsets = {
        one: (edge - at[one][0], height - at[one][1])
        for one, height in zip(in_column, heights, strict=True)
    }
    leader = {"arrowstyle": "-", "color": SOFT, "lw": 0.5, "shrinkA": 0, "relpos": (1, 0.5)}
    renderer = FigureCanvasAgg(panel.figure).get_renderer()
    boxes = []
    for one, (x, y) in at.items():
        text = panel.annotate(
            _name(one),
            _place(one),
            offsets.get(one, (7, 0)),
            textcoords="offset points",
            ha="right" if one in offsets else "left",
            va="center",
            fontsize=_LABEL_SIZE,
            weight="bold",
            arrowprops=leader if one in offsets else None,
        )
        text.set_in_layout(False)
        boxes.append(Text.get_window_extent(text, renderer))
        boxes.append(
            Bbox.from_extents(x, y, x, y).padded(4).transformed(Affine2D().scale(1 / scale))
        )
    return boxes


def _draw(panel: Axes, front: Front) -> None:
    line = [_place(one) for one in front.members]
    panel.plot(*zip(*line, strict=True), color=SOFT, linewidth=0.9, zorder=1)
    since = {choice.standing.contender: choice.rays for choice in front.choices}
    for one in front.view.ranked:
        is_member = one in front.members
        color = structure_color(one.structure)
        (point,) = panel.plot(
            *_place(one),
            "o",
            color=color,
            markersize=6 if is_member else 4,
            markerfacecolor=color if one.contender in since or not is_member else PAPER,
            markeredgecolor=(INK if one.contender in since else color) if is_member else PAPER,
            markeredgewidth=0.8 if is_member else 0.4,
            alpha=1.0 if is_member else 0.7,
        )
        words = f"{one.name}: build {number(one.build_ms)} ms, {number(one.ns_per_ray)} ns per ray"
        best = since.get(one.contender)
        hover(point, words if best is None else f"{words}; best from {rays_in_words(best)} rays on")
    set_title(panel, f"{front.scene}, {front.view.size}")
    panel.set(xscale="log", yscale="log")
    panel.margins(0.1)
    panel.autoscale_view()
    left = min(one.ns_per_ray for one in front.view.ranked)
    panel.set_xlim(left * (left / max(one.ns_per_ray for one in front.view.ranked)) ** _ROOM)
    for axis in (panel.xaxis, panel.yaxis):
        axis.set_major_locator(LogLocator(subs=(1, 3), numticks=6))
        axis.set_minor_locator(NullLocator())
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.9g}"))
    panel.set_xlabel("trace in ns per ray")
    panel.set_ylabel("build in ms")
    panel.grid(linewidth=0.6)


def _place(one: Standing) -> tuple[float, float]:
    return one.ns_per_ray, one.build_ms
