"""Measures how often pure noise raises a false alarm, and which slowdowns are found.

Noise is taken from repeated runs of one sweep by one program: groups of consecutive runs are
concatenated (block bootstrap), for all contenders of a scene together, since they share a
reference. Nights are then tested one by one with their predecessors, as by `scripts/nightly`.
"""

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from math import log1p, sqrt
from pathlib import Path
from time import monotonic

import numpy as np
import pandas as pd
from scipy import stats

from beambench_operations.history.night import references_of, views_of
from beambench_operations.history.nights import Nights
from beambench_operations.history.steps import Rule, find_steps
from beambench_report.base.analysis import read_analysis
from beambench_report.base.cell_files import name_of
from beambench_report.base.files import Problem
from beambench_report.base.records import read_run

_GROUP = 5
SCENES = 15
_LEAST_NIGHTS = 2 * _GROUP
_WAIT = 24
_REPORT_SECONDS = 10.0
_SEED = 1999


@dataclass(frozen=True)
class Noise:
    """Night-to-night noise without code changes: an array per scene, with a row for each night."""

    scenes: tuple[np.ndarray, ...]
    nights: int
    within: float | None = None
    """The standard error of a typical series, from the blocks of one night."""

    @property
    def standard_deviation(self) -> float:
        """Returns the noise of a typical series as a fraction of the time."""
        parts = np.concatenate([scene.std(axis=0) for scene in self.scenes])
        return float(np.median(parts))


@dataclass(frozen=True)
class Power:
    """How often a planted slowdown of one series was found and named."""

    slowdown: float
    found: float
    low: float
    """The 95% confidence interval of `found`."""
    high: float
    trials: int
    nights_until: float | None
    """The median number of nights from the change until it was found; None if it never was."""

    def __str__(self) -> str:
        """Returns the result as a sentence."""
        when = "" if self.nights_until is None else f", after {self.nights_until:.0f} nights"
        return (
            f"A slowdown by {self.slowdown:.1%} was found and named in {self.found:.1%} of "
            f"{self.trials} trials (95% confidence interval {self.low:.1%} to {self.high:.1%})"
            f"{when}."
        )


@dataclass(frozen=True)
class Calibration:
    """The false alarms and the power of a rule."""

    nights: int
    series: int
    alarms: int
    alarms_low: float
    """The 95% interval of the number of alarms, treating alarms as independent."""
    alarms_high: float
    noise: float
    noise_nights: int
    within: float | None
    rule: Rule
    power: tuple[Power, ...]

    @property
    def smallest_found(self) -> float | None:
        """Returns the smallest slowdown for which the interval of the power is above 90%."""
        return min((one.slowdown for one in self.power if one.low >= 0.9), default=None)

    def as_json(self) -> str:
        """Returns the result as JSON."""
        document = {**asdict(self), "smallest_slowdown_with_90_percent_power": self.smallest_found}
        return json.dumps(document, indent=2) + "\n"

    def summary(self) -> str:
        """Formats the result for people."""
        by_blocks = (
            ""
            if self.within is None
            else f"; by the blocks of one night it would be {100 * self.within:.2g}%"
        )
        lines = [
            f"{self.alarms} alarms in {self.nights} nights of pure noise over {self.series} series "
            f"together ({self._in_100_nights(self.alarms)} in 100 nights, 95% confidence interval "
            f"{self._in_100_nights(self.alarms_low)} to {self._in_100_nights(self.alarms_high)}); "
            f"the noise was drawn from {self.noise_nights} nights, {100 * self.noise:.2g}% "
            f"(standard deviation of a typical series){by_blocks}."
        ]
        lines += map(str, self.power)
        smallest = self.smallest_found
        named = f"{smallest:.1%}" if smallest is not None else "none of these"
        lines.append(
            "The smallest of these slowdowns with a power of 90% at the low end of the interval: "
            f"{named}."
        )
        return "\n".join(lines)

    def _in_100_nights(self, alarms: float) -> str:
        return f"{100 * alarms / self.nights:.2g}"


