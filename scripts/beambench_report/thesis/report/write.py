"""Writes the report as Markdown and as one HTML page."""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from beambench_report.base.figure import house_style, structure_color, write_plot
from beambench_report.base.files import write_text, write_whole
from beambench_report.base.quantities import number
from beambench_report.run.html import data_uri, environment
from beambench_report.thesis.chapter5.best import BestTable, Choice
from beambench_report.thesis.claims.register import Entry as JudgedClaim
from beambench_report.thesis.claims.register import amendment, summary
from beambench_report.thesis.claims.register import as_markdown as claims_as_markdown
from beambench_report.thesis.claims.verdict import Check, Outcome
from beambench_report.thesis.paper.cells import Cells
from beambench_report.thesis.paper.printed import (
    DASH,
    interval,
    milliseconds,
    origin,
    thesis_seconds,
)
from beambench_report.thesis.paper.section import section_as_markdown
from beambench_report.thesis.report.drawing import draw
from beambench_report.thesis.report.plan import Plan
from beambench_report.thesis.report.report import (
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
from beambench_report.thesis.report.tables import Entry, Line, PartTable, WorkTable


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
    """The numbers that figures carry in the report, and the row of the file behind each."""

    def write(pending: Path) -> None:
        with pending.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(["row", "file", "line", "cell", "repetitions", "verdict"])
            for cell in cells.cells:
                file_name = f"{cell.run}/results.csv"
                writer.writerow(
                    [cell.number, file_name, cell.line, cell.name, cell.repetitions, cell.verdict]
                )

    return write_whole(path, write)


_STATES = {"finished": "", "begun": "cut off", "waiting": "not run"}


def as_markdown(report: Report) -> str:
    """The whole report."""
    lines = [
        "# Chapter 5 of the thesis, measured again",
        "",
        f"{headline(report)} {notice(report)}".strip(),
    ]
    lines += [""]
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
    for figure in report.figures:
        image = f"figures/figure-{figure.number}.png"
        lines += [f"### Figure {figure.number}: {figure.title}", "", f"![{figure.title}]({image})"]
        lines += ["", figure.caption, ""]
    for picture in report.pictures:
        lines += [f"### Figure {picture.number}: {picture.title}", ""]
        if picture.path:
            lines += [f"![{picture.title}](figures/{picture.path.name})", ""]
        lines += [picture.caption, ""]
    lines += [section_as_markdown(section) for section in report.sections]
    lines += ["## Runs", "", *_runs(report), "", "## Every cell of the claims", ""]
    lines += [claims_as_markdown(report.claims, cells=True).split("\n\n", 1)[-1]]
    return "\n".join(lines)


def _part(part: Part) -> Iterable[str]:
    table = part.table
    yield f"#### {table.part.title}"
    yield ""
    heads = [text for size in table.resolutions for text in (f"{size} thesis", "ours")]
    if table.has_counts:
        heads += ["occupied leaves", "pixels of exit beams"]
    yield _row(["", *heads])
    yield _row(["---"] + ["---:"] * len(heads))
    for line in table.lines:
        yield _row([line.label, *_entries(line, table)])
    yield ""
    if part.work.rows:
        yield "<details><summary>Memory and work</summary>"
        yield ""
        yield from _work(part.work)
        yield ""
        yield "</details>"
        yield ""
    if part.best:
        yield from _best(part.best)


def _entries(line: Line, table: PartTable) -> list[str]:
    texts = [text for entry in line.entries for text in (_thesis(entry), _ours(entry))]
    if table.has_counts:
        counts = line.counts or ((None, None),) * 2
        texts += [" / ".join(_count(figure) for figure in pair) for pair in counts]
    return texts


def _count(figure: int | None) -> str:
    return DASH if figure is None else f"{figure:,}"


def _thesis(entry: Entry) -> str:
    if entry.thesis is None:
        return DASH
    shape = f" ({number(entry.thesis_shape)})" if entry.thesis_shape else ""
    return thesis_seconds(entry.thesis) + shape


def _ours(entry: Entry) -> str:
    if entry.ours is None or entry.ours.time is None:
        return f"{DASH} {entry.missing}"
    shape = f" ({number(entry.shape.value)})" if entry.shape else ""
    build = f", build {milliseconds(entry.ours.build)}"
    return f"{milliseconds(entry.ours.time.value)}{shape}{build}, #{entry.ours.number}"


def _work(table: WorkTable) -> Iterable[str]:
    heads = [f"{title} {unit}".strip() for title, unit in table.headings]
    yield _row(["contender", "resolution", *heads, "verdict", "row"])
    yield _row(["---", "---"] + ["---:"] * len(heads) + ["---", "---:"])
    for row in table.rows:
        texts = [field.text for field in row.fields]
        cell = row.cell
        yield _row([row.label, cell.resolution, *texts, cell.verdict, f"#{cell.number}"])


def _best(best: BestTable) -> Iterable[str]:
    yield f"Best against best, {best.part.title}. {BEST_WORDS}"
    yield ""
    heads = [text for size in best.resolutions for text in (size, "parameters")]
    yield _row(["contender", *heads])
    yield _row(["---"] + ["---:", "---"] * len(best.resolutions))
    for line in best.lines:
        texts = [text for choice in line.choices for text in _choice(choice)]
        yield _row([line.label, *texts])
    yield ""


def _choice(choice: Choice) -> tuple[str, str]:
    cell = choice.cell
    if cell is None or cell.time is None:
        return f"{DASH} not measured", ""
    ratio = ""
    if choice.ratio:
        known = choice.ratio.low < choice.ratio.high
        told = f"; {interval(choice.ratio, 1, '')}" if known else ""
        ratio = f" ({number(choice.ratio.value)}{told})"
    told = f"{choice.parameters} (best of {choice.tried})" if choice.parameters else ""
    edge = ", at the end of what was tried" if choice.is_edge else ""
    return f"{milliseconds(cell.time.value)}{ratio}, #{cell.number}", told + edge


def _runs(report: Report) -> Iterable[str]:
    yield _row(["run", "cells", "wrong", "state", "verdicts", "what for"])
    yield _row(["---", "---:", "---:", "---", "---", "---"])
    for run in report.runs:
        yield _row(_run(run))
    for sentence in report.cells.unread:
        yield ""
        yield sentence
    yield ""
    yield "A number behind `#` is a row of `rows.csv`, which names the file, line and cell."


def _run(run: RunSummary) -> list[str]:
    verdicts = Counter(cell.verdict for cell in run.cells)
    return [
        run.name,
        f"{len(run.cells)} of {run.planned}",
        f"{run.wrong}",
        _STATES[run.state] or "finished",
        ", ".join(f"{count} {verdict}" for verdict, count in verdicts.items()) or DASH,
        run.description,
    ]


def _row(texts: Iterable[str]) -> str:
    return f"| {' | '.join(texts)} |"


_OWN = Path(__file__).with_name("templates")


def as_page(report: Report) -> str:
    """The text of the page."""
    made = environment(_OWN)
    made.filters |= {
        "milliseconds": milliseconds,
        "thesis_seconds": thesis_seconds,
        "number": number,
        "interval": interval,
        "origin": origin,
        "color": structure_color,
        "summary": summary,
        "amendment": amendment,
        "slug": _slug,
    }
    made.globals |= {
        "dash": DASH,
        "table_words": TABLE_WORDS,
        "best_words": BEST_WORDS,
        "ratio_interval": partial(interval, factor=1, unit=""),
        "cells_of": _cells_of,
        "verdicts_of": lambda run: Counter(cell.verdict for cell in run.cells),
    }
    return made.get_template("thesis.html.j2").render(
        report=report,
        headline=headline(report),
        notice=notice(report),
        verdict_counts=verdict_counts(report),
        images={
            data.number: data_uri(report.directory / "figures" / f"figure-{data.number}.svg")
            for data in report.figures
        },
        plots={
            figure.stem: data_uri(report.directory / "figures" / f"{figure.stem}.svg")
            for section in report.sections
            for figure in section.figures
        },
        pictures=[
            (data_uri(picture.path) if picture.path else "", picture) for picture in report.pictures
        ],
        machine=next((run.manifest.machine for run in report.runs if run.manifest.machine), ""),
        uncontrolled=list(
            dict.fromkeys(text for run in report.runs for text in run.manifest.uncontrolled)
        ),
        commits=_commits(report),
    )


def _slug(text: str) -> str:
    """`holds-in-part` of `holds in part`."""
    return text.replace(" ", "-")


def _cells_of(entry: JudgedClaim) -> list[tuple[str, Check, Check]]:
    """Every cell that a claim's verdicts rest on: the thesis's check and ours."""
    thesis = {check.cell: check for check in entry.thesis.checks}
    ours = {check.cell: check for check in entry.ours.checks}
    nothing = Check("", Outcome.MISSING)
    return [
        (cell, thesis.get(cell, nothing), ours.get(cell, nothing))
        for cell in dict.fromkeys([*thesis, *ours])
    ]


def _commits(report: Report) -> list[str]:
    """The commits that were measured, as the manifests name them."""
    pairs = (pair for run in report.runs for facts in run.manifest.facts for pair in facts.pairs)
    return list(dict.fromkeys(value[:12] for name, value in pairs if name == "commit"))
