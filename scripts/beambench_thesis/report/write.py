"""Writes the report and its details as Markdown and as HTML pages."""

import csv
from collections import Counter
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from jinja2 import Environment

from beambench_report.base.figure import house_style, structure_color, write_plot
from beambench_report.base.files import write_text, write_whole
from beambench_report.base.formulas import guarded
from beambench_report.base.published import RESOLUTIONS
from beambench_report.base.quantities import DASH
from beambench_report.run.html import data_uri, environment
from beambench_thesis.claims.register import (
    agreeing,
    by_question,
    cells_as_markdown,
    cells_of,
    claims_as_markdown,
    heads_of,
    named,
    row_of,
    rule_in_words,
)
from beambench_thesis.claims.variants_file import NAME as VARIANTS_FILE
from beambench_thesis.claims.variants_file import write_variants
from beambench_thesis.claims.verdict import Outcome, Verdict
from beambench_thesis.paper.cells import Cells
from beambench_thesis.paper.markdown import markdown_environment
from beambench_thesis.paper.printed import interval, milliseconds, origin, thesis_seconds
from beambench_thesis.paper.section import section_as_markdown
from beambench_thesis.report.answers import answers
from beambench_thesis.report.drawing import draw
from beambench_thesis.report.plan import Plan
from beambench_thesis.report.report import (
    BEST_WORDS,
    FIRST_FIGURES,
    OTHER_SYSTEMS,
    STAND_IN_WORDS,
    TABLE_WORDS,
    Report,
    claim_words,
    gather,
    headline,
    notice,
    undecided,
    verdict_counts,
)


@dataclass(frozen=True)
class Written:
    """The files of a report, and how many of its cells were wrong."""

    paths: tuple[Path, ...]
    cells: int
    wrong: int
    notice: str
    """Warnings for the reader; empty if everything was measured completely."""


_TEMPLATES = Path(__file__).with_name("templates")


def write_report(directory: Path, plan: Plan, beambench: Path | None = None) -> Written:
    """Writes the report and its details as pages and as Markdown, the figures, and the rows."""
    report = gather(directory, plan, beambench)
    folder = directory / "figures"
    folder.mkdir(exist_ok=True)
    with house_style():
        for data in report.figures:
            write_plot(draw(data), folder)
        for figure in (one for section in report.sections for one in section.figures):
            write_plot(figure.draw(), folder)
    texts = {**as_pages(report), **as_markdown(report)}
    paths = [write_text(directory / name, text) for name, text in texts.items()]
    paths.append(_write_rows(report.cells, directory / "rows.csv"))
    if plan.variants:
        paths.append(write_variants(report.claims, directory / VARIANTS_FILE))
    return Written(tuple(paths), len(report.cells.cells), len(report.cells.wrong), notice(report))


def _write_rows(cells: Cells, path: Path) -> Path:
    """Writes the row numbers of figures in the report, with the file's row for each."""

    def write(pending: Path) -> None:
        with pending.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(["row", "file", "line", "cell", "repetitions", "verdict"])
            for cell in cells.cells:
                place = (cell.number, f"{cell.run}/results.csv", cell.line, cell.name)
                writer.writerow(map(guarded, (*place, cell.repetitions, cell.verdict)))

    return write_whole(path, write)


MARKDOWN = ("report.md", "tables.md", "details.md", "cells.md")


def as_markdown(report: Report) -> dict[str, str]:
    """Returns the texts by the names of MARKDOWN."""
    made = markdown_environment(_TEMPLATES)
    claims = claims_as_markdown(report.claims)
    cells = "# Every comparison of the claims\n\nPart of the [report](report.md).\n\n"
    return {
        name: _rendered(made, f"{name}.j2", report, claims=claims) for name in MARKDOWN[:-1]
    } | {MARKDOWN[-1]: cells + cells_as_markdown(report.claims)}


def _rendered(made: Environment, template: str, report: Report, **values: object) -> str:
    made.filters |= {
        "milliseconds": milliseconds,
        "thesis_seconds": thesis_seconds,
        "interval": interval,
        "origin": origin,
        "color": structure_color,
        "agreeing": agreeing,
        "named": named,
        "section_as_markdown": section_as_markdown,
        "slug": lambda text: text.replace(" ", "-"),
    }
    return made.get_template(template).render(
        report=report,
        headline=headline(report),
        notice=notice(report),
        verdict_counts=verdict_counts(report),
        answers=answers(report.claims),
        contradicted=[one for one in report.claims if one.ours.verdict is Verdict.CONTRADICTED],
        undecided=undecided(report),
        by_question=by_question(report.claims),
        first_figures=FIRST_FIGURES,
        stand_in_words=STAND_IN_WORDS,
        other_systems=OTHER_SYSTEMS,
        dash=DASH,
        table_sizes=RESOLUTIONS,
        table_words=TABLE_WORDS,
        best_words=BEST_WORDS,
        claim_words=claim_words(report.claims),
        heads=heads_of(report.claims),
        row_of=row_of,
        rule_in_words=rule_in_words,
        zip=zip,
        opposite=Outcome.NO,
        **_origin(report),
        ratio_interval=partial(interval, factor=1, unit=""),
        cells_of=cells_of,
        states={"finished": "finished", "begun": "cut off", "waiting": "not run"},
        verdicts_of=lambda run: Counter(cell.verdict for cell in run.cells),
        **values,
    )


def _origin(report: Report) -> dict[str, object]:
    """Returns the machine and the commits of the runs, by their names in the templates."""
    manifests = [run.manifest for run in report.runs]
    facts = (pair for manifest in manifests for group in manifest.facts for pair in group.pairs)
    return {
        "machine": next((manifest.machine for manifest in manifests if manifest.machine), ""),
        "commits": list(dict.fromkeys(value[:12] for name, value in facts if name == "commit")),
    }


def as_pages(report: Report) -> dict[str, str]:
    """Returns the report and its details as pages, by their names."""
    folder = report.directory / "figures"
    manifests = [run.manifest for run in report.runs]
    values = {
        "images": {
            data.number: data_uri(folder / f"figure-{data.number}.svg") for data in report.figures
        },
        "plots": {
            figure.stem: data_uri(folder / f"{figure.stem}.svg")
            for section in report.sections
            for figure in section.figures
        },
        "pictures": [(data_uri(one.path) if one.path else "", one) for one in report.pictures],
        "uncontrolled": list(dict.fromkeys(text for one in manifests for text in one.uncontrolled)),
    }
    return {
        name: _rendered(environment(_TEMPLATES), f"{name}.j2", report, **values)
        for name in ("report.html", "details.html")
    }
