"""Facts that the report adds to the sweeps: counts printed by single commands of beambench.

`gather_facts` runs the commands and stores their output in folders beside the runs; each section
reads one of these folders.
"""

import json
import math
import re
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import pandas as pd

from beambench_report.base.files import Problem, load_json, output_of, write_text
from beambench_report.base.published import primitives_by_scene, read_published
from beambench_report.base.quantities import DASH, number
from beambench_thesis.paper.evidence import published_evidence
from beambench_thesis.paper.measured import ORDERS, census_file
from beambench_thesis.paper.printed import scene_title
from beambench_thesis.paper.section import Section, SectionTable, section_table

Read = TypeVar("Read")


def _read(path: Path, take: Callable[[dict], Read]) -> Read | None:
    """Returns the result of `take` on a file; None if the file is missing or malformed."""
    try:
        return take(load_json(path))
    except (OSError, ValueError, KeyError, TypeError):
        return None


# Table 5.1: the polygons and spheres of each scene

_KINDS = ("polygons", "spheres", "cones")


def scene_file(directory: Path, scene: str) -> Path:
    """Returns the path of the output of `beambench scene NAME --json`."""
    return directory / "scenes" / f"{scene}.json"


def scenes_section(directory: Path) -> Section | None:
    """Returns table 5.1 with our counts; None if no scene was counted."""
    printed = read_published("scenes.csv").to_dict("records")
    counted = {row["scene"]: _read(scene_file(directory, row["scene"]), _counts) for row in printed}
    if not any(counted.values()):
        return None
    rows, other = [], []
    for row in printed:
        own, title = counted[row["scene"]], scene_title(row["scene"])
        ours = {kind: f"{own[kind]:,}" if own else DASH for kind in _KINDS}
        pairs = (text for kind in _KINDS[:2] for text in (f"{row[kind]:,}", ours[kind]))
        rows.append((title, *pairs, ours["cones"]))
        if own and (any(own[kind] != row[kind] for kind in _KINDS[:2]) or own["cones"]):
            other.append(title)
    known = sum(own is not None for own in counted.values())
    heads = [f"{kind}, {whose}" for kind in _KINDS[:2] for whose in ("thesis", "ours")]
    return Section(
        "scenes",
        "Table 5.1: the scenes",
        (
            "The files of the thesis's scenes are lost. Ours are stand-ins with their names and "
            "their numbers of primitives; shapes, cameras, lights and surfaces are beambench's.",
        ),
        (section_table("Primitives", ("scene",), (*heads, "cones, ours"), rows),),
        findings=(
            f"{known - len(other)} of {known} scenes have the thesis's numbers"
            + (f"; others: {', '.join(other)}." if other else "."),
        ),
    )


def _counts(source: dict) -> dict[str, int]:
    return {kind: int(source[kind]) for kind in _KINDS}


# How often rays and beams visit the nodes of an octree, by level: the thesis's argument for level 6

VISITED_SCENES = ("maceta", "delfines")
VISITED = "beam:max_level=8,max_objects=0"
_SIX = 6
_VISITS_WORDS = (
    "Section 5.3.1 takes level 6 from McNeill et al. (1992): from the sixth level on, a ray is "
    "very unlikely to visit a given node, so beams would have few rays. The table counts, in "
    "octrees of level 8, the nodes that single rays pass through up to their first hit, and the "
    "leaves that beams reach. Deeper leaves exist only around the surfaces."
)


def visits_file(directory: Path, scene: str) -> Path:
    """Returns the path of the output of `beambench stats --levels --json`."""
    return directory / "visits" / f"{scene}.json"


