"""Compares contenders at their best, each with its best parameters for the view."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from beambench_thesis.paper.cells import Cell, Cells, comparable, resolutions_of
from beambench_thesis.paper.evidence import Measured
from beambench_thesis.paper.printed import REFERENCES, PrintedPart, contender_title


@dataclass(frozen=True)
class Choice:
    """The best of a contender's cells in one view."""

    cell: Cell | None
    parameters: str
    """The parameters that were tried with several values."""
    tried: int
    is_edge: bool = False
    """Whether the level or grid is the lowest or highest tried; a better one may lie beyond."""
    ratio: Measured | None = None
    """The time of the cell over the best time of the first contender."""


@dataclass(frozen=True)
class BestLine:
    """A contender's best in each resolution."""

    label: str
    structure: str
    choices: tuple[Choice, ...]


@dataclass(frozen=True)
class BestTable:
    """The contenders of one part of a table, each at its best."""

    part: PrintedPart
    resolutions: tuple[str, ...]
    lines: tuple[BestLine, ...]


def best_table(part: PrintedPart, cells: Cells) -> BestTable | None:
    """Returns the table for resolutions with a choice of parameters; None if there are none."""
    structures = [*part.structures, *REFERENCES]
    resolutions = [
        resolution
        for resolution in resolutions_of(cells.cells)
        if any(len(cells.of(part.scene, name, resolution)) > 1 for name in structures)
        and _is_second_pass(part, cells, resolution)
    ]
    if not resolutions:
        return None
    lines = []
    for name in structures:
        for label, only in _pools(name):
            found = (
                [c for c in cells.of(part.scene, name, at) if _has(c, only)] for at in resolutions
            )
            lines.append(BestLine(label, name, tuple(map(choose, found))))
    lines = [line for line in lines if any(choice.cell for choice in line.choices)]
    bases = [choice.cell for choice in lines[0].choices] if lines else []
    with_ratios = (
        replace(
            line,
            choices=tuple(
                replace(choice, ratio=_ratio(choice.cell, base))
                for choice, base in zip(line.choices, bases, strict=True)
            ),
        )
        for line in lines
    )
    return BestTable(part, tuple(resolutions), tuple(with_ratios))


def choose(candidates: Sequence[Cell]) -> Choice:
    """Returns the candidate with correct hits and the least total time, building included."""
    timed = [cell for cell in candidates if cell.time is not None]
    if not timed:
        return Choice(None, "", len(candidates))
    best = min(timed, key=comparable(timed))
    differing = (
        f"{name}={value}"
        for name, value in best.parameters.items()
        if len({cell.parameters.get(name) for cell in candidates}) > 1
    )
    return Choice(best, ", ".join(differing), len(timed), _is_edge(best, timed))


def _is_edge(best: Cell, timed: Sequence[Cell]) -> bool:
    """Returns whether the best is at an end of the tried levels or grids filled alike."""
    fill = best.parameters.get("fill")
    alike = [cell.parameters for cell in timed if cell.parameters.get("fill") == fill]
    for name in ("max_level", "resolution"):
        value = best.parameters.get(name, "")
        tried = {int(v) for given in alike if (v := given.get(name, "")).isdecimal()}
        if value.isdecimal() and len(tried) > 1 and int(value) in (min(tried), max(tried)):
            return True
    return False


def _has(cell: Cell, values: dict[str, str]) -> bool:
    """Returns whether a cell has these values, as far as its version had the parameters."""
    return all(cell.parameters.get(name, value) == value for name, value in values.items())


def _pools(structure: str) -> list[tuple[str, dict[str, str]]]:
    """Returns the forms of a contender: the thesis's own and, if there are others, any form.

    The thesis's beams do not hand over and test samples one by one; its hierarchy places objects
    beside terminal nodes.
    """
    title = contender_title(structure)
    if structure == "beam":
        of_thesis = {"handover": "0", "leaf": "exact"}
        return [
            (f"{title}, handover=0, leaf=exact", of_thesis),
            (f"{title}, with today's means", {}),
        ]
    if structure == "goldsmith-salmon":
        return [(f"{title}, insert=terminal", {"insert": "terminal"}), (f"{title}, any insert", {})]
    return [(title, {})]


def _is_second_pass(part: PrintedPart, cells: Cells, resolution: str) -> bool:
    """Returns whether parameters other than the thesis's own were tried at this resolution."""
    own = {row.setting(part.scene, resolution) for row in part.rows}
    return any(
        cell.setting not in own
        for name in part.structures
        for cell in cells.of(part.scene, name, resolution)
        if cell.run.startswith("best-")
        or (cell.setting is None and cell.parameters.get("leaf") != "simd")
    )


def _ratio(cell: Cell | None, base: Cell | None) -> Measured | None:
    if cell is None or base is None or cell.time is None or base.time is None:
        return None
    return Measured.exact(1.0) if cell is base else cell.time / base.time
