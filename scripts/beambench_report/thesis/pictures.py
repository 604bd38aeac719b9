"""Figure 5.9: the octrees of four scenes, drawn over them by beambench."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path

from beambench_report.thesis.printed import scene_title

_SCENES = ("bola-espacial", "caracol", "tetera", "torre-eiffel")
_ACCEL = "samet:max_level=6,max_objects=0"
_SIZE = "480x384"


@dataclass(frozen=True)
class Picture:
    """A picture and its caption; nothing but the caption where it could not be made."""

    path: Path | None
    caption: str


def octree_pictures(directory: Path, beambench: Path) -> list[Picture]:
    """Renders those that DIRECTORY/pictures does not have yet."""
    folder = directory / "pictures"
    folder.mkdir(exist_ok=True)
    return [_picture(folder / f"octree-{scene}.png", scene, beambench) for scene in _SCENES]


def _picture(path: Path, scene: str, beambench: Path) -> Picture:
    title = scene_title(scene)
    if not path.exists():
        options = ["--accel", _ACCEL, "--overlay", "cells", "--resolution", _SIZE]
        command = [str(beambench), "render", scene, *options, "-o", str(path)]
        try:
            done = subprocess.run(command, capture_output=True, text=True, check=False)
        except OSError as error:
            return Picture(None, f"{title}: {beambench} cannot be run: {error.strerror}")
        if done.returncode != 0:
            said = done.stderr.strip().splitlines() or ["no reason told"]
            return Picture(None, f"{title}: {said[-1]}")
    return Picture(path, f"{title}: the leaves of the octree of level 6")
