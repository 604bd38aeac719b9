"""A formula fitted: coefficients with intervals, and how well they tell the times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beambench_report.ledger.fit import r_squared
from beambench_report.ledger.measured import Measured
from beambench_report.thesis.cost.formulas import Formula, Observation
from beambench_report.thesis.cost.least_squares import relative_equations, solve

LEAST_CELLS = 10
_LEAST_SCENES = 3  # from which on scenes can be drawn again, or one be left out
_DRAWS = 1000
_SEED = 1999


@dataclass(frozen=True)
class Fit:
    """One formula, the cells it was fitted to, and what it tells of them."""

    formula: Formula
    observations: tuple[Observation, ...]
    coefficients: tuple[Measured, ...]
    """Nanoseconds each; the interval is (nan, nan) with too few scenes."""
    told: tuple[float, ...]
    """Nanoseconds, by the fitted coefficients."""
    r_squared: float
    errors: tuple[float, ...]
    """|told - measured| / measured."""
    errors_of_strangers: tuple[float, ...]
    """The same, each scene told by what was fitted to all others; empty with too few."""

    @property
    def scenes(self) -> int:
        """How many scenes the cells are of."""
        return len({observation.cell.scene for observation in self.observations})


def fit(formula: Formula, observations: Sequence[Observation]) -> Fit | None:
    """Fits a formula to cells; None if there are too few."""
    if len(observations) < LEAST_CELLS:
        return None
    counts = np.array([observation.counts for observation in observations], dtype=float)
    times = np.array([observation.time for observation in observations])
    scenes_of = [observation.cell.scene for observation in observations]
    groups = np.unique(scenes_of, return_inverse=True)[1]
    equations = relative_equations(counts, times, groups)
    every = np.ones((1, len(equations.aims)))
    values = solve(equations.sums(every))[0]
    told = counts @ values
    low = high = np.full(len(values), np.nan)
    strangers: tuple[float, ...] = ()
    scenes = len(equations.aims)
    if scenes >= _LEAST_SCENES:
        drawn = np.random.default_rng(_SEED).multinomial(scenes, [1 / scenes] * scenes, _DRAWS)
        low, high = np.percentile(solve(equations.sums(drawn)), [2.5, 97.5], axis=0)
        others = solve(equations.sums(1 - np.eye(scenes)))[groups]
        strangers = _errors(np.sum(counts * others, axis=1), times)
    return Fit(
        formula,
        tuple(observations),
        tuple(Measured(*map(float, figures)) for figures in zip(values, low, high, strict=True)),
        tuple(map(float, told)),
        r_squared(times, told),
        _errors(told, times),
        strangers,
    )


def _errors(told: np.ndarray, times: np.ndarray) -> tuple[float, ...]:
    return tuple(map(float, np.abs(told - times) / times))
