"""results/published/cluster: the thesis's cluster simulated, and the program on this machine."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd

from beambench_report.base.files import Problem, read_json, read_table
from beambench_thesis.chapter6.results import read_processes, read_simulations

_THESIS = {"era": "1999", "options": "thesis", "machines": "equal"}
_REMEDY = "restore it with git"


def figures(folder: Path) -> dict[str, Any]:
    """Returns functions that find a simulation by its settings, and counts over several."""
    simulations, processes = read_simulations(folder), read_processes(folder)
    split = read_table(folder / "split.csv", ("era", "scene", "processes"), _REMEDY, {"era": str})
    measured = read_table(folder / "measured.csv", ("scene", "setting", "seconds"), _REMEDY)
    divisions = read_table(
        folder / "scene-divisions.csv", ("division", "scene", "processes", "efficiency"), _REMEDY
    )
    recorded = read_json(folder / "recorded.json")
    if not isinstance(recorded, dict):
        raise Problem(f"{folder}/recorded.json: there is no such file; {_REMEDY}")
    at = _finder(simulations)
    return {
        "at": at,
        "best": lambda scene, network: (
            _of(simulations, scene, network).nlargest(1, "efficiency").iloc[0]
        ),
        "most_busy": lambda scene, network: _of(simulations, scene, network)["producer_busy"].max(),
        "balance": lambda scene, network: _balance(at, processes, scene, network),
        "simulations": len(simulations),
        "recorded": recorded,
        "split": lambda era, scene, parts: _one(
            split, {"era": era, "scene": scene, "processes": parts}, folder / "split.csv"
        ),
        "divided": lambda scene, division, parts: _one(
            divisions,
            {"scene": scene, "division": division, "processes": parts},
            folder / "scene-divisions.csv",
        ),
        "measured": lambda scene, setting: float(
            _one(measured, {"scene": scene, "setting": setting}, folder / "measured.csv")["seconds"]
        ),
        "commits": sorted(
            {str(one)[:7] for one in measured["commit"]}
            | {one["commit"][:7] for one in recorded.values()}
        ),
    }


def _one(table: pd.DataFrame, values: dict[str, object], file: Path) -> pd.Series:
    """Returns the only row with these values. Raises Problem if there is none, or several."""
    for name, value in values.items():
        table = table[table[name] == value]
    if len(table) != 1:
        raise Problem(f"{file}: {len(table)} rows have {values}, but one was expected")
    return table.iloc[0]


def _finder(simulations: pd.DataFrame) -> Callable[..., pd.Series]:
    """Returns a finder of simulations, by default with the thesis's options and machines."""

    def at(scene: str, network: str, consumers: int, **columns: str) -> pd.Series:
        own = _THESIS | {"scene": scene, "network": network, "consumers": consumers} | columns
        return _one(simulations, own, Path("simulations.csv"))

    return at


def _of(simulations: pd.DataFrame, scene: str, network: str) -> pd.DataFrame:
    rows = simulations[(simulations["scene"] == scene) & (simulations["network"] == network)]
    for name, value in _THESIS.items():
        rows = rows[rows[name] == value]
    return rows


def _balance(
    at: Callable[..., pd.Series], processes: pd.DataFrame, scene: str, network: str
) -> dict[str, float]:
    """Returns the most beams over the fewest, and the first end over the last, of 14 consumers."""
    number = at(scene, network, 14)["simulation"]
    own = processes[(processes["simulation"] == number) & (processes["role"] == "consumer")]
    return {
        "beams": own["tasks"].max() / own["tasks"].min(),
        "ends": own["last_seconds"].min() / own["last_seconds"].max(),
    }
