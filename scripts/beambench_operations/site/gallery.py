"""The gallery of the site: pages of `beambench explain`, with a paragraph each."""

import json
import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlencode

from beambench_report.base.files import Problem

_SCENES = {
    "escena2": "91 balls in front of a wall, with much background",
    "gato-bill": "a cat of many small polygons",
    "habitacion": "a closed room, in which every ray hits something",
}
"""The scenes of the figures in the thesis's chapter 3, and what is special about each."""

_FIGURES = (
    (
        "Division of beams",
        {"map": "beams", "view": "eye"},
        "The beam of the whole image is divided at the faces of the octree's leaves, until each "
        "part meets one leaf. A part that passes an empty leaf (gray) continues as one beam and is "
        "divided again behind it, where leaves are small.",
    ),
    (
        "Exit beams",
        {"map": "beams", "only": "2", "scene": "yes"},
        "Exit beams alone (blue), which leave the scene through empty leaves. All pixels of an "
        "exit beam become background without tracing a ray, however fine the image is.",
    ),
    (
        "Occupied leaves",
        {"map": "beams", "only": "1", "scene": "yes", "level": "all"},
        "The beams that end at leaves with primitives (orange), and these leaves (green). Each "
        "pixel of such a beam becomes a ray, which begins at the leaf and not at the eye.",
    ),
)
"""The title, the state of the page, and the paragraph of each figure."""

_OWN_TEXTS = {
    ("habitacion", "Exit beams"): "There are no exit beams: the room is closed, and each pixel "
    "becomes a ray. Beams save only the empty leaves that neighboring rays share.",
}

_STRUCTURES_SHOW = "escena2"
_ELSEWHERE = {"polygon-beam": "tetra:n=4"}
"""Scenes for structures that do not support the spheres of that scene."""
_LEFT_OUT = {"null", "embree", "exhaustive"}
"""Structures without cells to show."""


@dataclass(frozen=True)
class Exhibit:
    """A page, with its title and the text of its link."""

    title: str
    href: str
    text: str


@dataclass(frozen=True)
class Gallery:
    """The contents of the gallery's first page."""

    figures: list[tuple[str, str, list[Exhibit]]]
    """Scene, what is special about it, and its figures."""
    structures: list[Exhibit]


def make_gallery(beambench: Path, folder: Path) -> Gallery:
    """Writes all pages into the folder with the program `beambench`; returns the contents.

    Raises Problem if the program cannot write a page.
    """
    folder.mkdir(parents=True, exist_ok=True)
    figures = []
    for scene, about in _SCENES.items():
        page = _write(beambench, folder, scene, "beam")
        exhibits = [
            Exhibit(title, f"{page}#{urlencode(state)}", _OWN_TEXTS.get((scene, title), text))
            for title, state, text in _FIGURES
        ]
        figures.append((scene, about, exhibits))
    structures = [
        Exhibit(name, _write(beambench, folder, scene, name), _sentence(summary))
        for name, summary in _structures(beambench)
        for scene in [_ELSEWHERE.get(name, _STRUCTURES_SHOW)]
    ]
    return Gallery(figures, structures)


def _structures(beambench: Path) -> Iterator[tuple[str, str]]:
    listed = subprocess.run(
        [beambench, "list", "--json"], capture_output=True, text=True, check=True
    )
    for structure in json.loads(listed.stdout)["structures"]:
        if structure["name"] not in _LEFT_OUT:
            yield structure["name"], structure["summary"]


def _sentence(summary: str) -> str:
    return f"{summary[:1].upper()}{summary[1:]}."


def _write(beambench: Path, folder: Path, scene: str, structure: str) -> str:
    """Writes the page of a structure over a scene; returns the name of its file."""
    name = re.sub(r"[^a-z0-9]+", "-", f"{scene}-{structure}") + ".html"
    words = [beambench, "explain", scene, "--accel", structure, "-o", folder / name]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Problem(done.stderr.strip().removeprefix("beambench: "))
    return name
