"""A claim of the thesis, the rule that tests it, and the verdict on all its cells."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from math import ceil, isnan

from beambench.analysis import MARGIN, Ratio
from beambench_report.base.quantities import number
from beambench_thesis.paper.evidence import Evidence, Measured


class Question(Enum):
    """The questions of readers, by which the report groups the claims."""

    BEAMS_OR_RAYS = "Do beams beat single rays through the same octree?"
    OTHER_STRUCTURES = "Do beams beat other structures?"
    OCTREE = "How should the octree be divided?"
    GROWTH = "How does the time grow with the rays?"
    WORK = "Where does the time go?"
    PARALLEL = "How well does the parallel program work?"


class Outcome(Enum):
    """The outcome of one cell for the claim."""

    YES = "yes"
    NO = "no"
    UNDECIDED = "undecided"
    MISSING = "missing"


class Verdict(Enum):
    """The outcome of all cells together."""

    SUPPORTED = "supported"
    MIXED = "mixed"
    CONTRADICTED = "contradicted"
    UNDECIDED = "undecided"
    NOT_TESTABLE = "not testable"
    NOT_TESTED = "not tested"


@dataclass(frozen=True)
class Check:
    """One cell of a claim: its place, its outcome, and its figures."""

    cell: str
    outcome: Outcome
    figures: str = ""
    ratio: float | None = None
    """If two figures are compared, the one that should be larger over the other."""
    value: float | None = None
    """The figure that should lie between two bounds, if there is one."""
    aside: bool = False
    """Whether the cell is additional information, which does not affect the verdict."""
    is_paired: bool | None = None
    """Whether both figures are from the same blocks; None if they were not both measured."""


def below(cell: str, smaller: Measured | None, larger: Measured | None, factor: float = 1) -> Check:
    """Checks whether one figure is below the other, by `factor` or more.

    Times of the same blocks are ranked by their ratio, as contenders are; otherwise the interval of
    the difference decides. The outcome is no if the figures are surely equal within MARGIN, and yes
    if an exact figure exactly meets the factor.
    """
    if smaller is None or larger is None:
        return Check(cell, Outcome.MISSING)
    figures = f"{number(smaller.value)} against {number(larger.value)}"
    ratio = larger.value / smaller.value if smaller.value > 0 else None
    if paired := larger.blocks.over(smaller.blocks, factor):
        low, ratio, high = (factor * end for end in (paired.low, paired.value, paired.high))
        figures += f", {number(ratio)} times ({number(low)} to {number(high)})"
        outcome = _by_rank(paired, smaller.blocks.over(larger.blocks, 1 / factor))
        if outcome is Outcome.UNDECIDED:
            figures += f"; {_blocks_to_decide(paired)}"
    else:
        outcome = _by_difference(smaller.times(factor), larger, factor > 1)
    if outcome is None:
        outcome = Outcome.NO if factor == 1 else Outcome.UNDECIDED
        figures += f", equal within {MARGIN:.0%}" * (factor == 1)
    elif any(isnan(one.low) for one in (smaller, larger)) and not paired:
        figures += ", too few repetitions to rank"
    is_exact = any(one.low == one.high for one in (smaller, larger))
    return Check(cell, outcome, figures, ratio, is_paired=None if is_exact else bool(paired))


def _by_rank(up: Ratio, down: Ratio) -> Outcome | None:
    """Returns whether the contender with the ratio `up` is behind the contender with its inverse.

    None if they are tied.
    """
    slower = max(up, down, key=lambda ratio: ratio.value)
    if slower.rank == "behind":
        return Outcome.YES if slower is up else Outcome.NO
    return None if slower.rank == "tied" else Outcome.UNDECIDED


def _blocks_to_decide(paired: Ratio) -> str:
    """Returns a note: by what factor the blocks must increase to decide the check.

    This assumes that the spread stays the same. The interval shrinks with the square root of the
    number of blocks, until it either excludes 1 or lies within MARGIN of it, whichever takes fewer
    blocks.
    """
    half = (paired.high - paired.low) / 2
    away = abs(paired.value - 1)
    more = (half / max(away, MARGIN - away)) ** 2
    return f"about {max(2, ceil(more))} times as many blocks would decide it"


def _by_difference(bound: Measured, larger: Measured, may_meet: bool) -> Outcome | None:
    """Returns whether `larger` is above the bound or, if both are exact and it may, equal to it.

    None if they are surely equal within MARGIN.
    """
    gap = larger - bound
    if gap.low > 0 or (gap.low == gap.high == 0 and may_meet):
        return Outcome.YES
    if gap.high < 0 or gap.low == gap.high:
        return Outcome.NO
    return None if _are_alike(bound, larger) else Outcome.UNDECIDED


def _are_alike(one: Measured, other: Measured) -> bool:
    """Returns whether independent figures are tied by their ratio; exact bounds never are."""
    is_bound = any(figure.low == figure.high for figure in (one, other))
    if is_bound or min(one.low, other.low) <= 0:
        return False
    ratio = max(one / other, other / one, key=lambda ratio: ratio.value)
    ends = (ratio.low, ratio.high)
    return Ratio(ratio.value, *ends, False, *ends).rank == "tied"


def between(cell: str, figure: Measured | None, low: float, high: float, unit: str = "") -> Check:
    """Checks whether a figure is between two bounds; undecided if its interval contains one."""
    if figure is None:
        return Check(cell, Outcome.MISSING)
    if low <= figure.low and figure.high <= high:
        outcome = Outcome.YES
    elif figure.high < low or figure.low > high:
        outcome = Outcome.NO
    else:
        outcome = Outcome.UNDECIDED
    figures = f"{number(figure.value)}{unit} (allowed {number(low)} to {number(high)})"
    return Check(cell, outcome, figures, value=figure.value)


def aside(check: Check) -> Check:
    """Marks a cell as one that does not count."""
    return replace(check, aside=True)


def counted(checks: Sequence[Check]) -> list[Check]:
    """Returns the cells that count."""
    return [check for check in checks if not check.aside]


def verdict_of(checks: Sequence[Check]) -> Verdict:
    """Combines all cells into one verdict.

    A claim is supported if every cell agrees, contradicted if most disagree, and mixed otherwise.
    If a cell is missing, the claim is not tested. Undecided cells may go either way: there is a
    verdict if it is the same in every case.
    """
    number = Counter(check.outcome for check in counted(checks))
    if not number or number[Outcome.MISSING]:
        return Verdict.NOT_TESTED
    cells, undecided = number.total(), number[Outcome.UNDECIDED]
    possible = {_verdict_by(number[Outcome.NO] + more, cells) for more in range(undecided + 1)}
    return possible.pop() if len(possible) == 1 else Verdict.UNDECIDED


def _verdict_by(opposite: int, cells: int) -> Verdict:
    if opposite == 0:
        return Verdict.SUPPORTED
    return Verdict.CONTRADICTED if 2 * opposite > cells else Verdict.MIXED


def former_verdict(checks: Sequence[Check]) -> str:
    """Returns the verdict in the words of version 0.2, which had no word for contradictions.

    It called any mixture of cells "holds in part".
    """
    outcomes = {check.outcome for check in counted(checks)}
    if not outcomes or Outcome.MISSING in outcomes:
        return "not tested"
    if {Outcome.YES, Outcome.NO} <= outcomes:
        return "holds in part"
    if Outcome.UNDECIDED in outcomes:
        return "undecided"
    return "holds" if Outcome.YES in outcomes else "fails"


Rule = Callable[[Evidence], list[Check]]


@dataclass(frozen=True)
class Claim:
    """A row of the table of claims."""

    name: str
    where: str
    says: str
    question: Question
    rule: Rule
    is_figures: bool
    """Whether the claim is a list of figures, which agree with themselves by definition."""
    quantity: str | None = "times"
    """The unit of the effect; None if the comparisons have no common unit."""
    untestable: str = ""
    """Why stand-ins cannot test the claim, in one sentence; its cells are shown nevertheless."""


class Claims(list[Claim]):
    """The claims in the order of the thesis; rules register themselves."""

    def claim(
        self,
        name: str,
        where: str,
        says: str,
        question: Question,
        *,
        is_figures: bool = False,
        quantity: str | None = "times",
        untestable: str = "",
    ) -> Callable[[Rule], Rule]:
        """Decorates the rule of a claim."""

        def register(rule: Rule) -> Rule:
            self.append(Claim(name, where, says, question, rule, is_figures, quantity, untestable))
            return rule

        return register
