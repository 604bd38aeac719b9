"""The repetitions, messages and examples of single cells, which are only in the log."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import pandas as pd

from beambench.analysis import (
    Median,
    Ratio,
    block_ratio,
    is_undisturbed,
    paired_ratio,
    unpaired_ratio,
)
from beambench_report.base.records import TIMED_VERDICTS, size_of
from beambench_report.base.run_log import LoggedCell, Repetition, logged_cells

IDENTITY = ("scene", "camera", "structure", "parameters", "width", "height", "samples", "ray_kind")
Identity = tuple[str, ...]


@dataclass(frozen=True)
class Example:
    """One disputed ray in words, and the command that replays it."""

    text: str
    replay: str


@dataclass(frozen=True)
class CellFile:
    """One cell of a run."""

    message: str
    examples: tuple[Example, ...]
    total_ms: Mapping[int, float]
    """The time of build or update and trace in the fastest undisturbed repetition, by block.

    In records of one process: in each repetition, by round. The same applies to the fields below.
    """
    trace_ms: Mapping[int, float] = field(default_factory=dict)
    """The time of the first trace after each build."""
    warm_ms: Mapping[int, float] = field(default_factory=dict)
    """The time of a second trace of the same structure, in blocks or rounds that had one."""
    clock_ghz: Mapping[int, float] = field(default_factory=dict)
    """The clock rate during the repetition, if it was read."""
    in_blocks: bool = False

    def ratio(
        self, times: str, base: "CellFile", shares: tuple[float, float] = (0.0, 0.0)
    ) -> Ratio | None:
        """Returns the paired ratio of this cell to `base`; None if no times can be paired.

        `times` names the field to compare. `shares`, in milliseconds, are subtracted from the times
        of this cell and of `base`.
        """
        over, under = (
            {turn: ms - less for turn, ms in getattr(one, times).items()}
            for one, less in zip((self, base), shares, strict=True)
        )
        return (block_ratio if self.in_blocks and base.in_blocks else paired_ratio)(over, under)


def identity(row: Mapping[str, object]) -> Identity:
    """Returns the identity of a row within its run."""
    values = (row[name] for name in IDENTITY)
    return tuple(str(int(one)) if isinstance(one, float) else str(one) for one in values)


def read_cell_files(directory: Path) -> dict[Identity, CellFile]:
    """Reads the cells of the log that are finished or have a verdict; empty without a log."""
    return {
        identity(cell.facts): _cell_file(cell)
        for cell in logged_cells(directory)
        if cell.is_finished or cell.verdict
    }


def repetitions_of(cell: LoggedCell) -> list[Repetition]:
    """Returns the repetitions of a cell if its times count, otherwise an empty list."""
    return cell.repetitions if cell.verdict in TIMED_VERDICTS else []


def name_of(row: Mapping[str, object]) -> str:
    """Returns the name of a row's cell in logs and analyses."""
    accel = f"{row['structure']}:{row['parameters']}".rstrip(":")
    view = (row["scene"], row["camera"], size_of(row), f"{row['samples']:.0f}", row["ray_kind"])
    return "/".join((*view, accel))


def median_of(row: Mapping[str, object], phase: str) -> Median:
    """Returns the time to compare for a phase, "total" or "trace", with its interval.

    It is the mean over a row's blocks; in records of one process, the median of the repetitions.
    """
    ends = (row.get(f"{phase}_ms_ci_{end}") for end in ("low", "high"))
    known = [None if end is None or pd.isna(end) else float(end) for end in ends]
    return Median(float(row[f"{phase}_ms"]), *known)


def ratio_of(
    phase: Literal["total", "trace"],
    row: Mapping[str, object],
    base: Mapping[str, object],
    files: Mapping[Identity, CellFile],
) -> Ratio:
    """Returns a row's time over that of `base`, paired if the repetitions of both are known."""
    over, under = (files.get(identity(one)) for one in (row, base))
    paired = over.ratio(f"{phase}_ms", under) if over and under else None
    return paired or unpaired_ratio_of(phase, row, base)


def unpaired_ratio_of(
    phase: Literal["total", "trace"], row: Mapping[str, object], base: Mapping[str, object]
) -> Ratio:
    """Returns a row's time over that of `base`, if they were not measured together."""
    return unpaired_ratio(median_of(row, phase), median_of(base, phase))


def _cell_file(cell: LoggedCell) -> CellFile:
    repetitions = repetitions_of(cell)
    in_blocks = any("block" in one for one in repetitions)
    if in_blocks:
        repetitions = _fastest_of_blocks(repetitions)
    turn = "block" if in_blocks else "round"
    return CellFile(
        cell.message,
        tuple(_example(text) for text in cell.examples),
        {one[turn]: one.get("update_ms", one["build_ms"]) + one["trace_ms"] for one in repetitions},
        *(
            {one[turn]: one[name] for one in repetitions if name in one}
            for name in ("trace_ms", "warm_trace_ms", "clock_ghz")
        ),
        in_blocks,
    )


def _fastest_of_blocks(repetitions: Sequence[Repetition]) -> list[Repetition]:
    """Returns the undisturbed repetition with the fastest trace of each block."""
    undisturbed = [
        one for one in repetitions if is_undisturbed(one["trace_ms"], one["trace_cpu_ms"])
    ]
    slowest_first = sorted(undisturbed, key=lambda one: -one["trace_ms"])
    return list({one["block"]: one for one in slowest_first}.values())


def _example(text: str) -> Example:
    """Separates the words from the command's line: `  replay beambench trace ...`."""
    lines = text.rstrip().splitlines()
    replays = [line.strip() for line in lines if line.lstrip().startswith("replay ")]
    words = [line for line in lines if line.strip() not in replays]
    return Example("\n".join(words), replays[0].removeprefix("replay ").strip() if replays else "")
