"""From the cells of a claim to a verdict on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

from beambench_report.ledger.measured import Measured
from beambench_report.quantities import number


class Outcome(Enum):
    """What one cell says of the claim."""

    YES = "yes"
    NO = "no"
    UNDECIDED = "undecided"
    MISSING = "missing"


class Verdict(Enum):
    """What all cells say of it."""

    HOLDS = "holds"
    IN_PART = "holds in part"
    FAILS = "fails"
    UNDECIDED = "undecided"
    NOT_TESTED = "not tested"


@dataclass(frozen=True)
class Check:
    """One cell of a claim: where, what it says, and the figures it says it by."""

    cell: str
    outcome: Outcome
    figures: str = ""
    ratio: float | None = None
    """What should be the larger figure over what should be the smaller one, if two are compared."""
    aside: bool = False
    """Worth knowing beside the claim, but not a part of it: no verdict depends on it."""


def below(cell: str, smaller: Measured | None, larger: Measured | None, factor: float = 1) -> Check:
    """Is one figure below the other, by `factor` or more? Not decided where intervals meet."""
    if smaller is None or larger is None:
        return Check(cell, Outcome.MISSING)
    if smaller.high * factor < larger.low:
        outcome = Outcome.YES
    elif smaller.low * factor > larger.high:
        outcome = Outcome.NO
    else:
        outcome = _met_where_exact(smaller, larger, factor)
    ratio = larger.value / smaller.value if smaller.value > 0 else None
    figures = f"{number(smaller.value)} against {number(larger.value)}"
    return Check(cell, outcome, figures, ratio)


def between(cell: str, figure: Measured | None, low: float, high: float, unit: str = "") -> Check:
    """Does a figure lie between two bounds? Not decided where its interval has a bound in it."""
    if figure is None:
        return Check(cell, Outcome.MISSING)
    if low <= figure.low and figure.high <= high:
        outcome = Outcome.YES
    elif figure.high < low or figure.low > high:
        outcome = Outcome.NO
    else:
        outcome = Outcome.UNDECIDED
    return Check(cell, outcome, f"{number(figure.value)}{unit} for {number(low)} to {number(high)}")


def aside(check: Check) -> Check:
    """The cell as one that does not count."""
    return replace(check, aside=True)


def verdict_of(checks: Sequence[Check]) -> Verdict:
    """One verdict of all cells.

    With a cell missing the claim is not tested. Undecided cells may fall either way: the verdict
    stands if it is the same whichever way they fall.
    """
    outcomes = {check.outcome for check in checks if not check.aside}
    if not outcomes or Outcome.MISSING in outcomes:
        return Verdict.NOT_TESTED
    if {Outcome.YES, Outcome.NO} <= outcomes:
        return Verdict.IN_PART
    if Outcome.UNDECIDED in outcomes:
        return Verdict.UNDECIDED
    return Verdict.HOLDS if Outcome.YES in outcomes else Verdict.FAILS


def _met_where_exact(smaller: Measured, larger: Measured, factor: float) -> Outcome:
    """Exact figures that meet a factor to the digit do meet it; equal ones are not decided."""
    exact = smaller.low == smaller.high and larger.low == larger.high
    return Outcome.YES if exact and factor > 1 else Outcome.UNDECIDED
