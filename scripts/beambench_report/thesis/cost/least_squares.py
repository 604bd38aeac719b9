"""Least squares of relative errors whose coefficients are not negative.

With a handful of terms there are few choices of those that stay away from zero, and the best of
all choices whose plain least squares are positive is the solution: all are tried. Fits work on the
normal equations, which of several groups of cells add up, and on many of them at once, so that the
thousand fits of a bootstrap cost little.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

_SAME = 1e-10  # columns whose part of their own is less say the same


@dataclass(frozen=True)
class NormalEquations:
    """What fits need to know of groups of cells; the first axis is that of the groups."""

    products: np.ndarray
    """Of the columns with each other: groups x terms x terms."""
    aims: np.ndarray
    """Of the columns with what is to be told: groups x terms."""

    def sums(self, weights: np.ndarray) -> NormalEquations:
        """Of unions of the groups, each as often as the rows of `weights` say."""
        return NormalEquations(
            np.tensordot(weights, self.products, axes=1), np.tensordot(weights, self.aims, axes=1)
        )


def relative_equations(
    counts: np.ndarray, times: np.ndarray, groups: np.ndarray
) -> NormalEquations:
    """Every cell counts alike, however long it took: the error is (told - measured) / measured."""
    shares = counts / times[:, None]
    parts = [shares[groups == group] for group in np.unique(groups)]
    return NormalEquations(
        np.stack([part.T @ part for part in parts]), np.stack([part.sum(axis=0) for part in parts])
    )


def solve(equations: NormalEquations) -> np.ndarray:
    """For each group the coefficients, none negative, that make the sum of the squares least."""
    lengths = np.sqrt(np.einsum("gtt->gt", equations.products))
    scale = np.where(lengths > 0, lengths, 1.0)
    products = equations.products / (scale[:, :, None] * scale[:, None, :])
    aims = equations.aims / scale
    groups, terms = aims.shape
    best, gains = np.zeros_like(aims), np.zeros(groups)
    for count in range(1, terms + 1):
        for chosen in combinations(range(terms), count):
            of = list(chosen)
            inverses = np.linalg.pinv(products[:, of][:, :, of], rcond=_SAME, hermitian=True)
            found = np.einsum("gst,gt->gs", inverses, aims[:, of])
            gain = np.sum(found * aims[:, of], axis=1)
            better = (found >= 0).all(axis=1) & (gain > gains)
            gains = np.where(better, gain, gains)
            best[better] = 0.0
            best[np.ix_(better, of)] = found[better]
    return best / scale
