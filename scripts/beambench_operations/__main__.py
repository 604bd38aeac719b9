"""Command line: python -m beambench_operations nightly|site|compare|diff|benchmarks ..."""

import argparse
import sys
from pathlib import Path

from beambench_operations.nightly.command import add_nightly_command
from beambench_operations.nightly.compare import compare_turns, measure_in_turns
from beambench_operations.nightly.diff import diff
from beambench_operations.nightly.exports import bigger_is_better, google_benchmark
from beambench_operations.site.write import write_site
from beambench_report.base.command_line import (
    Options,
    add_command,
    run_command,
)
from beambench_report.base.records import read_run

_EXPORTS = {"customBiggerIsBetter": bigger_is_better, "google-benchmark": google_benchmark}


def main(arguments: list[str] | None = None) -> int:
    """Runs one command; returns the exit code (2 for invalid arguments or input)."""
    return run_command(_parser(), arguments)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="beambench_operations",
        description="Nightly runs, their history and site, and comparisons of runs.",
    )
    commands = parser.add_subparsers(dest="command", required=True)
    add_nightly_command(commands)
    site = add_command(
        commands,
        "site",
        lambda o: [write_site(o.folders, o.output)],
        help="write a site of plain files over all runs: index, pages, comparisons, histories",
    )
    site("folders", type=Path, nargs="+", metavar="DIR", help="a run, or a folder of runs")
    site("-o", "--output", type=Path, required=True, metavar="SITE", help="a new folder, or a site")
    compare = add_command(
        commands, "compare", _compare, help="run two programs in turns: is B slower?"
    )
    compare("programs", type=Path, nargs=2, metavar="PROGRAM")
    compare("--sweep", type=Path, required=True, metavar="FILE")
    compare("--turns", type=int, default=12, metavar="N")
    compare("-o", "--output", type=Path, required=True, metavar="DIR")
    two = add_command(
        commands,
        "diff",
        lambda o: diff(o.first, o.second, relative=o.relative).text(),
        help="compare two result files, structure by structure",
    )
    two("first", type=Path, metavar="A.csv", help="a results.csv, or a run's folder")
    two("second", type=Path, metavar="B.csv")
    two(
        "--relative",
        action=argparse.BooleanOptionalAction,
        help="compare ratios to a contender that both files have (default: only if the machines "
        "differ, because their milliseconds are not comparable)",
    )
    benchmarks = add_command(
        commands,
        "benchmarks",
        lambda o: _EXPORTS[o.format](read_run(o.run)),
        help="print a run for other benchmark tools",
    )
    benchmarks("run", type=Path, metavar="RUN", help="folder of a run")
    benchmarks("--format", choices=sorted(_EXPORTS), required=True)
    return parser


def _compare(options: Options) -> int:
    runs = measure_in_turns(tuple(options.programs), options.sweep, options.output, options.turns)
    outcome = compare_turns(*runs)
    print(f"{outcome.table()}\n\n{outcome.verdict()}")
    return 1 if outcome.is_regression else 0


if __name__ == "__main__":
    sys.exit(main())
