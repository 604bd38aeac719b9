"""The nights of one machine as arrays: a row for each night, a column for each cell."""

import json
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from beambench_operations.history.store import History
from beambench_report.base.cell_files import IDENTITY
from beambench_report.base.columns import RENAMED_COLUMNS
from beambench_report.base.files import Problem
from beambench_report.base.names import with_names
from beambench_report.base.records import BASELINE

_DISTINGUISHING = {"camera": ", camera {}", "samples": ", {} samples", "ray_kind": ", {} rays"}


@dataclass(frozen=True)
class Nights:
    """The recorded nights of one machine, the oldest first; the last one is `tonight`.

    Only cells of the last night are included. `ratios` are NaN where a night has no time, or where
    its inputs (scene, rays or reference) differ from those of the last night.
    """

    nights: pd.DataFrame
    """number, run_id, time_utc, commit, dirty, folder, cells, wrong, in_blocks"""
    cells: pd.DataFrame
    """IDENTITY, the names of `with_names`, `verdict` tonight, `is_reference`"""
    ratios: np.ndarray
    errors: np.ndarray
    """Standard errors of the logarithms of the ratios, from the blocks of each night."""
    works: np.ndarray
    """The number of each cell's set of counters in each night; -1 where the inputs differ."""
    counters: dict[int, dict[str, float]]

    @cached_property
    def pools(self) -> pd.DataFrame:
        """The series that are tested: a contender over a scene, with its resolutions pooled."""
        names = [name for name in IDENTITY if name not in ("width", "height")]
        tested = self.cells[~self.cells["is_reference"] & (self.cells["verdict"] != BASELINE)]
        groups = tested.groupby(names, sort=False)
        named = [name for name in _DISTINGUISHING if self.cells[name].nunique() > 1]
        rows = []
        for key, group in groups:
            row = dict(zip(names, key, strict=True))
            row["title"] = series_title(group["contender"].iloc[0], row, named)
            rows.append({**row, "members": group.index.to_numpy()})
        return pd.DataFrame(rows, columns=[*names, "title", "members"])

    def pooled(self) -> np.ndarray:
        """Returns the logarithm of the ratio of each pool in each night, relative to its median.

        Each resolution is centered on its own median, and the mean is taken over the resolutions
        that a night has.
        """
        with np.errstate(all="ignore"):
            logs = np.log(self.ratios)
        logs[~np.isfinite(logs)] = np.nan
        logs = logs - nan_median(logs)
        columns = [nan_mean(logs[:, members]) for members in self.pools["members"]]
        return np.stack(columns, axis=1) if columns else np.empty((len(self.nights), 0))


def series_title(contender: str, row: Mapping[str, object], named: Iterable[str]) -> str:
    """Returns the series as shown to people: the contender, the scene, and further details."""
    title = f"{contender} in {row['scene']}"
    return title + "".join(_DISTINGUISHING[name].format(row[name]) for name in named)


def nan_median(values: np.ndarray) -> np.ndarray:
    """Returns the median of each column; NaN, without a warning, where a column is empty."""
    with warnings.catch_warnings(action="ignore", category=RuntimeWarning):
        return np.nanmedian(values, axis=0)


def nan_mean(values: np.ndarray) -> np.ndarray:
    """Returns the mean of each row; NaN, without a warning, where a row is empty."""
    with warnings.catch_warnings(action="ignore", category=RuntimeWarning):
        return np.nanmean(values, axis=1)


def read_nights(
    history: History, last: int | None = None, most: int | None = None, *, compared: bool = False
) -> Nights:
    """Returns the nights up to the night `last` (default: the newest night), on its machine.

    Of these, it returns the newest `most` (default: all). With `compared`, an earlier night is
    included only if both it and the last night were measured in blocks.
    """
    tonight = _tonight(history, last)
    names = "id run_id time_utc commit_hash dirty folder cells wrong in_blocks".split()
    columns = ", ".join(f"n.{name}" for name in names)
    only = "AND (n.id = t.id OR n.in_blocks AND t.in_blocks) " if compared else ""
    rows = history.read(
        f"SELECT {columns} FROM nights n, nights t WHERE t.id = ? AND n.machine_id = t.machine_id "
        f"AND (n.time_utc, n.id) <= (t.time_utc, t.id) {only}"
        "ORDER BY n.time_utc DESC, n.id DESC LIMIT ?",
        (tonight, most or -1),
    )[::-1]
    nights = pd.DataFrame(rows, columns=names)
    nights = nights.rename(columns={"id": "number", "commit_hash": "commit"})
    cells = _cells_of(history, tonight)
    shape = (len(nights), len(cells))
    ratios, errors, works = np.full(shape, np.nan), np.full(shape, np.nan), np.full(shape, -1)
    # One query is faster than a separate look-up for each night.
    figures = history.read(
        "SELECT f.night, f.cell, f.work, f.ratio, f.error, f.reference IS t.reference "
        "FROM figures f JOIN figures t ON t.cell = f.cell AND t.input = f.input "
        "WHERE t.night = ? AND f.night >= ?",
        (tonight, int(nights["number"].min())),
    )
    names = ["night", "cell", "work", "ratio", "error", "same_reference"]
    known = pd.DataFrame(figures, columns=names)
    known = known[known["night"].isin(nights["number"])]
    at = (
        pd.Index(nights["number"]).get_indexer(known["night"]),
        pd.Index(cells["cell"]).get_indexer(known["cell"]),
    )
    works[at] = known["work"]
    ratios[at] = known["ratio"].where(known["same_reference"] == 1).astype(float)
    errors[at] = known["error"].astype(float)
    used = set(np.unique(works[works >= 0]).tolist())
    counters = {
        number: {RENAMED_COLUMNS.get(name, name): value for name, value in json.loads(text).items()}
        for number, text in history.read("SELECT id, counters FROM work")
        if number in used
    }
    return Nights(nights, cells, ratios, errors, works, counters)


def _tonight(history: History, last: int | None) -> int:
    if last is not None:
        return last
    newest = history.read("SELECT id FROM nights ORDER BY time_utc DESC, id DESC LIMIT 1")
    if not newest:
        raise Problem(f"{history.path}: holds no night yet; run scripts/nightly")
    return newest[0][0]


def _cells_of(history: History, night: int) -> pd.DataFrame:
    names = ", ".join(f"c.{name}" for name in IDENTITY)
    rows = history.read(
        f"SELECT c.id, {names}, f.verdict, f.reference IS c.id FROM figures f "
        "JOIN cells c ON c.id = f.cell WHERE f.night = ? ORDER BY c.id",
        (night,),
    )
    cells = pd.DataFrame(rows, columns=["cell", *IDENTITY, "verdict", "is_reference"])
    cells["is_reference"] = cells["is_reference"].astype(bool)
    return with_names(cells)
