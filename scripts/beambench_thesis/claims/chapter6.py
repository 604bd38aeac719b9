"""The rules that decide by the simulated cluster whether the claims of chapter 6 hold.

They were committed before the first simulation of the cluster. The thesis says that its network is
an Ethernet and that there were 15 processors, but not whether its `p` includes the producer. Its
efficiency first rises with p. This is only possible if p includes the producer, which does not
trace beams, so p includes it here. The rules are applied to each simulated network.
"""

from collections.abc import Callable
from dataclasses import asdict
from functools import wraps
from itertools import product
from math import inf
from pathlib import Path

import pandas as pd

from beambench_thesis.chapter6.results import (
    EQUAL_MACHINES,
    THESIS_OPTIONS,
    read_processes,
    read_simulations,
)
from beambench_thesis.claims.comparisons import ratio_of
from beambench_thesis.claims.verdict import (
    Check,
    Claims,
    Outcome,
    Question,
    Rule,
    aside,
    below,
    between,
)
from beambench_thesis.paper.evidence import FIGURES, ClusterEvidence, Evidence, Measured, rows_with

CLUSTER_CLAIMS = Claims()

_BOTH = _CAT, _TOWER = "gato-bill", "torre-eiffel"


def _on_each_network(rule: Callable[[Evidence, str], list[Check]]) -> Rule:
    """Combines the checks of all networks; without a network, there is one missing check."""

    @wraps(rule)
    def on_all(e: Evidence) -> list[Check]:
        nothing = [Check("a cluster of 15 processors", Outcome.MISSING)]
        return [check for network in e.cluster.networks for check in rule(e, network)] or nothing

    return on_all


@CLUSTER_CLAIMS.claim(
    "C22",
    "6.3, figure 6.3",
    "The efficiency rises up to about 11 processors for gato-bill (around 0.75) and about 7 for "
    "torre-eiffel (above 0.6), then falls.",
    Question.PARALLEL,
    is_figures=True,
)
@_on_each_network
def efficiency_rises_and_falls(e: Evidence, network: str) -> list[Check]:
    """gato-bill is best at 9 to 13 processors, with an efficiency of 0.65 to 0.85.

    torre-eiffel is best at 5 to 9, with more than 0.6. Both are less efficient with all 15.
    """
    best = {scene: e.cluster.figure("best_efficiency", scene, network) for scene in _BOTH}
    processors = {scene: e.cluster.figure("best_processors", scene, network) for scene in _BOTH}
    means = {scene: e.cluster.figure("mean_efficiency", scene, network) for scene in _BOTH}
    return [
        between(f"{_CAT}, {network}, best with", processors[_CAT], 9, 13, " processors"),
        between(f"{_CAT}, {network}, best efficiency", best[_CAT], 0.65, 0.85),
        between(f"{_TOWER}, {network}, best with", processors[_TOWER], 5, 9, " processors"),
        below(f"{_TOWER}, {network}, best efficiency above 0.6", Measured.exact(0.6), best[_TOWER]),
        below(f"{network}, best of {_TOWER} below that of {_CAT}", best[_TOWER], best[_CAT]),
        *(
            below(
                f"{scene}, {network}, less with 15 processors",
                e.cluster.figure("last_efficiency", scene, network),
                best[scene],
            )
            for scene in _BOTH
        ),
        *(
            aside(between(f"{scene}, {network}, mean", means[scene], mean - 0.1, mean + 0.1))
            for scene, mean in ((_CAT, 0.75), (_TOWER, 0.65))
        ),
    ]


@CLUSTER_CLAIMS.claim(
    "C23",
    "6.3, figure 6.4",
    "Dynamic balancing: consumers get different numbers of beams and finish at nearly the same "
    "time.",
    Question.PARALLEL,
    quantity=None,
)
@_on_each_network
def balanced_by_demand(e: Evidence, network: str) -> list[Check]:
    """Of 14 consumers, one has at least 1.1 times as many beams as another.

    The first to end takes at least 95% of the time of the last.
    """
    checks = []
    for scene in _BOTH:
        fewest, most, first, last = (
            e.cluster.figure(name, scene, network)
            for name in ("fewest_beams", "most_beams", "first_end", "last_end")
        )
        cell = f"{scene}, {network}, fewest beams below most, by 1.1"
        checks.append(below(cell, fewest, most, 1.1))
        cell = f"{scene}, {network}, first end over last"
        checks.append(between(cell, ratio_of(first, last), 0.95, 1))
    return checks


@CLUSTER_CLAIMS.claim(
    "C24",
    "6.3",
    "The producer becomes the bottleneck first in the scene that makes more beams (torre-eiffel).",
    Question.PARALLEL,
    quantity=None,
)
@_on_each_network
def producer_saturates_first(e: Evidence, network: str) -> list[Check]:
    """torre-eiffel has more beams, and a busier producer with 14 consumers.

    It needs fewer consumers to keep the producer busy for 90% of the time.
    """

    def compared(cell: str, quantity: str, less: str, more: str) -> Check:
        return below(
            f"{network}, {cell}",
            e.cluster.figure(quantity, less, network),
            e.cluster.figure(quantity, more, network),
        )

    return [
        compared(f"beams of {_CAT} below {_TOWER}'s", "beams", _CAT, _TOWER),
        compared("producer busy, with 14 consumers", "producer_busy", _CAT, _TOWER),
        compared("consumers that saturate it", "consumers_that_saturate", _TOWER, _CAT),
    ]


