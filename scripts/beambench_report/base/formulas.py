"""Cells of CSV files that no spreadsheet takes for a formula; needs only Python."""

_FIRST_OF_FORMULAS = ("=", "+", "-", "@", "\t", "\r", "'")


def guarded(value: object) -> object:
    """Returns a cell as it is written: numbers stay as they are.

    A text that begins with one of `=+-@`, a tab or a carriage return, or with an apostrophe, has an
    apostrophe before it. beambench writes results.csv like that, too
    (harness/analysis/results_csv.cpp).
    """
    if isinstance(value, str) and value.startswith(_FIRST_OF_FORMULAS):
        return f"'{value}"
    return value
