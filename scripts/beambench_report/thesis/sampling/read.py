"""Reads what `beambench sampling SCENE --json` printed."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from beambench_report.problem import Problem

UNIFORM = "uniform"
_THESIS = (UNIFORM, "5")


@dataclass(frozen=True)
class Way:
    """One way of sampling the image."""

    method: str
    setting: str
    rays: float
    """A pixel."""
    milliseconds: float
    error: float
    """Root mean square, of 255, against 64 samples a pixel."""

    @property
    def is_thesis(self) -> bool:
        """Is it five samples in every pixel whose beam does not leave?"""
        return (self.method, self.setting) == _THESIS


@dataclass(frozen=True)
class Comparison:
    """The ways of one scene."""

    path: Path
    scene: str
    structure: str
    resolution: str
    repetitions: int
    ways: tuple[Way, ...]

    @property
    def methods(self) -> list[str]:
        """Each once, in the order of the file."""
        return list(dict.fromkeys(way.method for way in self.ways))

    @property
    def thesis(self) -> Way | None:
        """The thesis's way, where it was tried."""
        return next((way for way in self.ways if way.is_thesis), None)

    def of(self, method: str) -> list[Way]:
        """The settings of a method, the quickest first."""
        return sorted(
            (way for way in self.ways if way.method == method), key=lambda way: way.milliseconds
        )

    def time_at_error(self, method: str, error: float) -> float | None:
        """Milliseconds in which a method reaches an error, between two settings as they are
        drawn, by a straight line of logarithms; None beyond what was tried.
        """
        return _between([(way.error, way.milliseconds) for way in self.of(method)], error)

    def reached(self, method: str, error: float) -> tuple[float, bool] | None:
        """The least time in which a method reaches an error or a smaller one; is it that error
        between two settings, and not a smaller one of a setting that was tried? None where every
        setting has a larger error.
        """
        crossing = self.time_at_error(method, error)
        settings = [way.milliseconds for way in self.of(method) if way.error <= error]
        if crossing is not None and (not settings or crossing <= min(settings)):
            return crossing, True
        return (min(settings), False) if settings else None

    def error_at_time(self, method: str, milliseconds: float) -> float | None:
        """The error that a method reaches in a time; None beyond what was tried."""
        return _between([(way.milliseconds, way.error) for way in self.of(method)], milliseconds)


def read_comparison(path: Path) -> Comparison:
    """Raises Problem where the file is not what `beambench sampling --json` prints."""
    try:
        source = json.loads(path.read_text("utf-8"))
        ways = tuple(_way(entry) for entry in source["results"])
        if not ways:
            raise ValueError("no results")
        return Comparison(
            path,
            str(source["scene"]),
            str(source["structure"]),
            str(source["resolution"]),
            int(source["repetitions"]),
            ways,
        )
    except FileNotFoundError:
        raise Problem(
            f"{path}: there is no such file; write it with `beambench sampling SCENE --json`"
        ) from None
    except (ValueError, KeyError, TypeError, OSError) as error:
        raise Problem(
            f"{path}: is not what `beambench sampling SCENE --json` prints ({error})"
        ) from None


def _way(entry: dict[str, Any]) -> Way:
    way = Way(
        str(entry["method"]),
        str(entry["setting"]),
        float(entry["rays_per_pixel"]),
        float(entry["trace_ms"]),
        float(entry["error"]),
    )
    if not (way.milliseconds > 0 and math.isfinite(way.milliseconds) and way.error >= 0):
        raise ValueError(f"{way.method} {way.setting}: trace_ms and error must be positive")
    return way


def _between(points: Sequence[tuple[float, float]], at: float) -> float | None:
    """The first crossing along a line of logarithms."""
    logs = [(math.log(x), math.log(y)) for x, y in points if x > 0 and y > 0]
    wanted = math.log(at) if at > 0 else math.inf
    for (x0, y0), (x1, y1) in pairwise(logs):
        if min(x0, x1) <= wanted <= max(x0, x1):
            part = 0.0 if x0 == x1 else (wanted - x0) / (x1 - x0)
            return math.exp(y0 + part * (y1 - y0))
    return None
