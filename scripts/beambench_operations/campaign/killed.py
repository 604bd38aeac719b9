"""Kills programs by signals at random moments, and judges how they end."""

import json
import signal
import time
from dataclasses import dataclass, field
from pathlib import Path
from random import Random

from beambench_operations.campaign.programs import Ended, Program

SIGNALS = (signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
_HANGING = 300.0  # seconds

SWEEP = {
    "name": "tiny",
    "scenes": ["tetra:n=1", "tetra:n=2"],
    "structures": ["null", "samet:max_level=3", "beam:max_level=3", "embree"],
    "resolutions": ["8x8", "16x10"],
    "repetitions": {"minimum": 2, "maximum": 2},
    "budget_seconds": 0,
    "warm_up_seconds": 0,
}
"""The sweep that is killed: it takes seconds and has cells of several scenes and structures."""


def write_sweep(folder: Path) -> Path:
    """Writes the sweep into a folder."""
    path = folder / "tiny.json"
    path.write_text(json.dumps(SWEEP), "utf-8")
    return path


@dataclass
class Tally:
    """The counts and faults of a piece so far."""

    kills: int = 0
    runs: int = 0
    cpu_seconds: float = 0.0
    faults: list[str] = field(default_factory=list)


def finished(program: Program, tally: Tally) -> Ended:
    """Returns how a program ended. It is killed after five minutes, which counts as a fault."""
    ended = program.wait(_HANGING)
    if ended is None:
        tally.faults.append(f"it did not end within {_HANGING:.0f} s")
        program.end()
        ended = program.wait()
    assert ended is not None
    tally.runs += 1
    tally.cpu_seconds += ended.cpu_seconds
    return ended


def killed(
    program: Program, random: Random, whole: float, tally: Tally, *, to_all: bool = False
) -> Ended:
    """Sends a signal at a random time within `whole` seconds; returns how the program ended."""
    number = random.choice(SIGNALS)
    if program.wait(random.uniform(0, whole)) is None:
        program.send(number, to_all=to_all)
        tally.kills += 1
    return finished(program, tally)


def undisturbed(program: Program, tally: Tally) -> float:
    """Waits for a program that must succeed; returns its duration."""
    begin = time.monotonic()
    ended = finished(program, tally)
    if ended.code != 0:
        tally.faults.append(f"it failed although nothing killed it: {ended.last_words()}")
    return time.monotonic() - begin


def ended_as_killed(ended: Ended) -> bool:
    """Returns whether the program ended by the signal, or properly because of it."""
    return ended.code in (130, 143, *(-number for number in SIGNALS))
