"""The data of a run's plots: its rows in ns per ray, its repetitions, and its analysis."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import nan
from pathlib import Path

import pandas as pd

from beambench.analysis import median_interval
from beambench_report.base.analysis import Analysis, read_analysis
from beambench_report.base.cell_files import (
    CellFile,
    Identity,
    identity,
    median_of,
    read_cell_files,
)
from beambench_report.base.figure import Look, looks
from beambench_report.base.names import machine_label
from beambench_report.base.quantities import number
from beambench_report.base.records import REFERENCES, Run, finest_rays, read_run


@dataclass(frozen=True)
class Measured:
    """A run and the repetitions of its cells, as far as they exist."""

    run: Run
    files: Mapping[Identity, CellFile]

    @cached_property
    def looks(self) -> dict[str, Look]:
        """Returns the look of every contender."""
        return looks(self.run.rows)

    @cached_property
    def analysis(self) -> Analysis:
        """Returns the conclusions from the run."""
        return read_analysis(self.run.directory)

    @cached_property
    def timed(self) -> pd.DataFrame:
        """Returns the rows whose times count, with columns in ns per ray.

        Columns added: `ns`, `ns_low` and `ns_high` (the 95% interval; nan without one), `repeated`
        (the ns of every repetition) and `is_reference`.
        """
        rows = self.run.rows
        rows = rows[rows["timed"] & (rows["trace_ms"] > 0) & (rows["rays"] > 0)]
        rows = rows.drop_duplicates(["view", "contender", "rays"], keep="last")
        cells = [self._cell(row) for _, row in rows.iterrows()]
        added = pd.DataFrame(
            cells, index=rows.index, columns=["ns", "ns_low", "ns_high", "repeated"]
        )
        return rows.join(added).assign(is_reference=rows["structure"].isin(REFERENCES))

    def finest(self, view: str) -> pd.DataFrame:
        """Returns the timed rows of a view at their `finest_rays`, the fastest first."""
        rows = self.timed[self.timed["view"] == view]
        return rows[rows["rays"] == finest_rays(rows)].sort_values("ns", kind="stable")

    def _cell(self, row: pd.Series) -> tuple[float, float, float, tuple[float, ...]]:
        scale = 1e6 / row["rays"]
        middle = median_of(row, "trace")
        file = self.files.get(identity(row))
        times = sorted(file.trace_ms.values()) if file else []
        ends = (middle.low, middle.high)
        if None in ends:
            ends = median_interval(times) or ends
        low, high = (nan if end is None else scale * end for end in ends)
        return scale * middle.value, low, high, tuple(scale * time for time in times)


def read_measured(directory: Path) -> Measured:
    """Reads a run's folder."""
    return Measured(read_run(directory), read_cell_files(directory))


def ns_in_words(row: pd.Series) -> str:
    """Formats one cell for hover titles: `35.1 ns per ray (34.9 to 35.4)`."""
    interval = "" if pd.isna(row["ns_low"]) else between(row["ns_low"], row["ns_high"])
    return f"{number(row['ns'])} ns per ray{interval}"


def between(low: float, high: float) -> str:
    """Formats the ends of an interval, in parentheses after a value."""
    return f" ({number(low)} to {number(high)})"


def by_kind(rows: pd.DataFrame, views: Iterable[str]) -> dict[str, list[str]]:
    """Groups the views by kind of rays and, if it varies, by samples per pixel."""
    groups: dict[str, list[str]] = {}
    for view in views:
        first = rows[rows["view"] == view].iloc[0]
        parts = [f"{first['kind']} rays"]
        if rows["samples"].nunique() > 1:
            parts.append(f"{first['samples']:.0f} samples")
        groups.setdefault(", ".join(parts), []).append(view)
    return groups


def short_title(rows: pd.DataFrame, view: str) -> str:
    """Returns a short title of a view: its scene; if ambiguous, with camera and machine."""
    own = rows[rows["view"] == view].iloc[0]
    parts = [own["scene"]]
    if rows.loc[rows["scene"] == own["scene"], "camera"].nunique() > 1:
        parts.append(f"camera {own['camera']}")
    if rows["machine_id"].nunique() > 1:
        parts.append(machine_label(own["machine_id"]))
    return ", ".join(parts)
