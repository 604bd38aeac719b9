"""The record of releases: the commit, the files and the checksums of each version."""

import csv
import hashlib
import re
from collections.abc import Iterator, Sequence
from io import StringIO
from pathlib import Path

from beambench_report.base.files import ROOT, Problem, write_text

RECORD = ROOT / ".github/releases.csv"
COLUMNS = ("version", "date", "commit", "file", "bytes", "sha256")
"""A row for each file; a version without files has one row, whose last columns are empty."""
_SHAPES = {
    "version": r"\d+\.\d+\.\d+",
    "date": r"\d{4}-\d\d-\d\d",
    "commit": "[0-9a-f]{40}",
    "file": r"[\w.+-]+|",
    "bytes": r"[1-9]\d*|",
    "sha256": "[0-9a-f]{64}|",
}

Row = dict[str, str]


def read_record(path: Path = RECORD) -> list[Row]:
    """Returns the rows, newest version first. Raises Problem if the record is malformed."""
    with path.open(encoding="utf-8", newline="") as table:
        reader = csv.DictReader(table)
        rows = list(reader)
    if found := next(_faults(reader.fieldnames or [], rows), None):
        raise Problem(f"{path}:{found}")
    return rows


def rows_of(version: str, date: str, commit: str, files: Sequence[Path]) -> list[Row]:
    """Returns the rows of a release, in the order of its files' names."""
    return [
        {
            "version": version,
            "date": date,
            "commit": commit,
            "file": file.name,
            "bytes": str(file.stat().st_size),
            "sha256": hashlib.sha256(file.read_bytes()).hexdigest(),
        }
        for file in sorted(files, key=lambda one: one.name)
    ]


def write_release(rows: Sequence[Row], path: Path = RECORD) -> Path:
    """Puts the rows of a release before those of earlier ones; rows of its version are replaced."""
    versions = {row["version"] for row in rows}
    kept = [row for row in read_record(path) if row["version"] not in versions]
    text = StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows([*rows, *kept])
    return write_text(path, text.getvalue())


def _faults(names: Sequence[str], rows: Sequence[Row]) -> Iterator[str]:
    """Yields the line and the fault of each row that does not match COLUMNS and _SHAPES."""
    if tuple(names) != COLUMNS:
        yield f"1: the columns are {','.join(names)}, not {','.join(COLUMNS)}"
        return
    seen: dict[str, tuple[str, str]] = {}
    files = set()
    for line, row in enumerate(rows, 2):
        for name, shape in _SHAPES.items():
            if not re.fullmatch(shape, row[name] or ""):
                yield f"{line}: {name} is '{row[name]}', which does not match {shape}"
                return
        if len({bool(row[name]) for name in ("file", "bytes", "sha256")}) > 1:
            yield f"{line}: file, bytes and sha256 must be all filled or all empty"
        if row["file"] and row["file"] in files:
            yield f"{line}: {row['file']} is listed twice"
        files.add(row["file"])
        own = (row["date"], row["commit"])
        if seen.setdefault(row["version"], own) != own:
            yield f"{line}: version {row['version']} has two commits or dates"
    numbers = [tuple(map(int, version.split("."))) for version in seen]
    if numbers != sorted(numbers, reverse=True):
        yield f"{len(rows) + 1}: versions are not in the order of their numbers, newest first"
