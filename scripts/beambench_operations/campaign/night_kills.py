"""Kills and resumes nightly runs: the history must not lose or duplicate a night."""

import sqlite3
import sys
import time
from contextlib import closing
from pathlib import Path
from random import Random

from beambench_operations.campaign.killed import (
    Tally,
    ended_as_killed,
    finished,
    killed,
    undisturbed,
    write_sweep,
)
from beambench_operations.campaign.programs import PYTHON, Programs
from beambench_operations.campaign.rows import cells_of, difference
from beambench_operations.nightly.home import Home

_KILLS = 4
_REGRESSED = 1  # an allowed exit code, because tiny nights are noisy
_WAIT = 0.5  # seconds to wait for a run whose parent was killed
_IN_PROGRESS = ("a nightly run is in progress", "no run was cut off")


def kill_nights(beambench: Path, folder: Path, random: Random, programs: Programs) -> Tally:
    """Runs an undisturbed night, then kills and resumes nights until there were enough kills and
    the last night is complete.
    """
    tally = Tally()
    home = folder / "nightly"
    command = [
        *(sys.executable, "-m", "beambench_operations", "nightly", "run", "--home", home),
        *("--sweep", write_sweep(folder), "--beambench", beambench),
    ]
    whole = undisturbed(programs.start(command, folder, PYTHON), tally)
    nights = _nights(home)
    complete = False
    while not complete and not tally.faults:
        resume = ["--resume"] if Home(home).unfinished() else []
        program = programs.start([*command, *resume], folder, PYTHON)
        if tally.kills < _KILLS:
            ended = killed(program, random, whole, tally, to_all=random.random() < 0.5)
        else:
            ended = finished(program, tally)
        lost = nights - _nights(home)
        nights = _nights(home)
        if lost:
            tally.faults.append(f"the finished night {min(lost)} is gone")
        if ended.code in (0, _REGRESSED):
            complete = tally.kills >= _KILLS
        elif any(words in ended.errors for words in _IN_PROGRESS):
            time.sleep(_WAIT)
        elif not ended_as_killed(ended):
            tally.faults.append(f"it ended with {ended.code}: {ended.last_words()}")
    if not tally.faults and (fault := _fault(home)):
        tally.faults.append(fault)
    return tally


def _fault(home: Path) -> str:
    """Returns what is wrong with the history; empty if nothing is wrong."""
    with closing(sqlite3.connect(home / "history.sqlite")) as history:
        nights = sorted(folder for (folder,) in history.execute("SELECT folder FROM nights"))
    if nights != sorted(_nights(home)):
        return f"the history has the nights {nights}, not {sorted(_nights(home))}"
    first, _ = cells_of(home / nights[0] / "results.csv")
    for night in nights:
        cells, damage = cells_of(home / night / "results.csv")
        if fault := damage or difference(first, cells):
            return f"in the night {night}, {fault}"
    return ""


def _nights(home: Path) -> set[str]:
    """Returns the nights that finished."""
    return {run.name for run in Home(home).finished()}
