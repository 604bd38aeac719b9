"""Command line: python -m beambench_report plots|pictures RUN."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from beambench_report.pictures import write_pictures
from beambench_report.plots import write_plots
from beambench_report.problem import Problem


def main(arguments: list[str] | None = None) -> int:
    """Runs one command; returns the exit code (2 when the request was wrong)."""
    parser = argparse.ArgumentParser(
        prog="beambench_report", description="Plots and pictures of a beambench run."
    )
    commands = parser.add_subparsers(dest="command", required=True)
    plots = commands.add_parser("plots", help="draw RUN/plots from RUN/results.csv")
    pictures = commands.add_parser("pictures", help="render RUN/pictures of the scenes of a run")
    for command in (plots, pictures):
        command.add_argument("run", type=Path, metavar="RUN", help="folder of a run")
    pictures.add_argument(
        "--beambench", type=Path, required=True, metavar="PROGRAM", help="the built beambench"
    )
    options = parser.parse_args(arguments)
    try:
        if options.command == "plots":
            paths = write_plots(options.run)
        else:
            paths = write_pictures(options.run, options.beambench)
    except Problem as problem:
        print(f"error: {problem}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"error: {error.filename}: {error.strerror}", file=sys.stderr)
        return 2
    for path in paths:
        print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
