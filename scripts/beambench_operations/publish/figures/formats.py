"""Formats figures in the texts: the filters of the templates."""

from collections.abc import Callable

from beambench.analysis import Ratio
from beambench_report.base.quantities import number


def fixed(value: float | Ratio, digits: int = 2) -> str:
    """Formats with so many digits behind the point, thousands marked: 1,234.50."""
    return f"{_value(value):,.{digits}f}"


def short(value: float | Ratio) -> str:
    """Three significant digits: 0.971, 2.40, 24.1, 1,230."""
    return number(_value(value))


def brief(value: float | Ratio) -> str:
    """Formats as in tables of many ratios: 0.97, 2.4, 24."""
    known = _value(value)
    return f"{known:.{2 if known < 0.995 else 1 if known < 9.95 else 0}f}"


def count(value: float) -> str:
    """A whole number, thousands marked."""
    whole = round(_value(value))
    if value != whole:
        raise ValueError(f"{value} is no count")
    return f"{whole:,}"


def percent(share: float, digits: int = 0) -> str:
    """A share of 1: 37%."""
    return f"{100 * _value(share):.{digits}f}%"


def signed_percent(share: float, digits: int = 0) -> str:
    """A difference in parts of 1: +3%, -16%."""
    return f"{100 * _value(share):+.{digits}f}%"


def interval(ratio: Ratio) -> str:
    """The ratio with its 95% confidence interval: 2.40 (2.35 to 2.46)."""
    if ratio.interval is None:
        return f"{short(ratio)} (no interval)"
    low, high = (number(end) for end in ratio.interval)
    return f"{short(ratio)} ({low} to {high})"


def cited(figure: str) -> str:
    """A figure that another work states, or that a target sets: nobody measured it here."""
    return figure


def holds(condition: object) -> str:
    """Nothing, where what a sentence says without a figure is so. Raises ValueError otherwise."""
    if not condition:
        raise ValueError("what this sentence says does not follow from the rows any more")
    return ""


def _value(value: float | Ratio) -> float:
    """Raises an error that names what a template uses and lacks: hence the sum."""
    return value.value if isinstance(value, Ratio) else value + 0


FILTERS: dict[str, Callable[..., str]] = {
    one.__name__: one for one in (fixed, short, brief, count, percent, signed_percent, interval)
}
