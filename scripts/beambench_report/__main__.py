"""Command line: python -m beambench_report plots|pictures|page|claims|repeated|... ..."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from beambench_report.base.cell_files import write_repetitions
from beambench_report.base.columns import as_markdown, dictionary
from beambench_report.base.files import ROOT, Problem, write_text
from beambench_report.base.records import read_run
from beambench_report.embree_comparison.command import beat_text, write_beat
from beambench_report.nightly.command import add_nightly_command, nightly
from beambench_report.nightly.compare import compare_turns, measure_in_turns
from beambench_report.nightly.diff import diff
from beambench_report.nightly.exports import bigger_is_better, google_benchmark
from beambench_report.run.growth import write_growth
from beambench_report.run.page import write_page
from beambench_report.run.pictures import write_contact_sheet, write_pictures
from beambench_report.run.plots import write_plots
from beambench_report.run.repeatability import repeatability
from beambench_report.thesis.chapter5.levels import levels_text, write_levels
from beambench_report.thesis.chapter5.sampling import write_sampling
from beambench_report.thesis.chapter6.command import add_cluster_command, cluster
from beambench_report.thesis.claims.register import as_markdown as ledger_as_markdown
from beambench_report.thesis.claims.register import ledger
from beambench_report.thesis.report.command import add_thesis_command, thesis

_EXPORTS = {"customBiggerIsBetter": bigger_is_better, "google-benchmark": google_benchmark}
_FORMER_NAMES = {"ledger": "claims", "beat": "embree-comparison"}
_BUILT = ROOT / "build/release/bin/beambench"


def main(arguments: list[str] | None = None) -> int:
    """Runs one command; returns the exit code (2 for invalid arguments or input)."""
    options = _parser().parse_args(_renamed(sys.argv[1:] if arguments is None else arguments))
    if options.command == "columns":
        print(as_markdown(dictionary()), end="")
        return 0
    try:
        if options.command == "repeated":
            print(repeatability(read_run(options.run), read_run(options.second)).summary())
            return 0
        if options.command == "claims" and options.output is None:
            print(_claims(options), end="")
            return 0
        if options.command == "levels" and options.output is None:
            print(levels_text(options.runs), end="")
            return 0
        if options.command == "embree-comparison" and options.output is None:
            print(beat_text(options.runs), end="")
            return 0
        if options.command == "thesis":
            return thesis(options)
        if options.command == "nightly":
            return nightly(options)
        if options.command == "compare":
            return _compare(options)
        if options.command == "diff":
            print(diff(options.first, options.second, relative=options.relative).text(), end="")
            return 0
        if options.command == "benchmarks":
            print(_EXPORTS[options.format](read_run(options.run)), end="")
            return 0
        paths = _write(options)
    except Problem as problem:
        print(f"error: {problem}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"error: {error.filename}: {error.strerror}", file=sys.stderr)
        return 2
    for path in paths:
        print(path)
    return 0


def _renamed(arguments: list[str]) -> list[str]:
    """The arguments with the command's present name; a former one works still, with a warning."""
    if not arguments or arguments[0] not in _FORMER_NAMES:
        return arguments
    name = _FORMER_NAMES[arguments[0]]
    print(f"warning: the command '{arguments[0]}' is now '{name}'", file=sys.stderr)
    return [name, *arguments[1:]]


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="beambench_report", description="Plots, pictures and the page of a beambench run."
    )
    commands = parser.add_subparsers(dest="command", required=True)
    plots = commands.add_parser("plots", help="draw RUN/plots from RUN/results.csv")
    pictures = commands.add_parser("pictures", help="render RUN/pictures of the scenes of a run")
    page = commands.add_parser("page", help="write RUN/report.html from all that RUN holds")
    repeated = commands.add_parser(
        "repeated", help="say how many medians of SECOND lie within the intervals of RUN"
    )
    for command in (plots, pictures, page, repeated):
        command.add_argument("run", type=Path, metavar="RUN", help="folder of a run")
    repeated.add_argument("second", type=Path, metavar="SECOND", help="the same sweep, run again")
    pictures.add_argument(
        "--beambench", type=Path, required=True, metavar="PROGRAM", help="the built beambench"
    )
    page.add_argument(
        "--reference",
        metavar="CONTENDER",
        help="whose times are 1 in the ratios, as the plots call it; if not given, the contender "
        "that was right in the most views, Embree rather than others",
    )
    repetitions = commands.add_parser(
        "repetitions",
        help="write every repetition of a run into one file, for a run that is published",
    )
    repetitions.add_argument("run", type=Path, metavar="RUN", help="folder of a run")
    repetitions.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="FILE.csv",
        help="if not given, RUN/repetitions.csv; beside a published results.csv it is read as such",
    )
    growth = commands.add_parser(
        "growth", help="draw what beambench scene NAME --growth --csv wrote"
    )
    growth.add_argument("files", type=Path, nargs="+", metavar="FILE.csv")
    growth.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="FILE.png",
        help="if not given, beside the first file; an SVG comes beside it",
    )
    sheet = commands.add_parser("contact-sheet", help="render scenes, side by side on one picture")
    sheet.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.png")
    sheet.add_argument(
        "--scenes",
        nargs="+",
        metavar="SCENE",
        help="if not given, the fifteen of the thesis and the Standard Procedural Databases",
    )
    sheet.add_argument(
        "--beambench",
        type=Path,
        default=_BUILT,
        metavar="PROGRAM",
        help="the built beambench; if not given, build/release/bin/beambench",
    )
    claims = commands.add_parser(
        "claims", help="say whether the claims of the thesis hold, by its figures and ours"
    )
    claims.add_argument(
        "runs",
        type=Path,
        nargs="*",
        metavar="RUN",
        help="folder of a run, of the simulated cluster, or of censuses (scan.json, beams.json)",
    )
    claims.add_argument("--cells", action="store_true", help="list every cell, too")
    claims.add_argument(
        "-o", "--output", type=Path, metavar="FILE.md", help="if not given, it is printed"
    )
    levels = commands.add_parser(
        "levels", help="say how well max_level=auto chooses, beside the best of fixed levels"
    )
    beat = commands.add_parser(
        "embree-comparison",
        help="compare tile beams with Embree's fastest mode",
    )
    for command in (levels, beat):
        command.add_argument("runs", type=Path, nargs="+", metavar="RUN", help="folder of a run")
        command.add_argument(
            "-o",
            "--output",
            type=Path,
            metavar="FILE.md",
            help="if not given, it is printed; its plots come beside it",
        )
    sampling = commands.add_parser(
        "sampling", help="draw what beambench sampling SCENE --json printed, beside each other"
    )
    sampling.add_argument("files", type=Path, nargs="+", metavar="FILE.json")
    sampling.add_argument("-o", "--output", type=Path, required=True, metavar="DIR")
    add_thesis_command(commands, _BUILT)
    add_nightly_command(commands, _BUILT)
    add_cluster_command(commands, _BUILT.parent)
    _add_comparisons(commands)
    commands.add_parser("columns", help="print results/README.md: what every column means")
    return parser


