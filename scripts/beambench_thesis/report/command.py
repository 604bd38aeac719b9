"""The command `python -m beambench_thesis run`, which scripts/thesis calls."""

import argparse
from datetime import UTC, datetime
from pathlib import Path

from beambench_report.base.files import ROOT, Problem, say
from beambench_thesis.chapter5.facts import gather_facts
from beambench_thesis.report.plan import (
    Plan,
    add_levels,
    add_variants,
    keep_plan,
    make_plan,
    read_plan,
)
from beambench_thesis.report.runner import describe, run_sweeps
from beambench_thesis.report.write import write_report

_QUICK = (
    "only 320x200 and 640x480, with few repetitions; enough for the claims C12, C14, C21, C30, "
    "C31 and C34 alone: the other claims need higher resolutions"
)
_MOST_VARIANTS = 99
_EXAMPLES = """examples:
  scripts/thesis                            everything, within an hour
  scripts/thesis --quick                    the two lowest resolutions, within five minutes
  scripts/thesis --table 5.4 --table 5.6    what two tables need
  scripts/thesis --figure 5.11 -o samples   what a figure needs, in a folder of your choice
  scripts/thesis --levels                   also how well max_level=auto chooses the level
  scripts/thesis --perturb                  also the claims over eight variants of every scene
  scripts/thesis --dry-run                  what would be run, and how long it would take
  scripts/thesis --resume samples           resume a run that was cut off
"""


def add_run_command(commands: argparse._SubParsersAction, built: Path) -> None:
    """Adds the command and its options; `built` is the default path of the program."""
    parser = commands.add_parser(
        "run",
        help="measure the tables and figures of the thesis again, and report on them",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.set_defaults(handler=thesis)
    add = parser.add_argument
    add(
        "--table",
        action="append",
        default=[],
        metavar="5.4",
        help="measure only what this table needs",
    )
    add(
        "--figure",
        action="append",
        default=[],
        metavar="5.8",
        help="measure only what this figure needs",
    )
    add("--quick", action="store_true", help=_QUICK)
    add("--levels", action="store_true", help="also test how max_level=auto chooses; 8 min or more")
    add(
        "--perturb",
        type=_variants,
        nargs="?",
        const=8,
        default=0,
        metavar="N",
        help="also N variants of every scene (8 by default; up to 7 minutes each) at 320x200 and "
        "640x480: other seeds, cameras and places of objects",
    )
    add(
        "--dry-run",
        action="store_true",
        help="list the sweeps, their cells and their time, and stop",
    )
    add("--report-only", action="store_true", help="measure nothing; write the report anew")
    add(
        "-o",
        "--output",
        type=Path,
        metavar="DIR",
        help="output folder; default results/runs/<time>-thesis",
    )
    add("--resume", type=Path, metavar="DIR", help="resume the run in DIR; skips finished sweeps")
    add("--beambench", type=Path, default=built, metavar="PROGRAM", help="the built beambench")


def _variants(text: str) -> int:
    if not text.isdecimal() or not 1 <= int(text) <= _MOST_VARIANTS:
        raise argparse.ArgumentTypeError(f"'{text}': give a number from 1 to {_MOST_VARIANTS}")
    return int(text)


def thesis(options: argparse.Namespace) -> int:
    """Runs the command; returns its exit code. Raises Problem for invalid arguments or input."""
    plan, directory = _request(options)
    if options.dry_run:
        print(describe(plan, directory if options.resume else None), end="")
        return 0
    directory.mkdir(parents=True, exist_ok=True)
    if not options.resume or options.levels or options.perturb:
        keep_plan(plan, directory)
    code = 0
    if not options.report_only:
        outcome = run_sweeps(plan, directory, options.beambench)
        if outcome.interrupted:
            say(f"interrupted; resume with: scripts/thesis --resume '{directory}'")
            return outcome.exit_code
        for name in outcome.not_made:
            say(f"the sweep '{name}' could not be run (see above); the report leaves it out")
        code = outcome.exit_code
        if plan.is_everything:
            for sentence in gather_facts(directory, options.beambench):
                say(f"{sentence}; the report leaves it out")
    report = write_report(directory, plan, options.beambench)
    if report.wrong and not code:
        code = 1
    if report.wrong:
        say(f"{report.wrong} of {report.cells} cells have no times: wrong hits")
    if report.notice:
        say(report.notice)
    for path in report.paths:
        print(path)
    return code


def _request(options: argparse.Namespace) -> tuple[Plan, Path]:
    if options.resume is None:
        if options.report_only:
            raise Problem("--report-only needs the folder of a run: give it with --resume DIR")
        plan = make_plan(
            options.table,
            options.figure,
            options.quick,
            with_levels=options.levels,
            variants=options.perturb,
        )
        time = datetime.now(UTC).strftime("%Y%m%dT%H%M%SZ")
        directory = options.output or ROOT / "results/runs" / f"{time}-thesis"
        if (directory / "thesis.json").exists() and not options.dry_run:
            raise Problem(
                f"{directory}: holds a run already; resume it with --resume, or choose another"
            )
        return plan, directory
    if any((options.table, options.figure, options.quick, options.output)):
        raise Problem(
            "--resume continues a run: no other choice can be given with it, except --levels and "
            "--perturb"
        )
    plan = read_plan(options.resume)
    plan = add_variants(plan, options.perturb)
    return add_levels(plan) if options.levels else plan, options.resume
