"""Formats figures and tables for people."""

from collections.abc import Collection, Iterable, Sequence
from math import floor, isfinite, log2, log10

DASH = "–"  # noqa: RUF001


def number(value: float) -> str:
    """Formats with three significant digits and thousands separators: 0.00123, 4.57, 12,300."""
    if value == 0 or not isfinite(value):
        return f"{value:g}"
    digits = max(0, 2 - floor(log10(abs(value))))
    return f"{value:,.{min(digits, 6)}f}"


def size_in_words(size: float) -> str:
    """Formats a number of bytes: 640 B, 12.0 KiB, 3.40 GiB."""
    if size < 1024:
        return f"{size:.0f} B"
    power = min(int(log2(size)) // 10, 3)
    return f"{number(size / 1024**power)} {('KiB', 'MiB', 'GiB')[power - 1]}"


def duration_in_words(seconds: float) -> str:
    """Formats a duration: 48 s, 4 min 10 s, 2 h 5 min."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"


def markdown_row(texts: Iterable[str]) -> str:
    """Formats one line of a Markdown table."""
    return f"| {' | '.join(texts)} |"


def markdown_table(
    heads: Sequence[str], rows: Iterable[Iterable[str]], right: Collection[int] = ()
) -> list[str]:
    """Returns the lines of a Markdown table; the columns `right` are aligned to the right."""
    marks = ("---:" if place in right else "---" for place in range(len(heads)))
    return [markdown_row(heads), f"|{'|'.join(marks)}|", *map(markdown_row, rows)]
