"""What the report states beside the sweeps: counts that single commands of beambench print.

`gather_facts` runs the commands and keeps what they print in folders beside the runs; each section
reads one of these folders.
"""

from __future__ import annotations

import json
import math
import re
import subprocess
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from beambench_report.base.files import Problem, write_text
from beambench_report.base.published import FOLDER, primitives_by_scene
from beambench_report.base.quantities import number
from beambench_report.thesis.paper.evidence import published_evidence
from beambench_report.thesis.paper.measured import ORDERS, census_file
from beambench_report.thesis.paper.printed import DASH, scene_title
from beambench_report.thesis.paper.section import Column, Field, Section, SectionTable

_KINDS = ("polygons", "spheres", "cones")


def scene_file(directory: Path, scene: str) -> Path:
    """What `beambench scene NAME --json` printed."""
    return directory / "scenes" / f"{scene}.json"


def scenes_section(directory: Path) -> Section | None:
    """Table 5.1 with our counts; None where no scene was counted."""
    printed = pd.read_csv(FOLDER / "scenes.csv").to_dict("records")
    counted = {row["scene"]: _counts(scene_file(directory, row["scene"])) for row in printed}
    if not any(counted.values()):
        return None
    columns = (
        Column("scene", False),
        *(Column(f"{kind}, {whose}") for kind in _KINDS[:2] for whose in ("thesis", "ours")),
        Column("cones, ours"),
    )
    rows = []
    for row in printed:
        own = counted[row["scene"]]
        texts = [scene_title(row["scene"])]
        for kind in _KINDS[:2]:
            texts += [f"{row[kind]:,}", f"{own[kind]:,}" if own else DASH]
        texts.append(f"{own['cones']:,}" if own else DASH)
        rows.append(tuple(Field(text) for text in texts))
    known = {row["scene"]: row for row in printed if counted[row["scene"]]}
    other = [
        scene_title(scene)
        for scene, row in known.items()
        if any(counted[scene][kind] != row[kind] for kind in _KINDS[:2]) or counted[scene]["cones"]
    ]
    return Section(
        "scenes",
        "Table 5.1: the scenes",
        (
            "The files of the thesis's scenes are lost. Ours are stand-ins with their names and "
            "their numbers of primitives; shapes, cameras, lights and surfaces are beambench's.",
        ),
        (SectionTable("Primitives", columns, tuple(rows)),),
        findings=(
            f"{len(known) - len(other)} of {len(known)} scenes have the thesis's numbers"
            + (f"; others: {', '.join(other)}." if other else "."),
        ),
    )


def _counts(path: Path) -> dict[str, int] | None:
    try:
        source = json.loads(path.read_text("utf-8"))
        return {kind: int(source[kind]) for kind in _KINDS}
    except (OSError, ValueError, KeyError, TypeError):
        return None


SCENES = ("maceta", "delfines")
ACCEL = "beam:max_level=8,max_objects=0"
_SIX = 6

_WORDS = (
    "Section 5.3.1 takes level 6 from McNeill et al. (1992): from the sixth level on, a ray is "
    "very unlikely to visit a given node, so that beams would have few rays. Counted here over "
    "octrees of level 8: nodes that rays pass through up to their first hit, each ray by itself, "
    "and leaves that beams come to. Deeper leaves exist only around the surfaces."
)


@dataclass(frozen=True)
class Level:
    """One level of an octree and who came to it."""

    level: int
    nodes: int
    leaves: int
    occupied_leaves: int
    node_visits: int
    leaf_visits: int
    beams: int

    @property
    def rays_a_node(self) -> float:
        """Rays that visit a node, on average."""
        return self.node_visits / self.nodes


def visits_file(directory: Path, scene: str) -> Path:
    """What `beambench stats --levels --json` printed."""
    return directory / "visits" / f"{scene}.json"


def visits_section(directory: Path) -> Section | None:
    """A table a scene; None where no visits were counted."""
    read = {scene: _read(visits_file(directory, scene)) for scene in SCENES}
    known = {scene: found for scene, found in read.items() if found is not None}
    if not known:
        return None
    return Section(
        "visits",
        "Visits by level",
        (_WORDS,),
        tuple(_table(scene, *found) for scene, found in known.items()),
        findings=tuple(
            sentence
            for scene, found in known.items()
            for sentence in (_finding(scene, *found),)
            if sentence
        ),
    )