def visits_section(directory: Path) -> Section | None:
    """Returns a table for each scene; None if no visits were counted."""
    read = {scene: _read(visits_file(directory, scene), _visits) for scene in VISITED_SCENES}
    known = {scene: found for scene, found in read.items() if found is not None}
    if not known:
        return None
    tables = tuple(_visits_table(scene, *found) for scene, found in known.items())
    findings = (_visits_finding(scene, *found) for scene, found in known.items())
    words = (_VISITS_WORDS,)
    return Section(
        "visits", "Visits by level", words, tables, findings=tuple(filter(None, findings))
    )


def _visits(source: dict) -> tuple[int, pd.DataFrame]:
    """Returns the number of rays, and a row for each level that has nodes."""
    (structure,) = source["structures"]
    levels = pd.DataFrame(structure["levels"]).set_index("level")
    return int(source["rays"]), levels.assign(rays=levels["node_visits"] / levels["nodes"])


def _visits_table(scene: str, rays: int, levels: pd.DataFrame) -> SectionTable:
    rows = []
    for level in levels.itertuples():
        counts = (level.leaves, level.occupied_leaves, level.leaf_visits, level.beams)
        part = (number(level.rays), f"{level.rays / rays:.3%}")
        texts = (f"{count:,}" if count else DASH for count in counts)
        rows.append((f"{level.Index}", f"{level.nodes:,}", *part, *texts))
    heads = "level, nodes, rays that visit a node, share of all rays, leaves, occupied leaves, "
    heads += "visits of leaves by rays, visits of leaves by beams"
    title = f"{scene_title(scene)}, {VISITED}, {rays:,} rays"
    return section_table(title, (), heads.split(", "), rows)


def _visits_finding(scene: str, rays: int, levels: pd.DataFrame) -> str:
    """Returns a sentence on how visits decrease around level 6."""
    before, six, after = levels["rays"].reindex([_SIX - 1, _SIX, _SIX + 1])
    if not before + six + after > 0:  # a level is missing
        return ""
    return (
        f"{scene_title(scene)}: a node of level {_SIX} is visited by {number(six)} of {rays:,} "
        f"rays on average ({six / rays:.2%}), one of level {_SIX - 1} by {number(before / six)} "
        f"times as many, one of level {_SIX + 1} by {number(six / after)} times fewer."
    )


# Pixels of exit beams from two cameras

TURNED_SCENE = "delfines"
OBJECTS = (0, 40)
"""Values of max_objects, at level 6."""


@dataclass(frozen=True)
class Turn:
    """The movement of a camera around the point that it looks at."""

    azimuth: float
    """Degrees around the z axis, relative to the original camera."""
    elevation: float
    """Degrees above the horizon."""
    distance: float
    """The distance relative to the original."""
    angle: float
    """The angle of view in degrees."""


TURN = Turn(azimuth=29.6, elevation=4.0, distance=1.34, angle=9.74)


def view_file(directory: Path, *, turned: bool, objects: int) -> Path:
    """Returns the path of the output of `beambench stats` on beams from one of the two cameras."""
    return directory / "views" / f"{TURNED_SCENE}-{'turned' if turned else 'own'}-{objects}.json"


def camera_section(directory: Path) -> Section | None:
    """Returns exit pixels from both cameras and the thesis's; None if they were not counted."""
    pixels = {
        (turned, objects): _read(view_file(directory, turned=turned, objects=objects), _exit_pixels)
        for turned in (False, True)
        for objects in OBJECTS
    }
    if None in pixels.values():
        return None
    scene = scene_title(TURNED_SCENE)
    printed = [published_evidence().count("exit_pixels", TURNED_SCENE, objects=n) for n in OBJECTS]
    rows = [
        (name, *(f"{pixels[turned, objects]:,}" for objects in OBJECTS))
        for turned, name in ((False, "the scene's own"), (True, "turned"))
    ]
    rows.append(("thesis", *(f"{one.value:,.0f}" if one else DASH for one in printed)))
    own, turned = (pixels[which, OBJECTS[-1]] for which in (False, True))
    return Section(
        "camera",
        "Exit pixels and the camera",
        (
            f"Scenes and cameras of the thesis are lost. Here the camera of {scene} is turned by "
            f"{TURN.azimuth:g} degrees around the scene, to {TURN.elevation:g} degrees above the "
            f"horizon, {TURN.distance:g} times as far away, with an angle of view of "
            f"{TURN.angle:g} degrees; level 6, 1280x1024.",
        ),
        (
            section_table(
                f"Pixels of beams that leave {scene}",
                ("camera",),
                [f"{n} objects per leaf" for n in OBJECTS],
                rows,
            ),
        ),
        findings=(
            "The number of pixels in exit beams depends on the camera as well as on the division "
            f"of the octree: with {OBJECTS[-1]} objects per leaf, it is {own:,} from the scene's "
            f"own camera and {turned:,} from the turned camera, in the same octree.",
        ),
    )


