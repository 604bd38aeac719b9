"""Counts the work of whole pictures by the rules of the Standard Procedural Databases."""

import json
from pathlib import Path
from typing import TypedDict

from beambench_report.base.files import output_of, read_json, write_text
from beambench_report.havran.contenders import SCENES


class Census(TypedDict):
    """The fields used from the output of `beambench census ... --count --json` on one scene."""

    size: dict[str, float]
    work: dict[str, float]


def census_of(file: Path, program: Path, scene: str, contender: str) -> Census:
    """Returns the counts for a scene, by its published name, from FILE or by counting into it."""
    known = read_json(file)
    if not isinstance(known, dict) or known.get("structure") != contender:
        command = [str(program), "census", SCENES[scene], "--rules", "spd", "--accel", contender]
        counted = output_of([*command, "--count", "--json"])
        write_text(file, counted)
        known = json.loads(counted)
    census: Census = known["scenes"][0]
    return census