def _read(path: Path) -> tuple[int, list[Level]] | None:
    """The number of rays, and the levels that have nodes."""
    try:
        source = json.loads(path.read_text("utf-8"))
        (structure,) = source["structures"]
        return int(source["rays"]), [Level(**level) for level in structure["levels"]]
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _table(scene: str, rays: int, levels: list[Level]) -> SectionTable:
    heads = (
        "level",
        "nodes",
        "rays that visit a node",
        "of all rays",
        "leaves",
        "occupied",
        "visits of leaves by rays",
        "by beams",
    )
    rows = tuple(
        tuple(
            Field(text)
            for text in (
                f"{level.level}",
                f"{level.nodes:,}",
                number(level.rays_a_node),
                f"{level.rays_a_node / rays:.3%}",
                *(
                    f"{count:,}" if count else DASH
                    for count in (
                        level.leaves,
                        level.occupied_leaves,
                        level.leaf_visits,
                        level.beams,
                    )
                ),
            )
        )
        for level in levels
    )
    title = f"{scene_title(scene)}, {ACCEL}, {rays:,} rays"
    return SectionTable(title, tuple(Column(head) for head in heads), rows)


def _finding(scene: str, rays: int, levels: list[Level]) -> str:
    """How visits fall around level 6."""
    by_level = {level.level: level for level in levels}
    wanted = [by_level[level] for level in (_SIX - 1, _SIX, _SIX + 1) if level in by_level]
    if len(wanted) < 3:
        return ""
    before, six, after = (level.rays_a_node for level in wanted)
    title = scene_title(scene)
    return (
        f"{title}: a node of level {_SIX} is visited by {number(six)} of {rays:,} rays on average "
        f"({six / rays:.2%}), one of level {_SIX - 1} by {number(before / six)} times as many, one "
        f"of level {_SIX + 1} by {number(six / after)} times fewer."
    )


SCENE = "delfines"
OBJECTS = (0, 40)
"""Values of max_objects, at level 6."""


@dataclass(frozen=True)
class Turn:
    """How a camera is moved around the point that it looks at."""

    azimuth: float
    """Degrees around the z axis, beside where it was."""
    elevation: float
    """Degrees above the horizon."""
    distance: float
    """Over what it was."""
    angle: float
    """Of view, in degrees."""


TURN = Turn(azimuth=29.6, elevation=4.0, distance=1.34, angle=9.74)


def view_file(directory: Path, *, turned: bool, objects: int) -> Path:
    """What `beambench stats` printed of the beams from one of the two cameras."""
    return directory / "views" / f"{SCENE}-{'turned' if turned else 'own'}-{objects}.json"


def camera_section(directory: Path) -> Section | None:
    """Exit pixels from both cameras beside the thesis's; None where they were not counted."""
    pixels = {
        (turned, objects): _exit_pixels(view_file(directory, turned=turned, objects=objects))
        for turned in (False, True)
        for objects in OBJECTS
    }
    if None in pixels.values():
        return None
    columns = (Column("camera", False), *(Column(f"{n} objects a leaf") for n in OBJECTS))
    printed = [published_evidence().count("exit_pixels", SCENE, objects=n) for n in OBJECTS]
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
            "Scenes and cameras of the thesis are lost. Here the camera of "
            f"{scene_title(SCENE)} is turned by {TURN.azimuth:g} degrees around the scene, to "
            f"{TURN.elevation:g} degrees above the horizon, {TURN.distance:g} times as far away, "
            f"with an angle of view of {TURN.angle:g} degrees; level 6, 1280x1024.",
        ),
        (
            SectionTable(
                f"Pixels of beams that leave {scene_title(SCENE)}",
                columns,
                tuple(tuple(Field(text) for text in row) for row in rows),
            ),
        ),
        findings=(
            "Pixels of exit beams depend on the camera as well as on the division of the octree: "
            f"with {OBJECTS[-1]} objects a leaf they are {own:,} from the scene's own camera and "
            f"{turned:,} from the turned one, over the same octree.",
        ),
    )


def _exit_pixels(path: Path) -> int | None:
    try:
        source = json.loads(path.read_text("utf-8"))
        (structure,) = source["structures"]
        return round(structure["per_ray"]["samples_leaving"] * source["rays"])
    except (OSError, ValueError, KeyError, TypeError):
        return None


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
