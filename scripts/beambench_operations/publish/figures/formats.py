"""Filters of the templates, which format figures."""

from collections.abc import Callable

from beambench.analysis import Ratio
from beambench_report.base.quantities import number


def fixed(value: float | Ratio, digits: int = 2) -> str:
    """Formats with a fixed number of decimals, with thousands separators: 1,234.50."""
    return f"{_value(value):,.{digits}f}"


def short(value: float | Ratio) -> str:
    """Formats with three significant digits: 0.971, 2.40, 24.1, 1,230."""
    return number(_value(value))


def brief(value: float | Ratio) -> str:
    """Formats as in tables of many ratios: 0.97, 2.4, 24."""
    known = _value(value)
    return f"{known:.{2 if known < 0.995 else 1 if known < 9.95 else 0}f}"


def count(value: float) -> str:
    """Formats a whole number with thousands separators."""
    whole = round(_value(value))
    if value != whole:
        raise ValueError(f"{value} is not a count")
    return f"{whole:,}"


def percent(share: float, digits: int = 0) -> str:
    """Formats a share of 1: 37%."""
    return f"{100 * _value(share):.{digits}f}%"


def signed_percent(share: float, digits: int = 0) -> str:
    """Formats a relative difference: +3%, -16%."""
    return f"{100 * _value(share):+.{digits}f}%"


def interval(ratio: Ratio) -> str:
    """Formats a ratio with its 95% confidence interval: 2.40 (2.35 to 2.46)."""
    if ratio.interval is None:
        return f"{short(ratio)} (no interval)"
    low, high = (number(end) for end in ratio.interval)
    return f"{short(ratio)} ({low} to {high})"


def is_ahead(speedup: Ratio) -> bool:
    """Returns whether the interval is above 1."""
    return speedup.low is not None and speedup.low > 1


def is_behind(speedup: Ratio) -> bool:
    """Returns whether the interval is below 1."""
    return speedup.high is not None and speedup.high < 1


def open_in_italics(ratio: Ratio) -> str:
    """Formats a ratio with two decimals, in italics unless its interval excludes 1."""
    mark = "" if is_ahead(ratio) or is_behind(ratio) else "*"
    return f"{mark}{fixed(ratio)}{mark}"


def speedup(ratio: Ratio, otherwise: str) -> str:
    """Formats a speedup with its interval; if that is below 1, adds `otherwise`: who is faster."""
    if is_behind(ratio):
        return f"{interval(ratio)}: {otherwise}"
    is_open = ratio.interval is not None and not is_ahead(ratio)
    return f"{interval(ratio)}{': undecided' * is_open}"


def inverse(ratio: Ratio) -> Ratio:
    """Returns the ratio of the same two times the other way around."""
    ends = [None if end is None else 1 / end for end in (ratio.high, ratio.low)]
    return Ratio(1 / ratio.value, *ends, paired=ratio.paired)


def cited(figure: str) -> str:
    """Marks a figure of another work or of a target, which was not measured here."""
    return figure


def holds(condition: object) -> str:
    """Returns an empty string if a statement without a figure is true, or raises ValueError."""
    if not condition:
        raise ValueError("this sentence no longer follows from the rows")
    return ""


def _value(value: float | Ratio) -> float:
    """Returns the value. The sum raises an error that names an undefined variable of a template."""
    return value.value if isinstance(value, Ratio) else value + 0


FILTERS: dict[str, Callable[..., str | Ratio]] = {
    one.__name__: one
    for one in (
        fixed,
        short,
        brief,
        count,
        percent,
        signed_percent,
        interval,
        open_in_italics,
        speedup,
        inverse,
    )
}
