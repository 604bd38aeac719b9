"""The clusters that are simulated: processors, messages, networks.

The thesis tells 15 equal workstations (Pentium II, 330 MHz, 32 MB) on an Ethernet, and seconds of
its sequential program on a Pentium of 350 MHz. From these comes how much slower a machine of 1999
is (`calibration.py`). What a message cost then it does not tell: the figures here are assumptions,
what MPI over TCP was known to take on such machines (0.2 ms from process to process), and the page
shows what half and twice as much of it changes.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Network:
    """Bytes a second are what is left for messages: 7% to 12% of the bits are headers."""

    name: str
    kind: str  # shared: one medium for all; switched: a line for each machine, both ways
    bytes_per_second: float
    latency_seconds: float

    def arguments(self) -> list[str]:
        """The simulator's."""
        return [
            *("--network", self.kind),
            *("--bandwidth", str(self.bytes_per_second)),
            *("--latency", str(self.latency_seconds)),
        ]


@dataclass(frozen=True)
class Messages:
    """What messages take of the processor, of the sender's and of the receiver's."""

    message_seconds: float
    byte_seconds: float
    look_seconds: float

    def arguments(self) -> list[str]:
        """The simulator's."""
        return [
            *("--message-seconds", str(self.message_seconds)),
            *("--byte-seconds", str(self.byte_seconds)),
            *("--look-seconds", str(self.look_seconds)),
        ]

    def times(self, factor: float) -> Messages:
        """So many times as much."""
        return Messages(
            self.message_seconds * factor, self.byte_seconds * factor, self.look_seconds * factor
        )


SHARED = Network("shared 10 Mbit/s", "shared", 1.1e6, 7e-5)
SWITCHED = Network("switched 100 Mbit/s", "switched", 1.1e7, 7e-5)
MODERN = Network("switched 10 Gbit/s", "switched", 1.15e9, 1e-5)

MESSAGES_OF_1999 = Messages(7e-5, 1.5e-8, 2e-5)
MESSAGES_OF_TODAY = Messages(1e-6, 1e-10, 2e-7)

# The thesis sends pixels, not samples: places and a colour, in 8 bytes or so; 5 samples make one.
BYTES_A_SAMPLE_OF_1999 = 8 / 5
