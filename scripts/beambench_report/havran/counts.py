"""Counts of structures on scenes: what Havran published, and ours in the same form."""

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import pandas as pd

from beambench_report.base.csv_texts import csv_of
from beambench_report.base.files import ROOT, read_table, write_text

PUBLISHED = ROOT / "results/havran/counts.csv"


class Case(NamedTuple):
    """One structure with one setting on one scene, by the published names."""

    structure: str
    scene: str
    setting: str


Counts = dict[Case, dict[str, float]]
"""The quantities of each case, in the order of the file."""


def read_counts(path: Path) -> Counts:
    """Reads a file of counts. Raises Problem where it is missing or is none."""
    columns = (*Case._fields, "quantity", "value")
    rows = read_table(path, columns, "run `python -m beambench_report havran measure DIR`")
    counts: Counts = {}
    for row in rows.itertuples():
        case = Case(str(row.structure), str(row.scene), str(row.setting))
        counts.setdefault(case, {})[str(row.quantity)] = float(row.value)
    return counts


def write_counts(path: Path, counts: Iterable[tuple[Case, str, dict[str, float]]]) -> Path:
    """Writes counts, each with the contender that they were measured with."""
    rows = [
        {**case._asdict(), "quantity": quantity, "value": f"{value:.6g}", "contender": contender}
        for case, contender, quantities in counts
        for quantity, value in quantities.items()
    ]
    table = pd.DataFrame(rows)
    return write_text(path, csv_of(table))
