"""The choice of the level as a part of the report, and as a file of its own."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial

from beambench_report.thesis.cells import Cell
from beambench_report.thesis.levels.choice import (
    AIM,
    SHARE_AIM,
    LevelChoice,
    Losses,
    level_choices,
    losses,
)
from beambench_report.thesis.levels.plot import draw_losses
from beambench_report.thesis.printed import scene_title
from beambench_report.thesis.section import Column, Field, Section, SectionFigure, SectionTable
from beambench_report.thesis.texts import DASH, milliseconds

STEM = "level-choice"
_WORDS = (
    "With max_level=auto, samet and beam choose the octree's level from a few rays, the camera and "
    "the resolution, by sums of counts like those of section 5.3.3. Each choice stands beside the "
    "best of the fixed levels that were measured for the same scene and resolution. The loss is "
    "its time, building and choosing included, over that of the best level, less 1; beside it is "
    "what the chosen level loses by itself, without the cost of choosing it. Times are compared in "
    "clock cycles, where they were counted. A loss below zero is a cell quicker than every fixed "
    "level, by chance or by a level that was not measured."
)
_CAPTION = (
    "Filled: with the choosing; hollow: the chosen level by itself, where it was measured. Grey: a "
    "loss of more than a tenth. The axis is linear to 10% and logarithmic beyond."
)


def levels_section(cells: Iterable[Cell]) -> Section | None:
    """The choices and what they lose; None where none was measured."""
    choices = level_choices(cells)
    if not choices:
        return None
    structures = list(dict.fromkeys(choice.auto.structure for choice in choices))
    parts = {name: losses(choices, name) for name in structures}
    every = losses(choices)
    return Section(
        "levels",
        "The level chosen automatically",
        (_WORDS,),
        (
            _summary(parts | {"both": every} if len(parts) > 1 else parts),
            _table("The five that lose the most", every.worst),
            _table("Every choice", choices, is_long=True),
        ),
        (
            SectionFigure(
                STEM,
                "What choosing the level loses against the best level",
                _CAPTION,
                partial(draw_losses, STEM, choices),
            ),
        ),
        (_finding(every),),
    )


def _finding(every: Losses) -> str:
    met = "met" if every.share >= SHARE_AIM else "missed"
    return (
        f"{every.good} of {len(every.choices)} choices ({every.share:.0%}) lose less than "
        f"{AIM:.0%}; the aim, nine of ten, is {met}. The middle loss is {_percent(every.median)}."
    )


def _summary(parts: dict[str, Losses]) -> SectionTable:
    heads = ("choices", "loss below 10%", "level's own loss below 10%", "middle loss", "worst")
    rows = []
    for name, part in parts.items():
        good, known = part.good_levels
        texts = (
            name,
            f"{len(part.choices)}",
            f"{part.good} ({part.share:.0%})",
            f"{good} of {known}" + (f" ({good / known:.0%})" if known else ""),
            _percent(part.median),
            _percent(part.worst[0].loss),
        )
        rows.append(tuple(Field(text) for text in texts))
    columns = (Column("structure", False), *(Column(head) for head in heads))
    return SectionTable("How much choosing loses", columns, tuple(rows))


def _table(title: str, choices: Sequence[LevelChoice], *, is_long: bool = False) -> SectionTable:
    names = (Column("structure", False), Column("scene", False), Column("resolution", False))
    heads = (
        "chosen",
        "best",
        "measured",
        "time of auto",
        "of the best",
        "loss",
        "level's own loss",
    )
    columns = (*names, *(Column(head) for head in heads))
    return SectionTable(title, columns, tuple(_row(choice) for choice in choices), is_long)


def _row(choice: LevelChoice) -> tuple[Field, ...]:
    auto, best = choice.auto, choice.fixed[choice.best]
    own = choice.loss_of_level
    return (
        Field(auto.structure),
        Field(scene_title(auto.scene)),
        Field(auto.resolution),
        Field(DASH if choice.level is None else str(choice.level)),
        Field(f"{choice.best}{' (at the end)' if choice.is_best_at_end else ''}"),
        Field(_levels(list(choice.fixed))),
        _time(auto),
        _time(best),
        Field(_percent(choice.loss), value=choice.loss),
        Field(DASH) if own is None else Field(_percent(own), choice.chosen, own),
    )


def _time(cell: Cell) -> Field:
    assert cell.time is not None  # only such cells are compared
    return Field(milliseconds(cell.time.value), cell, cell.time.value)


def _levels(levels: Sequence[int]) -> str:
    """`4 to 8`, or all of them where some between are missing."""
    first, last = levels[0], levels[-1]
    if len(levels) == last - first + 1 and len(levels) > 1:
        return f"{first} to {last}"
    return ", ".join(map(str, levels))


def _percent(loss: float) -> str:
    return f"{100 * loss:+.1f}%"
