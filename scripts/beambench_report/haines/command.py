"""`python -m beambench_report haines DIR`."""

import argparse
from pathlib import Path

from beambench_report.haines.counts import measure_tests
from beambench_report.haines.report import write_report
from beambench_report.havran.census import require_program


def add_haines_command(commands: argparse._SubParsersAction, program: Path) -> None:
    """Adds `haines`; `program` is the built beambench."""
    haines = commands.add_parser(
        "haines", help="count Haines's tests of the SPD (1987) again, ours beside his"
    )
    haines.set_defaults(handler=run_haines)
    haines.add_argument(
        "folder", type=Path, metavar="DIR", help="gets tests.csv and report.md; is resumed"
    )
    haines.add_argument(
        "--program",
        type=Path,
        default=program,
        metavar="PROGRAM",
        help="if not given, build/release/bin/beambench",
    )


def run_haines(options: argparse.Namespace) -> list[Path]:
    """Counts and writes; returns what was written."""
    program = require_program(options.program)
    return [measure_tests(options.folder, program), write_report(options.folder)]
