"""The history of nightly runs in one SQLite file, which can be rebuilt from the CSVs of its runs.

nights      a row for each run; `folder` contains its results.csv, relative to the history's folder
cells       what was measured: the columns that identify a row of results.csv
inputs      hashes of scene and rays; nights with other hashes are not comparable
work        counters per ray as JSON, sorted by name; stored once, because they repeat nightly
figures     a row for each cell of each night; NULL means not measured, or not verified
alarms      the alarms of each night, stored so that no later night repeats them

`machine_id` of a night is the column's, followed by the processor if the run's manifest names it: a
series contains only nights of one machine.

`ratio` is the total (build and trace) relative to the contender `reference` of the same run and
rays, the geometric mean over the blocks; `error` is the standard error of its logarithm. A night
that was not measured `in_blocks` has ratios of medians, which are shown but never compared.
"""

import json
import sqlite3
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from beambench_operations.history.night import Key, Night, night_of
from beambench_report.base.cell_files import IDENTITY
from beambench_report.base.files import Problem, write_whole
from beambench_report.base.records import read_run

SCHEMA_VERSION = 2

# Marks the file as a history of ours: "bbnh".
APPLICATION_ID = 0x62626E68

TABLES = """
CREATE TABLE nights (
  id INTEGER PRIMARY KEY,
  run_id TEXT NOT NULL UNIQUE,
  time_utc TEXT NOT NULL,
  commit_hash TEXT NOT NULL,
  dirty INTEGER NOT NULL,
  machine_id TEXT NOT NULL,
  folder TEXT NOT NULL,
  csv_sha256 TEXT NOT NULL,
  cells INTEGER NOT NULL,
  wrong INTEGER NOT NULL,
  in_blocks INTEGER NOT NULL DEFAULT 0
);
CREATE TABLE cells (
  id INTEGER PRIMARY KEY,
  scene TEXT NOT NULL,
  camera TEXT NOT NULL,
  structure TEXT NOT NULL,
  parameters TEXT NOT NULL,
  width INTEGER NOT NULL,
  height INTEGER NOT NULL,
  samples INTEGER NOT NULL,
  ray_kind TEXT NOT NULL,
  UNIQUE (scene, camera, structure, parameters, width, height, samples, ray_kind)
);
CREATE TABLE inputs (id INTEGER PRIMARY KEY, hashes TEXT NOT NULL UNIQUE);
CREATE TABLE work (id INTEGER PRIMARY KEY, counters TEXT NOT NULL UNIQUE);
CREATE TABLE figures (
  night INTEGER NOT NULL REFERENCES nights (id) ON DELETE CASCADE,
  cell INTEGER NOT NULL REFERENCES cells (id),
  input INTEGER NOT NULL REFERENCES inputs (id),
  work INTEGER NOT NULL REFERENCES work (id),
  reference INTEGER REFERENCES cells (id),
  verdict TEXT NOT NULL,
  ratio REAL,
  error REAL,
  PRIMARY KEY (night, cell)
) WITHOUT ROWID;
CREATE TABLE alarms (
  night INTEGER NOT NULL REFERENCES nights (id) ON DELETE CASCADE,
  kind TEXT NOT NULL CHECK (kind IN ('time', 'counter', 'verdict')),
  series TEXT NOT NULL,
  details TEXT NOT NULL,
  PRIMARY KEY (night, kind, series)
) WITHOUT ROWID;
"""


_FROM_VERSION_1 = """
ALTER TABLE nights ADD COLUMN in_blocks INTEGER NOT NULL DEFAULT 0;
ALTER TABLE figures ADD COLUMN error REAL;
"""

_REMEDY = "rebuild it from the runs: python -m beambench_operations nightly rebuild"


@dataclass(frozen=True)
class Alarm:
    """An alarm of a night."""

    night: int
    kind: str
    """`time`, `counter` or `verdict`."""
    series: str
    details: dict


FindAlarms = Callable[["History", int], list[Alarm]]
"""A function that returns the alarms of the night with a given number."""


