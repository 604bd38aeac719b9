"""How often does pure noise raise an alarm, and how small a slow-down is found?

Noise is taken from repeated runs of one sweep by one program: blocks of consecutive runs are put
one after another (block bootstrap), all contenders of a scene together, since they share a
reference. Nights are then judged one by one, each with those before it, as `scripts/nightly` does.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from math import log1p

import numpy as np

from beambench_report.nightly.nights import Nights
from beambench_report.nightly.steps import Rule, find_steps

BLOCK = 5
SCENES = 15
_LEAST_NIGHTS = 2 * BLOCK
_WAIT = 24


@dataclass(frozen=True)
class Noise:
    """What nights without any change differ by: for each scene an array, a row a night."""

    scenes: tuple[np.ndarray, ...]
    nights: int

    @property
    def standard_deviation(self) -> float:
        """Of a usual series, as a part of the time."""
        parts = np.concatenate([scene.std(axis=0) for scene in self.scenes])
        return float(np.median(parts))


@dataclass(frozen=True)
class Power:
    """How often a planted slow-down of one series was found and named."""

    slowdown: float
    found: float
    nights_until: float
    """The median number of nights after the change until it was."""


@dataclass(frozen=True)
class Calibration:
    """What a rule comes to."""

    nights: int
    series: int
    alarms: int
    noise: float
    noise_nights: int
    rule: Rule
    power: tuple[Power, ...]

    @property
    def smallest_found(self) -> float | None:
        """The smallest slow-down that is found with 90% power."""
        return min((one.slowdown for one in self.power if one.found >= 0.9), default=None)

    def as_json(self) -> str:
        """For a file."""
        told = {**asdict(self), "smallest_slowdown_with_90_percent_power": self.smallest_found}
        return json.dumps(told, indent=2) + "\n"

    def summary(self) -> str:
        """For people."""
        lines = [
            f"{self.alarms} alarms in {self.nights} nights of pure noise over {self.series} series "
            f"together ({100 * self.alarms / self.nights:.2g} in 100 nights); the noise was drawn "
            f"from {self.noise_nights} nights, {100 * self.noise:.2g}% (standard deviation of a "
            "usual series)."
        ]
        lines += [
            f"A slow-down by {one.slowdown:.1%} was found and named in {one.found:.0%} of the "
            f"trials, after {one.nights_until:.0f} nights."
            for one in self.power
        ]
        smallest = self.smallest_found
        told = f"{smallest:.1%}" if smallest is not None else "none of these"
        lines.append(f"The smallest slow-down found with 90% power: {told}.")
        return "\n".join(lines)


def noise_of(nights: Nights) -> Noise:
    """The noise of the nights of a history in which nothing changed."""
    pooled = nights.pooled()
    whole = np.isfinite(pooled).all(axis=1)
    scenes = nights.pools["scene"].to_numpy()
    parts = tuple(pooled[np.ix_(whole, scenes == scene)] for scene in dict.fromkeys(scenes))
    return Noise(parts, int(whole.sum()))


def has_enough(noise: Noise) -> bool:
    """Are there nights enough to draw blocks from?"""
    return noise.nights >= _LEAST_NIGHTS and bool(noise.scenes)


def made_up_nights(noise: Noise, nights: int, random: np.random.Generator) -> np.ndarray:
    """Nights of pure noise over as many scenes as a nightly sweep has."""
    columns = []
    for number in range(SCENES):
        source = noise.scenes[number % len(noise.scenes)]
        starts = random.integers(0, len(source), -(-nights // BLOCK))
        places = (starts[:, None] + np.arange(BLOCK)).ravel() % len(source)
        columns.append(source[places[:nights]])
    return np.concatenate(columns, axis=1)


def count_alarms(values: np.ndarray, rule: Rule) -> list[tuple[int, int, int]]:
    """Night, series and night of the change of every alarm, as night after night would raise it."""
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
    slowdowns: Iterable[float] = (0.01, 0.015, 0.02, 0.03, 0.05),
    trials: int = 100,
    rule: Rule | None = None,
    seed: int = 1999,
) -> Calibration:
    """Lets noise, and noise with a slow-down of one series, be judged."""
    rule = rule or Rule()
    random = np.random.default_rng(seed)
    values = made_up_nights(noise, nights, random)
    alarms = count_alarms(values, rule)
    power = tuple(_power(noise, slowdown, trials, rule, random) for slowdown in slowdowns)
    return Calibration(
        nights,
        values.shape[1],
        len(alarms),
        noise.standard_deviation,
        noise.nights,
        rule,
        power,
    )


def _power(
    noise: Noise, slowdown: float, trials: int, rule: Rule, random: np.random.Generator
) -> Power:
    """Sees whether the series is named within `_WAIT` nights after it got slower."""
    waits = []
    before = rule.window - _WAIT
    for _ in range(trials):
        values = made_up_nights(noise, rule.window, random)
        series = int(random.integers(values.shape[1]))
        values[before:, series] += log1p(slowdown)
        # The others are as they were: they count by making Holm's correction what it is.
        for night in range(before + rule.side, rule.window + 1):
            if any(step.series == series for step in find_steps(values[:night], None, rule)):
                waits.append(night - before)
                break
    return Power(slowdown, len(waits) / trials, float(np.median(waits)) if waits else float("nan"))
