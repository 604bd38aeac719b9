"""The ratio of two times, with its interval: the only place where ratios are computed.

Contenders of a run take turns, so the repetitions of one round ran side by side: a slow moment of
the machine is in both of them, and their ratio has less noise than either. Where both have their
repetitions, the ratio is therefore paired: the median of the rounds' ratios, and the 95% interval
of that median by order statistics, which holds for any distribution and, unlike a bootstrap, for
few rounds as well (Conover, Practical Nonparametric Statistics, section 3.2). Below six rounds
there is none.

Where only medians and their intervals are known, as of a published CSV, the ratio is not paired:
the distances of both medians to their ends add up in quadrature, on a logarithmic scale (Zou and
Donner, "Construction of confidence limits about effect measures", Statistics in Medicine 27, 2008).
Noise that both contenders of a run have in common makes that wider than it need be. Whether two
intervals overlap decides nothing: they may, and the ratio be clearly off 1.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from math import exp, hypot, log
from statistics import median

import pandas as pd
from scipy.stats import binom


@dataclass(frozen=True)
class Ratio:
    """A ratio of two times and its 95% interval, which too few repetitions do not have."""

    value: float
    low: float | None = None
    high: float | None = None
    paired: bool = False
    """Was it made round by round?"""

    @property
    def interval(self) -> tuple[float, float] | None:
        """Both ends, or None: then nothing can be decided by this ratio."""
        return None if self.low is None or self.high is None else (self.low, self.high)


@dataclass(frozen=True)
class Median:
    """A median and its 95% interval, all above 0."""

    value: float
    low: float | None = None
    high: float | None = None


def median_of(row: Mapping[str, object], phase: str) -> Median:
    """The median of a phase, "total" or "trace", of a row of results.csv, with its interval."""
    middle, low, high = (row.get(f"{phase}_ms_{what}") for what in ("median", "ci_low", "ci_high"))
    known = [None if end is None or pd.isna(end) else float(end) for end in (low, high)]
    return Median(float(middle), *known)


def paired_ratio(over: Mapping[int, float], under: Mapping[int, float]) -> Ratio | None:
    """The median ratio of the rounds that both have; None where they have none in common."""
    rounds = sorted(turn for turn in over.keys() & under.keys() if under[turn] > 0)
    if not rounds:
        return None
    ratios = sorted(over[turn] / under[turn] for turn in rounds)
    rank = interval_rank(len(ratios))
    if rank == 0:
        return Ratio(median(ratios), paired=True)
    return Ratio(median(ratios), ratios[rank - 1], ratios[-rank], paired=True)


def unpaired_ratio(over: Median, under: Median) -> Ratio:
    """The ratio of two medians; with an interval where both have one."""
    value = over.value / under.value
    ends = (over.low, over.high, under.low, under.high)
    if any(end is None or end <= 0 for end in ends):
        return Ratio(value)
    down = hypot(log(over.value / over.low), log(under.high / under.value))
    up = hypot(log(over.high / over.value), log(under.value / under.low))
    return Ratio(value, value * exp(-down), value * exp(up))


def geometric_mean(ratios: Sequence[Ratio]) -> Ratio:
    """Of at least one; with an interval where all have one.

    Scenes are measured one after another, so their noise is independent: the distances to their
    ends add up in quadrature.
    """
    count = len(ratios)
    value = exp(sum(log(ratio.value) for ratio in ratios) / count)
    intervals = [ratio.interval for ratio in ratios]
    if any(ends is None or ends[0] <= 0 for ends in intervals):
        return Ratio(value)
    known = [(ratio.value, *ends) for ratio, ends in zip(ratios, intervals, strict=True)]
    down = hypot(*(log(middle / low) for middle, low, _ in known)) / count
    up = hypot(*(log(high / middle) for middle, _, high in known)) / count
    paired = all(ratio.paired for ratio in ratios)
    return Ratio(value, value * exp(-down), value * exp(up), paired)


@cache
def interval_rank(count: int) -> int:
    """The rank of the lower end of the median's 95% interval; 0 where there is none.

    The number of samples below the median is binomial, whatever their distribution.
    """
    return int(binom.ppf(0.025, count, 0.5)) if count else 0
