"""The page of the newest night: alarms, changes, cells, and charts by the plotly.js beside it."""

import base64
import json
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd
from plotly.offline import get_plotlyjs

from beambench_report.base.cell_files import IDENTITY, CellFile, Identity, read_cell_files
from beambench_report.base.columns import Column
from beambench_report.base.figure import structure_color
from beambench_report.base.files import Problem, write_text
from beambench_report.base.machine import Manifest, read_manifest
from beambench_report.base.records import (
    BASELINE,
    ERROR,
    FAULTLESS_VERDICTS,
    OK,
    Run,
    read_run,
    size_of,
)
from beambench_report.history.alarms import SHARE, doubt, sentence
from beambench_report.history.night import Night, night_of
from beambench_report.history.nights import Nights, read_nights
from beambench_report.history.steps import Rule
from beambench_report.history.store import Alarm, History
from beambench_report.nightly.home import Home
from beambench_report.run.all_cells import pack
from beambench_report.run.html import data_uri, environment
from beambench_report.run.outcome import summarize_verdicts

NOTEWORTHY = 0.02
_MOST = 25


@dataclass(frozen=True)
class Change:
    """One cell's ratio, then and now."""

    contender: str
    view: str
    size: str
    before: float
    after: float

    @property
    def share(self) -> float:
        """0.05: slower by 5%."""
        return self.after / self.before - 1


@dataclass(frozen=True)
class Changes:
    """A night beside another one."""

    name: str
    run_id: str
    commit: str
    changes: list[Change] = field(default_factory=list)
    """The largest ones, slower or faster."""
    slower: int = 0
    faster: int = 0
    compared: int = 0
    sentences: list[str] = field(default_factory=list)


def compare_nights(name: str, tonight: Night, other: Night, rows: pd.DataFrame) -> Changes:
    """Tonight beside another night; `rows` are tonight's, in the order of its figures."""
    known = {figure.key: figure for figure in other.figures}
    changes, verdicts, other_inputs, more = [], [], 0, 0
    for place, now in enumerate(tonight.figures):
        then = known.pop(now.key, None)
        if then is None:
            continue
        row = rows.iloc[place]
        if then.inputs != now.inputs:
            other_inputs += 1
            continue
        if then.verdict != now.verdict:
            verdicts.append(
                f"{row['contender']} in {row['view']} at {size_of(row)}: {then.verdict} before, "
                f"{now.verdict} now."
            )
        if then.counters != now.counters:
            more += 1
        noise_only = now.verdict == BASELINE or now.reference == now.key
        if now.ratio and then.ratio and then.reference == now.reference and not noise_only:
            changes.append(
                Change(row["contender"], row["view"], size_of(row), then.ratio, now.ratio)
            )
    new = len(tonight.figures) - (len(other.figures) - len(known))
    sentences = []
    if other.machine_id != tonight.machine_id:
        sentences.append(
            f"Of another machine: tonight {tonight.machine_id}, then {other.machine_id}. Ratios "
            "depend on the processor, so these changes are not the program's alone."
        )
    sentences += verdicts[:_MOST]
    sentences += _counted(more, "cells have other counters.", "cell has other counters.")
    sentences += _counted(other_inputs, "cells have other rays or scenes; they are not compared.")
    sentences += _counted(new, "cells are new.", "cell is new.")
    sentences += _counted(len(known), "cells are gone.", "cell is gone.")
    changes.sort(key=lambda change: -abs(change.share))
    return Changes(
        name,
        other.run_id,
        other.commit,
        changes[:_MOST],
        sum(change.share > NOTEWORTHY for change in changes),
        sum(change.share < -NOTEWORTHY for change in changes),
        len(changes),
        sentences,
    )


def shares(tonight: Night, other: Night | None) -> list[float]:
    """Each figure's change in percent; NaN where it cannot be compared."""
    known = {figure.key: figure for figure in other.figures} if other else {}
    result = []
    for now in tonight.figures:
        then = known.get(now.key)
        comparable = then and then.inputs == now.inputs and then.reference == now.reference
        if comparable and then.ratio and now.ratio:
            result.append(100 * (now.ratio / then.ratio - 1))
        else:
            result.append(float("nan"))
    return result


