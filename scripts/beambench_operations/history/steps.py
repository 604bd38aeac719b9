"""Finds series of nights that stepped up and stayed there.

The series are logarithms of ratios to a contender of the same run, so that a shift of 0.05 is 5%.
A step is reported when
- ruptures finds a change with at least `side` nights before and after it (binary segmentation by
  the sum of absolute deviations, which outliers do not sway; Truong, Oudre and Vayatis, 2020);
- the medians before and after differ by more than chance explains: the shift over its standard
  error against Student's t, with Holm's correction over all series of the night;
- the block bootstrap's 95% interval of the shift lies above `tolerance`.

The rates of false alarms and missed slowdowns are measured, not derived, by
nightly/calibration.py.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import log, sqrt
from typing import TypeVar

import numpy as np
import ruptures
from scipy import stats

from beambench_operations.history.nights import nan_median


@dataclass(frozen=True)
class Rule:
    """The conditions for an alarm."""

    side: int = 12
    """The least number of nights on each side of a step."""
    window: int = 60
    """The number of recent nights that are examined."""
    level: float = 0.01
    """The chance that a night of pure noise raises any alarm, over all series together."""
    tolerance: float = 0.01
    """A shift whose interval reaches below this is not a regression."""
    inflation: float = 1.9
    """The factor by which the standard error is multiplied, found by calibration.

    It is above 1 because a change found by searching lies where the noise favors it, and because
    each night is examined again in the nights that follow.
    """


@dataclass(frozen=True)
class Step:
    """A step of one series."""

    series: int
    change: int
    """The first night of the new level."""
    before: int
    after: int
    """The number of nights compared."""
    shift: float
    low: float
    high: float
    p_value: float
    """The p-value without Holm's correction."""


Tested = TypeVar("Tested")
"""Anything with a `p_value`."""

_LEAST_NOISE = 0.002  # a short series may seem quieter than any clock
_BLOCK = 3
_RESAMPLES = 2000


def find_steps(
    values: np.ndarray, starts: Sequence[int] | None = None, rule: Rule | None = None
) -> list[Step]:
    """Returns the series (columns) that stepped up, as seen after the last night (row).

    Nights before `starts` are left out, because their steps were reported already.
    """
    rule = rule or Rule()
    count = values.shape[1]
    first = np.zeros(count, int) if starts is None else np.asarray(starts)
    tested = 0
    candidates: list[Step] = []
    hopeful = _may_have_risen(values[-rule.window :], rule)
    for series in range(count):
        begin = max(first[series], len(values) - rule.window)
        known = begin + np.flatnonzero(np.isfinite(values[begin:, series]))
        if len(known) < 2 * rule.side:
            continue
        tested += 1
        if hopeful[series] and (step := _last_step(values[known, series], rule)):
            split, start = step
            candidates.append(_measure(series, values[:, series], known, start, split, rule))
    return [step for step in holm(candidates, tested, rule.level) if step.low > rule.tolerance]


def _may_have_risen(recent: np.ndarray, rule: Rule) -> np.ndarray:
    """Returns whether each series' last nights are clearly slower; if not, no search is needed."""
    side = rule.side
    if len(recent) < 2 * side:
        return np.zeros(recent.shape[1], bool)
    changes = np.diff(recent, axis=0)
    noise = 1.4826 * nan_median(np.abs(changes - nan_median(changes))) / sqrt(2)
    now, near = nan_median(recent[-side:]), nan_median(recent[-2 * side : -side])
    far = nan_median(recent[:-side])
    rise = np.fmax(now - near, now - far)
    error = 1.2533 * noise * sqrt(1 / side + 1 / max(len(recent) - side, side))
    # NaN means gaps, which do not justify skipping the search.
    return ~((rise <= rule.tolerance) | (rise <= 2 * error))


def _last_step(values: np.ndarray, rule: Rule) -> tuple[int, int] | None:
    """Returns the start of the last change, and of the level before it; None without a change."""
    noise = max(_scale(np.diff(values)) / sqrt(2), _LEAST_NOISE)
    search = ruptures.Binseg(model="l1", min_size=rule.side, jump=1).fit(values.reshape(-1, 1))
    ends = search.predict(pen=2 * noise * log(len(values)))[:-1]
    if not ends:
        return None
    return ends[-1], ends[-2] if len(ends) > 1 else 0


def _measure(
    series: int, values: np.ndarray, known: np.ndarray, start: int, split: int, rule: Rule
) -> Step:
    before, after = values[known[start:split]], values[known[split:]]
    shift = float(np.median(after) - np.median(before))
    deviations = np.concatenate([before - np.median(before), after - np.median(after)])
    noise = max(_scale(deviations), _LEAST_NOISE)
    # 1.2533: for normal noise, the median's standard error exceeds the mean's by this factor.
    error = 1.2533 * noise * sqrt(1 / len(before) + 1 / len(after)) * _drag(deviations)
    p_value = float(stats.t.sf(shift / (rule.inflation * error), len(deviations) - 2))
    low, high = _bootstrap(before, after)
    change = int(known[split])
    return Step(series, change, len(before), len(after), shift, low, high, p_value)


def _scale(deviations: np.ndarray) -> float:
    """Returns the standard deviation of normal noise with this median absolute deviation."""
    return 1.4826 * float(np.median(np.abs(deviations - np.median(deviations))))


def _drag(deviations: np.ndarray) -> float:
    """Returns the factor by which correlated neighboring nights widen the error of a mean."""
    variance = float(np.mean(deviations**2))
    if variance == 0:
        return 1.0
    lag = float(np.mean(deviations[1:] * deviations[:-1])) / variance
    lag = min(max(lag, 0.0), 0.8)
    return sqrt((1 + lag) / (1 - lag))


def _bootstrap(before: np.ndarray, after: np.ndarray) -> tuple[float, float]:
    """Returns the 95% interval of the difference of medians; blocks keep neighbors together."""
    random = np.random.default_rng(1999)
    shifts = np.median(_resample(after, random), axis=1)
    shifts -= np.median(_resample(before, random), axis=1)
    low, high = np.quantile(shifts, (0.025, 0.975))
    return float(low), float(high)


def _resample(values: np.ndarray, random: np.random.Generator) -> np.ndarray:
    blocks = -(-len(values) // _BLOCK)
    starts = random.integers(0, len(values), (_RESAMPLES, blocks, 1))
    places = (starts + np.arange(_BLOCK)).reshape(_RESAMPLES, -1) % len(values)
    return values[places[:, : len(values)]]


def holm(candidates: Iterable[Tested], tested: int, level: float) -> list[Tested]:
    """Applies Holm's procedure: the chance of any false positive is at most `level`."""
    kept = []
    for rank, step in enumerate(sorted(candidates, key=lambda step: step.p_value)):
        if step.p_value > level / (tested - rank):
            break
        kept.append(step)
    return kept
