"""`python -m beambench_thesis cluster record|simulate|split|measure|write DIR`."""

import argparse
from pathlib import Path

from beambench_report.base.files import Problem
from beambench_thesis.chapter6.record import BEAMS, LARGE, SCENES, TILES, Picture, measure, record
from beambench_thesis.chapter6.report import write_report
from beambench_thesis.chapter6.scene_divisions import simulate_scene_divisions
from beambench_thesis.chapter6.simulate import simulate, simulations
from beambench_thesis.chapter6.split import simulate_split


def add_cluster_command(commands: argparse._SubParsersAction, programs: Path) -> None:
    """Adds `cluster` with its steps; `programs` is the folder of the built programs."""
    cluster = commands.add_parser(
        "cluster", help="simulate the thesis's cluster (chapter 6) with the costs of real beams"
    )
    cluster.set_defaults(handler=run_step)
    steps = cluster.add_subparsers(dest="step", required=True)
    first = steps.add_parser(
        "record", help="record the costs of the beams of two scenes and a large picture"
    )
    second = steps.add_parser("simulate", help="simulate clusters of 2 to 1,024 processes")
    split = steps.add_parser("split", help="simulate scenes divided into 1 to 64 parts")
    real = steps.add_parser("measure", help="time the program with mpirun, on 1 to 3 processes")
    last = steps.add_parser("write", help="write DIR/report.md and its figures")
    for step in (first, second, split, real, last):
        step.add_argument("folder", type=Path, metavar="DIR")
    for step, program in (
        (first, "beambench-cluster"),
        (real, "beambench-cluster"),
        (second, "beambench-cluster-simulated"),
        (split, "beambench-cluster-simulated"),
    ):
        step.add_argument(
            "--program",
            type=Path,
            default=programs / program,
            metavar="PROGRAM",
            help=f"if not given, build/release/bin/{program}",
        )
    for step in (first, split, real):
        step.add_argument(
            "--repeats",
            type=int,
            default=3,
            metavar="N",
            help="take medians of N runs; by default 3",
        )
        step.add_argument(
            "--resolution",
            default="1280x1024",
            metavar="WxH",
            help="by default 1280x1024, as in the thesis",
        )
    first.add_argument(
        "--large",
        default="8192x8192",
        metavar="WxH",
        help=f"resolution of {LARGE}; by default 8192x8192",
    )
    for step, most, things in ((second, 1024, "processes"), (split, 64, "parts")):
        step.add_argument(
            "--most",
            type=int,
            default=most,
            metavar="N",
            help=f"at most N {things}; by default {most}",
        )
    second.add_argument(
        "--jobs", type=int, default=1, metavar="N", help="run N simulations at a time; by default 1"
    )


def run_step(options: argparse.Namespace) -> list[Path]:
    """Runs one step; returns the files that it wrote."""
    if options.step != "write":
        options.program = options.program.absolute()  # `./bc` is not the `bc` of the system
    if getattr(options, "repeats", 1) < 1:
        raise Problem("--repeats: expected 1 or more")
    if options.step in ("record", "measure"):
        width, height = _resolution("--resolution", options.resolution)
        pictures = [Picture(scene, width, height) for scene in SCENES]
        if options.step == "measure":
            return measure(options.folder, options.program, pictures, options.repeats)
        width, height = _resolution("--large", options.large)
        pictures.append(Picture(LARGE, width, height, samples=1, works=(BEAMS, TILES)))
        return record(options.folder, options.program, pictures, options.repeats)
    if options.step == "simulate":
        if options.jobs < 1:
            raise Problem("--jobs: expected 1 or more")
        plan = simulations(SCENES, most=options.most)
        return simulate(options.folder, options.program, plan, options.jobs)
    if options.step == "split":
        _resolution("--resolution", options.resolution)
        asked = (options.program, options.resolution, options.repeats, options.most)
        return [
            *simulate_split(options.folder, *asked),
            *simulate_scene_divisions(options.folder, *asked),
        ]
    return write_report(options.folder)


def _resolution(option: str, text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    if not (width.isdecimal() and height.isdecimal()):
        raise Problem(f"{option}: expected WIDTHxHEIGHT, found '{text}'")
    return int(width), int(height)
