"""The thesis's tables with our cells: times, shapes, memory and work."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

from beambench_report.base.published import FINEST, RESOLUTIONS
from beambench_report.base.quantities import number, size_in_words
from beambench_thesis.paper.cells import Cell, Cells
from beambench_thesis.paper.evidence import HIERARCHY, Measured, published_evidence
from beambench_thesis.paper.printed import (
    DASH,
    REFERENCES,
    PrintedPart,
    PrintedRow,
    interval,
    milliseconds,
)
from beambench_thesis.paper.section import Field

Reasons = Callable[[str], str]
"""A function that returns why nothing was measured at a resolution."""

_WITHOUT_TERMINAL = {"order": "given", "queue": "heap", "insert": "everywhere"}
"""The thesis's hierarchy with Goldsmith and Salmon's own insertion.

It is shown in addition to the thesis's, which only places objects beside terminal nodes (4.3).
"""


@dataclass(frozen=True)
class Entry:
    """One cell of a table. Its shape is its time over that of the part's first row at 320x200."""

    thesis: float | None
    thesis_shape: float | None
    ours: Cell | None
    shape: Measured | None
    missing: str
    """Why we have no time; empty if we have one."""


@dataclass(frozen=True)
class Line:
    """A row of a table, one entry for each resolution."""

    label: str
    structure: str
    entries: tuple[Entry, ...]
    is_reference: bool = False
    counts: tuple[tuple[int | None, int | None], ...] = ()
    """Occupied leaves and pixels of exit beams, thesis and ours, where the table prints them."""


@dataclass(frozen=True)
class PartTable:
    """A part of a table with our figures in it."""

    part: PrintedPart
    lines: tuple[Line, ...]

    @property
    def has_counts(self) -> bool:
        """Whether the thesis prints leaves and pixels with this part."""
        return any(line.counts for line in self.lines)


def fill(part: PrintedPart, cells: Cells, why: Reasons) -> PartTable:
    """Fills a part with our measurements."""
    lines = [_line(part, row, cells, why) for row in part.rows]
    added = [(name, f"{name} (of today)", {}) for name in REFERENCES]
    if HIERARCHY in part.structures:
        label = "hierarchy, insert=everywhere (Goldsmith and Salmon 1987)"
        added.insert(0, (HIERARCHY, label, _WITHOUT_TERMINAL))
    extra = [_not_printed(part, *names, cells, why) for names in added]
    lines += [line for line in extra if any(entry.ours for entry in line.entries)]
    return PartTable(part, tuple(lines))


def _line(part: PrintedPart, row: PrintedRow, cells: Cells, why: Reasons) -> Line:
    ours = {at: cells.at(row.setting(part.scene, at)) for at in RESOLUTIONS}
    entries = _entries(part, ours, cells, why, row.seconds)
    return Line(row.label, row.structure, entries, counts=_counts(part, row, ours[FINEST]))


def _not_printed(
    part: PrintedPart,
    structure: str,
    label: str,
    wanted: dict[str, str],
    cells: Cells,
    why: Reasons,
) -> Line:
    """Returns a row that the thesis lacks: the structure's first cell with the parameters."""
    ours = {}
    for resolution in RESOLUTIONS:
        found = (
            cell
            for cell in cells.of(part.scene, structure, resolution)
            # Older runs lack the parameter `insert`: they inserted everywhere.
            if all(cell.parameters.get(name, value) == value for name, value in wanted.items())
        )
        ours[resolution] = next(found, None)
    return Line(label, structure, _entries(part, ours, cells, why, {}), is_reference=True)


def _entries(
    part: PrintedPart,
    ours: dict[str, Cell | None],
    cells: Cells,
    why: Reasons,
    printed: dict[str, float],
) -> tuple[Entry, ...]:
    """Returns the entries of a row by our cells and the thesis's seconds at each resolution."""
    base = cells.at(part.rows[0].setting(part.scene, RESOLUTIONS[0]))
    entries = []
    for at, cell in ours.items():
        thesis, shape, missing = printed.get(at), None, ""
        if cell is None:
            missing = why(at)
        elif cell.time is None:
            missing = f"no time: {cell.verdict}"
        elif base and base.time:
            shape = cell.time / base.time
        thesis_shape = thesis / part.base if thesis and part.base else None
        entries.append(Entry(thesis, thesis_shape, cell, shape, missing))
    return tuple(entries)


def _counts(
    part: PrintedPart, row: PrintedRow, ours: Cell | None
) -> tuple[tuple[int | None, int | None], ...]:
    """Returns the counts that tables 5.2 and 5.3 print, for 1280x1024."""
    if part.table not in ("5.2", "5.3"):
        return ()
    evidence = published_evidence()
    thesis = [
        evidence.count(what, part.scene, level=row.level, objects=row.objects)
        for what in ("occupied_leaves", "exit_pixels")
    ]
    own = [None, None]
    if ours is not None:
        leaving = ours.counters.get("samples_leaving")
        own = [
            round(ours.leaves - ours.empty_leaves) if ours.leaves == ours.leaves else None,
            round(leaving * ours.rays) if leaving is not None else None,
        ]
    printed = [round(figure.value) if figure else None for figure in thesis]
    return tuple(zip(printed, own, strict=True))


_PER_RAY = {
    "traversal_steps": "traversal steps",
    "leaves": "leaves",
    "empty_leaves": "empty leaves",
    "box_tests": "box tests",
    "primitive_tests": "primitive tests",
}
_PER_IMAGE = {
    "beams": "beams",
    "beams_nonterminal": "non-terminal beams",
    "beams_occupied": "beams at occupied leaves",
    "beams_made": "beams made by cutting",
    "beams_divided": "beams made and cut again",
}


@dataclass(frozen=True)
class WorkRow:
    """One cell's memory and work."""

    label: str
    cell: Cell
    fields: tuple[Field, ...]


@dataclass(frozen=True)
class WorkTable:
    """Headings, each with its unit, and rows."""

    headings: tuple[tuple[str, str], ...]
    rows: tuple[WorkRow, ...]


def work_of_lines(lines: Iterable[Line]) -> WorkTable:
    """Returns a row for each measured cell."""
    cells = [(line.label, entry.ours) for line in lines for entry in line.entries if entry.ours]
    ray, image = (
        [name for name in names if any(cell.counters.get(name) for _, cell in cells)]
        for names in (_PER_RAY, _PER_IMAGE)
    )
    headings = [("total", ""), ("interval", ""), ("build", ""), ("memory", "")]
    headings += [(_PER_RAY[name], "per ray") for name in ray]
    headings += [(_PER_IMAGE[name], "per image") for name in image]
    rows = (WorkRow(label, cell, tuple(_fields(cell, ray, image))) for label, cell in cells)
    return WorkTable(tuple(headings), tuple(rows))


def _fields(cell: Cell, ray: Sequence[str], image: Sequence[str]) -> Iterator[Field]:
    nothing = Field(DASH)
    if cell.time:
        yield Field(milliseconds(cell.time.value), value=cell.time.value)
        yield Field(interval(cell.time), value=cell.time.low)
        yield Field(milliseconds(cell.build), value=cell.build)
    else:
        yield from (nothing, nothing, nothing)
    has_memory = not math.isnan(cell.memory)
    yield Field(size_in_words(cell.memory), value=cell.memory) if has_memory else nothing
    for name in ray:
        count = cell.counters.get(name)
        yield nothing if count is None else Field(number(count), value=count)
    for name in image:
        count = cell.counters[name] * cell.rays if name in cell.counters else None
        yield nothing if count is None else Field(f"{count:,.0f}", value=count)
