"""Makes figures of several panels at page width, never taller than 1.4 times the width."""

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import ceil, log10
from typing import TypeVar

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter, NullLocator
from matplotlib.transforms import blended_transform_factory

from beambench_report.base.figure import DPI, PAGE_WIDTH, Look, Plot, caption
from beambench_report.base.names import file_stems
from beambench_report.base.records import Run
from beambench_report.run.measured import by_kind, short_title

TALLEST = 1.38 * PAGE_WIDTH
"""The greatest height in inches: 1.4 times the width, less a margin for rounding to pixels."""
MOST_LINES = 24
"""The most contenders in a figure with a line for each."""
MOST_ROWS = 60
"""The most contenders in a figure with a row for each."""
WIDE_RANGE = 20
"""An axis is logarithmic if its largest value exceeds the smallest by more than this factor."""

_LEGEND_LINE = 0.165  # inches
_LEGEND_CHARACTER = 0.066  # inches
_Item = TypeVar("_Item")


def chunks(items: Sequence[_Item], most: int) -> list[Sequence[_Item]]:
    """Splits items into as few parts of at most `most` as possible, as evenly as possible."""
    parts = ceil(len(items) / most)
    size = ceil(len(items) / parts) if parts else 1
    return [items[start : start + size] for start in range(0, len(items), size)]


def numbered(stem: str, index: int) -> str:
    """Returns the stem of one of several figures, counted from 0: memory, memory-2, memory-3."""
    return stem if index == 0 else f"{stem}-{index + 1}"


def parts_by_kind(
    rows: pd.DataFrame, views: Iterable[str], stem: str, most: int
) -> Iterator[tuple[str, Sequence[str], str]]:
    """Yields the kind, views and stem of each figure; a figure shows one kind of rays."""
    groups = by_kind(rows, views)
    kinds = file_stems(groups)
    for kind, own in groups.items():
        base = stem if len(groups) == 1 else f"{stem}-{kinds[kind]}"
        for index, part in enumerate(chunks(own, most)):
            yield kind, part, numbered(base, index)


def panels_with_legend(
    count: int,
    columns: int,
    panel_height: float,
    legend: Mapping[str, Look],
    *,
    width_ratios: Sequence[float] | None = None,
    with_lines: bool = True,
) -> tuple[Figure, list[Axes]]:
    """Returns a figure of `count` panels, with the legend of contenders, if any, below them."""
    rows = ceil(count / columns)
    longest = max((len(name) for name in legend), default=0)
    legend_columns = max(1, int(PAGE_WIDTH / (0.45 + _LEGEND_CHARACTER * longest)))
    legend_height = _LEGEND_LINE * ceil(len(legend) / legend_columns)
    figure = Figure(
        figsize=(PAGE_WIDTH, rows * panel_height + legend_height), dpi=DPI, layout="constrained"
    )
    heights = [panel_height] * rows + ([legend_height] if legend else [])
    grid = figure.add_gridspec(
        len(heights), columns, height_ratios=heights, width_ratios=width_ratios
    )
    panels = [figure.add_subplot(grid[place // columns, place % columns]) for place in range(count)]
    if legend:
        below = figure.add_subplot(grid[-1, :])
        below.set_axis_off()
        below.legend(
            [_handle(look, with_line=with_lines) for look in legend.values()],
            list(legend),
            loc="upper left",
            bbox_to_anchor=(0.01, 1),  # from the left end of the page, not of the panels
            bbox_transform=blended_transform_factory(figure.transFigure, below.transAxes),
            ncols=legend_columns,
            fontsize=7.5,
            frameon=False,
            borderaxespad=0,
            labelspacing=0.3,
            columnspacing=1.4,
        ).set_in_layout(False)
    return figure, panels


def _handle(look: Look, *, with_line: bool) -> Line2D:
    dashes = look.dashes if with_line else "none"
    return Line2D([], [], color=look.color, marker=look.marker, linestyle=dashes, markersize=4.5)


def finish(
    figure: Figure, heading: str, rows: pd.DataFrame, explanation: str, *, times: bool = True
) -> Figure:
    """Writes heading and caption, and settles the layout only once."""
    lines = textwrap.wrap(heading, 92)
    figure.suptitle("\n".join(lines), x=0.01, ha="left", weight="bold", fontsize=10)
    width, height = figure.get_size_inches()
    figure.set_size_inches(width, height + 0.2 * len(lines) + 0.1)
    caption(figure, rows, explanation, times=times)
    figure.set_size_inches(width, min(figure.get_size_inches()[1], TALLEST))
    figure.get_layout_engine().set(w_pad=0.08)
    figure.get_layout_engine().execute(figure)
    figure.set_layout_engine("none")
    return figure


def plot_of_views(
    run: Run, stem: str, figure: Figure, views: Sequence[str], what: tuple[str, str], reading: str
) -> Plot:
    """Finishes a figure of some views; `what` is its heading, and its summary without scenes."""
    heading, summary = what
    finish(figure, heading, run.rows[run.rows["view"].isin(views)], reading)
    scenes = ", ".join(short_title(run.rows, view) for view in views)
    return Plot(stem, figure, f"{summary}: {scenes}", views[0] if len(views) == 1 else "")


def set_title(panel: Axes, title: str, width: int = 38) -> None:
    """Sets the title of one of several panels."""
    panel.set_title(textwrap.fill(title, width, break_on_hyphens=False), fontsize=8.5)


def scale_axis(panel: Axes, which: str, values: Iterable[float], ticks: int = 9) -> bool:
    """Makes an axis, "x" or "y", logarithmic if the values need it; returns whether it is."""
    above = [value for value in values if value > 0]
    is_wide = bool(above) and max(above) > WIDE_RANGE * min(above)
    panel.set(**{f"{which}scale": "log" if is_wide else "linear"})
    axis = {"x": panel.xaxis, "y": panel.yaxis}[which]
    if is_wide:
        decades = log10(max(above) / min(above))
        axis.set_major_locator(
            LogLocator(subs=(1, 2, 5) if decades < 2 and ticks > 6 else (1,), numticks=ticks)
        )
        axis.set_minor_locator(NullLocator())
        axis.set_minor_formatter(NullFormatter())
    else:
        axis.set_major_locator(MaxNLocator(min(5, ticks - 1), steps=(1, 2, 5, 10)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.9g}"))
    return is_wide


def hide_repeated_labels(panels: Sequence[Axes], columns: int, is_shared: str = "xy") -> None:
    """Hides labels except at the left and lower edges of the figure, and ticks of shared axes."""
    for place, panel in enumerate(panels):
        if place % columns:
            panel.set_ylabel("")
            panel.tick_params(axis="y", labelleft="y" not in is_shared)
        if place + columns < len(panels):
            panel.set_xlabel("")
            panel.tick_params(axis="x", labelbottom=False)


def share_limits(panels: Sequence[Axes], which: str = "xy") -> None:
    """Sets the limits of all panels so that they cover the limits of each panel."""
    for axis in which:
        limits = [getattr(panel, f"get_{axis}lim")() for panel in panels]
        widest = (min(low for low, _ in limits), max(high for _, high in limits))
        for panel in panels:
            getattr(panel, f"set_{axis}lim")(widest)
