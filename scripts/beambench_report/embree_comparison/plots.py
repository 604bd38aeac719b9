"""The plots of the comparison: ratios and their targets, and how they change with size."""

from collections.abc import Iterable, Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullLocator

from beambench.analysis import Ratio
from beambench_report.base.figure import Plot, new_figure, write_below
from beambench_report.base.palette import INK, PAPER, structure_color
from beambench_report.embree_comparison.growth import NO_BACKS, PIXELS, PRIMITIVES, growth
from beambench_report.embree_comparison.pairings import PRIMARY, Pairing, headlines
from beambench_report.embree_comparison.targets import (
    LARGE,
    MIDDLE,
    SMALL,
    Group,
    groups,
    part_of_targets,
)
from beambench_report.run.panels import numbered

_LINE_HEIGHT = 0.12  # inches, of one marker; a row has one for each resolution
_PANEL_HEIGHT = 0.55  # inches that a panel needs beside its rows
_TALLEST = 8.2  # inches of panels in one figure
# Each resolution has one marker in all figures. The color is tile-beam's, whose speed is drawn.
_MARKERS = {"80x50": "v", "160x100": "s", SMALL: "o", MIDDLE: "D", LARGE: "^"}
_COLOR = structure_color("tile-beam")
_TARGET_HEIGHT = 0.4  # half the height of a target's tick, in lines
_TICKS = (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100)
_READING = (
    "First traces after a build. Line: 95% confidence interval; hollow: too few repetitions for an "
    "interval; tick on the line of a marker: its target. At 1, both are equally fast."
)
_Panel = tuple[Group, Sequence[Pairing]]


def plots(found: Sequence[Pairing]) -> list[Plot]:
    """Returns the figures for which there are enough images."""
    single = [pair for pair in found if pair.samples == 1]
    drawn = [
        plot
        for isa in dict.fromkeys(pair.isa for pair in single)
        for plot in _ratios(isa, [pair for pair in headlines(single) if pair.isa == isa])
    ]
    best = [pair for pair in single if pair.isa == "best" and pair.kind == PRIMARY]
    return [*drawn, *growth(best, PRIMITIVES), *growth(best, PIXELS)]


def _ratios(isa: str, found: Sequence[Pairing]) -> list[Plot]:
    """Distributes whole groups over as few figures as possible, each of at most a page."""
    panels = []
    for group in groups():
        own = [pair for pair in found if group.holds(pair)]
        if own:
            panels.append((group, own))
    stem = "beat-embree" if isa == "best" else f"beat-embree-{isa}"
    return [_figure(numbered(stem, index), isa, own) for index, own in enumerate(_by_page(panels))]


def _by_page(panels: Iterable[_Panel]) -> list[list[_Panel]]:
    """Puts each panel on the first page with room for it."""
    pages: list[list[_Panel]] = []
    for panel in panels:
        for page in pages:
            if sum(map(_height, [*page, panel])) <= _TALLEST:
                page.append(panel)
                break
        else:
            pages.append([panel])
    return pages


def _height(panel: _Panel) -> float:
    _, own = panel
    rows = len({pair.scene for pair in own})
    return _LINE_HEIGHT * (len(_resolutions(own)) + 0.5) * rows + _PANEL_HEIGHT


def _figure(stem: str, isa: str, shown: Sequence[_Panel]) -> Plot:
    """Draws a panel per group, a row per scene, and a marker per resolution with its target's tick.

    Each tick is on the line of its marker, so that ticks do not hide each other.
    """
    heights = [_height(panel) for panel in shown]
    figure, panels = new_figure(sum(heights) + 0.3, len(shown), height_ratios=heights)
    every = [pair for _, own in shown for pair in own]
    for panel, (group, own) in zip(panels, shown, strict=True):
        scenes = [scene for scene in group.scenes if any(pair.scene == scene for pair in own)]
        resolutions = _resolutions(own)
        line = 1 / (len(resolutions) + 0.5)
        for pair in own:
            shift = line * (resolutions.index(pair.resolution) - (len(resolutions) - 1) / 2)
            target = part_of_targets(isa) * group.targets[pair.resolution]
            _draw_ratio(
                panel, pair, scenes.index(pair.scene) + shift, target, line * _TARGET_HEIGHT
            )
        panel.set_title(group.title)
        culled = {pair.scene for pair in own if pair.is_culled}
        names = [f"{group.scenes[scene]}{', no backs' * (scene in culled)}" for scene in scenes]
        panel.set_yticks(range(len(scenes)), names)
        panel.set_ylim(len(scenes) - 0.4, -0.6)
        _axis_of_ratios(panel, every)
    panels[-1].set_xlabel("Embree's fastest time over that of tile-beam (higher is better)")
    _legend(figure, _resolutions(every))
    limited = "" if isa == "best" else f" Both are limited to isa={isa}."
    no_backs = NO_BACKS * any(pair.is_culled for pair in every)
    write_below(
        figure, [_READING + no_backs + limited, *dict.fromkeys(pair.origin for pair in every)]
    )
    titles = "; ".join(group.title for group, _ in shown)
    return Plot(stem, figure, f"speed of tile beams relative to Embree: {titles}")


def _draw_ratio(panel: Axes, pair: Pairing, at: float, target: float, half: float) -> None:
    ratio: Ratio = pair.ratio
    if ratio.interval:
        panel.plot(ratio.interval, [at, at], color=_COLOR, linewidth=1.5)
    panel.plot(
        ratio.value,
        at,
        _MARKERS[pair.resolution],
        color=_COLOR,
        markerfacecolor=_COLOR if ratio.interval else PAPER,
        markersize=4.5,
        zorder=3,
    )
    ends = [at - half, at + half]
    panel.plot([target, target], ends, color=INK, linewidth=2, solid_capstyle="butt", zorder=2.5)


def _axis_of_ratios(panel: Axes, found: Sequence[Pairing]) -> None:
    values = [end for pair in found for end in pair.ratio.interval or (pair.ratio.value,)]
    panel.set_xscale("log")
    panel.set_xlim(min(0.6, 0.8 * min(values)), max(20.0, 1.3 * max(values)))
    panel.set_xticks(
        [tick for tick in _TICKS if panel.get_xlim()[0] <= tick <= panel.get_xlim()[1]]
    )
    panel.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    panel.xaxis.set_minor_locator(NullLocator())
    panel.axvline(1, color=structure_color("embree"), linewidth=0.8)
    panel.grid(linewidth=0.6)


def _legend(figure: Figure, resolutions: Sequence[str]) -> None:
    handles = [
        Line2D([], [], marker=_MARKERS[size], color=_COLOR, linestyle="none", label=size)
        for size in resolutions
    ]
    handles.append(
        Line2D([], [], marker="|", color=INK, linestyle="none", markeredgewidth=2, label="target")
    )
    figure.legend(
        handles=handles, loc="outside upper center", ncols=len(handles), frameon=False, fontsize=8
    )


def _resolutions(found: Sequence[Pairing]) -> list[str]:
    """Returns the measured resolutions, the coarsest first."""
    return [size for size in _MARKERS if any(pair.resolution == size for pair in found)]
