"""What every choice of a level loses: a row a scene, a panel a structure."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from beambench_report.figure import Plot, new_figure
from beambench_report.style import structure_colour
from beambench_report.thesis.levels.choice import AIM, LevelChoice
from beambench_report.thesis.printed import scene_title

_ROW_HEIGHT = 0.24  # inches
_MARKERS = ("o", "s", "D", "^", "v")
_TICKS = (-50, -20, -10, -5, 0, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000)


def draw_losses(stem: str, choices: Sequence[LevelChoice]) -> Plot:
    """Filled: with the choosing; hollow: what the chosen level loses by itself."""
    structures = list(dict.fromkeys(choice.auto.structure for choice in choices))
    scenes = list(dict.fromkeys(choice.auto.scene for choice in choices))
    sizes = list(dict.fromkeys(choice.auto.resolution for choice in choices))
    figure, panels = new_figure(_ROW_HEIGHT * len(scenes) + 1.3, 1, len(structures))
    for panel, structure in zip(panels, structures, strict=True):
        shown = [choice for choice in choices if choice.auto.structure == structure]
        _draw(panel, shown, scenes, sizes, structure_colour(structure))
        panel.set_title(structure)
        panel.set_xlim(_ends(choices))
    for panel in panels[1:]:
        panel.tick_params(labelleft=False)
    _legend(figure, sizes)
    return Plot(stem, figure, "What choosing the level loses")


def _draw(
    panel: Axes,
    choices: Sequence[LevelChoice],
    scenes: Sequence[str],
    sizes: Sequence[str],
    colour: str,
) -> None:
    panel.axvspan(100 * AIM, 1e6, color="#999999", alpha=0.18, linewidth=0)
    panel.axvline(0, color="#333333", linewidth=0.8)
    for index, size in enumerate(sizes):
        marker = _MARKERS[index % len(_MARKERS)]
        shift = 0.26 * (index - (len(sizes) - 1) / 2)
        at = [choice for choice in choices if choice.auto.resolution == size]
        rows = [scenes.index(choice.auto.scene) + shift for choice in at]
        levels = [
            (100 * choice.loss_of_level, row)
            for choice, row in zip(at, rows, strict=True)
            if choice.loss_of_level is not None
        ]
        panel.plot(
            [loss for loss, _ in levels],
            [row for _, row in levels],
            marker,
            markersize=5.5,
            markerfacecolor="none",
            markeredgecolor="#333333",
            markeredgewidth=0.7,
        )
        panel.plot(
            [100 * choice.loss for choice in at],
            rows,
            marker,
            markersize=3.5,
            color=colour,
        )
    panel.set_xscale("symlog", linthresh=10, linscale=1.2)
    panel.xaxis.set_major_locator(FixedLocator(_TICKS))
    panel.xaxis.set_minor_locator(NullLocator())
    panel.xaxis.set_major_formatter(
        FuncFormatter(lambda value, _: f"{value:+,.0f}%" if value else "0")
    )
    panel.set_yticks(range(len(scenes)), [scene_title(scene) for scene in scenes])
    panel.set_ylim(len(scenes) - 0.4, -0.6)
    panel.grid(color="#dddddd", linewidth=0.6)
    panel.tick_params(labelsize=8)
    panel.tick_params(axis="x", labelrotation=60)
    panel.set_xlabel("loss against the best level")


def _ends(choices: Sequence[LevelChoice]) -> tuple[float, float]:
    """Of the axis of losses, the same in every panel."""
    losses = [choice.loss for choice in choices]
    losses += [own for choice in choices if (own := choice.loss_of_level) is not None]
    return min(-13.0, 130 * min(losses)), max(40.0, 130 * max(losses))


def _legend(figure: Figure, sizes: Sequence[str]) -> None:
    grey = {"color": "#333333", "linestyle": "none"}
    shapes = [
        Line2D([], [], marker=_MARKERS[index % len(_MARKERS)], markersize=4, label=size, **grey)
        for index, size in enumerate(sizes)
    ]
    hollow = {"markerfacecolor": "none", "markersize": 5.5, "markeredgewidth": 0.7}
    own = Line2D([], [], marker="o", label="the level by itself", **hollow, **grey)
    figure.legend(
        handles=[*shapes, own],
        loc="outside lower center",
        ncols=len(sizes) + 1,
        frameon=False,
        fontsize=8,
    )
