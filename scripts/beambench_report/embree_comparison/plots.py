"""Ratios and their targets, and times as scenes and images get finer."""

from collections.abc import Callable, Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullLocator

from beambench_report.base.figure import Plot, new_figure, structure_color
from beambench_report.base.ratio import Ratio
from beambench_report.embree_comparison.pairings import Pairing, Trace
from beambench_report.embree_comparison.targets import LARGE, MIDDLE, SMALL, groups, part_of_targets

_LINE_HEIGHT = 0.12  # inches, of one marker; a row has one for each resolution
# Colors of Okabe and Ito, the same for a resolution in every figure.
_LOOKS = {
    "80x50": ("#cc79a7", "v"),
    "160x100": ("#56b4e9", "s"),
    SMALL: ("#0072b2", "o"),
    MIDDLE: ("#e69f00", "D"),
    LARGE: ("#d55e00", "^"),
}
_TARGET_HEIGHT = 0.4  # of the tick of a target, in lines, to each side
_TICKS = (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100)
_READING = (
    "First traces after a build. Line: 95% interval; hollow: too few repetitions; tick: target."
)
_MIN_SIZES = 5
"""A line needs as many sizes to show how a time grows."""


def plots(found: Sequence[Pairing]) -> list[Plot]:
    """Those for which the images suffice."""
    single = [pair for pair in found if pair.samples == 1]
    drawn = [_ratios(isa, single) for isa in dict.fromkeys(pair.isa for pair in single)]
    best = [pair for pair in single if pair.isa == "best"]
    drawn += [
        _growth(
            "beat-embree-scaling",
            best,
            line=lambda pair: (pair.scene.split(":")[0], pair.resolution),
            size=lambda pair: pair.primitives,
            axis="primitives",
        ),
        _growth(
            "beat-embree-resolutions",
            best,
            line=lambda pair: (pair.scene,),
            size=lambda pair: pair.rays,
            axis="pixels",
        ),
    ]
    return [plot for plot in drawn if plot is not None]


def _ratios(isa: str, found: Sequence[Pairing]) -> Plot | None:
    """One panel per group, row per scene, marker per resolution; targets are ticks of its color.

    The ticks stand in the line of their marker, so that none hides another one.
    """
    shown = [pair for pair in found if pair.isa == isa]
    panels_of = []
    for group in groups():
        own = [
            pair
            for pair in shown
            if pair.scene in group.scenes and pair.resolution in group.targets
        ]
        if own:
            panels_of.append((group, own))
    if not panels_of:
        return None
    shown = [pair for _, own in panels_of for pair in own]
    heights = [
        _LINE_HEIGHT * (len(_resolutions(own)) + 0.5) * len({pair.scene for pair in own}) + 0.5
        for _, own in panels_of
    ]
    figure, panels = new_figure(sum(heights) + 0.8, len(panels_of), height_ratios=heights)
    for panel, (group, own) in zip(panels, panels_of, strict=True):
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
        panel.set_yticks(range(len(scenes)), [group.scenes[scene] for scene in scenes])
        panel.set_ylim(len(scenes) - 0.4, -0.6)
        _axis_of_ratios(panel, shown)
    panels[-1].set_xlabel("speed relative to Embree's fastest mode")
    _legend(figure, _resolutions(shown))
    _name_origin(figure, shown, _READING)
    stem = "beat-embree" if isa == "best" else f"beat-embree-{isa}"
    return Plot(stem, figure, "speed of tile beams relative to Embree")


def _draw_ratio(panel: Axes, pair: Pairing, at: float, target: float, half: float) -> None:
    color, marker = _LOOKS[pair.resolution]
    ratio: Ratio = pair.ratio
    if ratio.interval:
        panel.plot(ratio.interval, [at, at], color=color, linewidth=1.5)
    inside = color if ratio.interval else "white"
    panel.plot(
        ratio.value, at, marker, color=color, markerfacecolor=inside, markersize=4.5, zorder=3
    )
    ends = [at - half, at + half]
    panel.plot([target, target], ends, color=color, linewidth=2, solid_capstyle="butt", zorder=2.5)


