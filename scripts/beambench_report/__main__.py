"""Command line: python -m beambench_report plots|pictures|page|winners|... ..."""

import argparse
import sys
from importlib import import_module
from pathlib import Path

from beambench_report.base.columns import as_markdown, dictionary
from beambench_report.base.command_line import (
    BEAMBENCH,
    AddArgument,
    Commands,
    Options,
    add_command,
    run_command,
)
from beambench_report.base.files import say
from beambench_report.embree_comparison.report import comparison
from beambench_report.haines.counts import measure_tests
from beambench_report.haines.report import write_report as write_haines
from beambench_report.havran.contenders import SCENES
from beambench_report.havran.counts import measure
from beambench_report.havran.report import write_report as write_havran
from beambench_report.run.coverage import write_coverage
from beambench_report.run.front_plots import write_fronts
from beambench_report.run.growth import write_growth
from beambench_report.run.page import write_page
from beambench_report.run.pictures import (
    registered_meshes,
    write_contact_sheet,
    write_pictures,
)
from beambench_report.run.plots import KINDS, write_plots
from beambench_report.run.ratio_table import write_ratios
from beambench_report.run.winners import write_winners

_FORMER_COMMANDS = {
    "beat": ("beambench_report", "embree-comparison"),
    "ledger": ("beambench_thesis", "claims"),
    "thesis": ("beambench_thesis", "run"),
    **{name: ("beambench_thesis", name) for name in ("claims", "cluster", "levels", "sampling")},
    **{
        name: ("beambench_operations", name)
        for name in ("benchmarks", "compare", "diff", "nightly", "site")
    },
}
"""The new package and name of each moved command; the old names work for one version."""


def main(arguments: list[str] | None = None) -> int:
    """Runs one command; returns the exit code (2 for invalid arguments or input)."""
    arguments = sys.argv[1:] if arguments is None else arguments
    if arguments and arguments[0] in _FORMER_COMMANDS:
        package, name = _FORMER_COMMANDS[arguments[0]]
        say(f"warning: the command '{arguments[0]}' is now: python -m {package} {name}")
        return import_module(f"{package}.__main__").main([name, *arguments[1:]])
    return run_command(_parser(), arguments)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="beambench_report", description="Plots, pictures and the page of a beambench run."
    )
    commands = parser.add_subparsers(dest="command", required=True)
    _add_commands_on_runs(commands)
    _add_tables(commands)
    _add_commands_on_scenes(commands)
    _add_other_works(commands)
    add_command(
        commands,
        "columns",
        lambda _: as_markdown(dictionary()),
        help="print results/README.md: what every column means",
    )
    return parser


def _add_commands_on_runs(commands: Commands) -> None:
    plots = add_command(
        commands,
        "plots",
        lambda o: write_plots(o.run, [kind for kind in KINDS if kind.name in o.kinds]),
        help="draw RUN/plots from RUN/results.csv",
    )
    pictures = add_command(
        commands,
        "pictures",
        lambda o: write_pictures(o.run, o.beambench),
        help="render RUN/pictures of the scenes of a run",
    )
    page = add_command(
        commands,
        "page",
        lambda o: write_page(o.run, o.reference),
        help="write RUN/report.html from the files in RUN; if there are no RUN/plots, draw them",
    )
    whole = add_command(
        commands,
        "report",
        _whole_report,
        help="all three: RUN/pictures, RUN/plots and RUN/report.html",
    )
    covered = add_command(
        commands,
        "coverage",
        lambda o: write_coverage(o.run, o.second),
        help="count how often values of each run lie in the other run's prediction intervals",
    )
    drawn = add_command(
        commands,
        "fronts",
        lambda o: write_fronts(o.run),
        help="draw the Pareto fronts of build and trace time into RUN/plots",
    )
    for command in (plots, pictures, page, whole, covered, drawn):
        command("run", type=Path, metavar="RUN", help="folder of a run")
    names = [kind.name for kind in KINDS]
    plots(
        "--kinds",
        nargs="+",
        choices=names,
        default=names,
        metavar="KIND",
        help=f"draw only these plots: any of {', '.join(map(repr, names))}; if not given, all",
    )
    covered("second", type=Path, metavar="SECOND", help="the same sweep, run again")
    for command in (pictures, whole):
        command(
            "--beambench", type=Path, required=True, metavar="PROGRAM", help="the built beambench"
        )
    for command in (page, whole):
        command(
            "--reference",
            metavar="CONTENDER",
            help="the contender whose time is 1 in the ratios, as plots name it; if not given, the "
            "one with correct hits in the most views, preferably Embree's fastest",
        )


