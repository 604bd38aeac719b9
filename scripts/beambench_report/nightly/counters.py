"""Did a structure need more work for the same rays?

Counters have no noise: the same program asked the same rays counts the same. Each is held to the
least it has been since it was last reported (in the nights that judge.py looks at), so that many
small steps are found like a large one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beambench_report.nightly.nights import Nights

SHARE = 0.001
"""An increase by more than this part of a counter is a regression."""


@dataclass(frozen=True)
class Increase:
    """One counter of one cell."""

    cell: int
    counter: str
    before: float
    after: float

    @property
    def share(self) -> float:
        """The part of it that was added; infinite where there was none before."""
        return self.after / self.before - 1 if self.before > 0 else float("inf")


def find_increases(nights: Nights, share: float = SHARE) -> list[Increase]:
    """What the last night counted more of than any night since the counter was last reported."""
    if len(nights.nights) < 2:
        return []
    found = []
    names = {name for known in nights.counters.values() for name in known}
    for name in sorted(names):
        values = _values(nights, name)
        before = _least_before(values, share)
        after = values[-1]
        with np.errstate(invalid="ignore"):
            more = after > before * (1 + share)
        found += [
            Increase(int(cell), name, float(before[cell]), float(after[cell]))
            for cell in np.flatnonzero(more)
        ]
    return sorted(found, key=lambda one: -one.share)


def _values(nights: Nights, name: str) -> np.ndarray:
    """A counter in each night of each cell; NaN where it was not counted."""
    numbers = np.fromiter(nights.counters, int, len(nights.counters))
    known = np.full(max(numbers, default=0) + 2, np.nan)  # the last place is that of -1
    for number, counters in nights.counters.items():
        known[number] = counters.get(name, np.nan)
    return known[nights.works]


def _least_before(values: np.ndarray, share: float) -> np.ndarray:
    least = np.full(values.shape[1], np.nan)
    for night in values[:-1]:
        with np.errstate(invalid="ignore"):
            reported = night > least * (1 + share)
        least = np.where(reported, night, np.fmin(least, night))
    return least