class History:
    """An open history file. Every change is one transaction, stored completely or not at all."""

    def __init__(self, path: Path) -> None:
        """Opens or creates the file. Raises Problem if it is not a history of this version."""
        self.path = path
        path.parent.mkdir(parents=True, exist_ok=True)
        self._base = sqlite3.connect(path, timeout=30, isolation_level=None)
        try:
            with self._problems():
                self._base.execute("PRAGMA foreign_keys = ON")
                self._begin_or_check()
        except BaseException:
            self._base.close()
            raise

    def __enter__(self) -> Self:
        """Returns itself, for `with`."""
        return self

    def __exit__(self, *_: object) -> None:
        """Closes the file."""
        self._base.close()

    def add(self, night: Night, folder: Path, find_alarms: FindAlarms | None = None) -> int | None:
        """Adds a night with its alarms; returns its number, or None if it exists already."""
        if self.number_of(night.run_id) is not None:
            return None
        with self.change():
            number = self._insert_night(night, folder)
            cells = self._cells(night)
            inputs = self._numbers("inputs", "hashes", (one.inputs for one in night.figures))
            work = self._numbers("work", "counters", (one.counters for one in night.figures))
            self._base.executemany(
                "INSERT INTO figures VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
                [
                    (
                        *(number, cells[one.key], inputs[one.inputs], work[one.counters]),
                        *(cells.get(one.reference), one.verdict, one.ratio, one.error),
                    )
                    for one in night.figures
                ],
            )
            alarms = find_alarms(self, number) if find_alarms else []
            self._base.executemany(
                "INSERT INTO alarms VALUES (?, ?, ?, ?)",
                [(number, one.kind, one.series, json.dumps(one.details)) for one in alarms],
            )
        return number

    def alarms(self) -> list[Alarm]:
        """Returns all alarms, the oldest first."""
        rows = self.read("SELECT night, kind, series, details FROM alarms ORDER BY night, series")
        return [Alarm(night, kind, series, json.loads(text)) for night, kind, series, text in rows]

    def number_of(self, run_id: str) -> int | None:
        """Returns the number of a run, or None if the history lacks it."""
        found = self.read("SELECT id FROM nights WHERE run_id = ?", (run_id,))
        return found[0][0] if found else None

    def read(self, query: str, values: tuple = ()) -> list[tuple]:
        """Returns the rows of a query."""
        with self._problems():
            return self._base.execute(query, values).fetchall()

    @contextmanager
    def change(self) -> Iterator[None]:
        """Opens a transaction."""
        with self._problems():
            self._base.execute("BEGIN IMMEDIATE")
            try:
                yield
            except BaseException:
                self._base.execute("ROLLBACK")
                raise
            self._base.execute("COMMIT")

    def _begin_or_check(self) -> None:
        application, version, tables = self._base.execute(
            "SELECT application_id, user_version, (SELECT count(*) FROM sqlite_schema) "
            "FROM pragma_application_id, pragma_user_version"
        ).fetchone()
        if application == version == tables == 0:
            # One script in one transaction, so that no process sees only some of the tables.
            self._base.executescript(
                f"BEGIN; PRAGMA application_id = {APPLICATION_ID};"
                f"PRAGMA user_version = {SCHEMA_VERSION}; {TABLES} COMMIT;"
            )
            return
        if application != APPLICATION_ID:
            raise Problem(f"{self.path}: is an SQLite file, but not a history of nightly runs")
        if version == 1:  # its nights were not measured in blocks
            self._base.executescript(f"BEGIN; {_FROM_VERSION_1} PRAGMA user_version = 2; COMMIT;")
            return
        if version != SCHEMA_VERSION:
            raise Problem(
                f"{self.path}: has schema version {version}, not {SCHEMA_VERSION}; {_REMEDY}"
            )

    @contextmanager
    def _problems(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.DatabaseError as error:
            raise Problem(f"{self.path}: cannot be used as a history: {error}; {_REMEDY}") from None

    def _insert_night(self, night: Night, folder: Path) -> int:
        place = folder.resolve()
        home = self.path.parent.resolve()
        relative = place.relative_to(home) if place.is_relative_to(home) else place
        values = (
            *(night.run_id, night.time_utc, night.commit, int(night.dirty), night.machine_id),
            *(str(relative), night.csv_sha256, len(night.figures), night.wrong),
            int(night.in_blocks),
        )
        marks = ", ".join("?" * len(values))
        cursor = self._base.execute(f"INSERT INTO nights VALUES (NULL, {marks})", values)
        return int(cursor.lastrowid or 0)

    def _cells(self, night: Night) -> dict[Key, int]:
        keys = {one.key for one in night.figures}
        marks = ", ".join("?" * len(IDENTITY))
        self._base.executemany(f"INSERT OR IGNORE INTO cells VALUES (NULL, {marks})", sorted(keys))
        known = self._base.execute(f"SELECT id, {', '.join(IDENTITY)} FROM cells")
        return {tuple(key): number for number, *key in known}

    def _numbers(self, table: str, column: str, texts: Iterable[str]) -> dict[str, int]:
        """Returns the number of each text in a table that stores every text once."""
        wanted = sorted(set(texts))
        self._base.executemany(
            f"INSERT OR IGNORE INTO {table} VALUES (NULL, ?)", [(text,) for text in wanted]
        )
        select = f"SELECT id FROM {table} WHERE {column} = ?"
        return {text: self._base.execute(select, (text,)).fetchone()[0] for text in wanted}


def recorded_folders(runs: Path) -> list[Path]:
    """Returns the folders of finished runs, the oldest first: names begin with the time."""
    return sorted(path.parent for path in runs.glob("[0-9]*/results.csv"))


def rebuild(
    path: Path,
    folders: Iterable[Path],
    find_alarms: FindAlarms | None = None,
) -> int:
    """Rebuilds the history from the CSVs of runs; the old one stays until the new one is complete.

    `find_alarms` is applied to each night as it is added, as when it was new. Returns the number of
    nights.
    """
    nights = [(night_of(read_run(folder)), folder) for folder in folders]
    nights.sort(key=lambda one: (one[0].time_utc, one[0].run_id))

    def fill(pending: Path) -> None:
        pending.unlink(missing_ok=True)
        with History(pending) as history:
            for night, folder in nights:
                if history.add(night, folder, find_alarms) is None:
                    raise Problem(f"{folder}: the run {night.run_id} is in another folder, too")
        # A rollback journal left by a killed process belongs to the file that is being replaced.
        for ending in ("-journal", "-wal", "-shm"):
            path.with_name(path.name + ending).unlink(missing_ok=True)

    write_whole(path, fill)
    return len(nights)
