"""Figures of the report as people read them, the same in Markdown and on the page."""

from __future__ import annotations

from beambench_report.ledger.measured import Measured
from beambench_report.quantities import number
from beambench_report.thesis.cells import Cell

DASH = "–"  # noqa: RUF001


def milliseconds(seconds: float) -> str:
    """`43.9 ms`, also of long times: one unit for all that is ours."""
    return f"{number(1e3 * seconds)} ms"


def thesis_seconds(seconds: float | None) -> str:
    """`2.21 s`, as printed."""
    return DASH if seconds is None else f"{seconds:,g} s"


def interval(figure: Measured, factor: float = 1e3, unit: str = " ms") -> str:
    """`43.1 to 45.0 ms`."""
    return f"{number(factor * figure.low)} to {number(factor * figure.high)}{unit}"


def origin(cell: Cell) -> str:
    """Where a figure comes from: row of which file, which cell, how often, which verdict."""
    time = f"; {interval(cell.time)}" if cell.time else ""
    return (
        f"row {cell.number}: {cell.run}/results.csv, line {cell.line}; {cell.name}; "
        f"{cell.repetitions} repetitions{time}; verdict {cell.verdict}"
    )
