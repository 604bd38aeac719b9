"""Killing and resuming a sweep until it is complete."""

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
from beambench_operations.campaign.programs import Programs
from beambench_operations.campaign.rows import cells_of, difference
from beambench_report.base.run_log import has_log

_MOST_KILLS = 12


def kill_sweep(beambench: Path, folder: Path, random: Random, programs: Programs) -> Tally:
    """Kills a sweep. Each cell must be there once at the end, as in an undisturbed run."""
    tally = Tally()
    sweep = write_sweep(folder)
    begin = [beambench, "run", sweep, "-o", folder / "undisturbed"]
    whole = undisturbed(programs.start(begin, folder), tally)
    run = folder / "killed"
    complete = False
    while not complete and not tally.faults:
        begun = has_log(run)
        arguments = ["--resume", run] if begun else [sweep, "-o", run]
        program = programs.start([beambench, "run", *arguments], folder)
        if tally.kills < _MOST_KILLS:
            ended = killed(program, random, whole, tally)
        else:
            ended = finished(program, tally)
        complete = ended.code == 0
        if not complete and not ended_as_killed(ended):
            tally.faults.append(f"it ended with {ended.code}: {ended.last_words()}")
    if not tally.faults:
        tally.faults += _faults(folder / "undisturbed/results.csv", run / "results.csv")
    return tally


def _faults(wanted_file: Path, found_file: Path) -> list[str]:
    (wanted, wrong), (found, damage) = cells_of(wanted_file), cells_of(found_file)
    fault = wrong or damage or difference(wanted, found)
    return [fault] if fault else []
