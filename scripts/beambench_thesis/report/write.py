"""Writes the report as Markdown and as one HTML page."""

import csv
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from beambench_report.base.figure import house_style, structure_color, write_plot
from beambench_report.base.files import write_text, write_whole
from beambench_report.base.formulas import guarded
from beambench_report.base.quantities import DASH, markdown_table, number
from beambench_report.run.html import data_uri, environment
from beambench_thesis.chapter5.best import BestTable, Choice
from beambench_thesis.claims.register import amendment, cells_of, claims_as_markdown, summary
from beambench_thesis.paper.cells import Cells
from beambench_thesis.paper.printed import interval, milliseconds, origin, thesis_seconds
from beambench_thesis.paper.section import section_as_markdown
from beambench_thesis.report.drawing import draw
from beambench_thesis.report.plan import Plan
from beambench_thesis.report.report import (
    BEST_WORDS,
    TABLE_WORDS,
    Part,
    Report,
    RunSummary,
    gather,
    headline,
    notice,
    verdict_counts,
)
from beambench_thesis.report.tables import Entry, Line, PartTable, WorkTable


@dataclass(frozen=True)
class Written:
    """The files of a report, and how many of its cells were wrong."""

    paths: tuple[Path, ...]
    cells: int
    wrong: int
    notice: str
    """What a reader must know before reading it; nothing where all was measured in full."""


def write_report(directory: Path, plan: Plan, beambench: Path | None = None) -> Written:
    """Writes DIRECTORY/report.html and report.md, the figures, and the list of rows."""
    report = gather(directory, plan, beambench)
    folder = directory / "figures"
    folder.mkdir(exist_ok=True)
    with house_style():
        for data in report.figures:
            write_plot(draw(data), folder)
        for figure in (one for section in report.sections for one in section.figures):
            write_plot(figure.draw(), folder)
    paths = (
        write_text(directory / "report.html", as_page(report)),
        write_text(directory / "report.md", as_markdown(report)),
        _write_rows(report.cells, directory / "rows.csv"),
    )
    return Written(paths, len(report.cells.cells), len(report.cells.wrong), notice(report))


def _write_rows(cells: Cells, path: Path) -> Path:
    """Writes the row numbers that figures have in the report, and the file's row behind each."""

    def write(pending: Path) -> None:
        with pending.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(["row", "file", "line", "cell", "repetitions", "verdict"])
            for cell in cells.cells:
                place = (cell.number, f"{cell.run}/results.csv", cell.line, cell.name)
                writer.writerow(map(guarded, (*place, cell.repetitions, cell.verdict)))

    return write_whole(path, write)


def as_markdown(report: Report) -> str:
    """Returns the whole report."""
    lines = ["# Chapter 5 of the thesis, measured again", ""]
    lines += [f"{headline(report)} {notice(report)}".strip(), ""]
    lines += ["## The claims of the thesis", "", verdict_counts(report), ""]
    lines += [claims_as_markdown(report.claims)]
    if report.tables:
        lines += ["## Tables", "", TABLE_WORDS, ""]
    for table, parts in report.tables:
        lines += [f"### Table {table.number}: {table.title}", ""]
        for part in parts:
            lines += _part(part)
    if report.figures or report.pictures:
        lines += ["## Figures", ""]
    drawn = [(one, f"figure-{one.number}.png") for one in report.figures]
    drawn += [(one, one.path.name if one.path else "") for one in report.pictures]
    for figure, name in drawn:
        lines += [f"### Figure {figure.number}: {figure.title}", ""]
        lines += [f"![{figure.title}](figures/{name})", ""] if name else []
        lines += [figure.caption, ""]
    lines += [section_as_markdown(section) for section in report.sections]
    lines += ["## Runs", "", *_runs(report), "", "## Every cell of the claims", ""]
    lines += [claims_as_markdown(report.claims, cells=True).split("\n\n", 1)[-1]]
    return "\n".join(lines)


def _part(part: Part) -> Iterable[str]:
    table = part.table
    heads = [text for size in table.resolutions for text in (f"{size} thesis", "ours")]
    heads += ["occupied leaves", "pixels of exit beams"] if table.has_counts else []
    rows = ([line.label, *_entries(line, table)] for line in table.lines)
    yield from (f"#### {table.part.title}", "")
    yield from (*markdown_table(["", *heads], rows, range(1, len(heads) + 1)), "")
    if part.work.rows:
        yield from ("<details><summary>Memory and work</summary>", "", *_work(part.work))
        yield from ("", "</details>", "")
    if part.best:
        yield from _best(part.best)


def _entries(line: Line, table: PartTable) -> list[str]:
    texts = [text for entry in line.entries for text in (_thesis(entry), _ours(entry))]
    if table.has_counts:
        counts = line.counts or ((None, None),) * 2
        texts += [" / ".join(DASH if n is None else f"{n:,}" for n in pair) for pair in counts]
    return texts


