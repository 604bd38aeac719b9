"""Texts of CSV files, none of which a spreadsheet may take for a formula.

A text that begins with one of `=+-@`, a tab or a carriage return, or with an apostrophe, has an
apostrophe before it. beambench writes results.csv like that, too
(harness/bench/record/run_folder.cpp).
"""

import pandas as pd
from pandas.api.types import is_string_dtype

_FIRST_OF_FORMULAS = ("=", "+", "-", "@", "\t", "\r", "'")


def guarded(value: object) -> object:
    """A cell as it is written: numbers stay as they are."""
    if isinstance(value, str) and value.startswith(_FIRST_OF_FORMULAS):
        return f"'{value}"
    return value


def unguarded(table: pd.DataFrame) -> pd.DataFrame:
    """A table that was read, its texts as they were before they were written."""
    texts = [name for name in table if is_string_dtype(table[name])]
    plain = {name: table[name].str.removeprefix("'") for name in texts}
    return table.assign(**plain)


def csv_of(table: pd.DataFrame, float_format: str | None = None) -> str:
    """A table as CSV, without its index."""
    safe = table.map(guarded).rename(columns=guarded)
    return safe.to_csv(index=False, float_format=float_format, lineterminator="\n")
