"""The figures of the charts: every night's ratios, and tonight's build and trace times."""

from __future__ import annotations

import base64
import json
from collections.abc import Sequence

import numpy as np
import pandas as pd

from beambench_report.nightly.history import Alarm
from beambench_report.nightly.nights import Nights
from beambench_report.page.cell_files import IDENTITY
from beambench_report.style import structure_colour

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
                    "colour": structure_colour(row["structure"]),
                    "variant": variant,
                    "verdict": row["verdict"],
                    "build": _figure(row["build_ms_median"]),
                    "trace": _figure(row["trace_ms_median"]),
                    "front": index in front,
                    "ratios": pack(nights.ratios[:, place]),
                }
            )
        views.setdefault(view, {})[f"{width:.0f}x{height:.0f}"] = cells
    number = {night: place for place, night in enumerate(nights.nights["number"])}
    told = {
        "nights": [
            {"run": night["run_id"], "time": night["time_utc"], "commit": night["commit"][:12]}
            for night in nights.nights.to_dict("records")
        ],
        "alarms": sorted({number[one.night] for one in alarms if one.night in number}),
        "views": views,
        "step": _STEP,
        "missing": _MISSING,
    }
    return json.dumps(told, separators=(",", ":")).replace("<", "\\u003c")


def pareto_front(rows: pd.DataFrame) -> set:
    """The rows than which none builds and traces faster: the index of each."""
    right = rows[rows["timed"] & (rows["verdict"] == "ok")]
    order = right.sort_values(["build_ms_median", "trace_ms_median"])
    front, best = set(), float("inf")
    for index, trace in order["trace_ms_median"].items():
        if trace < best:
            front.add(index)
            best = trace
    return front


def pack(ratios: np.ndarray) -> str:
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
