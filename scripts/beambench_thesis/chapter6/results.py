"""Reads and writes results as CSV: a row for each simulation, and for each of its processes."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pandas as pd

from beambench_report.base.csv_texts import csv_of
from beambench_report.base.files import read_table, write_text
from beambench_report.base.quantities import markdown_table

SIMULATIONS = "simulations.csv"
PROCESSES = "processes.csv"

THESIS_OPTIONS = "thesis"
EQUAL_MACHINES = "equal"

_OF_SIMULATIONS = (
    "simulation era scene network options machines consumers tasks "
    "seconds traced_seconds sequential_seconds build_seconds walk_seconds work_seconds "
    "accept_seconds speed_up efficiency efficiency_of_consumers producer_busy "
    "messages_from_producer bytes_from_producer messages_to_producer bytes_to_producer"
).split()
# Columns on all consumers together, which are not listed one by one if they are many.
_PROFILE = ["busy_mean", "busy_max"]
_OF_PROCESSES = (
    "simulation process role tasks samples busy_seconds wait_seconds last_seconds"
).split()
_MAX_PROCESSES = 32  # the processes of larger simulations are not listed
_REMEDY = "write it with: python -m beambench_thesis cluster simulate DIR"


def is_cluster_folder(folder: Path) -> bool:
    """Returns whether `cluster simulate` wrote this folder."""
    return (folder / SIMULATIONS).is_file()


def read_simulations(folder: Path) -> pd.DataFrame:
    """Reads the table of simulations. Raises Problem if it is missing or lacks a column."""
    return read_table(folder / SIMULATIONS, _OF_SIMULATIONS, _REMEDY, {"era": str})


def read_processes(folder: Path) -> pd.DataFrame:
    """Reads the table of processes. Raises Problem if it is missing or lacks a column."""
    return read_table(folder / PROCESSES, _OF_PROCESSES, _REMEDY)


def write_results(folder: Path, results: list[dict[str, object]]) -> list[Path]:
    """Writes both tables from the simulator's output, each result with its setting.

    Speedup and efficiency follow the thesis's formulas 6.1 and 6.2; the efficiency is stated with
    and without the producer.
    """
    rows = pd.DataFrame(results).assign(simulation=range(1, len(results) + 1))
    rows["speed_up"] = rows["sequential_seconds"] / rows["seconds"]
    rows["efficiency"] = rows["speed_up"] / (rows["consumers"] + 1)
    rows["efficiency_of_consumers"] = rows["speed_up"] / rows["consumers"].clip(lower=1)
    busy = [
        pd.Series(
            [each["busy_seconds"] for each in result["processes"] if each["role"] == "consumer"],
            dtype=float,
        )
        for result in results
    ]
    rows["busy_mean"] = [each.mean() for each in busy]
    rows["busy_max"] = [each.max() for each in busy]
    processes = [
        {"simulation": number} | process
        for number, result in enumerate(results, 1)
        if len(result["processes"]) <= _MAX_PROCESSES
        for process in result["processes"]
    ]
    return [
        write_rows(folder / SIMULATIONS, rows[_OF_SIMULATIONS + _PROFILE]),
        write_rows(folder / PROCESSES, pd.DataFrame(processes, columns=_OF_PROCESSES)),
    ]


def switched(rows: pd.DataFrame) -> pd.DataFrame:
    """Returns the simulations of networks with a line for each machine."""
    return rows[~rows["network"].str.startswith("shared")]


def pivot(
    rows: pd.DataFrame,
    by: Sequence[str],
    across: str,
    heads: Mapping[object, str],
    cell: Callable[[pd.Series], str],
    names: Sequence[str] = (),
) -> list[str]:
    """Returns a Markdown table with a row for each value of `by`.

    `heads` are the values of the column `across` with their headings, `names` the headings of `by`
    if these differ from the columns' names.
    """
    lines = []
    for key, group in rows.groupby(list(by), sort=False):
        runs = group.drop_duplicates(across).set_index(across)
        cells = (cell(runs.loc[value]) if value in runs.index else "" for value in heads)
        lines.append((*key, *cells))
    return markdown_table([*(names or by), *heads.values()], lines)


def write_rows(path: Path, rows: pd.DataFrame) -> Path:
    """Writes a table with six significant digits."""
    return write_text(path, csv_of(rows, float_format="%.6g"))
