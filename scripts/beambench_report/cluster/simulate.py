"""Runs the simulator for every simulation of the plan."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from beambench_report.cluster.calibration import (
    AS_OURS,
    NONE,
    TRACED,
    Recorded,
    Slowness,
    slowness_of_1999,
)
from beambench_report.cluster.plan import OLD, Simulation
from beambench_report.cluster.record import BEAMS, read_recorded, tasks_file
from beambench_report.cluster.results import write_results
from beambench_report.problem import Problem


class Memory:
    """Answers of the simulator by its arguments, in a file that grows line by line."""

    def __init__(self, path: Path) -> None:
        """Recalls what the file has."""
        self._path = path
        self._writing = threading.Lock()
        self._known: dict[tuple[str, ...], dict[str, object]] = {}
        for line in path.read_text("utf-8").splitlines() if path.is_file() else []:
            try:
                entry = json.loads(line)
            except ValueError:  # it was cut off
                continue
            self._known[tuple(entry["arguments"])] = entry["answer"]

    def answer(
        self, arguments: list[str], ask: Callable[[], dict[str, object]]
    ) -> dict[str, object]:
        """What was answered before, or is now; from any thread."""
        key = tuple(arguments)
        if key not in self._known:
            answer = ask()
            with self._writing, self._path.open("a", encoding="utf-8") as file:
                # A line of its own, whatever was cut off before.
                file.write("\n" + json.dumps({"arguments": arguments, "answer": answer}))
                self._known[key] = answer
        return self._known[key]


def simulate(folder: Path, program: Path, plan: Sequence[Simulation], jobs: int = 1) -> list[Path]:
    """Writes FOLDER/simulations.csv and processes.csv from what was recorded there.

    `jobs` simulations at a time. What was simulated before is not simulated again:
    FOLDER/answers.jsonl remembers it.
    """
    recorded = read_recorded(folder)
    memory = Memory(folder / "answers.jsonl")
    answers = []
    with ThreadPoolExecutor(jobs) as pool:
        asked = [
            pool.submit(_answer, folder, program, simulation, recorded, memory)
            for simulation in plan
        ]
        try:
            for number, each in enumerate(asked, 1):
                print(f"\r{number} of {len(plan)} simulations", end="", file=sys.stderr, flush=True)
                answers.append(each.result())
        finally:
            pool.shutdown(cancel_futures=True)  # where one failed, the others are not begun
    print(file=sys.stderr)
    return write_results(folder, answers)


def slowness_of(recorded: dict[tuple[str, str], Recorded], constant_is: str = AS_OURS) -> Slowness:
    """By the scene of which the thesis tells its seconds."""
    known = recorded.get((TRACED, BEAMS))
    if known is None:
        raise Problem(f"{TRACED} was not recorded, by which machines of 1999 are calibrated")
    return slowness_of_1999(known, constant_is)


def _answer(
    folder: Path,
    program: Path,
    simulation: Simulation,
    recorded: dict[tuple[str, str], Recorded],
    memory: Memory,
) -> dict[str, object]:
    slow = slowness_of(recorded, simulation.constant_is) if simulation.era == OLD else NONE
    build = recorded[simulation.scene, simulation.work].build_seconds * slow.build
    arguments = [
        *("--walk-scale", str(slow.walk)),
        *("--work-scale", str(slow.work)),
        *("--build-seconds", str(build)),
        *simulation.arguments(),
    ]
    tasks = tasks_file(folder, simulation.scene, simulation.work)
    answer = memory.answer(
        [tasks.name, *arguments], lambda: run_simulator([str(program), str(tasks), *arguments])
    )
    # Whatever is handed out, what it is compared with is the sequential beam tracer.
    beams = recorded[simulation.scene, BEAMS]
    sequential = (
        beams.build_seconds * slow.build
        + beams.walk_seconds * slow.walk
        + beams.work_seconds * slow.work
    )
    return answer | {
        "sequential_seconds": sequential,
        "era": simulation.era,
        "scene": simulation.scene,
        "network": simulation.network.name,
        "options": simulation.options,
        "machines": simulation.machines,
        "consumers": simulation.consumers,
    }


def run_simulator(command: list[str]) -> dict:
    """What it prints. Raises Problem where it is not there, or fails."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise Problem(
            f"{command[0]}: {error.strerror}; build {Path(command[0]).name} first "
            "(it needs libsimgrid-dev)"
        ) from None
    if done.returncode != 0:
        raise Problem(f"{' '.join(command)}: {done.stderr.strip() or 'failed'}")
    return json.loads(done.stdout)
