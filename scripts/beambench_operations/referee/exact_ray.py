"""The exact closest hit of one ray and a few triangles, in rational numbers.

It shares no code with the judge, so that a counterexample is confirmed twice.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

Vector = tuple[Fraction, Fraction, Fraction]
Triangle = tuple[Vector, Vector, Vector]


def vector(numbers: Sequence[float]) -> Vector:
    """Returns the exact values of floats."""
    x, y, z = map(Fraction, numbers)
    return x, y, z


def _minus(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _det(a: Vector, b: Vector, c: Vector) -> Fraction:
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def weights(triangle: Triangle, origin: Vector, direction: Vector) -> Vector:
    """Returns the barycentric coordinates, times their sum, where the line meets the plane."""
    a, b, c = (_minus(corner, origin) for corner in triangle)
    return _det(direction, b, c), _det(direction, c, a), _det(direction, a, b)


def crossing(triangle: Triangle, origin: Vector, direction: Vector) -> Fraction | None:
    """Returns t where the line meets the closed triangle; None if it misses or is parallel."""
    found = weights(triangle, origin, direction)
    total = sum(found)
    if total == 0 or (min(found) < 0 < max(found)):
        return None
    a, b, c = (_minus(corner, origin) for corner in triangle)
    return _det(a, b, c) / total


def closest(
    triangles: Sequence[Triangle],
    origin: Sequence[float],
    direction: Sequence[float],
    t_min: float = 0.0,
    t_max: float | None = None,
) -> Fraction | None:
    """Returns the smallest t in the closed interval; None if the ray hits nothing."""
    start, way = vector(origin), vector(direction)
    hits = (crossing(triangle, start, way) for triangle in triangles)
    inside = [
        t for t in hits if t is not None and t >= Fraction(t_min) and (t_max is None or t <= t_max)
    ]
    return min(inside, default=None)
