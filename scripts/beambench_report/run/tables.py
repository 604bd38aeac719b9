"""The tables of a page: times and memory, work per ray, and all contenders over all views."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import log2

import pandas as pd

from beambench.analysis import Ratio
from beambench_report.base.columns import COUNTER_SUFFIX
from beambench_report.base.palette import css_color
from beambench_report.base.quantities import number, size_in_words
from beambench_report.base.records import BASELINE, REFERENCES, size_of
from beambench_report.run.reference import Compared


@dataclass(frozen=True)
class Heading:
    """The head of a column; `column` names its entry in the data dictionary."""

    title: str
    unit: str = ""
    column: str = ""
    is_number: bool = True


@dataclass(frozen=True)
class Field:
    """A field: its text, its sort key, and a note in smaller print."""

    text: str
    value: float | str | None
    note: str = ""


@dataclass(frozen=True)
class Line:
    """A contender's line; the shares are the lengths of its bars, 1 being the whole width."""

    contender: str
    """The contender's label; if it is tuned, with the parameters that represent it."""
    color: str
    verdict: str
    fields: tuple[Field, ...]
    anchor: str = ""
    """The anchor of the contender's cell, for links to it."""
    is_reference: bool = False
    """Whether the contender is `null` or `exhaustive`, which are listed apart."""
    build_share: float = 0.0
    trace_share: float = 0.0
    off_the_scale: bool = False


@dataclass(frozen=True)
class Table:
    """Headings and lines; lines beyond what a page can show are only counted."""

    caption: str
    headings: tuple[Heading, ...]
    lines: tuple[Line, ...]
    unshown: int = 0
    left_out: tuple[tuple[str, str], ...] = ()
    """Contenders without a row in this table, each with the reason."""


MISSING = Field("–", None)  # noqa: RUF001
_MOST_LINES = 60
_FAR = 12  # times of more than this many medians would flatten the other bars


def view_table(
    caption: str,
    rows: pd.DataFrame,
    ratios: Mapping[str, Ratio],
    reference: str | None,
    left_out: tuple[tuple[str, str], ...] = (),
) -> Table:
    """Returns times and memory: by trace time, then contenders without times, then references."""
    ordered = _in_order(rows)
    headings = (
        Heading("trace", "ns per ray", "trace_ms"),
        Heading("trace", "ms", "trace_ms"),
        Heading("build", "ms", "build_ms_median"),
        Heading("total", "ms", "total_ms_median"),
        Heading("total", f"times {reference}" if reference else "ratio"),
        Heading("trace, net", "ms", "trace_net_ms_median"),
        Heading("speed", "Mrays/s", "mrays_per_s"),
        Heading("memory", "", "memory_bytes"),
        Heading("SIMD", "", "structure_isa", is_number=False),
    )
    scale = _scale(ordered.loc[ordered["timed"], "total_ms_median"])
    lines = tuple(
        _line(row, ratios.get(row["contender"]), scale)
        for _, row in ordered.head(_MOST_LINES).iterrows()
    )
    present = set(rows["contender"])
    absent = tuple(one for one in left_out if one[0] not in present)
    return Table(caption, headings, lines, len(ordered) - len(lines), absent)


def work_table(caption: str, rows: pd.DataFrame, counters: list[str]) -> Table | None:
    """Returns the table of counters per ray; None if nothing was counted."""
    counters = [name for name in counters if rows[name].notna().any() and (rows[name] != 0).any()]
    counted = rows[rows[counters].notna().any(axis=1)] if counters else rows.iloc[:0]
    if counted.empty:
        return None
    headings = tuple(
        Heading(name.removesuffix(COUNTER_SUFFIX).replace("_", " "), "", name) for name in counters
    )
    lines = tuple(
        _bare_line(row, tuple(_figure(row[name]) for name in counters))
        for _, row in _in_order(counted).head(_MOST_LINES).iterrows()
    )
    return Table(caption, headings, lines)


def _in_order(rows: pd.DataFrame) -> pd.DataFrame:
    """Returns the rows by trace time, the fastest first, references last."""
    times = rows["trace_ms"].where(rows["timed"])
    keys = pd.DataFrame({"reference": rows["structure"].isin(REFERENCES), "time": times})
    return rows.loc[keys.sort_values(["reference", "time"], kind="stable").index]


def _bare_line(row: pd.Series, fields: tuple[Field, ...]) -> Line:
    return Line(
        f"{row['contender']}: {row['parameters']}" if row["is_tuned"] else row["contender"],
        css_color(row["structure"]),
        row["verdict"] or "no verdict",
        fields,
        cell_anchor(row),
        row["structure"] in REFERENCES,
    )


