"""The command `python -m beambench_operations nightly`, which scripts/nightly calls."""

from collections.abc import Callable
from pathlib import Path

from beambench_operations.history.nights import Nights, read_nights
from beambench_operations.history.store import History, rebuild
from beambench_operations.nightly.calibration import (
    Effort,
    calibrate,
    has_enough,
    noise_of,
    noise_of_samples,
)
from beambench_operations.nightly.home import HOME, KEEP_SAMPLES, Home, adopt, only_one, prune
from beambench_operations.nightly.run import describe, rebuild_history, record, run_night
from beambench_operations.site.write import write_site
from beambench_report.base.command_line import BEAMBENCH, Commands, Options, Result, add_command
from beambench_report.base.files import ROOT, Problem, say, write_text
from beambench_report.base.records import read_run

_SWEEP = ROOT / "harness/measure/sweeps/nightly.json"
_PUBLISHED = ROOT / "results/published/nightly"


def add_nightly_command(commands: Commands) -> None:
    """Adds the command and its subcommands."""
    parser = commands.add_parser("nightly", help="measure, record and report nightly runs")
    parts = parser.add_subparsers(dest="part", required=True)
    run = add_command(parts, "run", _run, help="measure and record a night, write the site")
    run("--sweep", type=Path, default=_SWEEP, metavar="FILE")
    run("--resume", action="store_true", help="resume the interrupted run")
    run("--dry-run", action="store_true", help="print what would be done")
    add = add_command(
        parts, "add", _alone(_add), help="record and report a run that was measured by other means"
    )
    add("run", type=Path, metavar="RUN")
    rebuilding = add_command(
        parts,
        "rebuild",
        _alone(lambda o: f"{o.home.history}: {rebuild_history(o.home)} nights\n"),
        help="rebuild the history from the CSVs",
    )
    page = add_command(
        parts,
        "page",
        _alone(lambda o: [write_site([o.home.folder], o.home.site, o.published)]),
        help="write the site again",
    )
    pruning = add_command(
        parts,
        "prune",
        _alone(lambda o: f"{len(prune(o.home, o.keep))} files deleted\n"),
        help="delete the raw samples of old runs",
    )
    calibration = add_command(
        parts,
        "calibrate",
        _calibrate,
        help="count the false alarms of pure noise and find the smallest slowdown that is found",
    )
    for command in (run, add, rebuilding, page, pruning, calibration):
        command("--home", type=_home, default=_home(HOME), metavar="DIR")
    for command in (run, add, page):
        command("--published", type=Path, metavar="RUN")
    for command in (run, add, pruning):
        command("--keep", type=int, default=KEEP_SAMPLES, metavar="N")
    for command in (run, add):
        command("--beambench", type=Path, default=BEAMBENCH, metavar="PROGRAM")
    calibration(
        "runs",
        type=Path,
        nargs="*",
        metavar="RUN",
        help="ten or more runs of one sweep by one program; if none is given, those of the history",
    )
    calibration("--samples", action="store_true", help="draw nights from the blocks of the runs")
    calibration("--nights", type=int, default=1000, metavar="N")
    usual = Effort()
    for name, kind, words in (
        (
            "precision",
            float,
            "half the width that the 95%% confidence intervals of the powers should have",
        ),
        ("trials", int, "the most trials"),
        ("seconds", float, "the most seconds for the trials"),
    ):
        calibration(
            f"--{name}",
            type=kind,
            default=getattr(usual, name),
            help=f"{words} (default: %(default)s)",
        )
    calibration(
        "--slowdowns",
        type=float,
        nargs="+",
        default=[0.01, 0.015, 0.02, 0.03, 0.05],
        metavar="PART",
        help="the slowdowns that are planted; 0.05 is 5%%",
    )
    calibration("-o", "--output", type=Path, metavar="FILE.json")


def _home(folder: str | Path) -> Home:
    return Home(Path(folder).resolve())


def _alone(work: Callable[[Options], Result]) -> Callable[[Options], Result]:
    """Returns the command with its options checked and the home locked against other processes."""

    def checked(options: Options) -> Result:
        _check(options)
        with only_one(options.home.lock):
            return work(options)

    return checked


def _check(options: Options) -> None:
    """Fills in `published`. Raises Problem for invalid arguments."""
    if getattr(options, "keep", 1) < 1:
        raise Problem("--keep must be at least 1")
    wanted = getattr(options, "published", None)
    if wanted is not None and not (wanted / "results.csv").is_file():
        raise Problem(f"{wanted}: holds no results.csv; give the folder of a run")
    if wanted is None and (_PUBLISHED / "results.csv").is_file():
        options.published = _PUBLISHED


def _run(options: Options) -> Result:
    _check(options)
    if not options.sweep.is_file():
        raise Problem(f"{options.sweep}: is not a file that can be read")
    if options.dry_run:
        return describe(options)
    with only_one(options.home.lock) as lock:
        return run_night(options, lock)


def _add(options: Options) -> int:
    run_id = read_run(options.run).rows.iloc[0]["run_id"]
    return record(options, adopt(options.home, options.run, run_id))


def _calibrate(options: Options) -> int:
    if options.samples:
        noise = noise_of_samples(options.runs)
    elif options.runs:
        path = Path(options.runs[0]).parent / ".calibration.sqlite"
        try:
            rebuild(path, options.runs)
            noise = noise_of(_nights(path))
        finally:
            path.unlink(missing_ok=True)
    else:
        noise = noise_of(_nights(options.home.history))
    if not has_enough(noise):
        raise Problem(
            f"{noise.nights} nights in blocks are too few to draw noise from; ten are needed, or "
            "the blocks of a run: --samples RUN"
        )
    if options.trials < 1 or options.seconds <= 0 or options.precision <= 0:
        raise Problem("--trials must be at least 1, --seconds and --precision above 0")
    effort = Effort(options.precision, options.trials, options.seconds)
    result = calibrate(noise, options.nights, options.slowdowns, effort, report=say)
    print(result.summary())
    if options.output:
        write_text(options.output, result.as_json())
    return 0 if result.alarms * 100 <= result.nights else 1


def _nights(file: Path) -> Nights:
    with History(file) as history:
        return read_nights(history, compared=True)