@CLUSTER_CLAIMS.claim(
    "C38",
    "6.1, 7.2.5",
    "Beams on demand serve machines of unequal speed and with other load, too.",
    Question.PARALLEL,
    quantity="of their speed",
)
def serves_unequal_machines(e: Evidence) -> list[Check]:
    """On each simulated network, unequal machines use at least 90% of their speed.

    The reference is the time with equal machines.
    """

    def used(scene: str, kind: str, network: str) -> Measured | None:
        return ratio_of(
            e.cluster.figure(f"slowdown_{kind}", scene, network),
            e.cluster.figure(f"capacity_{kind}", scene, network),
        )

    checks = [
        between(
            f"{scene}, {network}, {words}, part of their speed",
            used(scene, kind, network),
            0.9,
            inf,
        )
        for network in e.cluster.networks
        if any(used(scene, kind, network) for scene in _BOTH for kind in UNEQUAL_MACHINES)
        for scene, (kind, (words, _)) in product(_BOTH, UNEQUAL_MACHINES.items())
    ]
    return checks or [Check("14 unequal consumers", Outcome.MISSING)]


UNEQUAL_MACHINES = {
    "slow": ("every other one half as fast", 0.75),
    "used": ("five used by others half of the time", 11.5 / 14),
}
"""Kinds of 14 consumers: their name in simulations.csv, and their speed relative to equal ones."""

STATIONS = 15
_ALIKE = 0.01  # efficiencies this close to the maximum count as equal to it
_SATURATED = 0.9
_MANY = 4 * STATIONS  # consumers; a producer that they do not saturate is later than the other


def cluster_evidence(folder: Path) -> ClusterEvidence:
    """Returns the figures of all scenes and networks that the thesis's program ran on.

    Raises Problem if the folder cannot be read.
    """
    simulations, processes = read_simulations(folder), read_processes(folder)
    thesis = rows_with(simulations, options=THESIS_OPTIONS, machines=EQUAL_MACHINES, era="1999")
    rows: list[dict[str, object]] = []
    for (scene, network), group in thesis.groupby(["scene", "network"], sort=False):
        unequal = rows_with(
            simulations, scene=scene, network=network, options=THESIS_OPTIONS, era="1999"
        )
        figures = (
            _efficiencies(group)
            | _balance(group, processes)
            | _bottleneck(group)
            | _slowdowns(group, unequal)
        )
        rows += [
            {"scene": scene, "network": network, "quantity": quantity} | asdict(figure)
            for quantity, figure in figures.items()
        ]
    return ClusterEvidence(pd.DataFrame(rows, columns=list(FIGURES)))


def _efficiencies(group: pd.DataFrame) -> dict[str, Measured]:
    by_processors = group[group["consumers"] < STATIONS].set_index("consumers")["efficiency"]
    if len(by_processors) < STATIONS - 1:
        return {}
    best = by_processors.max()
    alike = by_processors.index[by_processors >= (1 - _ALIKE) * best] + 1
    return {
        "best_processors": Measured(by_processors.idxmax() + 1, alike.min(), alike.max()),
        "best_efficiency": Measured.exact(best),
        "mean_efficiency": Measured.exact(by_processors.mean()),
        "last_efficiency": Measured.exact(by_processors[STATIONS - 1]),
    }


def _balance(group: pd.DataFrame, processes: pd.DataFrame) -> dict[str, Measured]:
    all_busy = rows_with(group, consumers=STATIONS - 1)
    consumers = rows_with(processes, simulation=all_busy["simulation"], role="consumer")
    if consumers.empty:
        return {}
    return {
        "fewest_beams": Measured.exact(consumers["tasks"].min()),
        "most_beams": Measured.exact(consumers["tasks"].max()),
        "first_end": Measured.exact(consumers["last_seconds"].min()),
        "last_end": Measured.exact(consumers["last_seconds"].max()),
    }


def _bottleneck(group: pd.DataFrame) -> dict[str, Measured]:
    figures = {"beams": Measured.exact(group["tasks"].iloc[0])}
    all_busy = rows_with(group, consumers=STATIONS - 1)["producer_busy"]
    if not all_busy.empty:
        figures["producer_busy"] = Measured.exact(all_busy.iloc[0])
    saturated = group.loc[group["producer_busy"] >= _SATURATED, "consumers"]
    most = group["consumers"].max()
    if not saturated.empty:
        figures["consumers_that_saturate"] = Measured.exact(saturated.min())
    elif most >= _MANY:
        figures["consumers_that_saturate"] = Measured.exact(most + 1)  # or more, or never
    return figures


def _slowdowns(group: pd.DataFrame, unequal: pd.DataFrame) -> dict[str, Measured]:
    """Returns the losses of unequal machines; empty if they were not simulated."""
    equal = rows_with(group, consumers=STATIONS - 1)["seconds"]
    figures = {}
    for kind, (machines, capacity) in UNEQUAL_MACHINES.items():
        seconds = rows_with(unequal, machines=machines, consumers=STATIONS - 1)["seconds"]
        if not seconds.empty and not equal.empty:
            figures[f"slowdown_{kind}"] = Measured.exact(equal.iloc[0] / seconds.iloc[0])
            figures[f"capacity_{kind}"] = Measured.exact(capacity)
    return figures
