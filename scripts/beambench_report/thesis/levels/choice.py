"""What choosing the octree's level by itself loses against the best level, cell by cell."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from statistics import median

import pandas as pd

from beambench_report.thesis.cells import Cell

AIM = 0.10
"""A loss below it is a good choice; nine of ten should be."""
SHARE_AIM = 0.9
_AUTO = "auto"
_WORST = 5


@dataclass(frozen=True)
class LevelChoice:
    """One cell of max_level=auto, and those of fixed levels of the same octree otherwise."""

    auto: Cell
    fixed: dict[int, Cell]
    """By level, the lowest first; at least two."""

    @property
    def level(self) -> int | None:
        """The level of the deepest leaf that the choice led to."""
        return None if pd.isna(self.auto.depth) else int(self.auto.depth)

    @cached_property
    def best(self) -> int:
        """The fixed level that was the quickest."""
        return min(self.fixed, key=lambda level: self._time(self.fixed[level]))

    @property
    def is_best_at_end(self) -> bool:
        """Is the best the lowest or the highest that was measured?"""
        return self.best in (min(self.fixed), max(self.fixed))

    @property
    def loss(self) -> float:
        """Time of auto, the choosing included, over that of the best level, less 1."""
        return self._over_best(self.auto)

    @property
    def chosen(self) -> Cell | None:
        """The cell of the fixed level that was chosen, where it was measured."""
        return None if self.level is None else self.fixed.get(self.level)

    @property
    def loss_of_level(self) -> float | None:
        """What the level itself loses, without the cost of choosing it."""
        return None if self.chosen is None else self._over_best(self.chosen)

    def _over_best(self, cell: Cell) -> float:
        return self._time(cell) / self._time(self.fixed[self.best]) - 1

    @cached_property
    def _by_cycles(self) -> bool:
        """Clock cycles, as cells may have met different clock rates; if all were counted."""
        return all(pd.notna(cell.megacycles) for cell in (self.auto, *self.fixed.values()))

    def _time(self, cell: Cell) -> float:
        """Building included."""
        assert cell.time is not None  # only such cells are compared
        return cell.megacycles if self._by_cycles else cell.time.value


@dataclass(frozen=True)
class Losses:
    """Several choices in short."""

    choices: tuple[LevelChoice, ...]

    @property
    def good(self) -> int:
        """How many lose less than the aim."""
        return sum(choice.loss < AIM for choice in self.choices)

    @property
    def good_levels(self) -> tuple[int, int]:
        """How many chosen levels lose less than the aim, of how many that were measured."""
        known = [choice.loss_of_level for choice in self.choices]
        losses = [loss for loss in known if loss is not None]
        return sum(loss < AIM for loss in losses), len(losses)

    @property
    def share(self) -> float:
        """Of choices that lose less than the aim."""
        return self.good / len(self.choices)

    @property
    def median(self) -> float:
        """The middle loss."""
        return median(choice.loss for choice in self.choices)

    @property
    def worst(self) -> list[LevelChoice]:
        """The five that lose the most."""
        return sorted(self.choices, key=lambda choice: -choice.loss)[:_WORST]


def level_choices(cells: Iterable[Cell]) -> list[LevelChoice]:
    """Every cell of max_level=auto that has fixed levels beside it, in the order of the cells."""
    timed = [cell for cell in cells if cell.time is not None and "max_level" in cell.parameters]
    fixed: dict[tuple[object, ...], list[Cell]] = {}
    for cell in timed:
        if cell.parameters["max_level"].isdecimal():
            fixed.setdefault(_key(cell), []).append(cell)
    found = []
    for auto in timed:
        if auto.parameters["max_level"] != _AUTO:
            continue
        levels = _by_level(fixed.get(_key(auto), ()), auto.run)
        if len(levels) > 1:
            found.append(LevelChoice(auto, levels))
    return found


def losses(choices: Sequence[LevelChoice], structure: str = "") -> Losses:
    """Those of one structure, or all."""
    return Losses(tuple(choice for choice in choices if structure in ("", choice.auto.structure)))


def _key(cell: Cell) -> tuple[object, ...]:
    """All but the level."""
    others = sorted((k, v) for k, v in cell.parameters.items() if k != "max_level")
    return cell.scene, cell.structure, cell.resolution, cell.samples, tuple(others)


def _by_level(cells: Iterable[Cell], run: str) -> dict[int, Cell]:
    """One cell a level: that of the choice's own run, or else the first."""
    found: dict[int, Cell] = {}
    for cell in sorted(cells, key=lambda one: one.run != run):
        found.setdefault(int(cell.parameters["max_level"]), cell)
    return dict(sorted(found.items()))
