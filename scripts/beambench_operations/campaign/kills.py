"""Pieces that kill a sweep, nightly runs, or the cluster program."""

from collections.abc import Callable
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from beambench_operations.campaign.cluster_kills import is_possible, kill_cluster
from beambench_operations.campaign.killed import (
    Tally,
    ended_as_killed,
    finished,
    killed,
    undisturbed,
    write_sweep,
)
from beambench_operations.campaign.night_kills import kill_nights
from beambench_operations.campaign.piece import Piece
from beambench_operations.campaign.programs import Programs
from beambench_operations.campaign.record import Record
from beambench_operations.campaign.rows import cells_of, difference
from beambench_report.base.run_log import has_log

_MOST_KILLS = 12


def kill_sweep(beambench: Path, folder: Path, random: Random, programs: Programs) -> Tally:
    """Kills and resumes a sweep. At the end it must have each cell once, as if undisturbed."""
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
        (wanted, wrong), (found, damage) = (
            cells_of(one / "results.csv") for one in (folder / "undisturbed", run)
        )
        if fault := wrong or damage or difference(wanted, found):
            tally.faults.append(fault)
    return tally


_KINDS: dict[str, Callable[[Path, Path, Random, Programs], Tally]] = {
    "sweep": kill_sweep,
    "nights": kill_nights,
    "cluster": kill_cluster,
}


def killable(beambench: Path) -> list[str]:
    """Returns the subjects that can be killed on this machine."""
    return [kind for kind in _KINDS if kind != "cluster" or is_possible(beambench)]


def kill(beambench: Path, kind: str, seed: int, record: Record, programs: Programs) -> Piece:
    """Kills a subject several times in a new folder, which is kept if anything is wrong."""
    with TemporaryDirectory(prefix="beambench-campaign-", ignore_cleanup_errors=True) as name:
        folder = Path(name)
        tally = _KINDS[kind](beambench.resolve(), folder, Random(seed), programs)
        again: list[str | Path] = [
            *("scripts/campaign", "kills", "--minutes", "0", "--only", kind, "--seed", str(seed))
        ]
        findings = [
            record.keep(folder, f"kills-{kind}-{seed}", fault, again) for fault in tally.faults
        ]
    counts = {"kills": tally.kills, "runs": tally.runs}
    return Piece("kills", kind, seed, counts, round(tally.cpu_seconds, 1), {}, findings)
