"""Escapes cells of CSV files that a spreadsheet would take for formulas; needs only Python."""

_FIRST_OF_FORMULAS = ("=", "+", "-", "@", "\t", "\r", "'")


def guarded(value: object) -> object:
    """Returns a cell as it is written: numbers are unchanged.

    A text that begins with one of `=+-@`, a tab, a carriage return or an apostrophe gets an
    apostrophe before it. beambench writes results.csv in the same way
    (harness/analysis/results_csv.cpp).
    """
    if isinstance(value, str) and value.startswith(_FIRST_OF_FORMULAS):
        return f"'{value}"
    return value
