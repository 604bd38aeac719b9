"""What is known of the beams on a cluster: figures by scene and network, told or simulated."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import pandas as pd

from beambench_report.ledger.measured import Measured

FIGURES = ("scene", "network", "quantity", "value", "low", "high")


@dataclass(frozen=True)
class ClusterEvidence:
    """One table: a row for each figure of a scene on a network.

    best_processors, best_efficiency, mean_efficiency, last_efficiency: of 2 to 15 processors, the
        producer's among them; the interval of the first holds all that are as good within 1%.
    beams: those at occupied leaves, which are sent.
    fewest_beams, most_beams: of 14 consumers.
    first_end, last_end: when they finished their last beam, in seconds.
    producer_busy: the part of the time during which the producer worked, with 14 consumers.
    consumers_that_saturate: the fewest with which that is 90%.
    """

    figures: pd.DataFrame

    @property
    def networks(self) -> list[str]:
        """Those that something is known of."""
        return list(dict.fromkeys(self.figures["network"]))

    def figure(self, quantity: str, scene: str, network: str) -> Measured | None:
        """One figure, if it is known."""
        return self._figures.get((scene, network, quantity))

    @cached_property
    def _figures(self) -> dict[tuple[str, str, str], Measured]:
        return {
            (row.scene, row.network, row.quantity): Measured(row.value, row.low, row.high)
            for row in self.figures.itertuples()
        }


NO_CLUSTER = ClusterEvidence(pd.DataFrame(columns=list(FIGURES)))
