"""A claim of the thesis, the rule that tests it, and the verdict on all its cells."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import partial

from beambench_report.base.quantities import number
from beambench_thesis.paper.evidence import Evidence, Measured


class Outcome(Enum):
    """The outcome of one cell for the claim."""

    YES = "yes"
    NO = "no"
    UNDECIDED = "undecided"
    MISSING = "missing"


class Verdict(Enum):
    """The outcome of all cells together."""

    HOLDS = "holds"
    IN_PART = "holds in part"
    FAILS = "fails"
    UNDECIDED = "undecided"
    NOT_TESTED = "not tested"


@dataclass(frozen=True)
class Check:
    """One cell of a claim: where, its outcome, and the figures behind it."""

    cell: str
    outcome: Outcome
    figures: str = ""
    ratio: float | None = None
    """What should be the larger figure over what should be the smaller one, if two are compared."""
    aside: bool = False
    """Worth knowing beside the claim, but not a part of it: no verdict depends on it."""


ALIKE = 1.05
"""Two measured figures are equal where their ratio is surely less than this, either way."""


def below(cell: str, smaller: Measured | None, larger: Measured | None, factor: float = 1) -> Check:
    """Is one figure below the other, by `factor` or more?

    The interval of the difference decides between yes and no; figures that are surely alike give
    no. An exact figure that meets the factor to the digit gives yes.
    """
    if smaller is None or larger is None:
        return Check(cell, Outcome.MISSING)
    gap = larger - smaller.times(factor)
    is_exact = gap.low == gap.high
    figures = f"{number(smaller.value)} against {number(larger.value)}"
    if gap.low > 0 or (is_exact and gap.value == 0 and factor > 1):
        outcome = Outcome.YES
    elif gap.high < 0 or is_exact:
        outcome = Outcome.NO
    elif factor == 1 and _are_alike(smaller, larger):
        outcome = Outcome.NO
        figures += f", equal within {ALIKE - 1:.0%}"
    else:
        outcome = Outcome.UNDECIDED
    ratio = larger.value / smaller.value if smaller.value > 0 else None
    return Check(cell, outcome, figures, ratio)


def _are_alike(one: Measured, other: Measured) -> bool:
    """Does the interval of the ratio lie between 1 / ALIKE and ALIKE? Bounds are never alike."""
    is_bound = any(figure.low == figure.high for figure in (one, other))
    if is_bound or min(one.low, other.low) <= 0:
        return False
    ratio = one / other
    return ratio.low > 1 / ALIKE and ratio.high < ALIKE


def between(cell: str, figure: Measured | None, low: float, high: float, unit: str = "") -> Check:
    """Does a figure lie between two bounds? Undecided where its interval contains a bound."""
    if figure is None:
        return Check(cell, Outcome.MISSING)
    if low <= figure.low and figure.high <= high:
        outcome = Outcome.YES
    elif figure.high < low or figure.low > high:
        outcome = Outcome.NO
    else:
        outcome = Outcome.UNDECIDED
    return Check(
        cell, outcome, f"{number(figure.value)}{unit} (allowed {number(low)} to {number(high)})"
    )


def aside(check: Check) -> Check:
    """Returns the cell as one that does not count."""
    return replace(check, aside=True)


def verdict_of(checks: Sequence[Check]) -> Verdict:
    """Combines all cells into one verdict.

    If a cell is missing, the claim is not tested. Undecided cells may be yes or no: the verdict
    stands if it is the same in either case.
    """
    outcomes = {check.outcome for check in checks if not check.aside}
    if not outcomes or Outcome.MISSING in outcomes:
        return Verdict.NOT_TESTED
    if {Outcome.YES, Outcome.NO} <= outcomes:
        return Verdict.IN_PART
    if Outcome.UNDECIDED in outcomes:
        return Verdict.UNDECIDED
    return Verdict.HOLDS if Outcome.YES in outcomes else Verdict.FAILS


Rule = Callable[[Evidence], list[Check]]


@dataclass(frozen=True)
class Amendment:
    """The former rule of a claim; its verdict is printed with that of the present one."""

    former: Rule
    why: str
    """Why the rule was amended, in one sentence."""


@dataclass(frozen=True)
class Claim:
    """A row of the table of claims."""

    name: str
    where: str
    says: str
    rule: Rule
    is_figures: bool
    """The claim is a list of figures, which are bound to agree with themselves."""
    amendment: Amendment | None = None


class Claims(list[Claim]):
    """The claims in the order of the thesis; rules register themselves."""

    def claim(
        self,
        name: str,
        where: str,
        says: str,
        *,
        is_figures: bool = False,
        former: Rule | dict[str, str] | None = None,
        why: str = "",
    ) -> Callable[[Rule], Rule]:
        """Decorates the rule of a claim.

        `former` is the rule before the amendment, or arguments that turn the present rule into it;
        `why` is the reason for the amendment.
        """

        def register(rule: Rule) -> Rule:
            before = partial(rule, **former) if isinstance(former, dict) else former
            amendment = Amendment(before, why) if before else None
            self.append(Claim(name, where, says, rule, is_figures, amendment))
            return rule

        return register
