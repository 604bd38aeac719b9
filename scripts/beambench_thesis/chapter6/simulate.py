"""Lists the simulations, and runs the simulator for each."""

import json
import sys
import threading
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

from beambench_report.base.files import Problem, output_of
from beambench_thesis.chapter6.machines import (
    ALL_BUILDING,
    ALL_WALKING,
    AS_OURS,
    BYTES_PER_SAMPLE_OF_1999,
    MESSAGES_OF_1999,
    MESSAGES_OF_TODAY,
    MODERN,
    NONE,
    SHARED,
    SWITCHED,
    TRACED,
    Messages,
    Network,
    Recorded,
    Slowness,
    options,
    slowness_of_1999,
)
from beambench_thesis.chapter6.record import (
    BEAMS,
    BLOCKS,
    LARGE,
    ROWS,
    TILES,
    WINDOWS,
    read_recorded,
    tasks_file,
)
from beambench_thesis.chapter6.results import EQUAL_MACHINES, THESIS_OPTIONS, write_results

OLD, TODAY = ERAS = ("1999", "today")
CLUSTERS = {OLD: (SWITCHED, MESSAGES_OF_1999), TODAY: (MODERN, MESSAGES_OF_TODAY)}
MACHINES_OF = {OLD: "1999, 100 Mbit/s", TODAY: "today, 10 Gbit/s"}
STATIONS = 15
MANY = tuple(2**power - 1 for power in range(4, 11))  # plus the producer: 16 to 1,024 processes

# Ideas that the thesis left for future work, each compared with the thesis's own scheme.
OPTIONS: dict[str, tuple[str, ...]] = {
    THESIS_OPTIONS: (),
    "8 beams a message": ("--batch", "8"),
    "two in flight": ("--in-flight", "2"),
    "8 beams a message, two in flight": ("--batch", "8", "--in-flight", "2"),
    "image blocks": (),
    "producer consumes": ("--producer-consumes",),
}
# The static divisions of section 2.3.2.1, and tiles whose beams the consumers make themselves. All
# except tiles trace individual rays.
DIVISIONS: dict[str, tuple[str, ...]] = {
    "contiguous rows": ("--division", "contiguous"),
    "interlaced rows": ("--division", "interlaced"),
    "interlaced windows": ("--division", "interlaced"),
    "windows by pre-pass": ("--division", "equal-cost"),
    "tiles": ("--division", "falling", "--stored"),
}
# For the large picture: the destination of its results, and messages sent before they are needed.
LARGE_OPTIONS: dict[str, tuple[str, ...]] = {
    "producer's beams": (),
    "tiles, results sent": ("--division", "falling", "--sample-bytes", "8"),
    "tiles": DIVISIONS["tiles"],
    "tiles, two in flight": (*DIVISIONS["tiles"], "--in-flight", "2"),
}
_WORK = {
    "image blocks": BLOCKS,
    "contiguous rows": ROWS,
    "interlaced rows": ROWS,
    "interlaced windows": WINDOWS,
    "windows by pre-pass": WINDOWS,
    "tiles, results sent": TILES,
    "tiles": TILES,
    "tiles, two in flight": TILES,
}
PRE_PASS = "windows by pre-pass"
MACHINES: dict[str, tuple[str, ...]] = {
    EQUAL_MACHINES: (),
    "every other one half as fast": ("--speeds", "1,0.5"),
    "five used by others half of the time": ("--loaded", "5", "--load-period", "4"),
}


@dataclass(frozen=True)
class Simulation:
    """One run of the program on one cluster."""

    era: str
    scene: str
    network: Network
    messages: Messages
    consumers: int
    options: str = THESIS_OPTIONS
    machines: str = EQUAL_MACHINES
    own_messages: bool = False
    """Whether results are sent as by our program, 8 bytes per sample, not the thesis's pixels."""
    constant_is: str = AS_OURS
    """How the thesis's seconds that do not grow with the rays are divided (machines.py)."""

    @property
    def work(self) -> str:
        """The kind of tasks."""
        return _WORK.get(self.options, BEAMS)

    def arguments(self) -> list[str]:
        """Returns arguments of the simulator that do not depend on recordings."""
        pixels = self.era == OLD and not self.own_messages and self.work != TILES
        return [
            *options(consumers=self.consumers),
            *self.network.arguments(),
            *self.messages.arguments(),
            *(options(sample_bytes=BYTES_PER_SAMPLE_OF_1999) if pixels else ()),
            *(OPTIONS | DIVISIONS | LARGE_OPTIONS).get(self.options, ()),
            *MACHINES[self.machines],
        ]


