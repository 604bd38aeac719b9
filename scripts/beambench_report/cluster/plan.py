"""Which simulations are made."""

from __future__ import annotations

from dataclasses import dataclass, replace

from beambench_report.cluster.calibration import ALL_BUILDING, ALL_WALKING, AS_OURS
from beambench_report.cluster.machines import (
    BYTES_A_SAMPLE_OF_1999,
    MESSAGES_OF_1999,
    MESSAGES_OF_TODAY,
    MODERN,
    SHARED,
    SWITCHED,
    Messages,
    Network,
)
from beambench_report.cluster.record import BEAMS, BLOCKS
from beambench_report.cluster.results import EQUAL_MACHINES, THESIS_OPTIONS

OLD, TODAY = ERAS = ("1999", "today")
STATIONS = 15
MANY = tuple(2**power - 1 for power in range(4, 11))  # 16 to 1,024 processes, the producer's one

# What the thesis left for others to try, each against its own scheme.
OPTIONS: dict[str, tuple[str, ...]] = {
    THESIS_OPTIONS: (),
    "8 beams a message": ("--batch", "8"),
    "two in flight": ("--in-flight", "2"),
    "8 beams a message, two in flight": ("--batch", "8", "--in-flight", "2"),
    "image blocks": (),
    "producer consumes": ("--producer-consumes",),
}
MACHINES: dict[str, tuple[str, ...]] = {
    EQUAL_MACHINES: (),
    "every other one half as fast": ("--speeds", "1,0.5"),
    "five used by others half of the time": ("--loaded", "5", "--load-period", "4"),
}


@dataclass(frozen=True)
class Simulation:
    """One run of the program on one cluster."""

    era: str
    scene: str
    network: Network
    messages: Messages
    consumers: int
    options: str = THESIS_OPTIONS
    machines: str = EQUAL_MACHINES
    own_messages: bool = False
    """Results as our program sends them, 8 bytes a sample, not the thesis's pixels."""
    constant_is: str = AS_OURS
    """How the thesis's seconds that do not grow with the rays are divided (calibration.py)."""

    @property
    def work(self) -> str:
        """The kind of tasks."""
        return BLOCKS if self.options == "image blocks" else BEAMS

    def arguments(self) -> list[str]:
        """Those of the simulator that do not depend on what was recorded."""
        pixels = self.era == OLD and not self.own_messages
        return [
            *("--consumers", str(self.consumers)),
            *self.network.arguments(),
            *self.messages.arguments(),
            *(("--sample-bytes", str(BYTES_A_SAMPLE_OF_1999)) if pixels else ()),
            *OPTIONS.get(self.options, ()),
            *MACHINES[self.machines],
        ]


def simulations(scenes: tuple[str, ...], *, most: int = 1024) -> list[Simulation]:
    """All of them, none with more than `most` processes."""
    every = [
        *(each for scene in scenes for each in _thesis(scene)),
        *(each for scene in scenes for each in _many(scene)),
        *(each for scene in scenes for each in _unlike(scene)),
        *(each for scene in scenes for each in _assumptions(scene)),
    ]
    return [each for each in dict.fromkeys(every) if each.consumers < most]


def _old(scene: str, network: Network, consumers: int) -> Simulation:
    return Simulation(OLD, scene, network, MESSAGES_OF_1999, consumers)


def _thesis(scene: str) -> list[Simulation]:
    """Figures 6.3 and 6.4: 1 to 14 consumers; a few more to see where the producer saturates."""
    return [
        _old(scene, network, consumers)
        for network in (SHARED, SWITCHED)
        for consumers in (*range(1, STATIONS), 31, 63)
    ]


def _many(scene: str) -> list[Simulation]:
    """Where the producer saturates, and what each option changes."""
    clusters = ((OLD, SWITCHED, MESSAGES_OF_1999), (TODAY, MODERN, MESSAGES_OF_TODAY))
    return [
        Simulation(era, scene, network, messages, consumers, options)
        for era, network, messages in clusters
        for options in OPTIONS
        for consumers in (STATIONS // 2, STATIONS - 1, *MANY)
    ]


def _unlike(scene: str) -> list[Simulation]:
    """Machines of two speeds, and machines that others use."""
    return [
        Simulation(OLD, scene, SWITCHED, MESSAGES_OF_1999, STATIONS - 1, options, machines)
        for machines in MACHINES
        for options in (THESIS_OPTIONS, "8 beams a message", "two in flight", "image blocks")
    ]


def _assumptions(scene: str) -> list[Simulation]:
    """What messages were assumed to cost, halved and doubled; and larger results."""
    usual = {
        network: [
            Simulation(OLD, scene, network, MESSAGES_OF_1999, consumers)
            for consumers in (STATIONS // 2, STATIONS - 1)
        ]
        for network in (SHARED, SWITCHED)
    }
    return [
        *(
            replace(each, messages=MESSAGES_OF_1999.times(factor), options=label)
            for network in usual
            for factor, label in ((0.5, "messages at half the cost"), (2, "at twice the cost"))
            for each in usual[network]
        ),
        *(
            replace(each, options="8 bytes a sample", own_messages=True)
            for network in usual
            for each in usual[network]
        ),
        *(
            replace(each, options=f"constant {constant}", constant_is=constant)
            for network in usual
            for constant in (ALL_WALKING, ALL_BUILDING)
            for each in usual[network]
        ),
    ]
