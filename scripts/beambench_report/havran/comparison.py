"""Ours beside the published: ratios, and whether structures are in the same order."""

from dataclasses import dataclass
from itertools import combinations

from scipy.stats import gmean

from beambench_report.havran.counts import Case, Counts

SIZES = ("N_IN", "N_V", "N_EV", "N_OIV")
WORK = ("N_IT", "N_TS", "N_ETS", "N_EETS")
QUANTITIES = (*SIZES, *WORK)
WITHIN = 0.05
"""A difference up to this needs no explanation."""
APART = 0.02
"""Structures whose counts differ by less than this have no order: they are the same."""


@dataclass(frozen=True)
class Ratios:
    """Ours over the published, of several cases."""

    values: tuple[float, ...]

    @property
    def mean(self) -> float:
        """Geometric."""
        return float(gmean(self.values))

    @property
    def within(self) -> int:
        """The number of counts that differ by at most `WITHIN`."""
        return sum(abs(value - 1) <= WITHIN for value in self.values)


@dataclass(frozen=True)
class Order:
    """Pairs of structures that the published counts put in an order."""

    pairs: int
    same: int
    level: int
    """Ours are the same there, to within `APART`."""
    reversed: tuple[tuple[Case, Case], ...] = ()
    """Those that ours put the other way."""


def ratios(
    ours: Counts,
    published: Counts,
    quantity: str,
    structure: str | None = None,
    scene: str | None = None,
) -> Ratios | None:
    """Returns ratios over all common cases; None if all published counts are 0."""
    values = tuple(
        ours[case][quantity] / published[case][quantity]
        for case in ours
        if structure in (None, case.structure)
        and scene in (None, case.scene)
        and case in published
        and published[case].get(quantity, 0) > 0
        and ours[case].get(quantity, 0) > 0
    )
    return Ratios(values) if values else None


def order(ours: Counts, published: Counts, quantity: str) -> Order:
    """Over all scenes and settings: each two structures that both sides have there."""
    pairs = same = level = 0
    reverse = []
    for one, other in combinations(ours, 2):
        if (one.scene, one.setting) != (other.scene, other.setting):
            continue
        if one not in published or other not in published:
            continue
        theirs = _sign(published[one][quantity], published[other][quantity])
        if theirs == 0:
            continue
        mine = _sign(ours[one][quantity], ours[other][quantity])
        pairs += 1
        same += mine == theirs
        level += mine == 0
        if mine == -theirs:
            reverse.append((one, other))
    return Order(pairs, same, level, tuple(reverse))


def _sign(one: float, other: float) -> int:
    if abs(one - other) <= APART * max(one, other):
        return 0
    return 1 if one > other else -1
