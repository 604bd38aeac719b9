"""Command line: python -m beambench_report plots|pictures|page|claims|repeated|... ..."""

import argparse
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

from beambench_report.base.cell_files import write_repetitions
from beambench_report.base.columns import as_markdown, dictionary
from beambench_report.base.files import ROOT, Problem, say, write_text
from beambench_report.base.records import read_run
from beambench_report.embree_comparison.report import comparison
from beambench_report.haines.command import add_haines_command
from beambench_report.havran.command import add_havran_command
from beambench_report.nightly.command import add_nightly_command
from beambench_report.nightly.compare import compare_turns, measure_in_turns
from beambench_report.nightly.diff import diff
from beambench_report.nightly.exports import bigger_is_better, google_benchmark
from beambench_report.run.growth import write_growth
from beambench_report.run.page import write_page
from beambench_report.run.pictures import (
    registered_meshes,
    write_contact_sheet,
    write_pictures,
)
from beambench_report.run.plots import KINDS, write_plots
from beambench_report.run.ratio_table import write_ratios
from beambench_report.run.repeatability import repeatability
from beambench_report.run.winners import write_winners
from beambench_report.site.write import write_site
from beambench_report.thesis.chapter5.levels import levels_of_runs
from beambench_report.thesis.chapter5.sampling import write_sampling
from beambench_report.thesis.chapter6.command import add_cluster_command
from beambench_report.thesis.claims.register import claims_as_markdown, judge_claims
from beambench_report.thesis.report.command import add_thesis_command

_EXPORTS = {"customBiggerIsBetter": bigger_is_better, "google-benchmark": google_benchmark}
_FORMER_NAMES = {"ledger": "claims", "beat": "embree-comparison"}
_BUILT = ROOT / "build/release/bin/beambench"

Options = argparse.Namespace
# What a command returns: its exit code, a text to be printed, or the files that it wrote.
Result = int | str | list[Path]


def main(arguments: list[str] | None = None) -> int:
    """Runs one command; returns the exit code (2 for invalid arguments or input)."""
    options = _parser().parse_args(_renamed(sys.argv[1:] if arguments is None else arguments))
    try:
        result: Result = options.handler(options)
    except Problem as problem:
        say(f"error: {problem}")
        return 2
    except OSError as error:
        say(f"error: {error.filename}: {error.strerror}")
        return 2
    if isinstance(result, int):
        return result
    print(result if isinstance(result, str) else "".join(f"{path}\n" for path in result), end="")
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
    add = partial(_add, commands)
    _add_of_runs(add)
    _add_of_scenes(add)
    _add_comparisons(add)
    _add_site(add)
    add_thesis_command(commands, _BUILT)
    add_nightly_command(commands, _BUILT)
    add_cluster_command(commands, _BUILT.parent)
    add_havran_command(commands, _BUILT)
    add_haines_command(commands, _BUILT)
    add(
        "columns",
        lambda _: as_markdown(dictionary()),
        help="print results/README.md: what every column means",
    )
    return parser


def _add(
    commands: argparse._SubParsersAction,
    name: str,
    handler: Callable[[Options], Result],
    **words: str,
) -> Callable[..., argparse.Action]:
    """Adds a command; returns what adds its arguments."""
    command = commands.add_parser(name, **words)
    command.set_defaults(handler=handler)
    return command.add_argument


def _add_of_runs(add: Callable[..., Callable[..., argparse.Action]]) -> None:
    run = {"type": Path, "metavar": "RUN", "help": "folder of a run"}
    plots = add(
        "plots",
        lambda o: write_plots(o.run, [kind for kind in KINDS if kind.name in o.kinds]),
        help="draw RUN/plots from RUN/results.csv",
    )
    pictures = add(
        "pictures",
        lambda o: write_pictures(o.run, o.beambench),
        help="render RUN/pictures of the scenes of a run",
    )
    page = add(
        "page",
        lambda o: write_page(o.run, o.reference),
        help="write RUN/report.html from all that RUN holds; it draws what RUN/plots lacks",
    )
    repeated = add(
        "repeated",
        lambda o: repeatability(read_run(o.run), read_run(o.second)).summary() + "\n",
        help="count the medians of SECOND that lie within the intervals of RUN",
    )
    repetitions = add(
        "repetitions",
        lambda o: [write_repetitions(o.run, o.output)],
        help="write every repetition of a run into one file, for a run that is published",
    )
    benchmarks = add(
        "benchmarks",
        lambda o: _EXPORTS[o.format](read_run(o.run)),
        help="print a run for other benchmark tools",
    )
    for command in (plots, pictures, page, repeated, repetitions, benchmarks):
        command("run", **run)
    names = [kind.name for kind in KINDS]
    plots(
        "--kinds",
        nargs="+",
        choices=names,
        default=names,
        metavar="KIND",
        help=f"draw only these of {', '.join(map(repr, names))}; if not given, all",
    )
    repeated("second", type=Path, metavar="SECOND", help="the same sweep, run again")
    benchmarks("--format", choices=sorted(_EXPORTS), required=True)
    pictures("--beambench", type=Path, required=True, metavar="PROGRAM", help="the built beambench")
    page(
        "--reference",
        metavar="CONTENDER",
        help="whose times are 1 in the ratios, as the plots call it; if not given, the contender "
        "with correct hits in the most views, Embree's fastest rather than others",
    )
    repetitions(
        *("-o", "--output"),
        type=Path,
        metavar="FILE.csv",
        help="if not given, RUN/repetitions.csv; beside a published results.csv it is read as such",
    )
    claims = add(
        "claims", _claims, help="which claims of the thesis hold, by its figures and by ours"
    )
    claims(
        "runs",
        type=Path,
        nargs="*",
        metavar="RUN",
        help="folder of a run, of the simulated cluster, or of censuses (scan.json, beams.json)",
    )
    claims("--cells", action="store_true", help="list every cell, too")
    claims(*("-o", "--output"), type=Path, metavar="FILE.md", help="if not given, it is printed")
    winners = add(
        "winners",
        lambda o: write_winners(o.run, o.output),
        help="which structure wins where, each with its own best parameters",
    )
    winners("run", **run)
    winners(*("-o", "--output"), type=Path, metavar="FILE.md", help="if not given, it is printed")
    ratios = add(
        "ratios",
        lambda o: write_ratios(o.run, o.to, o.output),
        help="every contender over one of them, or over the best of a structure",
    )
    ratios("run", **run)
    ratios("--to", required=True, metavar="NAME", help="a contender, as plots call it; a structure")
    ratios(*("-o", "--output"), type=Path, metavar="FILE.md", help="if not given, it is printed")
    levels = add(
        "levels",
        lambda o: levels_of_runs(o.runs, o.output),
        help="compare the level that max_level=auto chooses with the best of fixed levels",
    )
    embree = add(
        "embree-comparison",
        lambda o: comparison(o.runs, o.output),
        help="compare tile beams with Embree's fastest mode",
    )
    for command in (levels, embree):
        command("runs", nargs="+", **run)
        command(
            *("-o", "--output"),
            type=Path,
            metavar="FILE.md",
            help="if not given, it is printed; its plots come beside it",
        )


