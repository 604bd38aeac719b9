"""Writes the page of the newest night."""

from __future__ import annotations

import base64
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template
from markupsafe import Markup
from plotly.offline import get_plotlyjs

from beambench_report.dictionary import Column
from beambench_report.files import write_text
from beambench_report.nightly.counters import SHARE
from beambench_report.nightly.history import Alarm, History
from beambench_report.nightly.home import Home
from beambench_report.nightly.judge import doubt, sentence
from beambench_report.nightly.night import Night, night_of
from beambench_report.nightly.nights import Nights, read_nights
from beambench_report.nightly.page.changes import Changes, compare_nights, shares
from beambench_report.nightly.page.series import chart_data
from beambench_report.nightly.pictures import INDEX
from beambench_report.nightly.steps import Rule
from beambench_report.page.all_cells import pack
from beambench_report.page.cell_files import CellFile, Identity, read_cell_files
from beambench_report.page.manifest import Manifest, read_manifest
from beambench_report.page.outcome import judge_run
from beambench_report.problem import Problem
from beambench_report.quantities import duration_in_words
from beambench_report.records import Run, read_run

_TEMPLATES = Path(__file__).with_name("templates")
_HOUSE_TEMPLATES = Path(__file__).resolve().parents[2] / "page/templates"
_NIGHTS_LISTED = 30


@dataclass(frozen=True)
class Mismatch:
    """A contender that was wrong, and the pictures of it."""

    title: str
    images: tuple[tuple[str, str], ...]
    """Address and caption."""


def write_night_page(home: Home, history: History, published: Path | None) -> Path:
    """Writes the page of the newest night into the folder of the history."""
    nights = read_nights(history)
    run = read_run(home.folder / nights.nights.iloc[-1]["folder"])
    return write_text(home.page, render(history, nights, run, _run_or_none(published), home))


def render(history: History, nights: Nights, run: Run, published: Run | None, home: Home) -> str:
    """The text of the page."""
    tonight = night_of(run)
    yesterday = _yesterday(nights, home)
    alarms = history.alarms()
    newest = int(nights.nights.iloc[-1]["number"])
    manifest = read_manifest(run.directory) or Manifest()
    charts = chart_data(nights, run.rows, alarms)
    return _template().render(
        manifest=manifest,
        newest=run.rows.iloc[-1].to_dict(),
        alarms=[_told(one) for one in alarms if one.night == newest],
        doubt=doubt([one for one in alarms if one.night == newest], len(nights.pools)),
        earlier=_earlier(alarms, nights, newest),
        count=len(nights.nights),
        judged=_judged(nights),
        rule=Rule(),
        counter_share=SHARE,
        outcome=judge_run(run, _cell_files(run)),
        changes=_changes(run, tonight, yesterday, published),
        mismatches=_mismatches(run.directory),
        nights=_listed(nights, alarms),
        charts=charts,
        cells=pack(_with_changes(run, tonight, yesterday, published), _OWN_COLUMNS),
        plotly=Markup(get_plotlyjs().replace("</script", "<\\/script")),
    )


_OWN_COLUMNS = {
    name: Column(name, "", "number", unit, meaning, "")
    for name, unit, meaning in (
        ("ratio", "", "Total over that of Embree's single rays, in cycles the thread ran."),
        ("since_yesterday", "%", "By how much the ratio changed since the night before."),
        ("since_published", "%", "By how much the ratio changed since the published run."),
    )
}


def _with_changes(run: Run, tonight: Night, yesterday: Night | None, published: Run | None) -> Run:
    rows = run.rows.copy()
    other = night_of(published) if published else None
    rows.insert(0, "since_published", np.round(shares(tonight, other), 2))
    rows.insert(0, "since_yesterday", np.round(shares(tonight, yesterday), 2))
    ratios = [figure.ratio if figure.ratio else float("nan") for figure in tonight.figures]
    rows.insert(0, "ratio", ratios)
    return Run(run.directory, rows)


def _changes(
    run: Run, tonight: Night, yesterday: Night | None, published: Run | None
) -> list[Changes]:
    others = [("yesterday", yesterday), ("the published run", published and night_of(published))]
    return [compare_nights(name, tonight, one, run.rows) for name, one in others if one]


def _yesterday(nights: Nights, home: Home) -> Night | None:
    if len(nights.nights) < 2:
        return None
    try:
        return night_of(read_run(home.folder / nights.nights.iloc[-2]["folder"]))
    except Problem:
        return None  # its CSV is gone or not readable; the history has what the charts need


def _run_or_none(folder: Path | None) -> Run | None:
    return read_run(folder) if folder else None


def _cell_files(run: Run) -> dict[Identity, CellFile]:
    """Only where something was wrong: a thousand files take their time."""
    return {} if run.rows["timed"].all() else read_cell_files(run.directory)


def _told(alarm: Alarm) -> tuple[str, str]:
    kinds = {"time": "slower", "counter": "more work", "verdict": "wrong hits"}
    return kinds[alarm.kind], sentence(alarm)


def _earlier(alarms: list[Alarm], nights: Nights, newest: int) -> list[tuple[str, str]]:
    runs = dict(zip(nights.nights["number"], nights.nights["run_id"], strict=True))
    known = [one for one in alarms if one.night != newest and one.night in runs]
    return [(runs[one.night], sentence(one)) for one in reversed(known)][:_NIGHTS_LISTED]


def _judged(nights: Nights) -> str:
    """How far the times can be judged yet."""
    needed = 2 * Rule().side
    if len(nights.nights) >= needed:
        return ""
    known = len(nights.nights)
    return (
        f"Times are not judged yet: this machine has {known} {'night' if known == 1 else 'nights'}"
        f", and a step needs {Rule().side} on each side. Until then scripts/compare REV_A REV_B "
        "tells."
    )


def _listed(nights: Nights, alarms: list[Alarm]) -> list[dict]:
    counts: dict[int, int] = {}
    for alarm in alarms:
        counts[alarm.night] = counts.get(alarm.night, 0) + 1
    last = nights.nights.tail(_NIGHTS_LISTED).iloc[::-1].to_dict("records")
    return [night | {"alarms": counts.get(night["number"], 0)} for night in last]


def _mismatches(directory: Path) -> list[Mismatch]:
    index = directory / "mismatches" / INDEX
    if not index.exists():
        return []
    found = []
    for entry in json.loads(index.read_text("utf-8")):
        images = tuple(
            (_uri(index.with_name(entry[kind])), caption)
            for kind, caption in (
                ("picture", "as the structure sees it"),
                ("difference", "where it differs from the oracle"),
            )
            if kind in entry and index.with_name(entry[kind]).exists()
        )
        found.append(Mismatch(f"{entry['contender']} in {entry['view']}", images))
    return found


def _uri(path: Path) -> str:
    return f"data:image/png;base64,{base64.b64encode(path.read_bytes()).decode('ascii')}"


def _template() -> Template:
    folders = [_TEMPLATES, _HOUSE_TEMPLATES]
    environment = Environment(
        loader=FileSystemLoader(folders),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["duration"] = duration_in_words

    # Style and scripts are not templates: their braces are their own.
    def raw(name: str) -> Markup:
        path = next(folder / name for folder in folders if (folder / name).exists())
        return Markup(path.read_text("utf-8"))

    environment.globals["raw"] = raw
    environment.filters["as_script_data"] = Markup  # whoever packed it escaped what ends a script
    return environment.get_template("night.html.j2")
