"""The page of a history: alarms first, a chart run by run, and what changed between runs."""

import base64
import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from beambench_operations.history.alarms import SHARE, doubt, sentence
from beambench_operations.history.nights import Nights
from beambench_operations.history.steps import Rule
from beambench_operations.history.store import Alarm
from beambench_operations.site.changes import Repository
from beambench_operations.site.machine_history import MachineHistory
from beambench_report.base.figure import structure_color
from beambench_report.base.files import read_json
from beambench_report.base.records import size_of
from beambench_report.run.html import data_uri

MISMATCHES = "mismatches/mismatches.json"
_MOST_EARLIER = 30
_KINDS = {"time": "slower", "counter": "more work", "verdict": "wrong hits"}
# Logarithms of ratios in steps of 0.05%, as 16-bit integers: a year of nights in two megabytes.
_STEP = 2000.0
_MISSING = -32768

Address = Callable[[str], str]
"""A function that returns the address of a run's page, given the run's id; empty without a page."""


@dataclass(frozen=True)
class Mismatch:
    """A contender with wrong hits, and their pictures."""

    title: str
    images: tuple[tuple[str, str], ...]
    """Address and caption."""


def page_values(history: MachineHistory, address: Address, repository: Repository) -> dict:
    """Returns the values of the template, except names and comparisons."""
    nights = history.nights
    rows = _rows(history, address, repository)
    return {
        "count": len(nights.nights),
        "newest": rows[-1],
        "alarms": [(_KINDS[one.kind], sentence(one)) for one in history.tonight],
        "doubt": doubt(history.tonight, len(nights.pools)),
        "earlier": _earlier(history, address),
        "left_out": history.left_out,
        "not_tested": _not_tested(nights),
        "rule": Rule(),
        "counter_share": SHARE,
        "nights": rows[::-1],
        "not_in_blocks": sum(not row["in_blocks"] for row in rows),
        "charts": chart_data(nights, history.alarms, rows),
    }


def _rows(history: MachineHistory, address: Address, repository: Repository) -> list[dict]:
    """Returns a line for each run, the oldest first."""
    counts = Counter(alarm.night for alarm in history.alarms)
    rows, before = [], ""
    for place, night in enumerate(history.nights.nights.to_dict("records")):
        commit = night["commit"]
        rows.append(
            night
            | {
                "place": place,
                "href": address(night["run_id"]),
                "time": night["time_utc"].replace("T", " ").replace("Z", "") or night["run_id"],
                "subject": repository.subject(commit),
                "change": repository.change(before, commit) if before else None,
                "alarms": counts[night["number"]],
            }
        )
        before = commit
    return rows


def _earlier(history: MachineHistory, address: Address) -> list[tuple[str, str, str]]:
    nights = history.nights.nights
    runs = dict(zip(nights["number"], nights["run_id"], strict=True))
    known = [one for one in history.alarms if one.night != history.newest]
    newest_first = [(runs[one.night], sentence(one)) for one in reversed(known)][:_MOST_EARLIER]
    return [(run, address(run), words) for run, words in newest_first]


def _not_tested(nights: Nights) -> str:
    """Returns why times are not tested yet; empty if they are."""
    known = int(nights.nights["in_blocks"].sum())
    if known >= 2 * Rule().side:
        return ""
    return (
        f"Times are not tested yet: this machine has {known} runs in blocks, and a step needs "
        f"{Rule().side} on each side. Until then use scripts/compare REV_A REV_B."
    )


def chart_data(nights: Nights, alarms: Sequence[Alarm], rows: Sequence[Mapping]) -> str:
    """Returns the JSON for charts.js; `rows` are the lines of the runs."""
    cells = nights.cells
    views: dict[str, dict[str, list[dict]]] = {}
    for (view, *_), group in cells.groupby(["view", "width", "height", "samples"], sort=False):
        variants: dict[str, int] = {}
        lines = []
        for place, row in group.iterrows():
            variant = variants[row["structure"]] = variants.get(row["structure"], -1) + 1
            lines.append(
                {
                    "name": row["contender"],
                    "color": structure_color(row["structure"]),
                    "variant": variant,
                    "verdict": row["verdict"],
                    "ratios": pack_ratios(nights.ratios[:, place]),
                }
            )
        views.setdefault(view, {})[size_of(group.iloc[0])] = lines
    place_of = {row["number"]: row["place"] for row in rows}
    data = {
        "nights": [_night(row) for row in rows],
        "alarms": sorted({place_of[one.night] for one in alarms if one.night in place_of}),
        "views": views,
        "step": _STEP,
        "missing": _MISSING,
    }
    return json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")


def _night(row: Mapping) -> dict:
    change = row["change"]
    return {
        "run": row["run_id"],
        "href": row["href"],
        "time": row["time"],
        "commit": row["commit"][:12],
        "subject": row["subject"],
        "change": "" if change is None else change.url or f"#change-{row['place']}",
        "in_blocks": bool(row["in_blocks"]),
    }


def pack_ratios(ratios: np.ndarray) -> str:
    """Encodes ratios as base64 of little-endian 16-bit integers."""
    with np.errstate(all="ignore"):
        logs = np.round(np.log(ratios) * _STEP)
    whole = np.where(np.isfinite(logs), np.clip(logs, -32767, 32767), _MISSING)
    return base64.b64encode(whole.astype("<i2").tobytes()).decode("ascii")


def read_mismatches(directory: Path) -> list[Mismatch]:
    """Returns the pictures that a nightly run made of wrong hits."""
    index = directory / MISMATCHES
    captions = {
        "picture": "as the structure sees it",
        "difference": "where it differs from the oracle",
    }
    found = []
    for entry in read_json(index) or []:
        images = tuple(
            (data_uri(file), caption)
            for kind, caption in captions.items()
            if (file := index.with_name(entry.get(kind, "nothing"))).exists()
        )
        found.append(Mismatch(f"{entry['contender']} in {entry['view']}", images))
    return found
