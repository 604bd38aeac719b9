"""Command line: python -m beambench_thesis run|claims|cluster|levels|sampling ..."""

import argparse
import sys
from pathlib import Path

from beambench_report.base.command_line import (
    BEAMBENCH,
    PROGRAMS,
    Commands,
    Options,
    Result,
    add_command,
    run_command,
)
from beambench_report.base.files import write_text
from beambench_thesis.chapter5.levels import levels_of_runs
from beambench_thesis.chapter5.sampling import write_sampling
from beambench_thesis.chapter6.command import add_cluster_command
from beambench_thesis.claims.register import cells_as_markdown, claims_as_markdown, judge_claims
from beambench_thesis.report.command import add_run_command


def main(arguments: list[str] | None = None) -> int:
    """Runs one command; returns the exit code (2 for invalid arguments or input)."""
    return run_command(_parser(), arguments)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="beambench_thesis",
        description="The tables, figures and claims of the thesis, measured again.",
    )
    commands = parser.add_subparsers(dest="command", required=True)
    add_run_command(commands, BEAMBENCH)
    add_cluster_command(commands, PROGRAMS)
    _add_claims(commands)
    levels = add_command(
        commands,
        "levels",
        lambda o: levels_of_runs(o.runs, o.output),
        help="compare the level that max_level=auto chooses with the best of fixed levels",
    )
    levels("runs", type=Path, nargs="+", metavar="RUN", help="folder of a run")
    levels(
        *("-o", "--output"),
        type=Path,
        metavar="FILE.md",
        help="if not given, the report is printed without plots",
    )
    sampling = add_command(
        commands,
        "sampling",
        lambda o: write_sampling(o.files, o.output),
        help="draw the output of beambench sampling SCENE --json, one plot for each file",
    )
    sampling("files", type=Path, nargs="+", metavar="FILE.json")
    sampling("-o", "--output", type=Path, required=True, metavar="DIR")
    return parser


def _add_claims(commands: Commands) -> None:
    claims = add_command(
        commands,
        "claims",
        _claims,
        help="judge the claims of the thesis by its figures and by ours",
    )
    claims(
        "runs",
        type=Path,
        nargs="*",
        metavar="RUN",
        help="folder of a run, of the simulated cluster, or of censuses (scan.json, beams.json)",
    )
    claims("--cells", action="store_true", help="also list every cell")
    claims(*("-o", "--output"), type=Path, metavar="FILE.md", help="if not given, it is printed")


def _claims(options: Options) -> Result:
    found = judge_claims(options.runs)
    text = claims_as_markdown(found)
    if options.cells:
        text += f"\n{cells_as_markdown(found)}"
    return [write_text(options.output, text)] if options.output else text


if __name__ == "__main__":
    sys.exit(main())
