"""Counts the work of whole pictures by the rules of the Standard Procedural Databases."""

import json
import subprocess
from pathlib import Path
from typing import TypedDict

from beambench_report.base.files import Problem, read_json, write_text
from beambench_report.havran.contenders import SCENES


class Census(TypedDict):
    """The used part of the output of `beambench census --count --json` on one scene."""

    size: dict[str, float]
    work: dict[str, float]


def require_program(program: Path) -> Path:
    """Returns the program's absolute path. Raises Problem where it does not exist."""
    found = program.absolute()
    if not found.exists():
        raise Problem(f"{found}: there is no such program; build it with scripts/setup")
    return found


def census_of(file: Path, program: Path, scene: str, contender: str) -> Census:
    """Counts into FILE, unless that has this contender's counts already; `scene` as published."""
    known = read_json(file)
    if not isinstance(known, dict) or known.get("structure") != contender:
        command = [program, "census", SCENES[scene], "--rules", "spd", "--accel", contender]
        done = subprocess.run(
            [*command, "--count", "--json"], capture_output=True, text=True, check=False
        )
        if done.returncode != 0:
            raise Problem(f"{program} census {scene}: {done.stderr.strip()}")
        write_text(file, done.stdout)
        known = json.loads(done.stdout)
    census: Census = known["scenes"][0]
    return census
