"""The analysis of runs, as made by `beambench run` and `analyze`.

It is implemented once, in harness/analysis; ratio.hpp describes the methods.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass
from typing import Any

from beambench import _beambench
from beambench._beambench import (
    MARGIN,
    break_even_rays,
    is_undisturbed,
    median_interval,
    name_cells,
    without_order,
)
from beambench.arrays import encoded

__all__ = [
    "MARGIN",
    "Median",
    "Ratio",
    "analyze",
    "block_ratio",
    "break_even_rays",
    "geometric_mean",
    "is_undisturbed",
    "median_interval",
    "name_cells",
    "paired_ratio",
    "unpaired_ratio",
    "without_order",
]


@dataclass(frozen=True)
class Ratio:
    """A ratio of two times, with its 95% interval if there are enough repetitions."""

    value: float
    low: float | None = None
    high: float | None = None
    paired: bool = False
    """Whether the ratio was computed block by block, or round by round."""
    predicted_low: float | None = None
    predicted_high: float | None = None
    """Covers the ratio of a second run of equal size with 95% probability; only with blocks."""
    error: float | None = None
    """The standard error of its logarithm; only with blocks."""

    @property
    def rank(self) -> str:
        """The rank of a contender with this ratio to the fastest.

        "tied": equivalent to the fastest, within MARGIN; "behind": clearly slower; "undecided";
        "unranked": no interval.
        """
        return _beambench.rank(*astuple(self)[:-1])

    @property
    def interval(self) -> tuple[float, float] | None:
        """Both ends; None if there is no interval, so that the ratio is not decisive."""
        return None if self.low is None or self.high is None else (self.low, self.high)


@dataclass(frozen=True)
class Median:
    """A median and its 95% interval; all values are positive."""

    value: float
    low: float | None = None
    high: float | None = None


def analyze(folder: str | bytes | os.PathLike[Any]) -> dict[str, Any]:
    """Analyzes the log of a run, which may have been cut off; returns the content of analysis.json.

    Raises InputError if the folder does not contain a log, or the log cannot be read.
    """
    return json.loads(_beambench.analyze(encoded("folder", folder)))


def paired_ratio(over: Mapping[int, float], under: Mapping[int, float]) -> Ratio | None:
    """Returns the median ratio of the common rounds; None if there are no common rounds."""
    found = _beambench.paired_ratio(dict(over), dict(under))
    return Ratio(*found) if found else None


def block_ratio(over: Mapping[int, float], under: Mapping[int, float]) -> Ratio | None:
    """Returns the geometric mean of the ratios of the common blocks.

    Its intervals are Student's t intervals. None if there are no common blocks.
    """
    found = _beambench.block_ratio(dict(over), dict(under))
    return Ratio(*found) if found else None


def unpaired_ratio(over: Median, under: Median) -> Ratio:
    """Returns the ratio of two medians, with an interval if both medians have one."""
    return Ratio(*_beambench.unpaired_ratio(astuple(over), astuple(under)))


def geometric_mean(ratios: Sequence[Ratio]) -> Ratio:
    """Returns the geometric mean of at least one ratio, with an interval if all ratios have one."""
    return Ratio(*_beambench.geometric_mean([astuple(ratio) for ratio in ratios]))
