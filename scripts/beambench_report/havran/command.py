"""`python -m beambench_report havran measure|write DIR`."""

import argparse
from pathlib import Path

from beambench_report.havran.census import require_program
from beambench_report.havran.contenders import SCENES
from beambench_report.havran.measure import measure
from beambench_report.havran.report import write_report


def add_havran_command(commands: argparse._SubParsersAction, program: Path) -> None:
    """Adds `havran` with its steps; `program` is the built beambench."""
    havran = commands.add_parser(
        "havran", help="measure Havran's comparison of octrees (1999) again, ours beside his"
    )
    havran.set_defaults(handler=run_step)
    steps = havran.add_subparsers(dest="step", required=True)
    first = steps.add_parser("measure", help="count into DIR/counts.csv; resumes what was cut off")
    last = steps.add_parser("write", help="write DIR/report.md from DIR/counts.csv")
    for step in (first, last):
        step.add_argument("folder", type=Path, metavar="DIR")
    first.add_argument(
        "--scene",
        action="append",
        choices=sorted(SCENES),
        help="only this scene; may be given several times",
    )
    first.add_argument(
        "--program",
        type=Path,
        default=program,
        metavar="PROGRAM",
        help="if not given, build/release/bin/beambench",
    )


def run_step(options: argparse.Namespace) -> list[Path]:
    """Runs one step; returns what was written."""
    if options.step == "write":
        return [write_report(options.folder)]
    program = require_program(options.program)
    return measure(options.folder, program, options.scene or sorted(SCENES))
