"""Pieces that kill a sweep, nightly runs, or the cluster program."""

from collections.abc import Callable
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from beambench_operations.campaign.cluster_kills import is_possible, kill_cluster
from beambench_operations.campaign.killed import Tally
from beambench_operations.campaign.night_kills import kill_nights
from beambench_operations.campaign.piece import Piece
from beambench_operations.campaign.programs import Programs
from beambench_operations.campaign.record import Record
from beambench_operations.campaign.sweep_kills import kill_sweep

_KINDS: dict[str, Callable[[Path, Path, Random, Programs], Tally]] = {
    "sweep": kill_sweep,
    "nights": kill_nights,
    "cluster": kill_cluster,
}


def killable(beambench: Path) -> list[str]:
    """Returns the subjects that can be killed on this machine."""
    return [kind for kind in _KINDS if kind != "cluster" or is_possible(beambench)]


def kill(beambench: Path, kind: str, seed: int, record: Record, programs: Programs) -> Piece:
    """Kills a subject several times in a folder of its own, which is kept if something is wrong."""
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