def _thesis(entry: Entry) -> str:
    shape = f" ({number(entry.thesis_shape)})" if entry.thesis_shape else ""
    return thesis_seconds(entry.thesis) + shape


def _ours(entry: Entry) -> str:
    if entry.ours is None or entry.ours.time is None:
        return f"{DASH} {entry.missing}"
    shape = f" ({number(entry.shape.value)})" if entry.shape else ""
    build = f", build {milliseconds(entry.ours.build)}"
    return f"{milliseconds(entry.ours.time.value)}{shape}{build}, #{entry.ours.number}"


def _work(table: WorkTable) -> list[str]:
    heads = [f"{title} {unit}".strip() for title, unit in table.headings]
    rows = (
        (
            *(row.label, row.cell.resolution),
            *(field.text for field in row.fields),
            *(row.cell.verdict, f"#{row.cell.number}"),
        )
        for row in table.rows
    )
    right = (*range(2, len(heads) + 2), len(heads) + 3)
    return markdown_table(["contender", "resolution", *heads, "verdict", "row"], rows, right)


def _best(best: BestTable) -> Iterable[str]:
    heads = ["contender", *(text for size in best.resolutions for text in (size, "parameters"))]
    rows = (
        [line.label, *(text for choice in line.choices for text in _choice(choice))]
        for line in best.lines
    )
    yield from (f"Best against best, {best.part.title}. {BEST_WORDS}", "")
    yield from (*markdown_table(heads, rows, range(1, len(heads), 2)), "")


def _choice(choice: Choice) -> tuple[str, str]:
    cell = choice.cell
    if cell is None or cell.time is None:
        return f"{DASH} not measured", ""
    ratio = ""
    if choice.ratio:
        known = choice.ratio.low < choice.ratio.high
        between = f"; {interval(choice.ratio, 1, '')}" if known else ""
        ratio = f" ({number(choice.ratio.value)}{between})"
    tried = f"{choice.parameters} (best of {choice.tried})" if choice.parameters else ""
    edge = ", at the end of what was tried" if choice.is_edge else ""
    return f"{milliseconds(cell.time.value)}{ratio}, #{cell.number}", tried + edge


def _runs(report: Report) -> Iterable[str]:
    heads = ("run", "cells", "wrong", "state", "verdicts", "what for")
    yield from markdown_table(heads, map(_run, report.runs), (1, 2))
    for sentence in report.cells.unread:
        yield from ("", sentence)
    yield ""
    yield "A number behind `#` is a row of `rows.csv`, which names the file, line and cell."


def _run(run: RunSummary) -> list[str]:
    verdicts = Counter(cell.verdict for cell in run.cells)
    return [
        run.name,
        f"{len(run.cells)} of {run.planned}",
        f"{run.wrong}",
        {"begun": "cut off", "waiting": "not run"}.get(run.state, run.state),
        ", ".join(f"{count} {verdict}" for verdict, count in verdicts.items()) or DASH,
        run.description,
    ]


def as_page(report: Report) -> str:
    """Returns the text of the page."""
    made = environment(Path(__file__).with_name("templates"))
    made.filters |= {
        "milliseconds": milliseconds,
        "thesis_seconds": thesis_seconds,
        "number": number,
        "interval": interval,
        "origin": origin,
        "color": structure_color,
        "summary": summary,
        "amendment": amendment,
        "slug": lambda text: text.replace(" ", "-"),
    }
    made.globals |= {
        "dash": DASH,
        "table_words": TABLE_WORDS,
        "best_words": BEST_WORDS,
        "ratio_interval": partial(interval, factor=1, unit=""),
        "cells_of": cells_of,
        "verdicts_of": lambda run: Counter(cell.verdict for cell in run.cells),
    }
    folder = report.directory / "figures"
    manifests = [run.manifest for run in report.runs]
    facts = (pair for manifest in manifests for group in manifest.facts for pair in group.pairs)
    return made.get_template("thesis.html.j2").render(
        report=report,
        headline=headline(report),
        notice=notice(report),
        verdict_counts=verdict_counts(report),
        images={
            data.number: data_uri(folder / f"figure-{data.number}.svg") for data in report.figures
        },
        plots={
            figure.stem: data_uri(folder / f"{figure.stem}.svg")
            for section in report.sections
            for figure in section.figures
        },
        pictures=[(data_uri(one.path) if one.path else "", one) for one in report.pictures],
        machine=next((manifest.machine for manifest in manifests if manifest.machine), ""),
        uncontrolled=list(dict.fromkeys(text for one in manifests for text in one.uncontrolled)),
        commits=list(dict.fromkeys(value[:12] for name, value in facts if name == "commit")),
    )
