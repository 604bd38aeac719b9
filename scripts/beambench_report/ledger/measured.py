"""A figure that is known to lie between two others, and what follows of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Measured:
    """A positive figure and its interval; one that was counted or printed is its own interval."""

    value: float
    low: float
    high: float

    @classmethod
    def exact(cls, value: float) -> Measured:
        """A figure without an interval."""
        return cls(value, value, value)

    def __truediv__(self, other: Measured) -> Measured:
        """The ratio, from the smallest to the largest that the intervals allow."""
        return Measured(self.value / other.value, self.low / other.high, self.high / other.low)

    def __sub__(self, other: Measured) -> Measured:
        """The difference, from the smallest to the largest that the intervals allow."""
        return Measured(self.value - other.value, self.low - other.high, self.high - other.low)

    def times(self, factor: float) -> Measured:
        """The figure in another unit, the factor being positive."""
        return Measured(self.value * factor, self.low * factor, self.high * factor)


def share(part: Measured, rest: Measured) -> Measured:
    """Part of the whole that `part` and `rest` make."""
    return Measured(
        part.value / (part.value + rest.value),
        part.low / (part.low + rest.high),
        part.high / (part.high + rest.low),
    )


def smallest(figures: Sequence[Measured]) -> Measured:
    """The least of several: its true value is no larger than the least upper end."""
    return Measured(
        min(each.value for each in figures),
        min(each.low for each in figures),
        min(each.high for each in figures),
    )


def largest(figures: Sequence[Measured]) -> Measured:
    """The greatest of several: its true value is no less than the greatest lower end."""
    return Measured(
        max(each.value for each in figures),
        max(each.low for each in figures),
        max(each.high for each in figures),
    )


def total(figures: Sequence[Measured]) -> Measured:
    """The sum."""
    return Measured(
        sum(each.value for each in figures),
        sum(each.low for each in figures),
        sum(each.high for each in figures),
    )
