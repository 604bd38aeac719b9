"""The thesis's tables with our cells: times, shapes, memory and work."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

from beambench_report.base.published import FINEST, RESOLUTIONS
from beambench_report.base.quantities import number, size_in_words
from beambench_thesis.paper.cells import Cell, Cells
from beambench_thesis.paper.evidence import Measured, published_evidence
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
"""Why there is nothing at a resolution, if there is nothing."""

_HIERARCHY = "goldsmith-salmon"
_WITHOUT_TERMINAL = {"order": "given", "queue": "heap", "insert": "everywhere"}
"""The thesis's hierarchy but for the insertion, which is the one of Goldsmith and Salmon's paper.
It is an extra beside the thesis's, which places objects beside terminal nodes alone (4.3)."""


@dataclass(frozen=True)
class Entry:
    """One cell of a table. Its shape is its time over that of the part's first row at 320x200."""

    thesis: float | None
    thesis_shape: float | None
    ours: Cell | None = None
    shape: Measured | None = None
    missing: str = ""
    """Why there is no time of ours."""


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
    resolutions: tuple[str, ...]
    lines: tuple[Line, ...]
    base: Cell | None

    @property
    def has_counts(self) -> bool:
        """Does the thesis print leaves and pixels with this part?"""
        return any(line.counts for line in self.lines)

    @property
    def cells(self) -> list[Cell]:
        """Our cells in it, row by row."""
        return [entry.ours for line in self.lines for entry in line.entries if entry.ours]


def fill(part: PrintedPart, cells: Cells, why: Reasons) -> PartTable:
    """Fills a part with our measurements."""
    lines = [_line(part, row, cells, why) for row in part.rows]
    added = [(name, f"{name} (of today)", {}) for name in REFERENCES]
    if _HIERARCHY in part.structures:
        label = "hierarchy, insert=everywhere (Goldsmith and Salmon 1987)"
        added.insert(0, (_HIERARCHY, label, _WITHOUT_TERMINAL))
    lines += [_not_printed(part, *names, cells, why) for names in added]
    lines = [line for line in lines if not line.is_reference or any(e.ours for e in line.entries)]
    return PartTable(part, RESOLUTIONS, tuple(lines), _base(part, cells))


def _line(part: PrintedPart, row: PrintedRow, cells: Cells, why: Reasons) -> Line:
    base = _base(part, cells)
    entries = []
    for resolution in RESOLUTIONS:
        ours = cells.at(row.setting(part.scene, resolution))
        thesis = row.seconds.get(resolution)
        shape = thesis / part.base if thesis and part.base else None
        entries.append(_entry(ours, base, Entry(thesis, shape, missing=why(resolution))))
    return Line(row.label, row.structure, tuple(entries), counts=_counts(part, row, ours))


def _not_printed(
    part: PrintedPart,
    structure: str,
    label: str,
    wanted: dict[str, str],
    cells: Cells,
    why: Reasons,
) -> Line:
    """Returns a row that the thesis lacks: the structure's first cell with the parameters."""
    base = _base(part, cells)
    entries = []
    for resolution in RESOLUTIONS:
        found = (
            cell
            for cell in cells.of(part.scene, structure, resolution)
            # Runs before the parameter `insert` lack it: they inserted everywhere.
            if all(cell.parameters.get(name, value) == value for name, value in wanted.items())
        )
        entries.append(_entry(next(found, None), base, Entry(None, None, missing=why(resolution))))
    return Line(label, structure, tuple(entries), is_reference=True)


def _base(part: PrintedPart, cells: Cells) -> Cell | None:
    return cells.at(part.rows[0].setting(part.scene, RESOLUTIONS[0]))


def _entry(ours: Cell | None, base: Cell | None, empty: Entry) -> Entry:
    if ours is None:
        return empty
    if ours.time is None:
        return replace(empty, ours=ours, missing=f"no time: {ours.verdict}")
    shape = ours.time / base.time if base and base.time else None
    return replace(empty, ours=ours, shape=shape, missing="")


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
    if ours is not None and ours.resolution == FINEST:
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
    "beams_divided": "of these cut again",
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
    return _work([(line.label, entry.ours) for line in lines for entry in line.entries])


def _work(named: Sequence[tuple[str, Cell | None]]) -> WorkTable:
    cells = [(label, cell) for label, cell in named if cell is not None]
    ray = [name for name in _PER_RAY if any(cell.counters.get(name) for _, cell in cells)]
    image = [name for name in _PER_IMAGE if any(cell.counters.get(name) for _, cell in cells)]
    headings = [("total", ""), ("interval", ""), ("build", ""), ("memory", "")]
    headings += [(_PER_RAY[name], "per ray") for name in ray]
    headings += [(_PER_IMAGE[name], "per image") for name in image]
    return WorkTable(
        tuple(headings),
        tuple(WorkRow(label, cell, _fields(cell, ray, image)) for label, cell in cells),
    )


def _fields(cell: Cell, ray: Sequence[str], image: Sequence[str]) -> tuple[Field, ...]:
    nothing = Field(DASH)
    times = (nothing, nothing, nothing)
    if cell.time:
        times = (
            Field(milliseconds(cell.time.value), value=cell.time.value),
            Field(interval(cell.time), value=cell.time.low),
            Field(milliseconds(cell.build), value=cell.build),
        )
    memory = nothing
    if not math.isnan(cell.memory):
        memory = Field(size_in_words(cell.memory), value=cell.memory)
    counts = cell.counters
    return (
        *times,
        memory,
        *(Field(number(counts[n]), value=counts[n]) if n in counts else nothing for n in ray),
        *(
            Field(f"{counts[n] * cell.rays:,.0f}", value=counts[n] * cell.rays)
            if n in counts
            else nothing
            for n in image
        ),
    )
