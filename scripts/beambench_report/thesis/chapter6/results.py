"""What was simulated, as CSV: a row for each simulation, and one for each of its processes."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from beambench_report.base.files import Problem, write_text

SIMULATIONS = "simulations.csv"
PROCESSES = "processes.csv"

THESIS_OPTIONS = "thesis"
EQUAL_MACHINES = "equal"

_OF_SIMULATIONS = (
    "simulation",
    "era",
    "scene",
    "network",
    "options",
    "machines",
    "consumers",
    "tasks",
    "seconds",
    "traced_seconds",
    "sequential_seconds",
    "build_seconds",
    "walk_seconds",
    "work_seconds",
    "accept_seconds",
    "speed_up",
    "efficiency",
    "efficiency_of_consumers",
    "producer_busy",
    "messages_from_producer",
    "bytes_from_producer",
    "messages_to_producer",
    "bytes_to_producer",
)
_OF_PROCESSES = (
    "simulation",
    "process",
    "role",
    "tasks",
    "samples",
    "busy_seconds",
    "wait_seconds",
    "last_seconds",
)
# More processes than this in one simulation are reported in sums alone.
_MOST_PROCESSES = 32


def is_cluster_folder(folder: Path) -> bool:
    """Is it a folder that `cluster simulate` wrote?"""
    return (folder / SIMULATIONS).is_file()


def read_simulations(folder: Path) -> pd.DataFrame:
    """Raises Problem where the table is missing or lacks a column."""
    return _read(folder / SIMULATIONS, _OF_SIMULATIONS)


def read_processes(folder: Path) -> pd.DataFrame:
    """Raises Problem where the table is missing or lacks a column."""
    return _read(folder / PROCESSES, _OF_PROCESSES)


def write_results(folder: Path, answers: list[dict[str, object]]) -> list[Path]:
    """Writes both tables from what the simulator answered, each answer with its setting."""
    simulations: list[dict[str, object]] = []
    processes: list[dict[str, object]] = []
    for number, answer in enumerate(answers, 1):
        row = {"simulation": number} | answer | _judged(answer)
        simulations.append({name: row[name] for name in _OF_SIMULATIONS})
        members = answer["processes"]
        if isinstance(members, list) and len(members) <= _MOST_PROCESSES:
            processes += [{"simulation": number} | member for member in members]
    return [
        _write(folder / SIMULATIONS, pd.DataFrame(simulations, columns=list(_OF_SIMULATIONS))),
        _write(folder / PROCESSES, pd.DataFrame(processes, columns=list(_OF_PROCESSES))),
    ]


def _judged(answer: dict[str, object]) -> dict[str, object]:
    """The thesis's formulas 6.1 and 6.2; the efficiency with the producer counted, and without."""
    speed_up = float(str(answer["sequential_seconds"])) / float(str(answer["seconds"]))
    consumers = int(str(answer["consumers"]))
    return {
        "speed_up": speed_up,
        "efficiency": speed_up / (consumers + 1),
        "efficiency_of_consumers": speed_up / max(consumers, 1),
    }


def _write(path: Path, rows: pd.DataFrame) -> Path:
    return write_text(path, rows.to_csv(index=False, float_format="%.6g", lineterminator="\n"))


def _read(path: Path, columns: tuple[str, ...]) -> pd.DataFrame:
    remedy = "write it with: python -m beambench_report cluster simulate DIR"
    try:
        rows = pd.read_csv(path, dtype={"era": str})
    except FileNotFoundError:
        raise Problem(f"{path}: there is no such file; {remedy}") from None
    except (pd.errors.ParserError, pd.errors.EmptyDataError, UnicodeDecodeError) as error:
        raise Problem(f"{path}: it is not a CSV file ({error})") from None
    missing = [column for column in columns if column not in rows]
    if missing:
        raise Problem(f"{path}: it has no column '{missing[0]}'; {remedy}")
    return rows
