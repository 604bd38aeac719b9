"""A library as a contender: its verdicts over a kit, and its smallest counterexample."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from beambench_operations.referee.findings import crashed_case

CRASH = re.compile(r"over \S*?([^/\s]+)/scene\.nff (crashed|ended the process) ?(\([^)]*\))?")


def part_of_kit(kit: Path, folder: Path, chosen: Callable[[str], bool]) -> Path:
    """Makes a kit of the cases whose folders' names are chosen."""
    index = json.loads((kit / "kit.json").read_text("utf-8"))
    index["cases"] = [case for case in index["cases"] if chosen(case["folder"])]
    folder.mkdir()
    for case in index["cases"]:
        (folder / case["folder"]).symlink_to((kit / case["folder"]).resolve())
    (folder / "kit.json").write_text(json.dumps(index), "utf-8")
    return folder


class Contender:
    """A library as a contender of the program."""

    def __init__(self, program: str, name: str, plugin: str) -> None:
        """Stores the command; nothing runs yet."""
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
        """Returns the library and version that its rows state."""
        text = self._run("stats", "tetra:n=1", "--accel", self.name, "--json")
        return str(json.loads(text)["structures"][0]["library_version"])

    def verify(self, kit: Path, verdict: Path) -> list[dict[str, Any]]:
        """Returns the verified cases of the kit, from an earlier verdict if there is one.

        A scene over which the library crashes is left out, and its cases get the verdict `error`.
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
        stated = {case["name"].split(",")[0] for case in found["cases"]}
        if left_out := crashes.keys() - stated:
            families = {
                case["folder"]: case["family"]
                for case in json.loads((kit / "kit.json").read_text("utf-8"))["cases"]
            }
            found["cases"] += [
                crashed_case(name, families[name], query, crashes[name])
                for name in sorted(left_out)
                for query in ("closest", "any")
            ]
            verdict.write_text(json.dumps(found), "utf-8")
        cases: list[dict[str, Any]] = found["cases"]
        return cases

    def write_minimal(self, kit: Path, cases: list[dict[str, Any]], out: Path) -> bool:
        """Writes the smallest counterexample: a wrong closest hit, otherwise a leak.

        Returns whether there is one.
        """
        shutil.rmtree(out, ignore_errors=True)
        faulty = [
            case
            for case in cases
            if case["query"] == "closest" and case["structure_error"] + case["leaks"] > 0
        ]
        faulty.sort(key=lambda case: (case["structure_error"] == 0, int(case["primitives"])))
        return any(self._reduce(kit, case["name"].split(",")[0], out) for case in faulty)

    def _reduce(self, kit: Path, name: str, out: Path) -> bool:
        """Reduces a fault; returns false if the library crashes over the smaller scenes."""
        with tempfile.TemporaryDirectory() as folder:
            small = part_of_kit(kit, Path(folder) / "kit", lambda each: each == name)
            failures = Path(folder) / "failures"
            self._run("verify", "--kit", small, "--accel", self.name, "--minimize", failures)
            found = [path for path in failures.glob("*") if "closest" in path.name]
            if not found:
                return False
            shutil.copytree(found[0], out)
        case = json.loads((out / "case.json").read_text("utf-8"))
        case["scene"] = f"{name} of the kit"  # in place of a temporary path
        (out / "case.json").write_text(json.dumps(case, indent=2) + "\n", "utf-8")
        return True
