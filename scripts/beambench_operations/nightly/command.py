"""The command `python -m beambench_operations nightly`, which scripts/nightly calls."""

import argparse
from pathlib import Path

from beambench_operations.history.nights import read_nights
from beambench_operations.history.store import History, rebuild
from beambench_operations.nightly.calibration import (
    Effort,
    calibrate,
    has_enough,
    noise_of,
    noise_of_samples,
)
from beambench_operations.nightly.home import HOME, KEEP_SAMPLES, Home, adopt, only_one, prune
from beambench_operations.nightly.run import Request, describe, rebuild_history, record, run_night
from beambench_operations.site.write import write_site
from beambench_report.base.files import ROOT, Problem, say, write_text
from beambench_report.base.records import read_run

_SWEEP = ROOT / "harness/bench/sweeps/nightly.json"
_PUBLISHED = ROOT / "results/published/nightly"


def add_nightly_command(commands: argparse._SubParsersAction, built: Path) -> None:
    """Adds the command and its parts; `built` is the default path of the program."""
    parser = commands.add_parser("nightly", help="measure, record and report nightly runs")
    parser.set_defaults(handler=nightly)
    parts = parser.add_subparsers(dest="part", required=True)
    run = parts.add_parser("run", help="measure and record a night, write the site")
    run.add_argument("--sweep", type=Path, default=_SWEEP, metavar="FILE")
    run.add_argument("--resume", action="store_true", help="resume what was cut off")
    run.add_argument("--dry-run", action="store_true", help="print what would be done")
    add = parts.add_parser("add", help="record and report a run that was measured otherwise")
    add.add_argument("run", type=Path, metavar="RUN")
    rebuilding = parts.add_parser("rebuild", help="make the history anew from the CSVs")
    page = parts.add_parser("page", help="write the site again")
    pruning = parts.add_parser("prune", help="delete the raw samples of old runs")
    for command in (run, add, rebuilding, page, pruning):
        command.add_argument("--home", type=Path, default=HOME, metavar="DIR")
    for command in (run, add, page):
        command.add_argument("--published", type=Path, metavar="RUN")
    for command in (run, add, pruning):
        command.add_argument("--keep", type=int, default=KEEP_SAMPLES, metavar="N")
    for command in (run, add):
        command.add_argument("--beambench", type=Path, default=built, metavar="PROGRAM")
    _add_calibrate(parts)


def _add_calibrate(parts: argparse._SubParsersAction) -> None:
    parser = parts.add_parser(
        "calibrate", help="count the false alarms of pure noise and find the least slow-down seen"
    )
    parser.add_argument(
        "runs",
        type=Path,
        nargs="*",
        metavar="RUN",
        help="ten or more runs of one sweep by one program; if none is given, those of the history",
    )
    parser.add_argument("--home", type=Path, default=HOME, metavar="DIR")
    parser.add_argument(
        "--samples", action="store_true", help="draw nights from the raw samples of the runs"
    )
    parser.add_argument("--nights", type=int, default=1000, metavar="N")
    usual = Effort()
    parser.add_argument(
        "--precision",
        type=float,
        default=usual.precision,
        metavar="PART",
        help="half the width that the 95%% intervals of the powers should have; %(default)s if not "
        "given",
    )
    parser.add_argument(
        "--trials", type=int, default=usual.trials, metavar="N", help="at most; %(default)s"
    )
    parser.add_argument(
        "--seconds",
        type=float,
        default=usual.seconds,
        metavar="S",
        help="at most, for the trials; %(default)s",
    )
    parser.add_argument(
        "--slowdowns",
        type=float,
        nargs="+",
        default=[0.01, 0.015, 0.02, 0.03, 0.05],
        metavar="PART",
        help="what is planted, 0.05 being 5%%",
    )
    parser.add_argument("-o", "--output", type=Path, metavar="FILE.json")


def nightly(options: argparse.Namespace) -> int:
    """Runs one part; returns its exit code. Raises Problem for invalid arguments or input."""
    if options.part == "calibrate":
        return _calibrate(options)
    home = Home(options.home.resolve())
    if getattr(options, "keep", 1) < 1:
        raise Problem("--keep must be at least 1")
    published = _published(options)
    if options.part == "run":
        return _run(options, home, published)
    with only_one(home.lock):
        if options.part == "add":
            run = adopt(home, options.run, read_run(options.run).rows.iloc[0]["run_id"])
            return record(home, run, options.beambench, published, options.keep)
        if options.part == "rebuild":
            print(f"{home.history}: {rebuild_history(home)} nights")
        elif options.part == "prune":
            print(f"{len(prune(home, options.keep))} files deleted")
        else:
            print(write_site([home.folder], home.site, published))
    return 0


def _run(options: argparse.Namespace, home: Home, published: Path | None) -> int:
    if not options.sweep.is_file():
        raise Problem(f"{options.sweep}: is not a file that can be read")
    request = Request(
        home, options.sweep, options.beambench, published, options.resume, options.keep
    )
    if options.dry_run:
        print(describe(request), end="")
        return 0
    with only_one(home.lock) as lock:
        return run_night(request, lock)


def _published(options: argparse.Namespace) -> Path | None:
    wanted = getattr(options, "published", None)
    if wanted is not None:
        if not (wanted / "results.csv").is_file():
            raise Problem(f"{wanted}: holds no results.csv; give the folder of a run")
        return wanted
    return _PUBLISHED if (_PUBLISHED / "results.csv").is_file() else None


def _calibrate(options: argparse.Namespace) -> int:
    if options.samples:
        noise = noise_of_samples(options.runs)
    elif options.runs:
        path = Path(options.runs[0]).parent / ".calibration.sqlite"
        try:
            rebuild(path, options.runs)
            with History(path) as history:
                noise = noise_of(read_nights(history))
        finally:
            path.unlink(missing_ok=True)
    else:
        with History(Home(options.home).history) as history:
            noise = noise_of(read_nights(history))
    if not has_enough(noise):
        raise Problem(
            f"{noise.nights} nights are too few to draw noise from; ten are needed, or raw samples "
            "of a run: --samples RUN"
        )
    if options.trials < 1 or options.seconds <= 0 or options.precision <= 0:
        raise Problem("--trials must be at least 1, --seconds and --precision above 0")
    effort = Effort(options.precision, options.trials, options.seconds)
    result = calibrate(
        noise,
        options.nights,
        options.slowdowns,
        effort,
        report=say,
    )
    print(result.summary())
    if options.output:
        write_text(options.output, result.as_json())
    return 0 if result.alarms * 100 <= result.nights else 1
