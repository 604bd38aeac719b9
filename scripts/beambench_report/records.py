"""Reads the results.csv of a run and checks that it holds what the plots need."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from beambench_report.names import contender_labels, view_titles
from beambench_report.problem import Problem

TEXT_COLUMNS = (
    "run_id",
    "commit",
    "dirty",
    "machine_id",
    "scene",
    "camera",
    "structure",
    "parameters",
    "ray_kind",
    "verdict",
)
COUNT_COLUMNS = ("threads", "primitives", "width", "height", "samples", "rays")
MEASURE_COLUMNS = (
    "build_ms_median",
    "trace_ms_median",
    "total_ms_median",
    "total_ms_ci_low",
    "total_ms_ci_high",
    "memory_bytes",
)
COUNTER_SUFFIX = "_per_ray"

TIMED_VERDICTS = ("ok", "baseline")


@dataclass(frozen=True)
class Run:
    """One run: a row a cell, as in results.csv, and what the plots call things.

    Columns added to those of the file: `contender` (label of structure and parameters), `view`
    (title of what the rays see) and `timed` (do the row's times count?).
    """

    directory: Path
    rows: pd.DataFrame

    @property
    def views(self) -> list[str]:
        """The titles of the views, in the order of the file."""
        return list(dict.fromkeys(self.rows["view"]))

    @property
    def counters(self) -> list[str]:
        """The counter columns that hold anything, in the order of the file."""
        names = [name for name in self.rows if str(name).endswith(COUNTER_SUFFIX)]
        return [name for name in names if self.rows[name].notna().any()]

    def view(self, title: str) -> pd.DataFrame:
        """The rows of one view."""
        return self.rows[self.rows["view"] == title]

    def finest(self, title: str) -> pd.DataFrame:
        """The rows of one view at the highest number of rays."""
        rows = self.view(title)
        return rows[rows["rays"] == rows["rays"].max()]


def read_run(directory: Path) -> Run:
    """Reads DIRECTORY/results.csv. Raises Problem naming the file, column and row at fault."""
    path = directory / "results.csv"
    # `null` is the name of a structure, so that only an empty field means "not measured".
    try:
        rows = pd.read_csv(path, dtype=str, keep_default_na=False, na_values=[""])
    except FileNotFoundError:
        raise Problem(
            f"{path}: there is no such file; give the folder that `beambench run` wrote"
        ) from None
    except (OSError, UnicodeDecodeError, pd.errors.ParserError, pd.errors.EmptyDataError) as error:
        raise Problem(f"{path}: cannot be read as CSV: {error}") from None

    wanted = TEXT_COLUMNS + COUNT_COLUMNS + MEASURE_COLUMNS
    missing = [name for name in wanted if name not in rows]
    if missing:
        raise Problem(
            f"{path}: the columns {', '.join(missing)} are missing; "
            "was it written by another version of beambench?"
        )
    if rows.empty:
        raise Problem(f"{path}: holds no row; the run was cut off before its first cell ended")

    for name in TEXT_COLUMNS:
        rows[name] = rows[name].fillna("")
    counters = [name for name in rows if name.endswith(COUNTER_SUFFIX)]
    for name in (*COUNT_COLUMNS, *MEASURE_COLUMNS, *counters):
        rows[name] = _numbers(rows[name], path)
    _require_values(rows, path, ("scene", "structure", "rays"))

    rows["contender"] = contender_labels(rows)
    rows["view"] = view_titles(rows)
    rows["timed"] = rows["verdict"].isin(TIMED_VERDICTS) & rows["total_ms_median"].notna()
    return Run(directory, rows)


def _numbers(column: pd.Series, path: Path) -> pd.Series:
    numbers = pd.to_numeric(column, errors="coerce")
    wrong = column[numbers.isna() & column.notna() & (column.str.lower() != "nan")]
    if not wrong.empty:
        raise Problem(
            f"{path}, row {wrong.index[0] + 2}: {column.name} is '{wrong.iloc[0]}', not a number"
        )
    return numbers.astype(float)


def _require_values(rows: pd.DataFrame, path: Path, columns: tuple[str, ...]) -> None:
    for name in columns:
        empty = rows.index[rows[name].isna() | (rows[name] == "")]
        if len(empty) > 0:
            raise Problem(f"{path}, row {empty[0] + 2}: {name} is empty")
