"""The table of one view at one resolution: times, ratio, memory and work of each contender."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd

from beambench_report.dictionary import COUNTER_SUFFIX
from beambench_report.page.table import Field, Heading, Line, Table
from beambench_report.quantities import number, size_in_words
from beambench_report.ratio import Ratio
from beambench_report.style import structure_colour

MISSING = Field("–", None)  # noqa: RUF001
_MOST_LINES = 60
_FAR = 12  # a time this many times the median one would flatten the others' bars


def view_table(
    caption: str, rows: pd.DataFrame, counters: list[str], ratios: Mapping[str, Ratio]
) -> Table:
    """The quickest first; those without times last."""
    ordered = rows.sort_values("total_ms_median", na_position="last", kind="stable")
    counters = [name for name in counters if rows[name].notna().any() and (rows[name] != 0).any()]
    headings = (
        Heading("total", "ms", "total_ms_median"),
        Heading("build", "ms", "build_ms_median"),
        Heading("trace", "ms", "trace_ms_median"),
        Heading("trace, net", "ms", "trace_net_ms_median"),
        Heading("ratio", "to reference"),
        Heading("speed", "Mrays/s", "mrays_per_s"),
        Heading("memory", "", "memory_bytes"),
        *(Heading(_counter_title(name), "a ray", name) for name in counters),
    )
    scale = _scale(ordered.loc[ordered["timed"], "total_ms_median"])
    lines = tuple(
        _line(row, counters, ratios.get(row["contender"]), scale)
        for _, row in ordered.head(_MOST_LINES).iterrows()
    )
    return Table(caption, headings, lines, len(ordered) - len(lines))


def ratio_field(ratio: Ratio | None) -> Field:
    """A ratio with its interval; one that is not paired says so."""
    if ratio is None:
        return MISSING
    note = ""
    if ratio.interval:
        note = f"{number(ratio.low)} to {number(ratio.high)}"
        note += "" if ratio.paired else ", not paired"
    return Field(number(ratio.value), ratio.value, note)


def _line(row: pd.Series, counters: list[str], ratio: Ratio | None, scale: float) -> Line:
    timed = bool(row["timed"])
    interval = ""
    if timed and pd.notna(row["total_ms_ci_low"]) and pd.notna(row["total_ms_ci_high"]):
        interval = f"{number(row['total_ms_ci_low'])} to {number(row['total_ms_ci_high'])}"
    times = [_figure(row[f"{part}_ms_median"] if timed else None) for part in ("build", "trace")]
    total = _figure(row["total_ms_median"] if timed else None, interval)
    memory = row["memory_bytes"]
    build, trace = ((field.value or 0.0) / scale for field in times)
    return Line(
        contender=row["contender"],
        colour=structure_colour(row["structure"]),
        verdict=row["verdict"] or "no verdict",
        fields=(
            total,
            *times,
            _figure(row.get("trace_net_ms_median") if timed else None),
            ratio_field(ratio),
            _figure(row.get("mrays_per_s") if timed else None),
            MISSING if pd.isna(memory) else Field(size_in_words(memory), memory),
            *(_figure(row[name]) for name in counters),
        ),
        build_share=min(build, 1.0),
        trace_share=max(min(trace, 1.0 - build), 0.0),
        off_the_scale=build + trace > 1.0,
    )


def _figure(value: float | None, note: str = "") -> Field:
    if value is None or pd.isna(value):
        return MISSING
    return Field(number(value), value, note)


def _counter_title(name: str) -> str:
    return name.removesuffix(COUNTER_SUFFIX).replace("_", " ")


def _scale(totals: pd.Series) -> float:
    near = totals[totals <= _FAR * totals.median()]
    return near.max() if len(near) > 0 and near.max() > 0 else 1.0
