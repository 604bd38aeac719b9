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
from beambench_operations.referee.leak import FOLDER, Face, reduced, write_kit

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


def write_case(out: Path, scene: str, subject: str, wrong: dict[str, Any]) -> None:
    """Writes the case.json of a leak, like that of `verify --minimize`."""
    case = {
        "scene": f"{scene} of the kit",
        "subject": subject,
        "query": "closest",
        "rays": 1,
        "wrong": wrong,
    }
    (out / "case.json").write_text(json.dumps(case, indent=2) + "\n", "utf-8")


class Contender:
    """A library as a contender of the program."""

    def __init__(self, program: str, name: str, plugin: str) -> None:
        """Initializes it; nothing runs yet."""
        self.name = name
        self._program = program
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
        wrong = [
            case for case in cases if case["structure_error"] > 0 and case["query"] == "closest"
        ]
        for case in sorted(wrong, key=lambda case: int(case["primitives"])):
            if self._write_wrong(kit, case["name"].split(",")[0], out):
                return True
        return self._write_leak(kit, cases, out)

    def _write_wrong(self, kit: Path, name: str, out: Path) -> bool:
        """Reduces a wrong hit; returns false if the library crashes over the smaller scenes."""
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

    def _write_leak(self, kit: Path, cases: list[dict[str, Any]], out: Path) -> bool:
        judged: list[dict[str, Any]] = []

        def leaks(
            case: dict[str, Any], vertices: list[str], faces: list[Face], ray: dict[str, Any]
        ) -> bool:
            shutil.rmtree(out, ignore_errors=True)
            write_kit(out, case, vertices, faces, ray)
            scene = out / FOLDER / "scene"
            subprocess.run(
                [self._program, "export", f"{scene}.obj", "-o", f"{scene}.nff"],
                check=True, capture_output=True,
            )  # fmt: skip
            with tempfile.TemporaryDirectory() as folder:
                verdict = Path(folder) / "verdict.json"
                self._run("verify", "--kit", out, "--accel", self.name, "--json", verdict)
                found = json.loads(verdict.read_text("utf-8"))["cases"]
            judged[:] = [
                example
                for each in found
                if each["query"] == "closest" and each["leaks"]
                for example in each["examples"]
            ]
            return bool(judged)

        found = reduced(kit, cases, leaks)
        if found is None:
            shutil.rmtree(out, ignore_errors=True)
            return False
        folder, ray = found
        wrong = {"class": "leak", "ray": ray, "reported": None, "exact": judged[0]["oracle"]}
        write_case(out, folder, self.name, wrong)
        return True
