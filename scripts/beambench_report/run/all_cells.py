"""The rows of results.csv in compact form, for the table that the browser sorts and filters.

Strings are indices into a list of all strings; figures are rounded to the precision of a table; a
column with the same value in all rows is stored once.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from pandas.api.types import is_numeric_dtype

from beambench_report.base.columns import Column, dictionary
from beambench_report.base.quantities import DASH, number
from beambench_report.base.records import Run

_DIGITS = 5
# Columns that are shown from the start; the others are shown with their group.
_FIRST_SHOWN = (
    "repetitions build_ms_median trace_ms_median total_ms_median mrays_per_s memory_bytes "
    "primitive_tests_per_ray verdict"
).split()
_MOST_WRITTEN = 500
"""The most rows of the table that a page shows without JavaScript."""
_OWN = ("contender", "subject", "view", "is_tuned", "kind", "timed")
"""The columns that `Run` adds."""
_NAMES = {
    "contender": "The structure, with the parameters that differ between rows of this run.",
    "view": "What the rays see: the scene, and whatever else differs between rows of this run.",
    "resolution": "Width and height of the image.",
}


@dataclass(frozen=True)
class AllCells:
    """The packed rows as JSON, the omitted columns, and the rows shown without JavaScript."""

    rows: int
    packed: str
    headings: list[str]
    written: list[list[str]]
    """The first rows, with the columns that are shown first."""
    same_everywhere: list[tuple[str, str]]

    @property
    def unwritten(self) -> int:
        """Counts the rows that need JavaScript."""
        return self.rows - len(self.written)


def pack(run: Run, own: Mapping[str, Column] | None = None) -> AllCells:
    """Packs every nonempty column of a run; `own` has the entries of columns in no record."""
    own = own or {}
    rows = run.rows
    sizes = rows["width"].map("{:.0f}x".format) + rows["height"].map("{:.0f}".format)
    texts = {name: sizes if name == "resolution" else rows[name] for name in _NAMES}
    columns = [
        {"name": name, "group": "", "unit": "", "meaning": _NAMES[name], "first": True}
        | _pack_texts(own_texts)
        for name, own_texts in texts.items()
    ]
    same = []
    for name in rows.columns.drop([*_OWN]):
        series = rows[name]
        entry = own.get(name) or dictionary().find(name) or _unknown(series)
        first = series.iloc[0]
        nothing = series.isna().all() if entry.is_number else (series == "").all()
        if nothing and name != "verdict":
            continue
        if len(rows) > 1 and name not in _FIRST_SHOWN and (series == first).all():
            same.append((name, f"{first:.10g}" if isinstance(first, float) else str(first)))
            continue
        packed = _pack_figures(series) if entry.is_number else _pack_texts(series)
        columns.append(
            {
                "name": name,
                "group": entry.group,
                "unit": entry.unit,
                "meaning": entry.meaning,
                "first": name in _FIRST_SHOWN,
                **packed,
            }
        )
    packed = json.dumps({"rows": len(rows), "columns": columns}, separators=(",", ":"))
    shown = [column for column in columns if column["first"]]
    written = [
        [_written(column, row) for column in shown] for row in range(min(len(rows), _MOST_WRITTEN))
    ]
    headings = [column["name"] for column in shown]
    return AllCells(len(rows), packed.replace("<", "\\u003c"), headings, written, same)


def _written(column: dict, row: int) -> str:
    if "words" in column:
        return column["words"][column["at"][row]]
    figure = column["figures"][row]
    return DASH if figure is None else number(figure)


def _unknown(series: pd.Series) -> Column:
    """Returns an entry for an unknown column: a newer beambench may add columns."""
    kind = "number" if is_numeric_dtype(series) else "text"
    return Column(str(series.name), "", kind, "", "Not in the data dictionary.", "")


def _pack_texts(series: pd.Series) -> dict:
    places, words = pd.factorize(series)
    return {"words": list(words), "at": places.tolist()}


def _pack_figures(series: pd.Series) -> dict:
    """Packs figures: whole numbers exactly, others rounded; null if not measured."""
    values = series.to_numpy(float)
    finite = np.isfinite(values)
    known = values[finite]
    is_whole = (known == np.round(known)).all()
    rounded = iter((known.astype(np.int64) if is_whole else _rounded(known)).tolist())
    return {"figures": [next(rounded) if there else None for there in finite]}


def _rounded(values: np.ndarray) -> np.ndarray:
    """Rounds to `_DIGITS` significant digits; np.round counts digits after the point."""
    magnitude = np.floor(np.log10(np.abs(values), where=values != 0, out=np.zeros_like(values)))
    factor = 10.0 ** (_DIGITS - 1 - magnitude)
    return np.round(values * factor) / factor
