"""Compares two runs of one sweep, except their times."""

from pathlib import Path

import pandas as pd

from beambench_report.base.cell_files import IDENTITY

_FOUND = "rays|scene_hash|rays_hash|hits|agree|tie|graze|verdict"


def cells_of(results: Path) -> tuple[pd.DataFrame, str]:
    """Returns the results of each cell without times, and any fault of the file."""
    try:
        rows = pd.read_csv(results, dtype=str, keep_default_na=False).set_index(list(IDENTITY))
    except (OSError, KeyError, ValueError) as error:
        return pd.DataFrame(), f"{results.name} cannot be read ({error!r})"
    twice = rows.index[rows.index.duplicated()]
    fault = f"{results.name} has the cell {'/'.join(twice[0])} twice" if len(twice) else ""
    return rows.filter(regex=rf"^({_FOUND}|.*(?<!_ns)_per_ray)$"), fault


def difference(undisturbed: pd.DataFrame, disturbed: pd.DataFrame) -> str:
    """Returns the difference as a sentence; empty if there is none."""
    for cells, others, what in (
        (undisturbed, disturbed, "is missing"),
        (disturbed, undisturbed, "should not exist"),
    ):
        if len(left := cells.index.difference(others.index)):
            return f"the cell {'/'.join(left[0])} {what}"
    for column, now in disturbed.reindex(undisturbed.index, columns=undisturbed.columns).items():
        for key in undisturbed.index[undisturbed[column] != now][:1]:
            return f"{column} of {'/'.join(key)} is {now[key]}, not {undisturbed[column][key]}"
    return ""
