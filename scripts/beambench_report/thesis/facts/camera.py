"""Pixels of exit beams from two cameras: they depend on the camera as well as on the division."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from beambench_report.ledger.published import published_evidence
from beambench_report.thesis.printed import scene_title
from beambench_report.thesis.section import Column, Field, Section, SectionTable
from beambench_report.thesis.texts import DASH

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