def _counted(count: int, many: str, one: str | None = None) -> list[str]:
    if count == 0:
        return []
    return [f"{count:,} {one if count == 1 and one else many}"]


# Logarithms of ratios in steps of 0.05%, as 16-bit integers: a year of nights in two megabytes.
_STEP = 2000.0
_MISSING = -32768


def chart_data(nights: Nights, rows: pd.DataFrame, alarms: Sequence[Alarm]) -> str:
    """JSON for charts.js; `rows` are those of the last night's run."""
    place_of = {key: place for place, key in enumerate(_keys(nights.cells))}
    views: dict[str, dict[str, list[dict]]] = {}
    for (view, width, height), group in rows.groupby(["view", "width", "height"], sort=False):
        front = pareto_front(group)
        variants: dict[str, int] = {}
        cells = []
        for index, row in group.iterrows():
            variant = variants[row["structure"]] = variants.get(row["structure"], -1) + 1
            place = place_of[_key(row)]
            cells.append(
                {
                    "name": row["contender"],
                    "color": structure_color(row["structure"]),
                    "variant": variant,
                    "verdict": row["verdict"],
                    "build": _figure(row["build_ms_median"]),
                    "trace": _figure(row["trace_ms_median"]),
                    "front": index in front,
                    "ratios": pack_ratios(nights.ratios[:, place]),
                }
            )
        views.setdefault(view, {})[f"{width:.0f}x{height:.0f}"] = cells
    number = {night: place for place, night in enumerate(nights.nights["number"])}
    data = {
        "nights": [
            {"run": night["run_id"], "time": night["time_utc"], "commit": night["commit"][:12]}
            for night in nights.nights.to_dict("records")
        ],
        "alarms": sorted({number[one.night] for one in alarms if one.night in number}),
        "views": views,
        "step": _STEP,
        "missing": _MISSING,
    }
    return json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")


def pareto_front(rows: pd.DataFrame) -> set:
    """The rows than which none builds and traces faster: the index of each."""
    right = rows[rows["timed"] & (rows["verdict"] == OK)]
    order = right.sort_values(["build_ms_median", "trace_ms_median"])
    front, best = set(), float("inf")
    for index, trace in order["trace_ms_median"].items():
        if trace < best:
            front.add(index)
            best = trace
    return front


def pack_ratios(ratios: np.ndarray) -> str:
    """Ratios as base64 of little-endian 16-bit integers."""
    with np.errstate(all="ignore"):
        logs = np.round(np.log(ratios) * _STEP)
    whole = np.where(np.isfinite(logs), np.clip(logs, -32767, 32767), _MISSING)
    return base64.b64encode(whole.astype("<i2").tobytes()).decode("ascii")


def _figure(value: float) -> float | None:
    return None if pd.isna(value) else float(f"{value:.5g}")


def _keys(cells: pd.DataFrame) -> list[tuple]:
    return [_key(row) for _, row in cells.iterrows()]


def _key(row: pd.Series) -> tuple:
    return tuple(row[name] if isinstance(row[name], str) else int(row[name]) for name in IDENTITY)


INDEX = "mismatches.json"
_MAX_PICTURES = 12  # one cause makes many cells wrong, and a page is read by people
_SECONDS = 120


def picture_mismatches(run: Run, beambench: Path) -> list[Path]:
    """Renders RUN/mismatches/*.png for cells of primary rays; returns what could be rendered.

    A picture that cannot be made keeps no page from being written: the index is without it.
    """
    wrong = run.rows[~run.rows["verdict"].isin((*FAULTLESS_VERDICTS, ERROR))]
    wrong = wrong[wrong["ray_kind"] == "primary"]
    # The lowest resolution shows what the highest does, and is read faster.
    wrong = wrong.sort_values("rays", kind="stable").drop_duplicates(
        ["scene", "camera", "structure", "parameters"]
    )
    folder = run.directory / "mismatches"
    entries, paths = [], []
    for number, (_, row) in enumerate(wrong.head(_MAX_PICTURES).iterrows(), 1):
        folder.mkdir(exist_ok=True)
        made = {}
        for kind, options in (("picture", []), ("difference", ["--difference", "oracle"])):
            path = folder / f"{number:02d}-{kind}.png"
            if _render(beambench, row, path, options):
                made[kind] = path.name
                paths.append(path)
        entries.append({"contender": row["contender"], "view": row["view"], **made})
    if entries:
        write_text(folder / INDEX, json.dumps(entries, indent=2) + "\n")
    return paths


