"""A part of the report beyond the thesis's own tables and figures: words, tables, plots."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from beambench_report.base.figure import Plot, house_style, write_plot
from beambench_report.base.files import write_text
from beambench_report.base.quantities import markdown_table
from beambench_thesis.paper.cells import Cell


@dataclass(frozen=True)
class Field:
    """An entry of a table, and the row of the file that it comes from."""

    text: str
    cell: Cell | None = None
    value: float | None = None
    """The sort key, if it is not the text."""


@dataclass(frozen=True)
class SectionTable:
    """A table of fields; a long table is folded, since it is for reference."""

    title: str
    heads: tuple[str, ...]
    words: int
    """The number of columns that contain words; the columns after them contain figures."""
    rows: tuple[tuple[Field, ...], ...]
    is_long: bool = False


@dataclass(frozen=True)
class SectionFigure:
    """A plot, drawn when the report is written."""

    stem: str
    title: str
    caption: str
    draw: Callable[[], Plot]


@dataclass(frozen=True)
class Section:
    """One part of the report; `words` are paragraphs, `findings` sentences."""

    anchor: str
    title: str
    words: tuple[str, ...]
    tables: tuple[SectionTable, ...] = ()
    figures: tuple[SectionFigure, ...] = ()
    findings: tuple[str, ...] = field(default=())


def section_table(
    title: str,
    words: Sequence[str],
    figures: Sequence[str],
    rows: Iterable[Iterable[str | Field]],
    *,
    is_long: bool = False,
) -> SectionTable:
    """Returns a table; columns headed by `words` come first, then columns of figures."""
    fields = (tuple(Field(x) if isinstance(x, str) else x for x in row) for row in rows)
    return SectionTable(title, (*words, *figures), len(words), tuple(fields), is_long)


def write_section(section: Section, file: Path, **options: object) -> list[Path]:
    """Writes the section as a separate FILE.md, with its plots."""
    text = section_as_markdown(section, level=1, folder="", **options)
    paths = [write_text(file, text)]
    with house_style():
        for figure in section.figures:
            paths += write_plot(figure.draw(), file.parent)
    return paths


Origin = Callable[[Cell], str]


def by_number(cell: Cell) -> str:
    """Returns `#12`: the row of the report's rows.csv."""
    return f"#{cell.number}"


def by_file(cell: Cell) -> str:
    """Returns `levels:14`: run and line of its results.csv, if rows.csv is missing."""
    return f"{cell.run}:{cell.line}"


def section_as_markdown(
    section: Section, *, level: int = 2, folder: str = "figures", origin: Origin = by_number
) -> str:
    """Returns the section under a heading of that level; plots are in `folder`."""
    lines = [f"{'#' * level} {section.title}", ""]
    for paragraph in section.words:
        lines += [paragraph, ""]
    if section.findings:
        lines += [*(f"- {finding}" for finding in section.findings), ""]
    for figure in section.figures:
        image = f"{folder}/{figure.stem}.png".removeprefix("/")
        lines += [f"![{figure.title}]({image})", "", f"{figure.title}. {figure.caption}", ""]
    for table in section.tables:
        rows = (
            [f"{one.text}, {origin(one.cell)}" if one.cell else one.text for one in row]
            for row in table.rows
        )
        title = f"<details><summary>{table.title}</summary>" if table.is_long else ""
        lines += [title or f"**{table.title}**", ""]
        lines += markdown_table(table.heads, rows, range(table.words, len(table.heads)))
        lines += ["", "</details>", ""] if table.is_long else [""]
    return "\n".join(lines)
