"""A part of the report beyond the thesis's own tables and figures: words, tables, plots.

Those who measure something of their own fill a `Section`; the report shows it in both its forms.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from beambench_report.base.figure import Plot
from beambench_report.thesis.paper.cells import Cell


@dataclass(frozen=True)
class Field:
    """What stands at a place of a table, and the row of the file behind it."""

    text: str
    cell: Cell | None = None
    value: float | None = None
    """What it sorts by, where that is not the text."""


@dataclass(frozen=True)
class Column:
    """A heading, and whether figures stand under it."""

    text: str
    is_figure: bool = True


@dataclass(frozen=True)
class SectionTable:
    """A table of fields."""

    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Field, ...], ...]
    is_long: bool = False
    """Is it looked up rather than read, so that it is better folded?"""


@dataclass(frozen=True)
class SectionFigure:
    """A plot, drawn when the report is written."""

    stem: str
    title: str
    caption: str
    draw: Callable[[], Plot]


@dataclass(frozen=True)
class Section:
    """One part of the report."""

    anchor: str
    title: str
    words: tuple[str, ...]
    """Paragraphs."""
    tables: tuple[SectionTable, ...] = ()
    figures: tuple[SectionFigure, ...] = ()
    findings: tuple[str, ...] = field(default=())
    """What came out, a sentence each."""


Origin = Callable[[Cell], str]


def by_number(cell: Cell) -> str:
    """`#12`: the row of the report's rows.csv."""
    return f"#{cell.number}"


def by_file(cell: Cell) -> str:
    """`levels:14`: run and line of its results.csv, where there is no rows.csv."""
    return f"{cell.run}:{cell.line}"


def section_as_markdown(
    section: Section, *, level: int = 2, folder: str = "figures", origin: Origin = by_number
) -> str:
    """The section under a heading of that level; plots are in `folder`."""
    lines = [f"{'#' * level} {section.title}", ""]
    for paragraph in section.words:
        lines += [paragraph, ""]
    if section.findings:
        lines += [*(f"- {finding}" for finding in section.findings), ""]
    for figure in section.figures:
        image = f"{folder}/{figure.stem}.png".removeprefix("/")
        lines += [f"![{figure.title}]({image})", "", f"{figure.title}. {figure.caption}", ""]
    for table in section.tables:
        lines += [*_table(table, origin), ""]
    return "\n".join(lines)


def _table(table: SectionTable, origin: Origin) -> Iterable[str]:
    if table.is_long:
        yield f"<details><summary>{table.title}</summary>"
    else:
        yield f"**{table.title}**"
    yield ""
    yield _row(column.text for column in table.columns)
    yield _row("---:" if column.is_figure else "---" for column in table.columns)
    for row in table.rows:
        yield _row(
            f"{field.text}, {origin(field.cell)}" if field.cell else field.text for field in row
        )
    if table.is_long:
        yield ""
        yield "</details>"


def _row(texts: Iterable[str]) -> str:
    return f"| {' | '.join(texts)} |"
