"""How much slower the thesis's machines were, task by task, by its own figures.

Its seconds of gato-bill by beams (table 5.5) grow by a line with the rays. The slope is what a ray
takes in occupied leaves. What stands at no rays is what reading the scene, building the octree and
walking the beams take, which do not depend on the rays; how it is divided among them the thesis
does not tell. Here it is divided as ours is, and the page shows what comes of the extremes. One
factor for all would not do: our leaves test 64 samples at a time by SIMD, theirs one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beambench_report.ledger.comparisons import rays
from beambench_report.ledger.evidence import RESOLUTIONS
from beambench_report.ledger.published import published_evidence

# Table 5.5 was measured at 350 MHz, the cluster ran at 330.
_CLOCKS = 350 / 330
TRACED = "gato-bill"


@dataclass(frozen=True)
class Recorded:
    """Sums of a recorded picture, in seconds of the recording machine."""

    build_seconds: float
    walk_seconds: float
    work_seconds: float
    samples: int  # of the whole picture, leaving beams' included


@dataclass(frozen=True)
class Slowness:
    """So many times as long as on the recording machine."""

    build: float
    walk: float
    work: float


NONE = Slowness(1, 1, 1)


def thesis_seconds(scene: str = TRACED) -> tuple[float, float]:
    """Seconds that do not grow with the rays, and seconds a ray, on the cluster's machines."""
    evidence = published_evidence()
    seconds = [evidence.time(scene, "beam", resolution) for resolution in RESOLUTIONS]
    slope, constant = np.polyfit(
        [rays(resolution) for resolution in RESOLUTIONS],
        [each.value for each in seconds if each is not None],
        1,
    )
    return float(constant) * _CLOCKS, float(slope) * _CLOCKS


CONSTANTS = AS_OURS, ALL_WALKING, ALL_BUILDING = ("as ours", "all walking", "all building")


def slowness_of_1999(recorded: Recorded, constant_is: str = AS_OURS) -> Slowness:
    """From our own picture of the same scene; `constant_is`: how the constant is divided."""
    constant, a_ray = thesis_seconds()
    work = a_ray * recorded.samples / recorded.work_seconds
    if constant_is == ALL_WALKING:
        return Slowness(0, constant / recorded.walk_seconds, work)
    if constant_is == ALL_BUILDING:
        return Slowness(constant / recorded.build_seconds, 1e-9, work)
    both = constant / (recorded.build_seconds + recorded.walk_seconds)
    return Slowness(both, both, work)