def _render(beambench: Path, row: pd.Series, path: Path, options: list[str]) -> bool:
    accel = f"{row['structure']}:{row['parameters']}".rstrip(":")
    command = [str(beambench), "render", row["scene"], "--accel", accel, "-o", str(path)]
    command += ["--resolution", size_of(row), "--samples", f"{row['samples']:.0f}"]
    command += ["--camera", row["camera"], *options]
    try:
        done = subprocess.run(command, capture_output=True, timeout=_SECONDS, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode in (0, 1) and path.exists()


_TEMPLATES = Path(__file__).with_name("templates")
_NIGHTS_LISTED = 30


@dataclass(frozen=True)
class Mismatch:
    """A contender that was wrong, and the pictures of it."""

    title: str
    images: tuple[tuple[str, str], ...]
    """Address and caption."""


_PLOTLY = "plotly.min.js"


def write_night_page(home: Home, history: History, published: Path | None) -> Path:
    """Writes the page of the newest night into the folder of the history."""
    nights = read_nights(history)
    run = read_run(home.folder / nights.nights.iloc[-1]["folder"])
    library = get_plotlyjs()
    if not (path := home.page.with_name(_PLOTLY)).exists() or path.read_text("utf-8") != library:
        write_text(path, library)
    return write_text(home.page, render(history, nights, run, _run_or_none(published), home))


def render(history: History, nights: Nights, run: Run, published: Run | None, home: Home) -> str:
    """The text of the page."""
    tonight = night_of(run)
    yesterday = _yesterday(nights, home)
    alarms = history.alarms()
    newest = int(nights.nights.iloc[-1]["number"])
    manifest = read_manifest(run.directory) or Manifest()
    charts = chart_data(nights, run.rows, alarms)
    return (
        environment(_TEMPLATES)
        .get_template("night.html.j2")
        .render(
            manifest=manifest,
            newest=run.rows.iloc[-1].to_dict(),
            alarms=[_in_words(one) for one in alarms if one.night == newest],
            doubt=doubt([one for one in alarms if one.night == newest], len(nights.pools)),
            earlier=_earlier(alarms, nights, newest),
            count=len(nights.nights),
            not_tested=_not_tested(nights),
            rule=Rule(),
            counter_share=SHARE,
            outcome=summarize_verdicts(run, _cell_files(run)),
            changes=_changes(run, tonight, yesterday, published),
            mismatches=_mismatches(run.directory),
            nights=_listed(nights, alarms),
            charts=charts,
            cells=pack(_with_changes(run, tonight, yesterday, published), _OWN_COLUMNS),
            plotly=_PLOTLY,
        )
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


def _in_words(alarm: Alarm) -> tuple[str, str]:
    kinds = {"time": "slower", "counter": "more work", "verdict": "wrong hits"}
    return kinds[alarm.kind], sentence(alarm)


def _earlier(alarms: list[Alarm], nights: Nights, newest: int) -> list[tuple[str, str]]:
    runs = dict(zip(nights.nights["number"], nights.nights["run_id"], strict=True))
    known = [one for one in alarms if one.night != newest and one.night in runs]
    return [(runs[one.night], sentence(one)) for one in reversed(known)][:_NIGHTS_LISTED]


def _not_tested(nights: Nights) -> str:
    """Why times are not tested yet; nothing where they are."""
    needed = 2 * Rule().side
    if len(nights.nights) >= needed:
        return ""
    known = len(nights.nights)
    return (
        f"Times are not tested yet: this machine has {known} {'night' if known == 1 else 'nights'}"
        f", and a step needs {Rule().side} on each side. Until then use "
        "scripts/compare REV_A REV_B."
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
            (data_uri(index.with_name(entry[kind])), caption)
            for kind, caption in (
                ("picture", "as the structure sees it"),
                ("difference", "where it differs from the oracle"),
            )
            if kind in entry and index.with_name(entry[kind]).exists()
        )
        found.append(Mismatch(f"{entry['contender']} in {entry['view']}", images))
    return found
