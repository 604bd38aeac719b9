"""Reads the results.csv of a run and checks that it has what plots and pages need."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import pandas as pd
from pandas.api.types import is_bool_dtype, is_numeric_dtype

from beambench import InputError
from beambench_report.base.columns import COUNTER_SUFFIX, RENAMED_COLUMNS, dictionary
from beambench_report.base.csv_texts import unguarded
from beambench_report.base.files import Problem
from beambench_report.base.names import with_names
from beambench_report.base.run_log import has_log

# Columns that plots and pages cannot do without.
NEEDED_COLUMNS = (
    "run_id commit dirty machine_id threads "
    "scene camera primitives structure parameters width height samples ray_kind rays "
    "build_ms_median trace_ms_median total_ms_median total_ms_ci_low total_ms_ci_high "
    "memory_bytes verdict"
).split()
VERSION_COLUMN = "schema_version"

OK, BASELINE = TIMED_VERDICTS = ("ok", "baseline")
ERROR = "error"  # the structure could not be built
REFERENCES = ("null", "exhaustive")
"""Structures that do not compete: one finds nothing, one tests everything."""
NO_RAYS = "no_rays"  # the scene has no rays of the kind: nothing was measured or wrong
UNSUPPORTED = "unsupported"  # the structure does not support these rays or primitives
FAULTLESS_VERDICTS = (*TIMED_VERDICTS, NO_RAYS, UNSUPPORTED)


@dataclass(frozen=True)
class Run:
    """One run: a row per cell, as in results.csv, and the names that plots and pages use.

    Besides the columns of the file there are the columns of `with_names` and `timed`: whether the
    row's times count.
    """

    directory: Path
    rows: pd.DataFrame

    @property
    def views(self) -> list[str]:
        """Returns the titles of the views, in the order of the file."""
        return self.rows["view"].unique().tolist()

    @property
    def counters(self) -> list[str]:
        """Returns the counter columns that are not empty, in the order of the file."""
        return self._counters(of_a_kind=False)

    @property
    def counters_by_kind(self) -> list[str]:
        """Returns the counter columns for single kinds of rays of whole pictures."""
        return self._counters(of_a_kind=True)

    def _counters(self, *, of_a_kind: bool) -> list[str]:
        known = self.rows.filter(regex=f"{COUNTER_SUFFIX}$").dropna(axis="columns", how="all")
        columns = {name: dictionary().find(name) for name in known}
        return [
            name for name, one in columns.items() if bool(one and one.is_of_a_kind) is of_a_kind
        ]

    def view(self, title: str) -> pd.DataFrame:
        """Returns the rows of one view."""
        return self.rows[self.rows["view"] == title]

    def finest(self, title: str) -> pd.DataFrame:
        """Returns the rows of one view with its `finest_rays`."""
        rows = self.view(title)
        return rows[rows["rays"] == finest_rays(rows)]


def in_blocks(rows: pd.DataFrame) -> bool:
    """Returns whether the run was measured in blocks; older runs are medians of one process."""
    return "blocks" in rows and bool(rows["blocks"].notna().any())


def finest_rays(rows: pd.DataFrame) -> float:
    """Returns the highest ray count of at least two contenders; with one contender, its highest.

    In an interrupted run, the last resolution may have only one cell.
    """
    others = rows[~rows["structure"].isin(REFERENCES)].groupby("rays")["contender"].nunique()
    return max(others.index[others > 1], default=rows["rays"].max())


def contenders_with_times(rows: pd.DataFrame) -> pd.DataFrame:
    """Returns the rows that can be compared; a baseline is not a contender."""
    return rows[rows["timed"] & (rows["verdict"] != BASELINE) & (rows["total_ms_median"] > 0)]


def size_of(row: Mapping[str, object]) -> str:
    """Returns the resolution of a row: `320x200`."""
    return f"{row['width']:.0f}x{row['height']:.0f}"


def read_run(directory: Path) -> Run:
    """Reads DIRECTORY/results.csv. Raises Problem naming the file, column and row at fault."""
    path = directory / "results.csv"
    try:
        status = path.stat()
    except OSError:
        return Run(directory, _read(path))  # its message is already clear
    return Run(directory, _known(path, status.st_ino, status.st_size, status.st_mtime_ns).copy())


@lru_cache(maxsize=256)
def _known(path: Path, *_status: int) -> pd.DataFrame:
    """Returns the rows of a file, cached while it is unchanged: published texts share files."""
    return _read(path)


def _read(path: Path) -> pd.DataFrame:
    rows = _read_csv(path)
    _require_version(rows, path)
    missing = [name for name in NEEDED_COLUMNS if name not in rows]
    if missing:
        raise Problem(
            f"{path}: the columns {', '.join(missing)} are missing; "
            "was it written by another version of beambench?"
        )
    if rows.empty:
        raise Problem(f"{path}: has no rows; the run was cut off before its first cell ended")

    for name in rows.columns:
        column = dictionary().find(name)
        if column and column.is_number:
            rows[name] = _numbers(rows[name], path)
        elif column or not is_numeric_dtype(rows[name]):  # figures in unknown columns stay numbers
            rows[name] = rows[name].astype(str).where(rows[name].notna(), "")
    for name in ("scene", "structure", "rays"):
        empty = rows.index[rows[name].isna() | (rows[name] == "")]
        if len(empty) > 0:
            raise Problem(f"{path}, row {empty[0] + 2}: {name} is empty")

    for name in ("trace_ms", "total_ms"):
        if name not in rows or rows[name].isna().all():  # a record of one process
            rows = rows.copy().assign(**{name: rows[f"{name}_median"]})
    if "outpaced" in rows:  # another parameter set represents the contender
        rows = rows[rows["outpaced"] != "true"].reset_index(drop=True)
    try:
        rows = with_names(rows)
    except InputError as error:
        raise Problem(f"{path}: {error}") from None
    rows["timed"] = rows["verdict"].isin(TIMED_VERDICTS) & rows["total_ms_median"].notna()
    return rows


def _read_csv(path: Path) -> pd.DataFrame:
    texts = {column.name: str for column in dictionary().columns if not column.is_number}
    texts[VERSION_COLUMN] = str
    try:
        # `null` is a structure's name, so only an empty field means "not measured".
        rows = pd.read_csv(
            path, dtype=texts, keep_default_na=False, na_values=[""], low_memory=False
        )
        return unguarded(rows).rename(columns=RENAMED_COLUMNS)
    except FileNotFoundError:
        remedy = "give the folder that `beambench run` wrote"
        if has_log(path.parent):
            remedy = f"the run was cut off; resume it, or: beambench analyze --write {path.parent}"
        raise Problem(f"{path}: there is no such file; {remedy}") from None
    except (OSError, UnicodeDecodeError, pd.errors.ParserError, pd.errors.EmptyDataError) as error:
        raise Problem(f"{path}: cannot be read as CSV: {error}") from None


def _require_version(rows: pd.DataFrame, path: Path) -> None:
    """Rejects other versions: guessing the meaning of their columns could be silently wrong."""
    known = dictionary().schema_version
    if VERSION_COLUMN not in rows:
        raise Problem(
            f"{path}: there is no column {VERSION_COLUMN}, so it was written by an older beambench "
            "or by something else; measure anew"
        )
    others = rows.index[
        ~rows[VERSION_COLUMN].astype(str).isin([str(one) for one in range(1, known + 1)])
    ]
    if len(others) > 0:
        raise Problem(
            f"{path}, row {others[0] + 2}: {VERSION_COLUMN} is "
            f"'{rows[VERSION_COLUMN][others[0]]}', but only versions 1 to {known} can be read; use "
            "the scripts of the commit that the row names, or measure anew"
        )


def _numbers(column: pd.Series, path: Path) -> pd.Series:
    if is_numeric_dtype(column) and not is_bool_dtype(column):
        return column.astype(float)
    numbers = pd.to_numeric(column.astype(str).where(column.notna()), errors="coerce")
    wrong = column[numbers.isna() & column.notna() & (column.astype(str).str.lower() != "nan")]
    if not wrong.empty:
        raise Problem(
            f"{path}, row {wrong.index[0] + 2}: {column.name} is '{wrong.iloc[0]}', not a number"
        )
    return numbers.astype(float)
