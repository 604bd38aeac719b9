"""Counts of tests by kind of primitive for whole pictures: Haines's, and ours by census."""

from pathlib import Path

import pandas as pd

from beambench_report.base.csv_texts import csv_of
from beambench_report.base.files import ROOT, read_table, say, write_text
from beambench_report.havran.census import census_of

PUBLISHED = ROOT / "results/haines/tests.csv"
KINDS = ("polygon", "sphere", "cone", "box")
CONTENDERS = ("goldsmith-salmon:order=given", "goldsmith-salmon:order=shuffled")
"""Both orders of insertion, because Haines does not state his."""

_PUBLISHED_COLUMNS = ("scene", "kind", "tests")
_COLUMNS = ("contender", *_PUBLISHED_COLUMNS)

Tests = dict[str, dict[str, float]]
"""Counts by scene, then by kind."""


def published_tests() -> Tests:
    """Returns Haines's counts."""
    return _by_scene(read_table(PUBLISHED, _PUBLISHED_COLUMNS, "it is part of the repository"))


def read_tests(path: Path) -> dict[str, Tests]:
    """Returns our counts, by contender. Raises Problem if the file is missing or malformed."""
    rows = read_table(path, _COLUMNS, "run `python -m beambench_report haines DIR`")
    return {str(name): _by_scene(group) for name, group in rows.groupby("contender", sort=False)}


def measure_tests(folder: Path, program: Path) -> Path:
    """Writes our counts to FOLDER/tests.csv; skips scenes that are already in FOLDER/census."""
    folder.joinpath("census").mkdir(parents=True, exist_ok=True)
    published = published_tests()
    rows = []
    for number, contender in enumerate(CONTENDERS):
        for scene in published:
            say(f"{scene}, {contender}")
            file = folder / "census" / f"{scene}-{number}.json"
            work = census_of(file, program, scene, contender)["work"]
            rows += [(contender, scene, kind, work[f"{kind}_tests"]) for kind in KINDS]
    table = pd.DataFrame(rows, columns=list(_COLUMNS))
    return write_text(folder / "tests.csv", csv_of(table))


def _by_scene(rows: pd.DataFrame) -> Tests:
    table = rows.pivot_table(index="scene", columns="kind", values="tests", sort=False)
    return table.to_dict("index")