def _add_tables(commands: Commands) -> None:
    winners = add_command(
        commands,
        "winners",
        lambda o: write_winners(o.run, o.output),
        help="list which structure wins in each view, every structure with its best parameters",
    )
    ratios = add_command(
        commands,
        "ratios",
        lambda o: write_ratios(o.run, o.to, o.output),
        help="divide all times by the times of one contender, or of a structure's fastest",
    )
    ratios(
        "--to",
        required=True,
        metavar="NAME",
        help="a contender, named as in the plots, or a structure",
    )
    for command in (winners, ratios):
        command("run", type=Path, metavar="RUN", help="folder of a run")
        _add_output(command, "FILE.md", "if not given, the table is printed")
    embree = add_command(
        commands,
        "embree-comparison",
        lambda o: comparison(o.runs, o.output),
        help="compare tile beams with Embree's fastest mode",
    )
    embree("runs", type=Path, nargs="+", metavar="RUN", help="folder of a run")
    _add_output(embree, "FILE.md", "if not given, the report is printed without plots")


def _add_output(command: AddArgument, metavar: str, words: str) -> None:
    command("-o", "--output", type=Path, metavar=metavar, help=words)


def _add_commands_on_scenes(commands: Commands) -> None:
    growth = add_command(
        commands,
        "growth",
        lambda o: write_growth(o.files, o.output),
        help="draw the output of beambench scene NAME --growth --csv",
    )
    growth("files", type=Path, nargs="+", metavar="FILE.csv")
    _add_output(growth, "FILE.png", "if not given, beside the first file; an SVG is written too")
    sheet = add_command(
        commands,
        "contact-sheet",
        _contact_sheet,
        help="render scenes side by side in one picture",
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
        help="render the registered meshes, each from its first camera",
    )
    sheet(
        "--beambench",
        type=Path,
        default=BEAMBENCH,
        metavar="PROGRAM",
        help="the built beambench; if not given, build/release/bin/beambench",
    )


def _add_other_works(commands: Commands) -> None:
    haines = add_command(
        commands,
        "haines",
        lambda o: [measure_tests(o.folder, o.program.absolute()), write_haines(o.folder)],
        help="repeat Haines's counts of tests on the SPD (1987), and set ours beside his",
    )
    haines(
        "folder",
        type=Path,
        metavar="DIR",
        help="for tests.csv and report.md; an interrupted count is resumed",
    )
    havran = commands.add_parser(
        "havran", help="repeat Havran's comparison of octrees (1999), and set our counts beside his"
    )
    steps = havran.add_subparsers(dest="step", required=True)
    measuring = add_command(
        steps,
        "measure",
        lambda o: [measure(o.folder, o.program.absolute(), o.scene or sorted(SCENES))],
        help="write our counts to DIR/counts.csv; resumes an interrupted count",
    )
    writing = add_command(
        steps,
        "write",
        lambda o: [write_havran(o.folder)],
        help="write DIR/report.md from DIR/counts.csv",
    )
    for step in (measuring, writing):
        step("folder", type=Path, metavar="DIR")
    measuring(
        "--scene",
        action="append",
        choices=sorted(SCENES),
        help="count only this scene; may be given several times",
    )
    for command in (haines, measuring):
        command(
            "--program",
            type=Path,
            default=BEAMBENCH,
            metavar="PROGRAM",
            help="if not given, build/release/bin/beambench",
        )


def _whole_report(options: Options) -> list[Path]:
    write_pictures(options.run, options.beambench)
    write_plots(options.run)
    return write_page(options.run, options.reference)


def _contact_sheet(options: Options) -> list[Path]:
    scenes = options.scenes
    if options.registered:
        scenes = [*(scenes or []), *registered_meshes(options.beambench)]
    return [write_contact_sheet(options.output, options.beambench, scenes)]


if __name__ == "__main__":
    sys.exit(main())
