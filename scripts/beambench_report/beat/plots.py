"""Ratios beside their aims, and times as scenes and images get finer."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullLocator

from beambench_report.beat.aims import groups
from beambench_report.beat.duels import Duel, Ratio, Trace
from beambench_report.beat.report import part_of_aims
from beambench_report.figure import Plot, new_figure
from beambench_report.style import structure_colour

_ROW_HEIGHT = 0.3  # inches
# Of Okabe and Ito; the coarsest image first.
_COLOURS = ("#cc79a7", "#56b4e9", "#0072b2", "#e69f00", "#d55e00")
_MARKERS = "vsoD^"
_TICKS = (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100)
_LEAST_SIZES = 5
"""A line of fewer sizes shows little growth."""


def plots(found: Sequence[Duel]) -> list[Plot]:
    """Those for which the images suffice."""
    single = [duel for duel in found if duel.samples == 1]
    drawn = [_ratios(isa, single) for isa in dict.fromkeys(duel.isa for duel in single)]
    drawn.append(
        _growth(
            "beat-embree-scaling",
            [duel for duel in single if duel.isa == "best"],
            line=lambda duel: (duel.scene.split(":")[0], duel.resolution),
            size=lambda duel: duel.primitives,
            axis="primitives",
        )
    )
    drawn.append(
        _growth(
            "beat-embree-resolutions",
            [duel for duel in single if duel.isa == "best"],
            line=lambda duel: (duel.scene,),
            size=lambda duel: duel.rays,
            axis="pixels",
        )
    )
    return [plot for plot in drawn if plot is not None]


def _ratios(isa: str, found: Sequence[Duel]) -> Plot | None:
    """A panel a group, a row a scene, a marker a resolution; the aims are bars in its colour."""
    shown = [duel for duel in found if duel.isa == isa]
    panels_of = []
    for group in groups():
        own = [
            duel for duel in shown if duel.scene in group.scenes and duel.resolution in group.aims
        ]
        if own:
            panels_of.append((group, own))
    if not panels_of:
        return None
    sizes = sorted({(duel.rays, duel.resolution) for _, own in panels_of for duel in own})
    resolutions = [resolution for _, resolution in sizes]
    heights = [_ROW_HEIGHT * len({duel.scene for duel in own}) + 0.5 for _, own in panels_of]
    figure, panels = new_figure(sum(heights) + 0.8, len(panels_of), height_ratios=heights)
    for panel, (group, own) in zip(panels, panels_of, strict=True):
        scenes = [scene for scene in group.scenes if any(duel.scene == scene for duel in own)]
        for duel in own:
            size = resolutions.index(duel.resolution)
            shift = 0.13 * (size - (len(resolutions) - 1) / 2)
            _draw_ratio(panel, duel.ratio, scenes.index(duel.scene) + shift, size)
        for resolution, aim in group.aims.items():
            if any(duel.resolution == resolution for duel in own):
                colour = _COLOURS[resolutions.index(resolution) % len(_COLOURS)]
                panel.axvline(part_of_aims(isa) * aim, color=colour, linewidth=1, linestyle="--")
        panel.set_title(group.title)
        panel.set_yticks(range(len(scenes)), [group.scenes[scene] for scene in scenes])
        panel.set_ylim(len(scenes) - 0.4, -0.6)
        _axis_of_ratios(panel, shown)
    panels[-1].set_xlabel("times as fast as Embree's fastest mode; dashed: aims")
    _legend(figure, resolutions)
    _tell_origin(figure, shown)
    stem = "beat-embree" if isa == "best" else f"beat-embree-{isa}"
    return Plot(stem, figure, "how many times as fast as Embree tile beams are")


def _draw_ratio(panel: Axes, ratio: Ratio, at: float, size: int) -> None:
    colour = _COLOURS[size % len(_COLOURS)]
    if ratio.low is not None and ratio.high is not None:
        panel.plot([ratio.low, ratio.high], [at, at], color=colour, linewidth=1.5)
    panel.plot(ratio.value, at, _MARKERS[size % len(_MARKERS)], color=colour, markersize=4.5)


def _axis_of_ratios(panel: Axes, found: Sequence[Duel]) -> None:
    values = [duel.ratio.value for duel in found]
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
        Line2D(
            [],
            [],
            marker=_MARKERS[index % len(_MARKERS)],
            color=_COLOURS[index % len(_COLOURS)],
            linestyle="none",
            label=resolution,
        )
        for index, resolution in enumerate(resolutions)
    ]
    figure.legend(
        handles=handles, loc="outside upper center", ncols=len(handles), frameon=False, fontsize=8
    )


def _tell_origin(figure: Figure, found: Sequence[Duel]) -> None:
    origins = dict.fromkeys(duel.origin for duel in found)
    figure.supxlabel("\n".join(origins), x=0.01, ha="left", fontsize=7.5, color="#333333")


def _growth(
    stem: str,
    found: Sequence[Duel],
    *,
    line: Callable[[Duel], tuple[str, ...]],
    size: Callable[[Duel], int],
    axis: str,
) -> Plot | None:
    """Times of both, a panel for each line that has sizes enough."""
    lines: dict[tuple[str, ...], list[Duel]] = {}
    for duel in sorted(found, key=size):
        lines.setdefault(line(duel), []).append(duel)
    long = {
        name: own for name, own in lines.items() if len({size(one) for one in own}) >= _LEAST_SIZES
    }
    if not long:
        return None
    figure, panels = new_figure(2.6 * len(long) + 0.6, len(long))
    for panel, (name, own) in zip(panels, long.items(), strict=True):
        _draw_times(panel, own, "Embree's fastest mode", "embree", size, lambda duel: duel.embree)
        _draw_times(panel, own, "tile-beam", "tile-beam", size, lambda duel: duel.tile)
        panel.set_title(", ".join(name))
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_ylabel("trace, ms")
        panel.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        panel.grid(axis="y", color="#dddddd", linewidth=0.6)
    panels[0].legend(frameon=False, fontsize=8)
    panels[-1].set_xlabel(axis)
    _tell_origin(figure, [duel for own in long.values() for duel in own])
    return Plot(stem, figure, f"time of tile beams and of Embree over the number of {axis}")


def _draw_times(
    panel: Axes,
    own: Sequence[Duel],
    label: str,
    structure: str,
    size: Callable[[Duel], int],
    trace: Callable[[Duel], Trace],
) -> None:
    panel.plot(
        [size(duel) for duel in own],
        [trace(duel).median for duel in own],
        marker="o" if structure == "embree" else "D",
        markersize=4.5,
        markeredgecolor="#333333",
        markeredgewidth=0.6,
        linewidth=1.4,
        color=structure_colour(structure),
        label=label,
    )
