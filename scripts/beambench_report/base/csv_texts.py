"""Formats tables as CSV and reads them; escapes strings that spreadsheets take for formulas."""

import pandas as pd
from pandas.api.types import is_string_dtype

from beambench_report.base.formulas import guarded


def unguarded(table: pd.DataFrame) -> pd.DataFrame:
    """Returns a table that was read, with its strings as they were before `csv_of`."""
    texts = [name for name in table if is_string_dtype(table[name])]
    plain = {name: table[name].str.removeprefix("'") for name in texts}
    return table.assign(**plain)


def csv_of(table: pd.DataFrame, float_format: str | None = None) -> str:
    """Formats a table as CSV, without its index."""
    safe = table.map(guarded).rename(columns=guarded)
    return safe.to_csv(index=False, float_format=float_format, lineterminator="\n")
