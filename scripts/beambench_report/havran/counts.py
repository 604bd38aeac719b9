"""Counts of structures on scenes: Havran's as published, and ours in the same form."""

from pathlib import Path

import pandas as pd

from beambench_report.base.csv_texts import csv_of
from beambench_report.base.files import ROOT, read_table, say, write_text
from beambench_report.havran.census import Census, census_of
from beambench_report.havran.contenders import STRUCTURES, contender_of

PUBLISHED = ROOT / "results/havran/counts.csv"
CASE = ["structure", "scene", "setting"]
"""The columns that identify one structure with one setting on one scene, by the published names."""


def read_counts(path: Path) -> pd.DataFrame:
    """Reads a file of counts: a row for each case, a column for each quantity.

    Raises Problem if the file is missing or malformed.
    """
    remedy = "run `python -m beambench_report havran measure DIR`"
    rows = read_table(path, (*CASE, "quantity", "value"), remedy)
    return rows.pivot_table(index=CASE, columns="quantity", values="value", sort=False)


def quantities_of(census: Census) -> dict[str, float]:
    """Returns Havran's quantities, with steps and tests by his definitions
    (results/havran/README.md).
    """
    size, work = census["size"], census["work"]
    rays = work["rays"]
    return {
        "N_IN": size["nodes"] - size["leaves"],
        "N_V": size["leaves"],
        "N_EV": size["empty_leaves"],
        "N_OIV": size["references"],
        "N_IT": work["primitive_tests"] / work["rays_that_hit"],
        "N_TS": (work["traversal_steps"] + work.get("last_climb", 0)) / rays,
        "N_ETS": work["leaves"] / rays,
        "N_EETS": work["empty_leaves"] / rays,
    }


def measure(folder: Path, program: Path, scenes: list[str]) -> Path:
    """Writes counts on these scenes to FOLDER/counts.csv; skips cases in FOLDER/census."""
    folder.joinpath("census").mkdir(parents=True, exist_ok=True)
    cases = [
        case
        for case in sorted(read_counts(PUBLISHED).index, key=_place)
        if case[0] in STRUCTURES and case[1] in scenes
    ]
    rows = []
    for number, (structure, scene, setting) in enumerate(cases, start=1):
        contender = contender_of(structure, setting)
        say(f"{number} of {len(cases)}: {scene}, {contender}")
        stem = "-".join((scene, *setting.split(), str(STRUCTURES.index(structure))))
        census = census_of(folder / "census" / f"{stem}.json", program, scene, contender)
        rows += [
            (structure, scene, setting, quantity, f"{value:.6g}", contender)
            for quantity, value in quantities_of(census).items()
        ]
    table = pd.DataFrame(rows, columns=[*CASE, "quantity", "value", "contender"])
    return write_text(folder / "counts.csv", csv_of(table))


def _place(case: tuple[str, str, str]) -> int:
    return STRUCTURES.index(case[0]) if case[0] in STRUCTURES else len(STRUCTURES)
