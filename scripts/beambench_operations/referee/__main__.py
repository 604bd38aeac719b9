"""Verifies the hits of libraries over a kit, and writes the referee's table."""

from __future__ import annotations

import argparse
import csv
import sys
from pathlib import Path
from typing import Any

from beambench_operations.referee.contender import Contender
from beambench_operations.referee.findings import COLUMNS, place_of, rows_of, wrong_rays
from beambench_operations.referee.page import page
from beambench_operations.referee.speed import write_speed


def write_table(given: argparse.Namespace) -> None:
    """Verifies all libraries; writes referee.csv and the counterexamples."""
    given.work.mkdir(parents=True, exist_ok=True)
    given.output.mkdir(parents=True, exist_ok=True)
    rows: list[dict[str, Any]] = []
    for text in given.libraries:
        name, _, plugin = text.rpartition("=")  # parameters have a "=", too
        contender = Contender(given.program, name, plugin)
        version = contender.version()
        place = place_of(name, version)
        cases = contender.verify(given.kit, given.work / f"{place}.json")
        found = rows_of(name, version, cases)
        contender.write_minimal(given.kit, cases, given.output / "minimal" / place)
        print(f"{name}, {version}: {sum(map(wrong_rays, found))} wrong", flush=True)
        rows += found
    with (given.output / "referee.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def main(arguments: list[str]) -> int:
    """Writes referee.csv and the counterexamples, or speed.csv, and README.md from them."""
    parser = argparse.ArgumentParser(prog="beambench_operations.referee", description=__doc__)
    parser.add_argument(
        "libraries", nargs="*", metavar="NAME=PLUGIN", help="as scripts/outside prints it"
    )
    parser.add_argument("--kit", type=Path, help="the folder that 'selftest --export' wrote")
    parser.add_argument("--speed", type=Path, metavar="RUN", help="run of speed.json to publish")
    parser.add_argument(
        "--work",
        type=Path,
        default=Path("build/referee"),
        help="folder of verdicts, which are kept",
    )
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--program", default="build/release/bin/beambench")
    given = parser.parse_args(arguments)
    if given.libraries and given.kit is None:
        parser.error("libraries are verified over a kit; add --kit DIR")
    if given.libraries:
        write_table(given)
    if given.speed is not None:
        write_speed(given.speed, given.output / "speed.csv")
    (given.output / "README.md").write_text(page(given.output), "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
