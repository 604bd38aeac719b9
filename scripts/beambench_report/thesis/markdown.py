"""The report as Markdown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from beambench_report.ledger.markdown import as_markdown as ledger_as_markdown
from beambench_report.quantities import number
from beambench_report.thesis.best import BestTable, Choice
from beambench_report.thesis.report import Part, Report, RunSummary
from beambench_report.thesis.section import section_as_markdown
from beambench_report.thesis.tables import Entry, Line, PartTable
from beambench_report.thesis.texts import DASH, interval, milliseconds, thesis_seconds
from beambench_report.thesis.words import BEST_WORDS, TABLE_WORDS, headline, notice, verdict_counts
from beambench_report.thesis.work import WorkTable

_STATES = {"finished": "", "begun": "cut off", "waiting": "not run"}


def as_markdown(report: Report) -> str:
    """The whole report."""
    lines = [
        "# Chapter 5 of the thesis, measured again",
        "",
        f"{headline(report)} {notice(report)}".strip(),
    ]
    lines += [""]
    lines += ["## The ledger: what the thesis claims", "", verdict_counts(report), ""]
    lines += [ledger_as_markdown(report.ledger)]
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
    lines += ["## Runs", "", *_runs(report), "", "## Every cell of the ledger", ""]
    lines += [ledger_as_markdown(report.ledger, cells=True).split("\n\n", 1)[-1]]
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
    yield _row(["run", "cells", "not right", "state", "verdicts", "what for"])
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