@dataclass(frozen=True)
class Effort:
    """The limits of the trials that measure the power."""

    precision: float = 0.03
    """Trials stop when no 95% interval of a power is wider than this to either side."""
    trials: int = 1200
    """The most trials: the default precision needs 1,067 where the power is one half."""
    seconds: float = 3600.0
    """The time limit; when it is reached, the intervals stay as wide as they are."""


Report = Callable[[str], None]


def noise_of(nights: Nights) -> Noise:
    """Returns the noise in the nights of a history during which nothing changed."""
    pooled = nights.pooled()
    whole = np.isfinite(pooled).all(axis=1)
    scenes = nights.pools["scene"].to_numpy()
    parts = tuple(pooled[np.ix_(whole, scenes == scene)] for scene in dict.fromkeys(scenes))
    squares = np.square(nights.errors)
    within = [squares[:, own].mean(axis=1) / len(own) for own in nights.pools["members"]]
    return Noise(parts, int(whole.sum()), sqrt(np.nanmedian(within)) if within else None)


def has_enough(noise: Noise) -> bool:
    """Returns whether there are enough nights to draw from."""
    return noise.nights >= _LEAST_NIGHTS and bool(noise.scenes)


def synthetic_nights(noise: Noise, nights: int, random: np.random.Generator) -> np.ndarray:
    """Draws nights of pure noise over as many scenes as a nightly sweep has."""
    columns = []
    for number in range(SCENES):
        source = noise.scenes[number % len(noise.scenes)]
        starts = random.integers(0, len(source), -(-nights // _GROUP))
        places = (starts[:, None] + np.arange(_GROUP)).ravel() % len(source)
        columns.append(source[places[:nights]])
    return np.concatenate(columns, axis=1)


def count_alarms(values: np.ndarray, rule: Rule) -> list[tuple[int, int, int]]:
    """Returns the night, the series and the night of the change of every alarm that successive
    nights raise.
    """
    starts = np.zeros(values.shape[1], int)
    alarms = []
    for night in range(2 * rule.side, len(values) + 1):
        begin = max(0, night - rule.window)
        for step in find_steps(values[begin:night], np.maximum(starts - begin, 0), rule):
            alarms.append((night - 1, step.series, begin + step.change))
            starts[step.series] = begin + step.change
    return alarms


def calibrate(
    noise: Noise,
    nights: int = 1000,
    slowdowns: Sequence[float] = (0.01, 0.015, 0.02, 0.03, 0.05),
    effort: Effort | None = None,
    report: Report | None = None,
) -> Calibration:
    """Tests pure noise, then noise with one slowed series; `report` receives progress."""
    rule, random = Rule(), np.random.default_rng(_SEED)
    values = synthetic_nights(noise, nights, random)
    alarms = len(count_alarms(values, rule))
    # The exact interval of a Poisson count (Garwood 1936).
    low = float(stats.chi2.ppf(0.025, 2 * alarms) / 2) if alarms else 0.0
    high = float(stats.chi2.ppf(0.975, 2 * alarms + 2) / 2)
    power = _powers(noise, slowdowns, effort or Effort(), rule, random, report)
    alarmed = (alarms, low, high)
    drawn_from = (noise.standard_deviation, noise.nights, noise.within)
    return Calibration(nights, values.shape[1], *alarmed, *drawn_from, rule, power)


def share_interval(found: int, trials: int) -> tuple[float, float]:
    """Returns the 95% interval of a share (Wilson 1927), which is valid near 0 and 1 as well."""
    interval = stats.binomtest(found, trials).proportion_ci(method="wilson")
    return float(interval.low), float(interval.high)


def _powers(
    noise: Noise,
    slowdowns: Sequence[float],
    effort: Effort,
    rule: Rule,
    random: np.random.Generator,
    report: Report | None,
) -> tuple[Power, ...]:
    """Measures the power for each slowdown.

    Each trial plants every slowdown into the same noise, so chance does not reorder them.
    """
    waits: dict[float, list[int]] = {slowdown: [] for slowdown in slowdowns}
    begun, reported, trials = monotonic(), monotonic(), 0
    before = rule.window - _WAIT
    while trials < effort.trials and monotonic() - begun < effort.seconds:
        values = synthetic_nights(noise, rule.window, random)
        series = int(random.integers(values.shape[1]))
        for slowdown, found in waits.items():
            if wait := _nights_until_found(values, series, before, slowdown, rule):
                found.append(wait)
        trials += 1
        intervals = [share_interval(len(found), trials) for found in waits.values()]
        widest = max((high - low for low, high in intervals), default=0.0) / 2
        if report and monotonic() - reported > _REPORT_SECONDS:
            reported = monotonic()
            report(
                f"{trials} trials, {reported - begun:.0f} s: powers are known to within "
                f"{100 * widest:.1f} points, {100 * effort.precision:g} wanted"
            )
        if widest <= effort.precision:
            break
    return tuple(
        Power(
            slowdown,
            len(found) / trials,
            *share_interval(len(found), trials),
            trials,
            float(np.median(found)) if found else None,
        )
        for slowdown, found in waits.items()
    )


def _nights_until_found(
    values: np.ndarray, series: int, before: int, slowdown: float, rule: Rule
) -> int:
    """Returns the nights from the slowdown until the series was named; 0 if not within `_WAIT`.

    The other series are unchanged; they matter because Holm's correction depends on their number.
    """
    slower = values.copy()
    slower[before:, series] += log1p(slowdown)
    for night in range(before + rule.side, len(slower) + 1):
        if any(step.series == series for step in find_steps(slower[:night], None, rule)):
            return night - before
    return 0


_BLOCKS = 8  # the blocks that are drawn for a night
_NIGHTS = 200


def noise_of_samples(folders: Iterable[Path]) -> Noise:
    """Returns the noise of nights drawn from the blocks of runs, without day-to-day variation.

    Raises Problem if no run has as many blocks as a night.
    """
    random = np.random.default_rng(_SEED)
    drawn = [noise for folder in folders for noise in _drawn(folder, random)]
    if not drawn:
        raise Problem(
            f"no run has a view with Embree, others, and {_BLOCKS} blocks; give runs of a sweep "
            f"with that many blocks"
        )
    scenes = tuple(scene for noise in drawn for scene in noise.scenes)
    within = [noise.within for noise in drawn if noise.within is not None]
    return Noise(scenes, _NIGHTS, float(np.median(within)) if within else None)


def _drawn(folder: Path, random: np.random.Generator) -> Iterator[Noise]:
    """Yields the noise of a run's scenes, if any; all cells use the same drawn blocks."""
    rows = read_run(folder).rows
    bases, totals = references_of(rows), read_analysis(folder).block_totals
    names = [name_of(row) for row in rows.to_dict("records")]
    logs = {}
    for place, view in enumerate(views_of(rows)):
        own = pd.Series(totals.get(names[place], {}), dtype=float)
        base = pd.Series(totals.get(names[bases[view]], {}) if view in bases else {}, dtype=float)
        if np.isfinite(ratio := np.log(own / base)).sum() >= _BLOCKS:
            logs[place] = ratio
    if not logs:
        return
    table = pd.DataFrame(logs)
    blocks = random.integers(0, len(table), (_NIGHTS, _BLOCKS))
    cells = rows.iloc[list(logs)].reset_index(drop=True)
    cells["is_reference"] = np.isin(list(logs), list(bases.values()))
    nights = table.to_numpy()[blocks]
    ratios = np.exp(np.nanmean(nights, axis=1))
    errors = np.nanstd(nights, axis=1, ddof=1) / sqrt(_BLOCKS)
    no_works = np.full(ratios.shape, -1)
    yield noise_of(Nights(pd.DataFrame(), cells, ratios, errors, no_works, {}))
