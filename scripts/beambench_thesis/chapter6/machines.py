"""The simulated clusters, and how much slower the thesis's machines were."""

from __future__ import annotations

from dataclasses import asdict, astuple, dataclass
from itertools import chain

import numpy as np

from beambench_report.base.published import RESOLUTIONS, rays
from beambench_thesis.paper.evidence import published_evidence


def options(**values: object) -> list[str]:
    """Returns `--walk-scale 2` for `walk_scale=2`."""
    names = (f"--{name.replace('_', '-')}" for name in values)
    return list(chain.from_iterable(zip(names, map(str, values.values()), strict=True)))


@dataclass(frozen=True)
class Network:
    """A network. Its bytes per second exclude headers, which are 7% to 12% of the bits."""

    name: str
    kind: str  # shared: one medium for all; switched: a line for each machine, in both directions
    bytes_per_second: float
    latency_seconds: float

    def arguments(self) -> list[str]:
        """Returns arguments of the simulator."""
        bandwidth, latency = self.bytes_per_second, self.latency_seconds
        return options(network=self.kind, bandwidth=bandwidth, latency=latency)


@dataclass(frozen=True)
class Messages:
    """The processor time that messages cost the sender and the receiver."""

    message_seconds: float
    byte_seconds: float
    look_seconds: float

    def arguments(self) -> list[str]:
        """Returns arguments of the simulator."""
        return options(**asdict(self))

    def times(self, factor: float) -> Messages:
        """Returns the costs multiplied by a factor."""
        return Messages(*(seconds * factor for seconds in astuple(self)))


SHARED = Network("shared 10 Mbit/s", "shared", 1.1e6, 7e-5)
SWITCHED = Network("switched 100 Mbit/s", "switched", 1.1e7, 7e-5)
MODERN = Network("switched 10 Gbit/s", "switched", 1.15e9, 1e-5)

MESSAGES_OF_1999 = Messages(7e-5, 1.5e-8, 2e-5)
MESSAGES_OF_TODAY = Messages(1e-6, 1e-10, 2e-7)

# The thesis sends pixels, not samples: a position and a color in about 8 bytes; 5 samples make one
# pixel.
BYTES_PER_SAMPLE_OF_1999 = 8 / 5


# Table 5.5 was measured at 350 MHz; the cluster ran at 330 MHz.
_CLOCKS = 350 / 330
TRACED = "gato-bill"


@dataclass(frozen=True)
class Recorded:
    """Totals of a recorded picture, in seconds of the recording machine."""

    build_seconds: float
    walk_seconds: float
    work_seconds: float
    samples: int  # of the whole picture, including those of beams that leave
    pre_pass_seconds: float = 0.0  # the time to estimate the costs of windows


@dataclass(frozen=True)
class Slowness:
    """The slowness of machines as factors of the times of the recording machine."""

    build: float
    walk: float
    work: float


NONE = Slowness(1, 1, 1)


def thesis_seconds() -> tuple[float, float]:
    """Returns the constant seconds and the seconds per ray on the cluster's machines."""
    evidence = published_evidence()
    seconds = [evidence.time(TRACED, "beam", resolution) for resolution in RESOLUTIONS]
    slope, constant = np.polyfit(
        [rays(resolution) for resolution in RESOLUTIONS],
        [each.value for each in seconds if each is not None],
        1,
    )
    return float(constant) * _CLOCKS, float(slope) * _CLOCKS


AS_OURS, ALL_WALKING, ALL_BUILDING = ("as ours", "all walking", "all building")


def slowness_of_1999(recorded: Recorded, constant_is: str = AS_OURS) -> Slowness:
    """Derives the factors from our picture; `constant_is` states how to divide the constant."""
    constant, per_ray = thesis_seconds()
    work = per_ray * recorded.samples / recorded.work_seconds
    if constant_is == ALL_WALKING:
        return Slowness(0, constant / recorded.walk_seconds, work)
    if constant_is == ALL_BUILDING:
        return Slowness(constant / recorded.build_seconds, 1e-9, work)
    both = constant / (recorded.build_seconds + recorded.walk_seconds)
    return Slowness(both, both, work)
