"""Draws the thesis's figures and ours on one axis, to compare shapes."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

from beambench_report.base.figure import Plot, legend_below, new_figure, variant_look
from beambench_thesis.paper.evidence import Measured

_ROW_HEIGHT = 2.5  # inches
_LEGEND_HEIGHT = 0.22
_LEGEND_COLUMNS = 95  # characters that fit beside each other
_MARGIN = 1.06


@dataclass(frozen=True)
class Points:
    """One line: positions along the axis and figures with their intervals."""

    label: str
    structure: str
    variant: int
    at: Sequence[tuple[float, Measured]]
    is_joined: bool = True
    """Whether a line is drawn through the points."""
    color: str = ""
    """The color; by default the structure's."""


@dataclass(frozen=True)
class Side:
    """The lines of one side of a panel, and the unit of their figures."""

    lines: tuple[Points, ...]
    title: str
    nothing: str = ""
    """The text that replaces the lines if there are none."""


@dataclass(frozen=True)
class Panel:
    """Two sides with one vertical axis: the thesis's on the left, ours on the right."""

    title: str
    unit: str
    left: Side
    right: Side


@dataclass(frozen=True)
class FigureData:
    """Everything that is drawn, and the caption."""

    number: str
    title: str
    panels: tuple[Panel, ...]
    across: str
    """The label of the horizontal axis."""
    caption: str
    ticks: tuple[float, ...] = ()
    is_log: bool = False
    is_log_across: bool = False
    is_all_ours: bool = False
    """Whether both sides show our data."""

    @property
    def is_empty(self) -> bool:
        """Whether we measured none of the figure's data."""
        ours = [panel.right for panel in self.panels]
        ours += [panel.left for panel in self.panels] if self.is_all_ours else []
        return not any(side.lines for side in ours)


def draw(data: FigureData) -> Plot:
    """Draws the figure, one row per panel."""
    names = _names(data)
    columns = max(1, min(len(names), _LEGEND_COLUMNS // (4 + max(map(len, names), default=1))))
    legend = _LEGEND_HEIGHT * (1 + len(names) // columns)
    figure, axes = new_figure(_ROW_HEIGHT * len(data.panels) + 0.3 + legend, len(data.panels), 2)
    for row, panel in enumerate(data.panels):
        left, right = axes[2 * row], axes[2 * row + 1]
        right.sharey(left)
        right.sharex(left)
        for axis, side in ((left, panel.left), (right, panel.right)):
            _draw_side(axis, side)
            axis.set_title(", ".join(words for words in (panel.title, side.title) if words))
            _label(axis, data, is_last=row == len(data.panels) - 1)
        left.set_ylabel(panel.unit)
        right.tick_params(labelleft=False)
        if not data.is_log:
            left.set_ylim(bottom=min(0.0, left.get_ylim()[0]))
    handles = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    legend_below(figure, columns, handles=handles.values(), labels=handles.keys())
    return Plot(f"figure-{data.number}", figure, data.title)


def _names(data: FigureData) -> set[str]:
    sides = chain.from_iterable((panel.left, panel.right) for panel in data.panels)
    return {line.label for side in sides for line in side.lines}


def _draw_side(axis: Axes, side: Side) -> None:
    for line in side.lines:
        look = variant_look(line.structure, line.variant)
        figures = [figure for _, figure in line.at]
        below = [max(0.0, figure.value - figure.low) for figure in figures]
        above = [max(0.0, figure.high - figure.value) for figure in figures]
        axis.errorbar(
            [place for place, _ in line.at],
            [figure.value for figure in figures],
            yerr=[below, above] if any(below) or any(above) else None,
            label=line.label,
            color=line.color or look.color,
            marker=look.marker,
            linestyle=look.dashes if line.is_joined else "none",
            markersize=4.5,
            capsize=2.5,
            linewidth=1.3,
        )
    if not side.lines:
        axis.text(
            0.5,
            0.5,
            side.nothing or "not measured",
            transform=axis.transAxes,
            ha="center",
            va="center",
            color="#555555",
            fontsize=8,
        )


def _label(axis: Axes, data: FigureData, *, is_last: bool) -> None:
    if data.is_log:
        axis.set_yscale("log")
        axis.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.yaxis.set_minor_formatter(NullFormatter())
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}"))
    if data.is_log_across:
        axis.set_xscale("log")
    if data.ticks:
        axis.set_xticks(data.ticks, [f"{tick:g}" for tick in data.ticks])
        axis.xaxis.set_minor_locator(NullLocator())
        first, last = data.ticks[0], data.ticks[-1]  # the same whatever was measured
        more = (_MARGIN - 1) * (last - first)
        log_ends = (first / _MARGIN, last * _MARGIN)
        axis.set_xlim(*(log_ends if data.is_log_across else (first - more, last + more)))
    axis.tick_params(labelsize=8)
    axis.title.set_fontsize(8.5)
    axis.grid(axis="y", which="major", color="#dddddd", linewidth=0.6)
    if is_last:
        axis.set_xlabel(data.across)