def _exit_pixels(source: dict) -> int:
    (structure,) = source["structures"]
    return round(structure["per_ray"]["samples_leaving"] * source["rays"])


# Running the commands, each once

CENSUS = "census"
"""The folder of censuses (`paper.measured`)."""


@dataclass(frozen=True)
class Fact:
    """A file and the arguments of the command that prints it."""

    path: Path
    arguments: tuple[str, ...]


def facts(directory: Path) -> list[Fact]:
    """Returns all facts except those of the turned camera, which need a separate scene file."""
    scenes = tuple(primitives_by_scene())
    census = (
        "census",
        *scenes,
        *"--accel beam --resolution 512x512 --shadows cache --json".split(),
    )
    visits = ("--accel", VISITED, "--levels", "--json")
    return [
        *(Fact(scene_file(directory, scene), ("scene", scene, "--json")) for scene in scenes),
        *(
            Fact(census_file(directory / CENSUS, order), (*census, "--order", order))
            for order in ORDERS
        ),
        *(Fact(visits_file(directory, one), ("stats", one, *visits)) for one in VISITED_SCENES),
        *_views(directory, TURNED_SCENE, turned=False),
    ]


def gather_facts(directory: Path, beambench: Path) -> list[str]:
    """Creates the missing files; returns a sentence for each failure."""
    failed = _make(facts(directory), beambench)
    if all(fact.path.exists() for fact in _views(directory, TURNED_SCENE, turned=True)):
        return failed
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / f"{TURNED_SCENE}.nff"
        try:
            output_of([str(beambench), "export", TURNED_SCENE, "-o", str(scene)])
            about = json.loads(output_of([str(beambench), "scene", TURNED_SCENE, "--json"]))
            scene.write_text(turn_camera(scene.read_text("utf-8"), about["cameras"][0], TURN))
        except (Problem, OSError, ValueError, KeyError, IndexError) as error:
            return [*failed, f"{TURNED_SCENE} from another camera: {error}"]
        return failed + _make(_views(directory, str(scene), turned=True), beambench)


def turn_camera(scene: str, camera: dict, turn: Turn) -> str:
    """Returns the text of an NFF scene with its camera turned around the point that it looks at.

    Raises ValueError if the text has no camera.
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


def _views(directory: Path, scene: str, *, turned: bool) -> list[Fact]:
    size = ("--resolution", "1280x1024", "--json")
    return [
        Fact(
            view_file(directory, turned=turned, objects=objects),
            ("stats", scene, "--accel", f"beam:max_level=6,max_objects={objects}", *size),
        )
        for objects in OBJECTS
    ]


def _make(wanted: Iterable[Fact], beambench: Path) -> list[str]:
    failed = []
    for fact in wanted:
        if fact.path.exists():
            continue
        try:
            printed = output_of([str(beambench), *fact.arguments])
            json.loads(printed)
        except (Problem, ValueError) as error:
            failed.append(f"{fact.path.parent.name}/{fact.path.name} was not made: {error}")
            continue
        fact.path.parent.mkdir(parents=True, exist_ok=True)
        write_text(fact.path, printed)
    return failed