def _add_comparisons(commands: argparse._SubParsersAction) -> None:
    two = commands.add_parser("diff", help="compare two result files, structure by structure")
    two.add_argument("first", type=Path, metavar="A.csv", help="a results.csv, or a run's folder")
    two.add_argument("second", type=Path, metavar="B.csv")
    two.add_argument(
        "--relative",
        action=argparse.BooleanOptionalAction,
        help="by the ratio to a contender that both files have; if not given, where the machines "
        "differ, whose milliseconds are refused",
    )
    compare = commands.add_parser("compare", help="run two programs in turns: is B slower?")
    compare.add_argument("programs", type=Path, nargs=2, metavar="PROGRAM")
    compare.add_argument("--sweep", type=Path, required=True, metavar="FILE")
    compare.add_argument("--turns", type=int, default=12, metavar="N")
    compare.add_argument("-o", "--output", type=Path, required=True, metavar="DIR")
    benchmarks = commands.add_parser("benchmarks", help="print a run for other benchmark tools")
    benchmarks.add_argument("run", type=Path, metavar="RUN")
    benchmarks.add_argument("--format", choices=sorted(_EXPORTS), required=True)


def _compare(options: argparse.Namespace) -> int:
    runs = measure_in_turns(tuple(options.programs), options.sweep, options.output, options.turns)
    outcome = compare_turns(*runs)
    print(outcome.table())
    print(f"\n{outcome.verdict()}")
    return 1 if outcome.is_regression else 0


def _write(options: argparse.Namespace) -> list[Path]:
    if options.command == "repetitions":
        return [write_repetitions(options.run, options.output)]
    if options.command == "growth":
        return write_growth(options.files, options.output)
    if options.command == "contact-sheet":
        return [write_contact_sheet(options.output, options.beambench, options.scenes)]
    if options.command == "claims":
        return [write_text(options.output, _claims(options))]
    if options.command == "levels":
        return write_levels(options.runs, options.output)
    if options.command == "embree-comparison":
        return write_beat(options.runs, options.output)
    if options.command == "cluster":
        return cluster(options)
    if options.command == "sampling":
        return write_sampling(options.files, options.output)
    if options.command == "plots":
        return write_plots(options.run)
    if options.command == "pictures":
        return write_pictures(options.run, options.beambench)
    return write_page(options.run, options.reference)


def _claims(options: argparse.Namespace) -> str:
    return ledger_as_markdown(ledger(options.runs), cells=options.cells)


if __name__ == "__main__":
    sys.exit(main())
