"""The command line of scripts/campaign."""

import argparse
import contextlib
import os
import signal
import sys
from collections.abc import Callable, Collection
from functools import partial
from pathlib import Path

from beambench_operations.campaign.kills import kill, killable
from beambench_operations.campaign.libfuzzer import fuzz, targets_in
from beambench_operations.campaign.maps import SUBJECT as MAPS
from beambench_operations.campaign.maps import fuzz_maps
from beambench_operations.campaign.piece import Piece, Task
from beambench_operations.campaign.pool import do_pieces
from beambench_operations.campaign.programs import Programs
from beambench_operations.campaign.rays import next_seed, structures, trace
from beambench_operations.campaign.record import Record
from beambench_operations.campaign.report import write_report
from beambench_report.base.command_line import BEAMBENCH, ScriptParser
from beambench_report.base.files import ROOT, Problem, say

HOME = ROOT / "results/robustness"
_TARGETS = ROOT / "build/fuzz/bin"
_LONGEST = 300.0  # most seconds of a piece of fuzzing, all of which Ctrl-C may lose
_MEASURE = {"fuzz": "seconds", "rays": "scenes", "kills": "runs"}
"""The count, over all pieces of the record, that is balanced between the subjects of a command."""

Work = dict[str, Callable[[int | None], Piece]]
"""Functions that make a piece for a subject, with a given seed or the next one."""


def main(arguments: list[str]) -> int:
    """Runs the command line; returns the exit code."""
    parser = ScriptParser("campaign")
    parser.add_argument("command", choices=_MEASURE, nargs="?")
    parser.add_argument("--minutes", type=_number, default=10.0)
    parser.add_argument("--jobs", type=_count, default=os.cpu_count() or 1)
    parser.add_argument("--only", metavar="NAME")
    parser.add_argument("--seed", type=_count)
    parser.add_argument("--home", type=Path, default=HOME, metavar="DIR")
    parser.add_argument("--report", type=Path, metavar="DIR")
    parser.add_argument("--dry-run", action="store_true")
    parser.add_argument("--beambench", type=Path, default=BEAMBENCH, metavar="PROGRAM")
    parser.add_argument("--targets", type=Path, default=_TARGETS, metavar="DIR")
    interrupted = "interrupted; the pieces in progress are not counted"
    return parser.run(_run, arguments, interrupted)


def _number(text: str) -> float:
    with contextlib.suppress(ValueError):
        if 0 <= (number := float(text)) < 1e6:
            return number
    raise argparse.ArgumentTypeError(f"'{text}' is not a number from 0 to a million")


def _count(text: str) -> int:
    with contextlib.suppress(ValueError):
        if 1 <= (number := int(text)) < 2**31:
            return number
    raise argparse.ArgumentTypeError(f"'{text}' is not a whole number of 1 or more")


def _run(options: argparse.Namespace) -> int:
    if bool(options.command) == bool(options.report):
        raise Problem("name one of fuzz, rays and kills, or --report with a folder")
    record = Record(options.home.absolute())
    if options.report:
        for path in write_report(record.pieces(), options.report):
            print(path)
        return 0
    if options.dry_run:
        print(f"{options.command}: {options.minutes:g} min on {options.jobs} cores, {record.file}")
        return 0
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    programs = Programs()
    work = _work(options, record, programs)
    if options.only:
        if options.only not in work:
            raise Problem(f"there is no '{options.only}' here, only {', '.join(work)}")
        work = {options.only: work[options.only]}
    choose = partial(_next, work, options, record)
    jobs = min(options.jobs, len(work))
    pieces = do_pieces(choose, record, programs, 60 * options.minutes, jobs)
    found = sum(len(piece.findings) for piece in pieces)
    say(f"{len(pieces)} pieces, {found} findings; {record.file}")
    return 1 if found else 0


def _next(work: Work, options: argparse.Namespace, record: Record, busy: Collection[str]) -> Task:
    """Returns the subject with the least work so far."""
    done = partial(record.total, options.command, what=_MEASURE[options.command])
    subject = min((one for one in work if one not in busy), key=lambda one: done(one))
    return Task(subject, partial(work[subject], options.seed))


def _work(options: argparse.Namespace, record: Record, programs: Programs) -> Work:
    if options.command == "fuzz":
        return _fuzzing(options, record, programs)
    beambench = options.beambench.absolute()

    def rays(structure: str, seed: int | None) -> Piece:
        seed = seed or next_seed(record, structure)
        return trace(beambench, structure, seed, record, programs)

    def kills(kind: str, seed: int | None) -> Piece:
        seed = seed or 1 + record.total("kills", kind, "runs")
        return kill(beambench, kind, seed, record, programs)

    if options.command == "rays":
        return {structure: partial(rays, structure) for structure in structures(beambench)}
    return {kind: partial(kills, kind) for kind in killable(beambench)}


def _fuzzing(options: argparse.Namespace, record: Record, programs: Programs) -> Work:
    targets = {target.name: target for target in targets_in(options.targets.absolute())}
    subjects = len(targets) + 1 if not options.only else 1
    jobs = min(options.jobs, subjects)
    share = min(max(60 * options.minutes * jobs / subjects, 1.0), _LONGEST)

    def seeded(name: str, seed: int | None) -> int:
        return seed or 1 + record.total("fuzz", name, "executions") % 2**31

    def target(name: str, seed: int | None) -> Piece:
        return fuzz(targets[name], seeded(name, seed), share, record, programs)

    def maps(seed: int | None) -> Piece:
        return fuzz_maps(seeded(MAPS, seed), share, record, programs)

    return {**{name: partial(target, name) for name in targets}, MAPS: maps}


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
