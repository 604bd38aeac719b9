"""A claim of the thesis, the rule that tests it, and the verdict on all its cells."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import partial
from math import isnan

from beambench.analysis import MARGIN, Ratio
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
    is_paired: bool | None = None
    """Are both figures of the same blocks? None where they were not both measured."""


def below(cell: str, smaller: Measured | None, larger: Measured | None, factor: float = 1) -> Check:
    """Is one figure below the other, by `factor` or more?

    Times of the same blocks are ranked by their ratio, as contenders are. Of others, the interval
    of the difference decides. Figures that are surely equal within MARGIN give no. An exact figure
    that meets the factor to the digit gives yes.
    """
    if smaller is None or larger is None:
        return Check(cell, Outcome.MISSING)
    figures = f"{number(smaller.value)} against {number(larger.value)}"
    ratio = larger.value / smaller.value if smaller.value > 0 else None
    if paired := larger.blocks.over(smaller.blocks, factor):
        low, ratio, high = (factor * end for end in (paired.low, paired.value, paired.high))
        figures += f", {number(ratio)} times ({number(low)} to {number(high)})"
        outcome = _by_rank(paired, smaller.blocks.over(larger.blocks, 1 / factor))
    else:
        outcome = _by_difference(smaller.times(factor), larger, factor > 1)
    if outcome is None:
        outcome = Outcome.NO if factor == 1 else Outcome.UNDECIDED
        figures += f", equal within {MARGIN:.0%}" * (factor == 1)
    elif any(isnan(one.low) for one in (smaller, larger)) and not paired:
        figures += ", not ranked: no interval"
    is_exact = any(one.low == one.high for one in (smaller, larger))
    return Check(cell, outcome, figures, ratio, is_paired=None if is_exact else bool(paired))


def _by_rank(up: Ratio, down: Ratio) -> Outcome | None:
    """Is the one of the ratio `up` behind the one of its inverse? None where they are tied."""
    slower = max(up, down, key=lambda ratio: ratio.value)
    if slower.rank == "behind":
        return Outcome.YES if slower is up else Outcome.NO
    return None if slower.rank == "tied" else Outcome.UNDECIDED


def _by_difference(bound: Measured, larger: Measured, may_meet: bool) -> Outcome | None:
    """Is it above the bound, or if exact, does it meet it? None where they are surely equal."""
    gap = larger - bound
    if gap.low > 0 or (gap.low == gap.high == 0 and may_meet):
        return Outcome.YES
    if gap.high < 0 or gap.low == gap.high:
        return Outcome.NO
    return None if _are_alike(bound, larger) else Outcome.UNDECIDED


def _are_alike(one: Measured, other: Measured) -> bool:
    """Are they tied by the ratio of independent figures? Bounds are never alike."""
    is_bound = any(figure.low == figure.high for figure in (one, other))
    if is_bound or min(one.low, other.low) <= 0:
        return False
    ratio = max(one / other, other / one, key=lambda ratio: ratio.value)
    ends = (ratio.low, ratio.high)
    return Ratio(ratio.value, *ends, False, *ends).rank == "tied"


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
