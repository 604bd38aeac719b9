"""A divided scene (`--split`) on simulated clusters: how time, traffic and memory grow with parts.

It is really traced while it is simulated, so the times of one run are those of this machine at that
time: medians of several runs are kept. Machines of 1999 are those of the other simulations
(`calibration.py`).
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, fields
from pathlib import Path
from statistics import median

import pandas as pd

from beambench_report.cluster.calibration import NONE, TRACED, Slowness
from beambench_report.cluster.machines import (
    MESSAGES_OF_1999,
    MESSAGES_OF_TODAY,
    MODERN,
    SWITCHED,
)
from beambench_report.cluster.plan import OLD, TODAY
from beambench_report.cluster.record import read_recorded
from beambench_report.cluster.simulate import Memory, run_simulator, slowness_of
from beambench_report.files import write_text
from beambench_report.problem import Problem

SPLIT = "split.csv"
CELLS_LEVEL = 4
PARTS = (1, 2, 4, 8, 16, 32, 64)


@dataclass(frozen=True)
class Divided:
    """A scene, and the octree that suits it."""

    scene: str
    structure: str


SCENES = (
    Divided(TRACED, "beam:max_level=6"),
    Divided("tetra:n=7", "beam:max_level=7"),
    Divided("bumpy:triangles=200000", "beam:max_level=7"),
)
_CLUSTERS = {OLD: (SWITCHED, MESSAGES_OF_1999), TODAY: (MODERN, MESSAGES_OF_TODAY)}


@dataclass(frozen=True)
class SplitRow:
    """One simulated run, the median of several; a column of the table for each field."""

    era: str
    scene: str
    structure: str
    resolution: str
    processes: int
    traced_seconds: float
    """Simulated: since the last process was ready, to the picture."""
    speed_up: float
    """Of tracing. Building is short and measured once a process: of many, the longest is chance."""
    efficiency: float
    balance: float
    """What a process is busy tracing on average, of what the busiest is."""
    build_seconds: float
    """To divide the scene and build a part: the processes' median, of this machine's processor."""
    walk_cpu_seconds: float
    """This and the next are sums over all processes, of this machine's processor."""
    test_cpu_seconds: float
    take_cpu_seconds: float
    messages: int
    bytes: int
    beams_handed: int
    rays_handed: int
    primitives: int
    largest_primitives: int
    largest_bytes: int
    """Scene and octree of the largest part."""
    result_hash: str


def simulate_split(
    folder: Path, program: Path, resolution: str, repeats: int, most: int
) -> list[Path]:
    """Writes FOLDER/split.csv, with machines of 1999 by what was recorded there.

    What was simulated before is not simulated again: FOLDER/split-answers.jsonl remembers it.
    Raises Problem where parts give another picture than the whole.
    """
    asker = _Asker(program, resolution, repeats, Memory(folder / "split-answers.jsonl"))
    slow_by_era = {OLD: slowness_of(read_recorded(folder)), TODAY: NONE}
    rows: list[SplitRow] = []
    for era, slow in slow_by_era.items():
        for divided in SCENES:
            answers = [asker.median(era, divided, parts, slow) for parts in PARTS if parts <= most]
            rows += [_row(era, divided, resolution, answer, answers[0]) for answer in answers]
    print(file=sys.stderr)
    _require_one_picture(rows)
    table = pd.DataFrame(rows, columns=[each.name for each in fields(SplitRow)])
    text = table.to_csv(index=False, float_format="%.6g", lineterminator="\n")
    return [write_text(folder / SPLIT, text)]


def read_split(folder: Path) -> pd.DataFrame | None:
    """The table; nothing where there is none. Raises Problem where it lacks a column."""
    path = folder / SPLIT
    if not path.is_file():
        return None
    try:
        rows = pd.read_csv(path, dtype={"era": str, "result_hash": str})
    except (pd.errors.ParserError, pd.errors.EmptyDataError, UnicodeDecodeError) as error:
        raise Problem(f"{path}: it is not a CSV file ({error})") from None
    for each in fields(SplitRow):
        if each.name not in rows:
            raise Problem(
                f"{path}: it has no column '{each.name}'; write it with: "
                "python -m beambench_report cluster split DIR"
            )
    return rows


class _Asker:
    """Asks the simulator several times."""

    def __init__(self, program: Path, resolution: str, repeats: int, memory: Memory) -> None:
        self._program = program
        self._resolution = resolution
        self._repeats = repeats
        self._memory = memory

    def median(self, era: str, divided: Divided, parts: int, slow: Slowness) -> dict:
        """The run whose tracing took the median."""
        print(f"\r{era}: {divided.scene} in {parts} parts   ", end="", file=sys.stderr, flush=True)
        network, messages = _CLUSTERS[era]
        arguments = [
            divided.scene,
            *("--accel", divided.structure),
            *("--split", str(CELLS_LEVEL)),
            *("--processes", str(parts)),
            *("--resolution", self._resolution),
            *("--build-scale", str(slow.build)),
            *("--walk-scale", str(slow.walk)),
            *("--work-scale", str(slow.work)),
            *network.arguments(),
            *messages.arguments(),
        ]
        runs = [
            self._memory.answer(
                [str(repeat), *arguments],
                lambda: run_simulator([str(self._program), *arguments]),
            )
            for repeat in range(self._repeats)
        ]
        return sorted(runs, key=lambda run: run["traced_seconds"])[len(runs) // 2]


def _total(answer: dict, quantity: str) -> float:
    return sum(process[quantity] for process in answer["processes"])


def _row(era: str, divided: Divided, resolution: str, answer: dict, alone: dict) -> SplitRow:
    processes = answer["processes"]
    speed_up = alone["traced_seconds"] / answer["traced_seconds"]
    busiest = max(process["busy"] for process in processes)
    return SplitRow(
        era=era,
        scene=divided.scene,
        structure=divided.structure,
        resolution=resolution,
        processes=len(processes),
        traced_seconds=answer["traced_seconds"],
        speed_up=speed_up,
        efficiency=speed_up / len(processes),
        balance=_total(answer, "busy") / len(processes) / busiest,
        build_seconds=median(process["build_seconds"] for process in processes),
        walk_cpu_seconds=_total(answer, "walk_seconds"),
        test_cpu_seconds=_total(answer, "test_seconds"),
        take_cpu_seconds=_total(answer, "take_seconds"),
        messages=int(_total(answer, "messages_out")),
        bytes=int(_total(answer, "bytes_out")),
        beams_handed=int(_total(answer, "beams_out")),
        rays_handed=int(_total(answer, "rays_out")),
        primitives=answer["primitives"],
        largest_primitives=max(process["primitives"] for process in processes),
        largest_bytes=max(process["bytes"] for process in processes),
        result_hash=answer["result_hash"],
    )


def _require_one_picture(rows: list[SplitRow]) -> None:
    pictures: dict[str, str] = {}
    for row in rows:
        if pictures.setdefault(row.scene, row.result_hash) != row.result_hash:
            raise Problem(
                f"{row.scene} in {row.processes} parts is another picture than the whole; that is "
                "a fault of beambench"
            )
