"""The report as one HTML page that holds everything and asks nothing of a network."""

from __future__ import annotations

import base64
from collections import Counter
from functools import partial
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from beambench_report import page
from beambench_report.ledger.book import Entry
from beambench_report.ledger.markdown import amendment, summary
from beambench_report.ledger.verdict import Check, Outcome
from beambench_report.quantities import duration_in_words, number
from beambench_report.style import structure_colour
from beambench_report.thesis.report import Report
from beambench_report.thesis.texts import (
    DASH,
    interval,
    milliseconds,
    origin,
    thesis_seconds,
)
from beambench_report.thesis.words import BEST_WORDS, TABLE_WORDS, headline, notice, verdict_counts

_OWN = Path(__file__).with_name("templates")
_SHARED = Path(page.__file__).with_name("templates")


def as_page(report: Report) -> str:
    """The text of the page."""
    environment = Environment(
        loader=FileSystemLoader([_OWN, _SHARED]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {
        "milliseconds": milliseconds,
        "thesis_seconds": thesis_seconds,
        "number": number,
        "interval": interval,
        "origin": origin,
        "colour": structure_colour,
        "duration": duration_in_words,
        "summary": summary,
        "amendment": amendment,
        "slug": _slug,
    }
    environment.globals |= {
        "raw": _raw,
        "dash": DASH,
        "table_words": TABLE_WORDS,
        "best_words": BEST_WORDS,
        "ratio_interval": partial(interval, factor=1, unit=""),
        "cells_of": _cells_of,
        "verdicts_of": lambda run: Counter(cell.verdict for cell in run.cells),
    }
    return environment.get_template("thesis.html.j2").render(
        report=report,
        headline=headline(report),
        notice=notice(report),
        verdict_counts=verdict_counts(report),
        images={
            data.number: _image(report.directory / "figures" / f"figure-{data.number}.svg")
            for data in report.figures
        },
        plots={
            figure.stem: _image(report.directory / "figures" / f"{figure.stem}.svg")
            for section in report.sections
            for figure in section.figures
        },
        pictures=[
            (_image(picture.path) if picture.path else "", picture) for picture in report.pictures
        ],
        machine=next((run.manifest.machine for run in report.runs if run.manifest.machine), ""),
        uncontrolled=list(
            dict.fromkeys(text for run in report.runs for text in run.manifest.uncontrolled)
        ),
        commits=_commits(report),
    )


def _raw(name: str) -> Markup:
    """Style and scripts are not templates: their braces are their own."""
    folder = _OWN if (_OWN / name).exists() else _SHARED
    return Markup((folder / name).read_text("utf-8"))


def _slug(text: str) -> str:
    """`holds-in-part` of `holds in part`."""
    return text.replace(" ", "-")


def _image(path: Path) -> str:
    kind = {".svg": "image/svg+xml", ".png": "image/png"}[path.suffix]
    return f"data:{kind};base64,{base64.b64encode(path.read_bytes()).decode('ascii')}"


def _cells_of(entry: Entry) -> list[tuple[str, Check, Check]]:
    """Every cell that a claim's verdicts rest on: the thesis's check and ours."""
    thesis = {check.cell: check for check in entry.thesis.checks}
    ours = {check.cell: check for check in entry.ours.checks}
    nothing = Check("", Outcome.MISSING)
    return [
        (cell, thesis.get(cell, nothing), ours.get(cell, nothing))
        for cell in dict.fromkeys([*thesis, *ours])
    ]


def _commits(report: Report) -> list[str]:
    """The commits that were measured, as the manifests tell them."""
    pairs = (pair for run in report.runs for facts in run.manifest.facts for pair in facts.pairs)
    return list(dict.fromkeys(value[:12] for name, value in pairs if name == "commit"))
