"""The level that max_level=auto chooses, compared with the best of the measured levels."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from statistics import median

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from beambench_report.base.figure import Plot, legend_below, new_figure
from beambench_report.base.files import Problem
from beambench_report.base.palette import INK, SOFT, structure_color
from beambench_report.base.quantities import DASH
from beambench_thesis.paper.cells import Cell, comparable, read_cells
from beambench_thesis.paper.printed import milliseconds, scene_title
from beambench_thesis.paper.section import (
    Field,
    Section,
    SectionFigure,
    SectionTable,
    by_file,
    section_as_markdown,
    section_table,
    write_section,
)

TARGET = 0.10
"""A choice with a smaller loss is good; 90% of the choices should be good."""
_TARGET_SHARE = 0.9
_AUTO = "auto"
_WORST = 5


@dataclass(frozen=True)
class LevelChoice:
    """One cell of max_level=auto, and the cells of the same octree with fixed levels."""

    auto: Cell
    fixed: dict[int, Cell]
    """The cells by level, the lowest first; at least two."""

    @property
    def level(self) -> int | None:
        """The level of the deepest leaf that resulted from the choice."""
        return None if pd.isna(self.auto.depth) else int(self.auto.depth)

    @cached_property
    def best(self) -> int:
        """Returns the fastest fixed level."""
        return min(self.fixed, key=lambda level: self._comparable(self.fixed[level]))

    @property
    def is_best_at_end(self) -> bool:
        """Whether the best level is the lowest or the highest that was measured."""
        return self.best in (min(self.fixed), max(self.fixed))

    @property
    def loss(self) -> float:
        """Returns the time of auto, the choosing included, over that of the best level, minus 1."""
        return self._over_best(self.auto)

    @property
    def chosen(self) -> Cell | None:
        """Returns the cell of the fixed level that was chosen, if it was measured."""
        return None if self.level is None else self.fixed.get(self.level)

    @property
    def loss_of_level(self) -> float | None:
        """Returns the loss of the level itself, without the cost of choosing it."""
        return None if self.chosen is None else self._over_best(self.chosen)

    def _over_best(self, cell: Cell) -> float:
        return self._comparable(cell) / self._comparable(self.fixed[self.best]) - 1

    @cached_property
    def _comparable(self) -> Callable[[Cell], float]:
        return comparable([self.auto, *self.fixed.values()])


@dataclass(frozen=True)
class Losses:
    """A summary of several choices."""

    choices: tuple[LevelChoice, ...]

    @property
    def good(self) -> int:
        """Returns the number of choices that lose less than the target."""
        return sum(choice.loss < TARGET for choice in self.choices)

    @property
    def good_levels(self) -> tuple[int, int]:
        """Returns how many chosen levels lose less than the target, and how many were measured."""
        losses = [own for choice in self.choices if (own := choice.loss_of_level) is not None]
        return sum(loss < TARGET for loss in losses), len(losses)

    @property
    def share(self) -> float:
        """Returns the share of choices that lose less than the target."""
        return self.good / len(self.choices)

    @property
    def median(self) -> float:
        """Returns the median loss."""
        return median(choice.loss for choice in self.choices)

    @property
    def worst(self) -> list[LevelChoice]:
        """Returns the five largest losses."""
        return sorted(self.choices, key=lambda choice: -choice.loss)[:_WORST]


def level_choices(cells: Iterable[Cell]) -> list[LevelChoice]:
    """Returns every cell of max_level=auto with measured fixed levels, in the order of the cells.

    If several runs measured a level, the cell of the choice's own run counts, or else the first.
    """
    timed = [cell for cell in cells if cell.time is not None and "max_level" in cell.parameters]
    fixed: dict[tuple[object, ...], list[Cell]] = {}
    for cell in timed:
        if cell.parameters["max_level"].isdecimal():
            fixed.setdefault(_key(cell), []).append(cell)
    found = []
    for auto in (cell for cell in timed if cell.parameters["max_level"] == _AUTO):
        levels: dict[int, Cell] = {}
        for cell in sorted(fixed.get(_key(auto), ()), key=lambda one: one.run != auto.run):
            levels.setdefault(int(cell.parameters["max_level"]), cell)
        if len(levels) > 1:
            found.append(LevelChoice(auto, dict(sorted(levels.items()))))
    return found


def losses(choices: Sequence[LevelChoice], structure: str = "") -> Losses:
    """Returns the losses of one structure, or of all."""
    return Losses(tuple(choice for choice in choices if structure in ("", choice.auto.structure)))


def _key(cell: Cell) -> tuple[object, ...]:
    """Returns all settings except the level."""
    others = sorted((k, v) for k, v in cell.parameters.items() if k != "max_level")
    return cell.scene, cell.structure, cell.resolution, cell.samples, tuple(others)


# The figure

_ROW_HEIGHT = 0.24  # inches
_MARKERS = ("o", "s", "D", "^", "v")
_TICKS = (-50, -20, -10, -5, 0, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000)
_HOLLOW = {"markersize": 5.5, "markerfacecolor": "none", "markeredgewidth": 0.7}


def draw_losses(stem: str, choices: Sequence[LevelChoice]) -> Plot:
    """Draws a row for each scene and a panel for each structure.

    Filled markers include the cost of choosing; hollow markers show the loss of the chosen level
    alone.
    """
    structures = list(dict.fromkeys(choice.auto.structure for choice in choices))
    scenes = list(dict.fromkeys(choice.auto.scene for choice in choices))
    sizes = list(dict.fromkeys(choice.auto.resolution for choice in choices))
    known = [choice.loss for choice in choices]
    known += [own for choice in choices if (own := choice.loss_of_level) is not None]
    figure, panels = new_figure(_ROW_HEIGHT * len(scenes) + 1.3, 1, len(structures))
    for panel, structure in zip(panels, structures, strict=True):
        shown = [choice for choice in choices if choice.auto.structure == structure]
        _draw(panel, shown, scenes, sizes, structure_color(structure))
        panel.set_title(structure)
        panel.set_xlim(min(-13.0, 130 * min(known)), max(40.0, 130 * max(known)))
    for panel in panels[1:]:
        panel.tick_params(labelleft=False)
    _legend(figure, sizes)
    return Plot(stem, figure, "Loss from choosing the level automatically")


def _draw(
    panel: Axes,
    choices: Sequence[LevelChoice],
    scenes: Sequence[str],
    sizes: Sequence[str],
    color: str,
) -> None:
    panel.axvspan(100 * TARGET, 1e6, color=SOFT, alpha=0.14, linewidth=0)
    panel.axvline(0, color=INK, linewidth=0.8)
    for index, size in enumerate(sizes):
        marker = _MARKERS[index % len(_MARKERS)]
        shift = 0.26 * (index - (len(sizes) - 1) / 2)
        at = [choice for choice in choices if choice.auto.resolution == size]
        rows = [scenes.index(choice.auto.scene) + shift for choice in at]
        own = [float("nan") if (x := one.loss_of_level) is None else 100 * x for one in at]
        panel.plot(own, rows, marker, markeredgecolor=INK, **_HOLLOW)
        panel.plot([100 * choice.loss for choice in at], rows, marker, markersize=3.5, color=color)
    panel.set_xscale("symlog", linthresh=10, linscale=0.7)
    panel.xaxis.set_major_locator(FixedLocator(_TICKS))
    panel.xaxis.set_minor_locator(NullLocator())
    panel.xaxis.set_major_formatter(
        FuncFormatter(lambda value, _: f"{value:+,.0f}%" if value else "0")
    )
    panel.set_yticks(range(len(scenes)), [scene_title(scene) for scene in scenes])
    panel.set_ylim(len(scenes) - 0.4, -0.6)
    panel.grid(linewidth=0.6)
    panel.tick_params(labelsize=8)
    panel.tick_params(axis="x", labelsize=6.5)
    panel.set_xlabel("loss against the best level (lower is better)")


def _legend(figure: Figure, sizes: Sequence[str]) -> None:
    gray = {"color": INK, "linestyle": "none"}
    shapes = [
        Line2D([], [], marker=_MARKERS[index % len(_MARKERS)], markersize=4, label=size, **gray)
        for index, size in enumerate(sizes)
    ]
    own = Line2D([], [], marker="o", label="the level alone", **_HOLLOW, **gray)
    legend_below(figure, len(sizes) + 1, handles=[*shapes, own])


# The section of the report, also written as a separate file

STEM = "level-choice"
_WORDS = (
    "With max_level=auto, samet and beam choose the octree's level from a few rays, the camera and "
    "the resolution, by sums of counts like those of section 5.3.3. Each choice is compared with "
    "the best of the fixed levels that were measured for the same scene and resolution. The loss "
    "is the time of the choice, building and choosing included, divided by that of the best level, "
    "minus 1; the level's own loss excludes the cost of choosing. Times are compared in clock "
    "cycles if these were counted. A loss below zero means that the choice is faster than every "
    "fixed level, by chance or because the chosen level was not measured."
)
_CAPTION = (
    "Filled: including the choosing; hollow: only the chosen level, if it was measured. Gray: a "
    "loss of more than 10%. The axis is linear to 10% and logarithmic beyond."
)


def levels_section(cells: Iterable[Cell]) -> Section | None:
    """Returns the choices and their losses; None if none was measured."""
    choices = level_choices(cells)
    if not choices:
        return None
    structures = list(dict.fromkeys(choice.auto.structure for choice in choices))
    parts = {name: losses(choices, name) for name in structures}
    every = losses(choices)
    title = "Loss of the automatic choice against the best level"
    met = "met" if every.share >= _TARGET_SHARE else "missed"
    return Section(
        "levels",
        "The level chosen automatically",
        (_WORDS,),
        (
            _summary(parts | {"both": every} if len(parts) > 1 else parts),
            _table("The five choices with the largest losses", every.worst),
            _table("Every choice", choices, is_long=True),
        ),
        (SectionFigure(STEM, title, _CAPTION, partial(draw_losses, STEM, choices)),),
        (
            f"{every.good} of {len(every.choices)} choices ({every.share:.0%}) lose less than "
            f"{TARGET:.0%}; the target, 90% of them, is {met}. The median loss is "
            f"{_percent(every.median)}.",
        ),
    )


def levels_of_runs(runs: Sequence[Path], file: Path | None = None) -> list[Path] | str:
    """Returns the section on some runs as text, or writes FILE.md and its figure.

    Raises Problem if a run cannot be read, or if no run has a choice.
    """
    cells: list[Cell] = []
    for run in runs:
        folder = run.resolve()
        found = read_cells(folder.parent, [folder.name])
        if found.unread:
            raise Problem(found.unread[0])
        if not found.runs:
            raise Problem(f"{run}: holds no results.csv; give the folder that a run wrote")
        cells += found.cells
    section = levels_section(cells)
    if section is None:
        names = ", ".join(str(run) for run in runs)
        raise Problem(
            f"{names}: no cell with max_level=auto has two cells with fixed levels; measure "
            "harness/measure/sweeps/levels.json"
        )
    if file is None:
        return section_as_markdown(replace(section, figures=()), level=1, origin=by_file)
    return write_section(section, file, origin=by_file)


def _summary(parts: dict[str, Losses]) -> SectionTable:
    heads = ("choices", "loss below 10%", "level's own loss below 10%", "median loss", "worst")
    rows = []
    for name, part in parts.items():
        good, known = part.good_levels
        rows.append(
            (
                name,
                f"{len(part.choices)}",
                f"{part.good} ({part.share:.0%})",
                f"{good} of {known}" + (f" ({good / known:.0%})" if known else ""),
                _percent(part.median),
                _percent(part.worst[0].loss),
            )
        )
    return section_table("How much choosing loses", ("structure",), heads, rows)


def _table(title: str, choices: Sequence[LevelChoice], *, is_long: bool = False) -> SectionTable:
    heads = "chosen, best, measured, time of auto, best time, loss, level's own loss".split(", ")
    rows = map(_row, choices)
    return section_table(title, ("structure", "scene", "resolution"), heads, rows, is_long=is_long)


def _row(choice: LevelChoice) -> tuple[Field | str, ...]:
    auto, best = choice.auto, choice.fixed[choice.best]
    own = choice.loss_of_level
    return (
        auto.structure,
        scene_title(auto.scene),
        auto.resolution,
        DASH if choice.level is None else str(choice.level),
        f"{choice.best}{' (at the end)' if choice.is_best_at_end else ''}",
        _levels(list(choice.fixed)),
        _time(auto),
        _time(best),
        Field(_percent(choice.loss), value=choice.loss),
        DASH if own is None else Field(_percent(own), choice.chosen, own),
    )


def _time(cell: Cell) -> Field:
    assert cell.time is not None  # only such cells are compared
    return Field(milliseconds(cell.time.value), cell, cell.time.value)


def _levels(levels: Sequence[int]) -> str:
    """Returns `4 to 8`, or lists all levels if some in between are missing."""
    first, last = levels[0], levels[-1]
    if len(levels) == last - first + 1 and len(levels) > 1:
        return f"{first} to {last}"
    return ", ".join(map(str, levels))


def _percent(loss: float) -> str:
    return f"{100 * loss:+.1f}%"
