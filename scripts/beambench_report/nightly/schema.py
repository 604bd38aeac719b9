"""The schema of the history: one SQLite file, rebuilt from the CSVs of its runs at any time.

nights      a row for each run; `folder` is where its results.csv lies, beside the history's file
cells       what was asked of whom: the columns that tell a row of results.csv from the others
inputs      hashes of scene and rays; a night with other hashes answered another question
work        counters a ray as JSON, sorted by name; they repeat from night to night, so kept once
figures     a row for each cell of each night; NULL is not measured, or not judged right
alarms      what a night raised its voice about, kept so that no later night does so again

`machine_id` of a night is the column's, with the processor behind it where the run's manifest names
it: a series holds nights of one machine only.

`ratio` is the total, in clock cycles during which the thread ran (see night.cycles), over that of
the contender `reference` of the same run and the same rays.
"""

from __future__ import annotations

SCHEMA_VERSION = 1

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
  wrong INTEGER NOT NULL
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
