"""Traces random rays: runs the self-test of one structure over new random scenes."""

import json
from pathlib import Path
from tempfile import TemporaryDirectory

from beambench_operations.campaign.piece import Finding, Piece
from beambench_operations.campaign.programs import Programs
from beambench_operations.campaign.record import Record
from beambench_report.base.files import Problem, output_of

SCENES = 20
"""The number of random scenes in each of the three checks that make them; built-in hard scenes are
added.
"""
RAYS = 4000
"""Rays for each random scene, approximately."""
CHECKS = ("random scenes", "scene families", "views")
"""The checks that make random scenes, different ones for every seed."""
FIRST_SEED = 100_000
"""The first seed; it is larger than the seeds of the tests."""


def structures(beambench: Path) -> list[str]:
    """Returns the structures whose hits can be verified."""
    listed = json.loads(output_of([str(beambench), "list", "--json"]))["structures"]
    return [one["name"] for one in listed if one["name"] != "null"]


def trace(beambench: Path, structure: str, seed: int, record: Record, programs: Programs) -> Piece:
    """Runs the self-test and keeps its output for each failed check."""
    with TemporaryDirectory(prefix="beambench-campaign-") as name:
        file = Path(name) / "selftest.json"
        command: list[str | Path] = [
            *(beambench, "selftest", "--accel", structure),
            *("--scenes", str(SCENES), "--rays", str(RAYS), "--seed", str(seed)),
        ]
        cases = Path(name) / "cases"
        done = programs.run([*command, "--json", file, "--minimize", cases])
        title = f"rays-{structure}-{seed}"
        if done.code in (0, 1) and file.exists():
            checks = json.loads(file.read_text("utf-8"))["checks"]
            findings = [
                _kept(check, file, title, command, record)
                for check in checks
                if not check["passed"]
            ]
            rays = sum(check["rays"] for check in checks)
        else:
            rays, findings = 0, [_cut_off(file, title, done.code, done.errors, command, record)]
    counts = {"scenes": SCENES * len(CHECKS), "rays": rays}
    return Piece("rays", structure, seed, counts, round(done.cpu_seconds, 1), {}, findings)


def _kept(
    check: dict, file: Path, title: str, command: list[str | Path], record: Record
) -> Finding:
    """Keeps the minimized case of a failed check if there is one, or else the output."""
    message = f"{check['check']}: {check['failure']}"
    if check["case"]:
        stem = f"{title}-{check['check']}"
        return record.keep(Path(check["case"]), stem, message, command)
    return record.keep(file, f"{title}.json", message, command)


def _cut_off(
    file: Path, title: str, code: int, errors: str, command: list[str | Path], record: Record
) -> Finding:
    if code == 2:
        raise Problem(f"the self-test was refused: {errors.strip()}")
    file.write_text(errors, "utf-8")
    return record.keep(file, f"{title}.log", f"the self-test ended with {code}", command)


def next_seed(record: Record, structure: str) -> int:
    """Returns the structure's first unused seed."""
    return FIRST_SEED + record.total("rays", structure, "scenes")
