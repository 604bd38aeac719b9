"""The repetitions, messages and examples of single cells, which results.csv does not have.

They are in the log of a run (`run_log`). A published run has one compact file instead,
repetitions.csv, a line for each repetition: `line` is that of its cell in results.csv, whose header
is line 1. From it paired ratios and the noise of a calibration can be computed again.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isclose
from pathlib import Path
from statistics import median
from typing import Literal

import pandas as pd

from beambench.analysis import Median, Ratio, paired_ratio, unpaired_ratio
from beambench_report.base.csv_texts import csv_of, unguarded
from beambench_report.base.files import Problem, write_text
from beambench_report.base.records import TIMED_VERDICTS, read_run
from beambench_report.base.run_log import LoggedCell, Repetition, has_log, logged_cells

IDENTITY = ("scene", "camera", "structure", "parameters", "width", "height", "samples", "ray_kind")
Identity = tuple[str, ...]
Row = dict[str, object]
REPETITIONS = "repetitions.csv"


@dataclass(frozen=True)
class Example:
    """One disputed ray in words, and the command that shows its path again."""

    text: str
    replay: str


@dataclass(frozen=True)
class CellFile:
    """One cell of a run."""

    message: str
    examples: tuple[Example, ...]
    total_ms: Mapping[int, float]
    """Build and trace of each repetition, by the round in which it had its turn."""
    trace_ms: Mapping[int, float] = field(default_factory=dict)
    """The first trace after each build, likewise."""
    warm_ms: Mapping[int, float] = field(default_factory=dict)
    """The second trace of the same structure, in the rounds that had one."""
    clock_ghz: Mapping[int, float] = field(default_factory=dict)
    """The clock's rate about each repetition, where it was read."""


def identity(row: Mapping[str, object]) -> Identity:
    """What identifies a row within its run."""
    return tuple(_plain(row[name]) for name in IDENTITY)


def read_cell_files(directory: Path) -> dict[Identity, CellFile]:
    """Every cell of the log that has an end or repetitions.

    Where there is no log, what the compact file of repetitions holds; it has no messages.
    """
    if has_log(directory):
        return {
            identity(cell.facts): _cell_file(
                cell.message, tuple(_example(text) for text in cell.examples), repetitions_of(cell)
            )
            for cell in logged_cells(directory)
            if cell.is_finished or cell.verdict
        }
    return {
        identity(row): _cell_file("", (), repetitions)
        for row, repetitions in published_repetitions(directory)
    }


def published_repetitions(directory: Path) -> list[tuple[Row, list[Repetition]]]:
    """Rows of DIRECTORY/results.csv with their repetitions, of DIRECTORY/repetitions.csv.

    None where there is no such file. Raises Problem where the two files are not of one run.
    """
    path = directory / REPETITIONS
    if not path.is_file():
        return []
    try:
        table = unguarded(pd.read_csv(path))
        by_line = {
            int(line): own.drop(columns="line").to_dict("records")
            for line, own in table.groupby("line", sort=False)
        }
        rows = read_run(directory).rows
        found = [(rows.loc[line - 2].to_dict(), own) for line, own in by_line.items()]
        for row, own in found:
            if not isclose(
                row["trace_ms_median"], median(o["trace_ms"] for o in own), rel_tol=1e-4
            ):
                raise ValueError(f"the repetitions of {row['contender']} are not those of its row")
    except (ValueError, KeyError) as error:
        raise Problem(
            f"{path}: does not belong to the results.csv beside it ({error}); write it again: "
            "python -m beambench_report repetitions RUN"
        ) from None
    return [(row, [_without_gaps(one) for one in own]) for row, own in found]


def _without_gaps(repetition: Repetition) -> Repetition:
    known = {name: value for name, value in repetition.items() if not pd.isna(value)}
    return known | {"round": int(repetition["round"])}


def repetitions_of(cell: LoggedCell) -> list[Repetition]:
    """The repetitions of a cell whose times count; of another, none."""
    return cell.repetitions if cell.verdict in TIMED_VERDICTS else []


def median_of(row: Mapping[str, object], phase: str) -> Median:
    """The median of a phase, "total" or "trace", of a row of results.csv, with its interval."""
    middle, low, high = (row.get(f"{phase}_ms_{what}") for what in ("median", "ci_low", "ci_high"))
    known = [None if end is None or pd.isna(end) else float(end) for end in (low, high)]
    return Median(float(middle), *known)


def ratio_of(
    phase: Literal["total", "trace"],
    row: Mapping[str, object],
    base: Mapping[str, object],
    files: Mapping[Identity, CellFile],
) -> Ratio:
    """A time of a row over another one's: paired where the repetitions of both are known."""
    repeated = [
        getattr(file, f"{phase}_ms")
        for one in (row, base)
        if (file := files.get(identity(one))) is not None
    ]
    paired = paired_ratio(*repeated) if len(repeated) == 2 else None
    return paired or unpaired_ratio(median_of(row, phase), median_of(base, phase))


def _cell_file(
    message: str, examples: tuple[Example, ...], repetitions: list[Repetition]
) -> CellFile:
    total, trace, warm, clock = {}, {}, {}, {}
    for repetition in repetitions:
        turn = repetition["round"]
        trace[turn] = repetition["trace_ms"]
        total[turn] = repetition["build_ms"] + trace[turn]
        if "warm_trace_ms" in repetition:
            warm[turn] = repetition["warm_trace_ms"]
        if "clock_ghz" in repetition:
            clock[turn] = repetition["clock_ghz"]
    return CellFile(message, examples, total, trace, warm, clock)


def _example(text: str) -> Example:
    """The command stands in a line of its own: `  replay beambench trace ...`."""
    lines = text.rstrip().splitlines()
    replays = [line.strip() for line in lines if line.lstrip().startswith("replay ")]
    words = [line for line in lines if line.strip() not in replays]
    return Example("\n".join(words), replays[0].removeprefix("replay ").strip() if replays else "")


def _plain(value: object) -> str:
    return str(int(value)) if isinstance(value, float) else str(value)


_FIGURES = "build_ms trace_ms warm_trace_ms build_cpu_ms trace_cpu_ms clock_ghz".split()


def write_repetitions(run: Path, output: Path | None = None) -> Path:
    """Writes the repetitions of RUN's log into `output`; six significant digits.

    Into RUN/repetitions.csv if not given.

    Raises Problem where the run has no repetitions, or a cell that results.csv has not.
    """
    rows = read_run(run).rows
    lines = {identity(row): place + 2 for place, row in rows.iterrows()}
    table = []
    for cell in logged_cells(run):
        for one in repetitions_of(cell):
            figures = {name: one[name] for name in _FIGURES if name in one}
            table.append({"line": lines[identity(cell.facts)], "round": one["round"], **figures})
    if not table:
        raise Problem(f"{run}: holds no log with repetitions; give the folder that a run left")
    columns = ["line", "round", *_FIGURES]
    whole = pd.DataFrame(table, columns=columns).sort_values(["line", "round"])

    text = csv_of(whole.dropna(axis="columns", how="all"), float_format="%.6g")
    return write_text(output or run / REPETITIONS, text)
