"""What was simulated of the thesis's cluster, as figures of its claims."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from beambench_report.cluster.results import (
    EQUAL_MACHINES,
    THESIS_OPTIONS,
    read_processes,
    read_simulations,
)
from beambench_report.ledger.cluster_evidence import FIGURES, ClusterEvidence

STATIONS = 15
_ALIKE = 0.01  # a maximum this flat has no one place
_SATURATED = 0.9
_MANY = 4 * STATIONS  # who does not saturate the producer by then does so later than the other


def cluster_evidence(folder: Path) -> ClusterEvidence:
    """The figures of all scenes and networks in the folder that the thesis's program ran on.

    Raises Problem where the folder cannot be read.
    """
    simulations = read_simulations(folder)
    processes = read_processes(folder)
    thesis = simulations[
        simulations["options"].eq(THESIS_OPTIONS)
        & simulations["machines"].eq(EQUAL_MACHINES)
        & simulations["era"].eq("1999")
    ]
    rows: list[dict[str, object]] = []
    for (scene, network), group in thesis.groupby(["scene", "network"], sort=False):
        own = processes[processes["simulation"].isin(group["simulation"])]
        figures = _efficiencies(group) | _balance(group, own) | _bottleneck(group)
        rows += [
            {"scene": scene, "network": network, "quantity": quantity}
            | dict(zip(("value", "low", "high"), interval, strict=True))
            for quantity, interval in figures.items()
        ]
    return ClusterEvidence(pd.DataFrame(rows, columns=list(FIGURES)))


_Interval = tuple[float, float, float]


def _exact(value: float) -> _Interval:
    return (value, value, value)


def _efficiencies(group: pd.DataFrame) -> dict[str, _Interval]:
    by_processors = group[group["consumers"] < STATIONS].set_index("consumers")["efficiency"]
    if len(by_processors) < STATIONS - 1:
        return {}
    best = by_processors.idxmax()
    alike = by_processors.index[by_processors >= (1 - _ALIKE) * by_processors.max()]
    return {
        "best_processors": (best + 1, alike.min() + 1, alike.max() + 1),
        "best_efficiency": _exact(by_processors.max()),
        "mean_efficiency": _exact(by_processors.mean()),
        "last_efficiency": _exact(by_processors[STATIONS - 1]),
    }


def _balance(group: pd.DataFrame, processes: pd.DataFrame) -> dict[str, _Interval]:
    all_busy = group.loc[group["consumers"].eq(STATIONS - 1), "simulation"]
    consumers = processes[processes["simulation"].isin(all_busy) & processes["role"].eq("consumer")]
    if consumers.empty:
        return {}
    return {
        "fewest_beams": _exact(consumers["tasks"].min()),
        "most_beams": _exact(consumers["tasks"].max()),
        "first_end": _exact(consumers["last_seconds"].min()),
        "last_end": _exact(consumers["last_seconds"].max()),
    }


def _bottleneck(group: pd.DataFrame) -> dict[str, _Interval]:
    figures = {"beams": _exact(group["tasks"].iloc[0])}
    all_busy = group.loc[group["consumers"].eq(STATIONS - 1), "producer_busy"]
    if not all_busy.empty:
        figures["producer_busy"] = _exact(all_busy.iloc[0])
    saturated = group.loc[group["producer_busy"] >= _SATURATED, "consumers"]
    most = group["consumers"].max()
    if not saturated.empty:
        figures["consumers_that_saturate"] = _exact(saturated.min())
    elif most >= _MANY:
        figures["consumers_that_saturate"] = _exact(most + 1)  # or more, or never
    return figures