def simulations(scenes: tuple[str, ...], *, most: int = 1024) -> list[Simulation]:
    """Returns all simulations with at most `most` processes."""
    counts = (STATIONS // 2, STATIONS - 1, *MANY)
    every = [
        *(each for scene in scenes for each in _thesis(scene)),
        # To show when the producer saturates, and the effect of each option.
        *(each for scene in scenes for each in _on_both(scene, OPTIONS, counts)),
        *(each for scene in scenes for each in _on_both(scene, DIVISIONS, counts)),
        *_on_both(LARGE, LARGE_OPTIONS, MANY),
        *(each for scene in scenes for each in _unlike(scene)),
        *(each for scene in scenes for each in _assumptions(scene)),
    ]
    return [each for each in dict.fromkeys(every) if each.consumers < most]


def _old(scene: str, network: Network, consumers: int) -> Simulation:
    return Simulation(OLD, scene, network, MESSAGES_OF_1999, consumers)


def _thesis(scene: str) -> list[Simulation]:
    """Returns simulations for figures 6.3 and 6.4, and with more consumers until saturation."""
    settings = product((SHARED, SWITCHED), (*range(1, STATIONS), 31, 63))
    return [_old(scene, network, consumers) for network, consumers in settings]


def _on_both(scene: str, kinds: Iterable[str], counts: Iterable[int]) -> list[Simulation]:
    """Returns simulations with each of the options and numbers of consumers on both clusters."""
    return [
        Simulation(era, scene, *CLUSTERS[era], consumers, each)
        for era, each, consumers in product(ERAS, kinds, counts)
    ]


def _unlike(scene: str) -> list[Simulation]:
    """Returns simulations with machines of two speeds, and with machines that others use."""
    kinds = (THESIS_OPTIONS, "8 beams a message", "two in flight", "image blocks")
    usual = _old(scene, SWITCHED, STATIONS - 1)
    return [replace(usual, machines=one, options=kind) for one, kind in product(MACHINES, kinds)]


def _assumptions(scene: str) -> list[Simulation]:
    """Returns simulations with half and double the assumed cost of messages, and larger results."""
    settings = product((SHARED, SWITCHED), (STATIONS // 2, STATIONS - 1))
    usual = [_old(scene, network, consumers) for network, consumers in settings]
    costs = ((0.5, "messages at half the cost"), (2, "at twice the cost"))
    changed: list[dict[str, object]] = [
        *({"messages": MESSAGES_OF_1999.times(by), "options": label} for by, label in costs),
        {"options": "8 bytes a sample", "own_messages": True},
        *(
            {"options": f"constant {constant}", "constant_is": constant}
            for constant in (ALL_WALKING, ALL_BUILDING)
        ),
    ]
    return [replace(each, **changes) for changes in changed for each in usual]


class ResultCache:
    """Results of the simulator by its arguments, in a file that grows line by line."""

    def __init__(self, path: Path) -> None:
        """Reads the file."""
        self._path = path
        self._writing = threading.Lock()
        self._known: dict[tuple[str, ...], dict[str, object]] = {}
        for line in path.read_text("utf-8").splitlines() if path.is_file() else []:
            try:
                entry = json.loads(line)
            except ValueError:  # the last line was cut off
                continue
            self._known[tuple(entry["arguments"])] = entry["answer"]

    def result(self, key: list[str], command: list[str]) -> dict[str, object]:
        """Returns the result stored under `key`, or computes it by the command, from any thread.

        Raises Problem if the simulator is missing or fails.
        """
        if tuple(key) not in self._known:
            name = Path(command[0]).name
            printed = output_of(command, remedy=f"build {name} first (it needs libsimgrid-dev)")
            result = json.loads(printed)
            with self._writing, self._path.open("a", encoding="utf-8") as file:
                # On a new line, since the previous one may have been cut off.
                file.write("\n" + json.dumps({"arguments": key, "answer": result}))
                self._known[tuple(key)] = result
        return self._known[tuple(key)]


def simulate(folder: Path, program: Path, plan: Sequence[Simulation], jobs: int = 1) -> list[Path]:
    """Writes FOLDER/simulations.csv and processes.csv from the recordings in FOLDER.

    Runs `jobs` simulations at a time. Earlier results in FOLDER/answers.jsonl are reused.
    """
    recorded = read_recorded(folder)
    cache = ResultCache(folder / "answers.jsonl")
    results = []
    with ThreadPoolExecutor(jobs) as pool:
        begun = [pool.submit(_simulate, folder, program, one, recorded, cache) for one in plan]
        try:
            for number, each in enumerate(begun, 1):
                print(f"\r{number} of {len(plan)} simulations", end="", file=sys.stderr, flush=True)
                results.append(each.result())
        finally:
            pool.shutdown(cancel_futures=True)  # after a failure, the others are not started
    print(file=sys.stderr)
    return write_results(folder, results)


def slowness_of(recorded: dict[tuple[str, str], Recorded], constant_is: str = AS_OURS) -> Slowness:
    """Returns the slowness, by the scene for which the thesis states seconds."""
    known = recorded.get((TRACED, BEAMS))
    if known is None:
        raise Problem(f"{TRACED} was not recorded; the machines of 1999 are calibrated by it")
    return slowness_of_1999(known, constant_is)


def _simulate(
    folder: Path,
    program: Path,
    simulation: Simulation,
    recorded: dict[tuple[str, str], Recorded],
    cache: ResultCache,
) -> dict[str, object]:
    slow = slowness_of(recorded, simulation.constant_is) if simulation.era == OLD else NONE
    build = recorded[simulation.scene, simulation.work].build_seconds * slow.build
    arguments = [
        *options(walk_scale=slow.walk, work_scale=slow.work, build_seconds=build),
        *simulation.arguments(),
    ]
    if simulation.options == PRE_PASS:
        seconds = recorded[simulation.scene, simulation.work].pre_pass_seconds
        arguments += options(pre_pass_seconds=seconds)
    tasks = tasks_file(folder, simulation.scene, simulation.work)
    result = cache.result(
        [tasks.name, *arguments], [str(program), "cluster", str(tasks), *arguments]
    )
    # All distributed runs are compared with the sequential beam tracer.
    beams = recorded[simulation.scene, BEAMS]
    sequential = (
        beams.build_seconds * slow.build
        + beams.walk_seconds * slow.walk
        + beams.work_seconds * slow.work
    )
    return result | {
        "sequential_seconds": sequential,
        "era": simulation.era,
        "scene": simulation.scene,
        "network": simulation.network.name,
        "options": simulation.options,
        "machines": simulation.machines,
        "consumers": simulation.consumers,
    }
