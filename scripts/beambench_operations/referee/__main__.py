"""Verifies the hits of libraries over a kit, and writes the referee's table."""

from __future__ import annotations

import argparse
import csv
import json
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from beambench_operations.referee.findings import (
    COLUMNS,
    Counterexample,
    counterexample,
    crashed_case,
    rows_of,
    wrong_rays,
)
from beambench_operations.referee.page import page

CRASH = re.compile(r"over \S*?([^/\s]+)/scene\.nff (crashed|ended the process) ?(\([^)]*\))?")


def part_of_kit(kit: Path, folder: Path, chosen: Callable[[str], bool]) -> Path:
    """Makes a kit of the chosen cases, by the names of their folders."""
    index = json.loads((kit / "kit.json").read_text("utf-8"))
    index["cases"] = [case for case in index["cases"] if chosen(case["folder"])]
    folder.mkdir()
    for case in index["cases"]:
        (folder / case["folder"]).symlink_to((kit / case["folder"]).resolve())
    (folder / "kit.json").write_text(json.dumps(index), "utf-8")
    return folder


class Library:
    """A library as a contender of the program."""

    def __init__(self, program: str, name: str, plugin: str) -> None:
        """Initializes it; nothing runs yet."""
        self.name = name
        self._words = [program, "--plugin", plugin]

    def _call(self, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [*self._words, *map(str, arguments)], capture_output=True, text=True, check=False
        )

    def _run(self, *arguments: str | Path) -> str:
        done = self._call(*arguments)
        if done.returncode > 1:
            raise SystemExit(f"{self.name}: {done.stderr.strip()[-2000:]}")
        return done.stdout

    def version(self) -> str:
        """Returns what its rows state as library and version."""
        text = self._run("stats", "tetra:n=1", "--accel", self.name, "--json")
        return str(json.loads(text)["structures"][0]["library_version"])

    def verify(self, kit: Path, verdict: Path) -> list[dict[str, Any]]:
        """Returns the cases of the kit as found, from an earlier verdict if there is one.

        A scene over which the library crashes is an error, and left out.
        """
        crashes: dict[str, str] = {}
        while not verdict.exists():
            with tempfile.TemporaryDirectory() as folder:
                rest = part_of_kit(kit, Path(folder) / "kit", lambda name: name not in crashes)
                done = self._call("verify", "--kit", rest, "--accel", self.name, "--json", verdict)
            crash = CRASH.search(done.stderr)
            if not verdict.exists() and crash is None:
                raise SystemExit(f"{self.name}: {done.stderr.strip()[-2000:]}")
            if crash is not None:
                crashes[crash[1]] = f"{crash[2]} {crash[3] or ''}".strip()
        found = json.loads(verdict.read_text("utf-8"))
        if crashes:
            families = {
                case["folder"]: case["family"]
                for case in json.loads((kit / "kit.json").read_text("utf-8"))["cases"]
            }
            found["cases"] += [
                crashed_case(name, families[name], query, how)
                for name, how in crashes.items()
                for query in ("closest", "any")
            ]
            verdict.write_text(json.dumps(found), "utf-8")
        cases: list[dict[str, Any]] = found["cases"]
        return cases

    def minimal(self, kit: Path, cases: list[dict[str, Any]], out: Path) -> Counterexample | None:
        """Reduces the wrong closest hit of the smallest scene; returns it, written to `out`."""
        wrong = [
            case for case in cases if case["structure_error"] > 0 and case["query"] == "closest"
        ]
        if not wrong:
            return None
        name = min(wrong, key=lambda case: case["primitives"])["name"].split(",")[0]
        with tempfile.TemporaryDirectory() as folder:
            small = part_of_kit(kit, Path(folder) / "kit", lambda each: each == name)
            failures = Path(folder) / "failures"
            self._run("verify", "--kit", small, "--accel", self.name, "--minimize", failures)
            found = next(path for path in sorted(failures.iterdir()) if "closest" in path.name)
            shutil.rmtree(out, ignore_errors=True)
            shutil.copytree(found, out)
        case = json.loads((out / "case.json").read_text("utf-8"))
        case["scene"] = f"{name} of the kit"  # in place of a temporary path
        (out / "case.json").write_text(json.dumps(case, indent=2) + "\n", "utf-8")
        return counterexample(out)


def main(arguments: list[str]) -> int:
    """Writes referee.csv, README.md and the counterexamples."""
    parser = argparse.ArgumentParser(prog="beambench_operations.referee", description=__doc__)
    parser.add_argument(
        "libraries", nargs="+", metavar="NAME=PLUGIN", help="as scripts/outside prints it"
    )
    parser.add_argument("--kit", type=Path, required=True, help="what 'selftest --export' wrote")
    parser.add_argument(
        "--work", type=Path, default=Path("build/referee"), help="folder of verdicts, kept"
    )
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--program", default="build/release/bin/beambench")
    parser.add_argument("--random", type=int, default=28, help="scenes of the kit, as --scenes")
    parser.add_argument("--rays", type=int, default=7000, help="rays of the kit, as --rays")
    given = parser.parse_args(arguments)
    given.work.mkdir(parents=True, exist_ok=True)
    given.output.mkdir(parents=True, exist_ok=True)

    rows: dict[str, list[dict[str, Any]]] = {}
    found: dict[str, Counterexample | None] = {}
    for text in given.libraries:
        name, _, plugin = text.rpartition("=")  # parameters have a "=", too
        place = re.sub(r"[^\w.-]+", "-", name)
        library = Library(given.program, name, plugin)
        cases = library.verify(given.kit, given.work / f"{place}.json")
        rows[name] = rows_of(name, library.version(), cases)
        found[name] = library.minimal(given.kit, cases, given.output / "minimal" / place)
        print(f"{name}: {sum(map(wrong_rays, rows[name]))} wrong", flush=True)

    with (given.output / "referee.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        for each in rows.values():
            writer.writerows(each)
    scenes = len(json.loads((given.kit / "kit.json").read_text("utf-8"))["cases"])
    kit = {"scenes": scenes, "random": given.random, "rays": given.rays}
    (given.output / "README.md").write_text(page(rows, found, kit), "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
