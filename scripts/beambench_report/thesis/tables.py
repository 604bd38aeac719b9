"""The tables of the thesis with our cells in them: both times, and both shapes."""

from __future__ import annotations

from dataclasses import dataclass

from beambench_report.ledger.evidence import FINEST, RESOLUTIONS
from beambench_report.ledger.measured import Measured
from beambench_report.ledger.published import published_evidence
from beambench_report.thesis.cells import Cell, Cells
from beambench_report.thesis.printed import PrintedPart, PrintedRow

REFERENCES = ("sah-bvh", "embree")
"""Contenders of today, which the thesis's tables do not have."""


@dataclass(frozen=True)
class Entry:
    """One cell of a table. Shapes are times over that of the part's first row at 320x200."""

    thesis: float | None
    thesis_shape: float | None
    ours: Cell | None
    shape: Measured | None
    missing: str = ""
    """Why there is no time of ours."""


@dataclass(frozen=True)
class Line:
    """A row of a table, one entry a resolution."""

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
        """Does the thesis print leaves and pixels with it?"""
        return any(line.counts for line in self.lines)

    @property
    def cells(self) -> list[Cell]:
        """Our cells in it, row by row."""
        return [entry.ours for line in self.lines for entry in line.entries if entry.ours]


def fill(part: PrintedPart, cells: Cells) -> PartTable:
    """Puts what was measured into a part."""
    base = cells.at(part.rows[0].setting(part.scene, RESOLUTIONS[0]))
    lines = [_line(part, row, cells, base) for row in part.rows]
    lines += [_reference(part, structure, cells, base) for structure in REFERENCES]
    lines = [line for line in lines if not line.is_reference or any(e.ours for e in line.entries)]
    return PartTable(part, RESOLUTIONS, tuple(lines), base)


def _line(part: PrintedPart, row: PrintedRow, cells: Cells, base: Cell | None) -> Line:
    entries = tuple(
        _entry(
            cells.at(row.setting(part.scene, resolution)),
            base,
            row.seconds.get(resolution),
            part.base,
        )
        for resolution in RESOLUTIONS
    )
    return Line(row.label, row.structure, entries, counts=_counts(part, row, entries[-1].ours))


def _reference(part: PrintedPart, structure: str, cells: Cells, base: Cell | None) -> Line:
    entries = tuple(
        _entry(next(iter(cells.of(part.scene, structure, resolution)), None), base, None, None)
        for resolution in RESOLUTIONS
    )
    return Line(f"{structure} (of today)", structure, entries, is_reference=True)


def _entry(
    ours: Cell | None, base: Cell | None, thesis: float | None, thesis_base: float | None
) -> Entry:
    thesis_shape = thesis / thesis_base if thesis and thesis_base else None
    if ours is None:
        return Entry(thesis, thesis_shape, None, None, "not measured")
    if ours.time is None:
        return Entry(thesis, thesis_shape, ours, None, f"no time: {ours.verdict}")
    shape = ours.time / base.time if base and base.time else None
    return Entry(thesis, thesis_shape, ours, shape)


def _counts(
    part: PrintedPart, row: PrintedRow, ours: Cell | None
) -> tuple[tuple[int | None, int | None], ...]:
    """Tables 5.2 and 5.3 print them, for 1280x1024."""
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