def _add_of_scenes(add: Callable[..., Callable[..., argparse.Action]]) -> None:
    growth = add(
        "growth",
        lambda o: write_growth(o.files, o.output),
        help="draw what beambench scene NAME --growth --csv wrote",
    )
    growth("files", type=Path, nargs="+", metavar="FILE.csv")
    growth(
        *("-o", "--output"),
        type=Path,
        metavar="FILE.png",
        help="if not given, beside the first file; an SVG comes beside it",
    )
    sheet = add(
        "contact-sheet",
        _contact_sheet,
        help="render scenes, side by side on one picture",
    )
    sheet("-o", "--output", type=Path, required=True, metavar="FILE.png")
    sheet(
        "--scenes",
        nargs="+",
        metavar="SCENE",
        help="if not given, the fifteen of the thesis and the Standard Procedural Databases",
    )
    sheet(
        "--registered",
        action="store_true",
        help="the meshes that are registered, each as its first camera sees it",
    )
    sheet(
        "--beambench",
        type=Path,
        default=_BUILT,
        metavar="PROGRAM",
        help="the built beambench; if not given, build/release/bin/beambench",
    )
    sampling = add(
        "sampling",
        lambda o: write_sampling(o.files, o.output),
        help="draw what beambench sampling SCENE --json printed, beside each other",
    )
    sampling("files", type=Path, nargs="+", metavar="FILE.json")
    sampling("-o", "--output", type=Path, required=True, metavar="DIR")


def _contact_sheet(options: Options) -> list[Path]:
    scenes = options.scenes
    if options.registered:
        scenes = [*(scenes or []), *registered_meshes(options.beambench)]
    return [write_contact_sheet(options.output, options.beambench, scenes)]


def _add_comparisons(add: Callable[..., Callable[..., argparse.Action]]) -> None:
    two = add(
        "diff",
        lambda o: diff(o.first, o.second, relative=o.relative).text(),
        help="compare two result files, structure by structure",
    )
    two("first", type=Path, metavar="A.csv", help="a results.csv, or a run's folder")
    two("second", type=Path, metavar="B.csv")
    two(
        "--relative",
        action=argparse.BooleanOptionalAction,
        help="by the ratio to a contender that both files have; if not given, where the machines "
        "differ, whose milliseconds are refused",
    )
    compare = add("compare", _compare, help="run two programs in turns: is B slower?")
    compare("programs", type=Path, nargs=2, metavar="PROGRAM")
    compare("--sweep", type=Path, required=True, metavar="FILE")
    compare("--turns", type=int, default=12, metavar="N")
    compare("-o", "--output", type=Path, required=True, metavar="DIR")


def _add_site(add: Callable[..., Callable[..., argparse.Action]]) -> None:
    site = add(
        "site",
        lambda o: [write_site(o.folders, o.output)],
        help="write a site of plain files over all runs: index, pages, comparisons, histories",
    )
    site("folders", type=Path, nargs="+", metavar="DIR", help="a run, or a folder that holds runs")
    site("-o", "--output", type=Path, required=True, metavar="SITE", help="a new folder, or a site")


def _compare(options: Options) -> int:
    runs = measure_in_turns(tuple(options.programs), options.sweep, options.output, options.turns)
    outcome = compare_turns(*runs)
    print(f"{outcome.table()}\n\n{outcome.verdict()}")
    return 1 if outcome.is_regression else 0


def _claims(options: Options) -> Result:
    text = claims_as_markdown(judge_claims(options.runs), cells=options.cells)
    return [write_text(options.output, text)] if options.output else text


if __name__ == "__main__":
    sys.exit(main())
