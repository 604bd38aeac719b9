"""Runs the commands whose output the report states, each once."""

from __future__ import annotations

import json
import math
import re
import subprocess
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from beambench_report.files import write_text
from beambench_report.ledger.census_run import ORDERS, census_file
from beambench_report.ledger.published import primitives_by_scene
from beambench_report.problem import Problem
from beambench_report.thesis.facts.camera import OBJECTS, SCENE, TURN, Turn, view_file
from beambench_report.thesis.facts.scenes import scene_file
from beambench_report.thesis.facts.visits import ACCEL, SCENES, visits_file

CENSUS = "census"
"""The folder of censuses (`ledger.census_run`)."""

_CENSUS_SIZE = "512x512"


@dataclass(frozen=True)
class Fact:
    """A file and the arguments of the command that prints it."""

    path: Path
    arguments: tuple[str, ...]


def facts(directory: Path) -> list[Fact]:
    """All but those of the turned camera, which need a scene file of their own."""
    scenes = tuple(primitives_by_scene())
    options = ("--accel", "beam", "--resolution", _CENSUS_SIZE, "--shadows", "cache", "--json")
    return [
        *(Fact(scene_file(directory, scene), ("scene", scene, "--json")) for scene in scenes),
        *(
            Fact(
                census_file(directory / CENSUS, order),
                ("census", *scenes, *options, "--order", order),
            )
            for order in ORDERS
        ),
        *(
            Fact(
                visits_file(directory, scene),
                ("stats", scene, "--accel", ACCEL, "--levels", "--json"),
            )
            for scene in SCENES
        ),
        *(_view(directory, SCENE, turned=False, objects=objects) for objects in OBJECTS),
    ]


def gather_facts(directory: Path, beambench: Path) -> list[str]:
    """Makes those that are not there; returns a sentence for each that could not be made."""
    wanted = facts(directory)
    failed = _make(wanted, beambench)
    turned = [
        view_file(directory, turned=True, objects=objects)
        for objects in OBJECTS
        if not view_file(directory, turned=True, objects=objects).exists()
    ]
    if not turned:
        return failed
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / f"{SCENE}.nff"
        try:
            _print(beambench, ("export", SCENE, "-o", str(scene)))
            about = json.loads(_print(beambench, ("scene", SCENE, "--json")))
            scene.write_text(turn_camera(scene.read_text("utf-8"), about["cameras"][0], TURN))
        except (Problem, OSError, ValueError, KeyError, IndexError) as error:
            return [*failed, f"{SCENE} from another camera: {error}"]
        views = (_view(directory, str(scene), turned=True, objects=objects) for objects in OBJECTS)
        return failed + _make(views, beambench)


def turn_camera(scene: str, camera: dict, turn: Turn) -> str:
    """The text of an NFF scene with its camera turned around the point that it looks at.

    Raises ValueError where the text has no camera of its own.
    """
    at, eye = camera["at"], camera["from"]
    away = [e - a for e, a in zip(eye, at, strict=True)]
    azimuth = math.atan2(away[1], away[0]) + math.radians(turn.azimuth)
    elevation, distance = math.radians(turn.elevation), turn.distance * math.hypot(*away)
    direction = (
        math.cos(elevation) * math.cos(azimuth),
        math.cos(elevation) * math.sin(azimuth),
        math.sin(elevation),
    )
    place = " ".join(f"{a + distance * d:.6f}" for a, d in zip(at, direction, strict=True))
    for name, value in (("from", place), ("angle", f"{turn.angle:g}")):
        scene, found = re.subn(rf"^{name} .*$", f"{name} {value}", scene, count=1, flags=re.M)
        if not found:
            raise ValueError(f"the scene's text has no line '{name}'")
    return scene


def _view(directory: Path, scene: str, *, turned: bool, objects: int) -> Fact:
    accel = f"beam:max_level=6,max_objects={objects}"
    options = ("--accel", accel, "--resolution", "1280x1024", "--json")
    return Fact(view_file(directory, turned=turned, objects=objects), ("stats", scene, *options))


def _make(wanted: Iterable[Fact], beambench: Path) -> list[str]:
    failed = []
    for fact in wanted:
        if fact.path.exists():
            continue
        try:
            printed = _print(beambench, fact.arguments)
            json.loads(printed)
        except (Problem, ValueError) as error:
            failed.append(f"{fact.path.parent.name}/{fact.path.name} was not made: {error}")
            continue
        fact.path.parent.mkdir(parents=True, exist_ok=True)
        write_text(fact.path, printed)
    return failed


def _print(beambench: Path, arguments: Iterable[str]) -> str:
    """The standard output of beambench."""
    command = [str(beambench), *arguments]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise Problem(f"{beambench} cannot be run: {error.strerror}; build it first") from None
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
        raise Problem(lines[-1])
    return done.stdout
