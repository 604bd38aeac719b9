"""Memory and work beside each time of a table, so that a reader sees why a time is what it is."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from beambench_report.quantities import number, size_in_words
from beambench_report.thesis.cells import Cell
from beambench_report.thesis.tables import Line
from beambench_report.thesis.texts import DASH, interval, milliseconds

_A_RAY = {
    "traversal_steps": "traversal steps",
    "leaves": "leaves",
    "empty_leaves": "empty leaves",
    "box_tests": "box tests",
    "primitive_tests": "primitive tests",
}
_AN_IMAGE = {
    "beams": "beams",
    "beams_nonterminal": "non-terminal beams",
    "beams_occupied": "beams at occupied leaves",
    "beams_made": "beams made by cutting",
    "beams_divided": "of these cut again",
}


@dataclass(frozen=True)
class WorkField:
    """What is read and what it sorts by."""

    text: str
    value: float | None


@dataclass(frozen=True)
class WorkRow:
    """One cell's memory and work."""

    label: str
    cell: Cell
    fields: tuple[WorkField, ...]


@dataclass(frozen=True)
class WorkTable:
    """Headings, each with its unit, and rows."""

    headings: tuple[tuple[str, str], ...]
    rows: tuple[WorkRow, ...]


def work_of_lines(lines: Iterable[Line]) -> WorkTable:
    """A row for each cell that was measured."""
    return _work([(line.label, entry.ours) for line in lines for entry in line.entries])


def _work(named: Sequence[tuple[str, Cell | None]]) -> WorkTable:
    cells = [(label, cell) for label, cell in named if cell is not None]
    ray = [name for name in _A_RAY if any(cell.counters.get(name) for _, cell in cells)]
    image = [name for name in _AN_IMAGE if any(cell.counters.get(name) for _, cell in cells)]
    headings = [("total", ""), ("interval", ""), ("build", ""), ("memory", "")]
    headings += [(_A_RAY[name], "a ray") for name in ray]
    headings += [(_AN_IMAGE[name], "an image") for name in image]
    return WorkTable(
        tuple(headings),
        tuple(WorkRow(label, cell, _fields(cell, ray, image)) for label, cell in cells),
    )


def _fields(cell: Cell, ray: Sequence[str], image: Sequence[str]) -> tuple[WorkField, ...]:
    nothing = WorkField(DASH, None)
    times = (nothing, nothing, nothing)
    if cell.time:
        times = (
            WorkField(milliseconds(cell.time.value), cell.time.value),
            WorkField(interval(cell.time), cell.time.low),
            WorkField(milliseconds(cell.build), cell.build),
        )
    memory = nothing
    if not math.isnan(cell.memory):
        memory = WorkField(size_in_words(cell.memory), cell.memory)
    counted = [cell.counters.get(name) for name in ray]
    counted_image = [cell.counters.get(name) for name in image]
    return (
        *times,
        memory,
        *(nothing if value is None else WorkField(number(value), value) for value in counted),
        *(
            nothing if value is None else WorkField(f"{value * cell.rays:,.0f}", value * cell.rays)
            for value in counted_image
        ),
    )