def _axis_of_ratios(panel: Axes, found: Sequence[Pairing]) -> None:
    values = [end for pair in found for end in pair.ratio.interval or (pair.ratio.value,)]
    panel.set_xscale("log")
    panel.set_xlim(min(0.6, 0.8 * min(values)), max(20.0, 1.3 * max(values)))
    panel.set_xticks(
        [tick for tick in _TICKS if panel.get_xlim()[0] <= tick <= panel.get_xlim()[1]]
    )
    panel.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    panel.xaxis.set_minor_locator(NullLocator())
    panel.axvline(1, color="#333333", linewidth=0.8)
    panel.grid(axis="y", color="#dddddd", linewidth=0.6)


def _legend(figure: Figure, resolutions: Sequence[str]) -> None:
    handles = [
        Line2D([], [], marker=marker, color=color, linestyle="none", label=resolution)
        for resolution, (color, marker) in _LOOKS.items()
        if resolution in resolutions
    ]
    figure.legend(
        handles=handles, loc="outside upper center", ncols=len(handles), frameon=False, fontsize=8
    )


def _resolutions(found: Sequence[Pairing]) -> list[str]:
    """Those that there are, the coarsest first."""
    return [size for size in _LOOKS if any(pair.resolution == size for pair in found)]


def _name_origin(figure: Figure, found: Sequence[Pairing], reading: str) -> None:
    lines = [reading, *dict.fromkeys(pair.origin for pair in found)]
    figure.supxlabel("\n".join(lines), x=0.01, ha="left", fontsize=7.5, color="#333333")


def _growth(
    stem: str,
    found: Sequence[Pairing],
    *,
    line: Callable[[Pairing], tuple[str, ...]],
    size: Callable[[Pairing], int],
    axis: str,
) -> Plot | None:
    """Times of both, a panel for each line that has sizes enough."""
    lines: dict[tuple[str, ...], list[Pairing]] = {}
    for pair in sorted(found, key=size):
        lines.setdefault(line(pair), []).append(pair)
    long = {
        name: own for name, own in lines.items() if len({size(one) for one in own}) >= _MIN_SIZES
    }
    if not long:
        return None
    figure, panels = new_figure(2.6 * len(long) + 0.6, len(long))
    for panel, (name, own) in zip(panels, long.items(), strict=True):
        _draw_times(panel, own, "Embree's fastest mode", "embree", size, lambda pair: pair.embree)
        _draw_times(panel, own, "tile-beam", "tile-beam", size, lambda pair: pair.tile)
        panel.set_title(", ".join(name))
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_ylabel("first trace, ms")
        panel.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        panel.grid(axis="y", color="#dddddd", linewidth=0.6)
    panels[0].legend(frameon=False, fontsize=8)
    panels[-1].set_xlabel(axis)
    drawn = [pair for own in long.values() for pair in own]
    _name_origin(figure, drawn, "First traces after a build; 95% intervals of the medians.")
    return Plot(
        stem, figure, f"time of tile beams and of Embree over the number of {axis}, 95% intervals"
    )


def _draw_times(
    panel: Axes,
    own: Sequence[Pairing],
    label: str,
    structure: str,
    size: Callable[[Pairing], int],
    trace: Callable[[Pairing], Trace],
) -> None:
    traces = [trace(pair).first for pair in own]
    errors = [
        [0.0 if one.low is None else one.value - one.low for one in traces],
        [0.0 if one.high is None else one.high - one.value for one in traces],
    ]
    panel.errorbar(
        [size(pair) for pair in own],
        [one.value for one in traces],
        yerr=errors,
        capsize=2.5,
        elinewidth=1.2,
        marker="o" if structure == "embree" else "D",
        markersize=4.5,
        linewidth=1.4,
        color=structure_color(structure),
        label=label,
    )
