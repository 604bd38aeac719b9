"""Escapes cells of CSV files that a spreadsheet takes for formulas; needs no packages."""

_FIRST_OF_FORMULAS = ("=", "+", "-", "@", "\t", "\r", "'")


def guarded(value: object) -> object:
    """Returns a cell as it is written to a file; numbers are unchanged.

    A string that begins with one of `=+-@`, a tab, a carriage return or an apostrophe is prefixed
    with an apostrophe. beambench writes results.csv in the same way
    (harness/analysis/results_csv.cpp).
    """
    if isinstance(value, str) and value.startswith(_FIRST_OF_FORMULAS):
        return f"'{value}"
    return value