def cell_anchor(row: Mapping[str, object]) -> str:
    """Returns the name by which a link opens one cell; templates/cells.js makes the same."""
    words = f"{row['view']} {size_of(row)} {row['contender']}"
    return "cell-" + re.sub(r"[^a-z0-9]+", "-", words.lower()).strip("-")


def ratio_field(ratio: Ratio | None) -> Field:
    """Formats a ratio with its interval; an unpaired ratio is marked."""
    if ratio is None:
        return MISSING
    note = ""
    if ratio.interval and ratio.low != ratio.high:  # equal for a contender over itself
        note = f"{number(ratio.low)} to {number(ratio.high)}"
        note += "" if ratio.paired else ", not paired"
    return Field(number(ratio.value), ratio.value, note)


def _line(row: pd.Series, ratio: Ratio | None, scale: float) -> Line:
    timed = bool(row["timed"])

    def time(part: str, factor: float = 1.0) -> Field:
        if not timed:
            return MISSING
        low, high = (
            row.get(f"{part}_ms_ci_{end}", float("nan")) * factor for end in ("low", "high")
        )
        note = f"{number(low)} to {number(high)}" if pd.notna(low) and pd.notna(high) else ""
        return _figure(row["trace_ms" if part == "trace" else f"{part}_ms_median"] * factor, note)

    build, trace = time("build"), time("trace")
    memory = row["memory_bytes"]
    shares = [(field.value or 0.0) / scale for field in (build, trace)]
    fields = (
        time("trace", 1e6 / row["rays"] if row["rays"] > 0 else float("nan")),
        trace,
        build,
        time("total"),
        ratio_field(ratio),
        _figure(row.get("trace_net_ms_median") if timed else None),
        _figure(row.get("mrays_per_s") if timed else None),
        MISSING if pd.isna(memory) else Field(size_in_words(memory), memory),
        _simd(row.get("structure_isa") or ""),
    )
    return replace(
        _bare_line(row, fields),
        build_share=min(shares[0], 1.0),
        trace_share=max(min(shares[1], 1.0 - shares[0]), 0.0),
        off_the_scale=sum(shares) > 1.0,
    )


def _simd(isa: str) -> Field:
    return Field(isa or "none", isa)


def _figure(value: float | None, note: str = "") -> Field:
    if value is None or pd.isna(value):
        return MISSING
    return Field(number(value), value, note)


def _scale(totals: pd.Series) -> float:
    near = totals[totals <= _FAR * totals.median()]
    return near.max() if len(near) > 0 and near.max() > 0 else 1.0


_DEEPEST = 4.0  # doublings at which the shade is darkest


@dataclass(frozen=True)
class Mark:
    """A field of the overview, shaded by its ratio to the reference."""

    field: Field
    verdict: str
    side: str
    depth: float


@dataclass(frozen=True)
class Comparison:
    """A table with a row for each contender and a column for each view."""

    reference: str
    views: tuple[str, ...]
    lines: tuple[tuple[str, str, tuple[Mark, ...]], ...]
    """A contender, its color, and its marks in the order of the views."""


def compare(reference: str, finest: Mapping[str, Compared]) -> Comparison:
    """Returns the overview of all views, each at its highest resolution."""
    structures: dict[str, str] = {}
    verdicts: dict[tuple[str, str], str] = {}
    for view, shown in finest.items():
        for row in shown.rows.itertuples():
            structures.setdefault(row.contender, row.structure)
            verdicts[row.contender, view] = row.verdict

    def order(contender: str) -> tuple[bool, bool, float]:
        ratios = [shown.ratios.get(contender) for shown in finest.values()]
        values = [log2(one.value) for one in ratios if one is not None and one.value > 0]
        mean = sum(values) / len(values) if values else 0.0
        return structures[contender] in REFERENCES, not values, mean

    structures = {contender: structures[contender] for contender in sorted(structures, key=order)}
    lines = tuple(
        (
            contender,
            css_color(structure),
            tuple(
                _mark(shown.ratios.get(contender), verdicts.get((contender, view)))
                for view, shown in finest.items()
            ),
        )
        for contender, structure in structures.items()
    )
    return Comparison(reference, tuple(finest), lines)


def _mark(ratio: Ratio | None, verdict: str | None) -> Mark:
    if verdict is None:
        return Mark(MISSING, "", "", 0.0)
    if ratio is None or ratio.value <= 0 or verdict == BASELINE:
        return Mark(ratio_field(ratio), verdict, "", 0.0)
    doublings = log2(ratio.value)
    side = "slower" if doublings > 0 else "faster"
    return Mark(ratio_field(ratio), verdict, side, min(abs(doublings) / _DEEPEST, 1.0))
