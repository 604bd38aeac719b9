"""Comparison of two runs of one sweep, times left out."""

import csv
from pathlib import Path

_KEY = (
    *("scene", "camera", "structure", "parameters", "width", "height"),
    *("samples", "ray_kind"),
)
_FOUND = ("rays", "scene_hash", "rays_hash", "hits", "agree", "tie", "graze", "verdict")
_TIME = "_ns_per_ray"

Rows = dict[tuple[str, ...], dict[str, str]]


def cells_of(results: Path) -> tuple[Rows, str]:
    """Returns the results of each cell without times, and any fault of the file."""
    rows: Rows = {}
    try:
        with results.open(encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                key = tuple(row[column] for column in _KEY)
                if key in rows:
                    return rows, f"{results.name} has the cell {'/'.join(key)} twice"
                rows[key] = {name: text for name, text in row.items() if _is_repeatable(name)}
    except (OSError, KeyError, csv.Error) as error:
        return rows, f"{results.name} cannot be read ({error!r})"
    return rows, ""


def difference(undisturbed: Rows, disturbed: Rows) -> str:
    """Returns the difference in a sentence; empty if there is none."""
    for key in undisturbed.keys() | disturbed.keys():
        name = "/".join(key)
        if key not in disturbed:
            return f"the cell {name} is missing"
        if key not in undisturbed:
            return f"the cell {name} is too much"
        for column, text in undisturbed[key].items():
            if disturbed[key].get(column) != text:
                return f"{column} of {name} is {disturbed[key].get(column)}, not {text}"
    return ""


def _is_repeatable(column: str) -> bool:
    is_counter = column.endswith("_per_ray") and not column.endswith(_TIME)
    return is_counter or column in _FOUND
