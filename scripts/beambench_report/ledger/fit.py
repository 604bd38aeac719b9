"""Straight lines and cost formulas by least squares."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beambench_report.ledger.measured import Measured


@dataclass(frozen=True)
class Line:
    """Least squares through points whose heights have intervals."""

    slope: Measured
    """From the least to the largest slope that heights within the intervals can have."""
    intercept: float
    r_squared: float
    within_intervals: bool
    """Does the line pass through every interval, so that nothing speaks against it?"""


def fit_line(places: Sequence[float], heights: Sequence[Measured]) -> Line:
    """Fits `heights` over `places`, of which at least three differ."""
    x = np.asarray(places, dtype=float)
    weights = (x - x.mean()) / np.sum((x - x.mean()) ** 2)  # the slope is linear in the heights
    value = np.array([height.value for height in heights])
    low = np.array([height.low for height in heights])
    high = np.array([height.high for height in heights])
    slope = Measured(
        float(weights @ value),
        float(np.sum(np.where(weights > 0, weights * low, weights * high))),
        float(np.sum(np.where(weights > 0, weights * high, weights * low))),
    )
    intercept = float(value.mean() - slope.value * x.mean())
    fitted = intercept + slope.value * x
    return Line(
        slope,
        intercept,
        r_squared(value, fitted),
        bool(np.all((low < high) & (low <= fitted) & (fitted <= high))),
    )


@dataclass(frozen=True)
class CostFit:
    """How well a sum of counts, each times a cost of its own, tells a time."""

    r_squared: float
    median_error: float
    """Median of |told - measured| / measured."""
    cells: int


def fit_costs(counts: Sequence[Sequence[float]], seconds: Sequence[float]) -> CostFit:
    """Fits a cost for each count by relative least squares: each cell counts alike."""
    matrix, measured = np.asarray(counts, dtype=float), np.asarray(seconds, dtype=float)
    scale = np.maximum(np.abs(matrix).max(axis=0), 1e-300)  # counts differ by orders of size
    scaled = matrix / scale
    costs = np.linalg.lstsq(scaled / measured[:, None], np.ones_like(measured), rcond=None)[0]
    told = scaled @ costs
    error = float(np.median(np.abs(told - measured) / measured))
    return CostFit(r_squared(measured, told), error, len(measured))


def r_squared(measured: np.ndarray, told: np.ndarray) -> float:
    """The part of the spread of what was measured that what is told explains."""
    spread = float(np.sum((measured - measured.mean()) ** 2))
    return 1.0 - float(np.sum((measured - told) ** 2)) / spread if spread > 0 else 1.0
