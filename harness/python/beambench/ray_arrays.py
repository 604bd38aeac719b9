"""Rays as one array."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beambench import _beambench
from beambench._beambench import InputError
from beambench.arrays import reals


def _rows(name: str, given: ArrayLike) -> NDArray[np.float32]:
    """Returns vectors: one for each ray, or a single one for all rays."""
    array = np.asarray(given)
    return reals(name, given, (3,) if array.ndim == 1 else ("N", 3), np.float32)


def _interval(name: str, given: ArrayLike) -> NDArray[np.float32]:
    """Returns numbers: one for each ray, or a single one for all rays."""
    array = np.asarray(given)
    return reals(name, given, () if array.ndim == 0 else ("N",), np.float32)


def rays(
    origins: ArrayLike,
    directions: ArrayLike,
    t_min: ArrayLike = 0.0,
    t_max: ArrayLike = np.inf,
) -> NDArray[np.float32]:
    """Combines the components of rays into one array, rounding each to float32 once.

    Args:
        origins: shape (N, 3), or (3,) for all rays.
        directions: shape (N, 3), or (3,) for all rays; they define the unit of t. The absolute
            value of the largest component must be from 1e-30 to 1e9.
        t_min: shape (N,) or one number; not negative.
        t_max: shape (N,) or one number; may be infinite.

    Returns:
        A new array of shape (N, 8), float32: origin, t_min, direction, t_max. All functions accept
        it without a copy.

    Raises:
        InputError: the arrays differ in their number of rows, or a ray is invalid; the message
            states its index.
    """
    parts = {
        "origins": _rows("origins", origins),
        "directions": _rows("directions", directions),
        "t_min": _interval("t_min", t_min),
        "t_max": _interval("t_max", t_max),
    }
    counts = {
        name: len(part)
        for name, part in parts.items()
        if part.ndim == (2 if name.endswith("s") else 1)
    }
    if len(set(counts.values())) > 1:
        found = ", ".join(f"{count} {name}" for name, count in counts.items())
        raise InputError(f"there are {found}; expected equal numbers of each, or one for all rays")
    made = np.empty((next(iter(counts.values()), 1), 8), np.float32)
    made[:, 0:3] = parts["origins"]
    made[:, 3] = parts["t_min"]
    made[:, 4:7] = parts["directions"]
    made[:, 7] = parts["t_max"]
    _beambench.require_valid_rays(made)
    return made
