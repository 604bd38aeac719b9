"""Draws times and ratios against the sizes of scenes and images, as small multiples."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import astuple, dataclass

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, NullLocator

from beambench_report.base.figure import Look, Plot, variant_look, write_below
from beambench_report.base.palette import INK, PAPER
from beambench_report.embree_comparison.pairings import Pairing, in_one_way
from beambench_report.run.panels import (
    chunks,
    hide_repeated_labels,
    numbered,
    panels_with_legend,
    scale_axis,
    set_title,
)

_MIN_SIZES = 5
"""The fewest sizes that show how a time grows."""
_MOST_LINES = 3
"""The most rows of panels, so that a figure is no taller than a page."""
_PANEL_HEIGHT = 2.5  # inches
_EMBREE, _TILE = "Embree's fastest mode", "tile-beam"
_STRUCTURES = {_EMBREE: "embree", _TILE: "tile-beam"}
_READING = "First traces after a build. Bars: 95% confidence intervals, where there are any."
NO_BACKS = " No backs: tile-beam left out the backs of solids, which Embree cannot do."
_NEWEST = "An image that several runs measured is drawn once, from the newest of them."


@dataclass(frozen=True)
class Axis:
    """The quantity that grows: stem of its figures, its name, and names of lines and ticks."""

    stem: str
    name: str
    line: Callable[[Pairing], str]
    size: Callable[[Pairing], int]
    tick: Callable[[Pairing], str]


PRIMITIVES = Axis(
    "beat-embree-scaling",
    "primitives",
    lambda pair: f"{pair.scene.split(':')[0]}, {pair.resolution}",
    lambda pair: pair.primitives,
    lambda pair: _in_short(pair.primitives),
)
PIXELS = Axis(
    "beat-embree-resolutions",
    "resolution",
    lambda pair: pair.scene,
    lambda pair: pair.rays,
    lambda pair: pair.resolution,
)


def growth(found: Sequence[Pairing], axis: Axis) -> list[Plot]:
    """Returns the figures: a row of two panels for each line with enough sizes."""
    lines: dict[str, list[Pairing]] = {}
    for pair in sorted(found, key=axis.size):
        lines.setdefault(axis.line(pair), []).append(pair)
    alike = {name: in_one_way(own, axis.size) for name, own in lines.items()}
    long = [
        (f"{name}{', no backs' * own[0].is_culled}", own)
        for name, own in alike.items()
        if len({axis.size(one) for one in own}) >= _MIN_SIZES
    ]
    return [
        _growth(numbered(axis.stem, index), dict(part), axis)
        for index, part in enumerate(chunks(long, _MOST_LINES))
    ]


def _growth(stem: str, lines: Mapping[str, Sequence[Pairing]], axis: Axis) -> Plot:
    drawn = [pair for own in lines.values() for pair in own]
    commits = list(dict.fromkeys(pair.commit for pair in sorted(drawn, key=lambda p: p.run_id)))
    looks = {name: variant_look(structure, 0) for name, structure in _STRUCTURES.items()}
    figure, panels = panels_with_legend(2 * len(lines), 2, _PANEL_HEIGHT, looks)
    for place, (name, own) in enumerate(lines.items()):
        times, ratios = panels[2 * place : 2 * place + 2]
        _draw_times(times, own, axis, looks, commits)
        _draw_ratios(ratios, own, axis, looks[_TILE], commits)
        for panel in (times, ratios):
            set_title(panel, name)
            _name_sizes(panel, own, axis)
    for panels_of_column in (panels[::2], panels[1::2]):
        hide_repeated_labels(panels_of_column, 1)
        for panel in panels_of_column:
            panel.tick_params(axis="x", labelbottom=True)
    which = ""
    if len(commits) > 1:
        which = f" Filled: commit {commits[-1]}; hollow: {' and '.join(commits[:-1])}."
    write_below(
        figure,
        [
            f"{_READING}{NO_BACKS * any(one.is_culled for one in drawn)}{which} {_NEWEST}",
            *dict.fromkeys(pair.origin for pair in drawn),
        ],
    )
    return Plot(
        stem,
        figure,
        f"ns per ray of tile beams and of Embree, and their ratio, against {axis.name}",
    )


def _draw_times(
    panel: Axes,
    own: Sequence[Pairing],
    axis: Axis,
    looks: Mapping[str, Look],
    commits: Sequence[str],
) -> None:
    values = []
    for name, look in looks.items():
        scaled = [
            tuple(None if end is None else 1e6 * end / pair.rays for end in astuple(trace.first))
            for pair in own
            for trace in [pair.embree if name == _EMBREE else pair.tile]
        ]
        _draw_line(panel, own, axis, scaled, look, commits)
        values += [value for value, *_ in scaled]
    scale_axis(panel, "y", values)
    panel.set_ylabel("ns per ray (lower is better)")


def _draw_ratios(
    panel: Axes, own: Sequence[Pairing], axis: Axis, look: Look, commits: Sequence[str]
) -> None:
    ratios = [(pair.ratio.value, *(pair.ratio.interval or (None, None))) for pair in own]
    _draw_line(panel, own, axis, ratios, look, commits)
    panel.axhline(1, color=INK, linewidth=0.8)
    scale_axis(panel, "y", [value for value, *_ in ratios])
    if panel.get_yscale() == "linear":
        panel.set_ylim(bottom=0)
    panel.set_ylabel("Embree's time over that of\ntile-beam (higher is better)")


def _draw_line(
    panel: Axes,
    own: Sequence[Pairing],
    axis: Axis,
    figures: Sequence[tuple[float, float | None, float | None]],
    look: Look,
    commits: Sequence[str],
) -> None:
    """Draws joined points with their intervals; points of the newest commit are filled."""
    sizes = [axis.size(pair) for pair in own]
    panel.plot(sizes, [value for value, *_ in figures], color=look.color, linewidth=1.1, zorder=2)
    for size, (_, low, high) in zip(sizes, figures, strict=True):
        if low is not None and high is not None:
            panel.plot([size, size], [low, high], "_-", color=look.color, linewidth=1.3, zorder=2.5)
    for pair, size, (value, *_) in zip(own, sizes, figures, strict=True):
        panel.plot(
            size,
            value,
            look.marker,
            color=look.color,
            markersize=4,
            markerfacecolor=look.color if pair.commit == commits[-1] else PAPER,
            zorder=3,
        )


def _name_sizes(panel: Axes, own: Sequence[Pairing], axis: Axis) -> None:
    panel.set_xscale("log")
    names = {axis.size(pair): axis.tick(pair) for pair in own}
    panel.set_xticks(list(names), list(names.values()), rotation=45, ha="right", fontsize=7)
    panel.xaxis.set_minor_locator(NullLocator())
    panel.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}"))
    panel.set_xlabel(axis.name)
    panel.grid(axis="y", linewidth=0.6)


def _in_short(count: int) -> str:
    """Formats a number: `16 k`, `1 M`, `10 M`."""
    if count >= 999_500:
        return f"{count / 1e6:.0f} M"
    return f"{count / 1e3:.0f} k" if count >= 1000 else str(count)
