"""Entries of the registry, and beambench's report on the meshes that they name."""

from __future__ import annotations

import hashlib
import json
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

from beambench_meshes.problem import Problem
from beambench_meshes.surface_mesh import Point


@dataclass(frozen=True)
class Camera:
    """A camera where a person would stand, in the mesh's coordinates; the angle is vertical."""

    name: str
    eye: Point
    at: Point
    angle: float = 60.0
    up: Point | None = None  # default: that of the mesh

    def as_json(self) -> dict[str, object]:
        """Returns the camera as an entry stores it."""
        up = {"up": self.up} if self.up else {}
        return {"name": self.name, "from": self.eye, "at": self.at, **up, "angle": self.angle}


@dataclass(frozen=True)
class Loaded:
    """A mesh as beambench read it."""

    triangles: int
    without_area: int  # triangles left out
    lower: Point
    upper: Point


def write_entry(entry: Path, content: dict[str, object]) -> None:
    """Writes a file to the folder `registered` atomically, without keys that have no value."""
    pending = entry.with_name(entry.name + ".pending")
    kept = {key: value for key, value in content.items() if value}
    pending.write_text(json.dumps(kept, ensure_ascii=False, indent=1) + "\n")
    pending.replace(entry)


def load(beambench: Path, name: str) -> Loaded:
    """Makes beambench read a registered mesh, which also fills the cache.

    Raises Problem on failure.
    """
    command = [str(beambench), "scene", f"mesh:{name}", "--json"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise Problem(f"{beambench} cannot be run: {error.strerror}") from None
    if done.returncode != 0:
        said = done.stderr.strip().splitlines() or [f"it ended with {done.returncode}"]
        raise Problem(said[-1].removeprefix("beambench: "))
    scene = json.loads(done.stdout)
    left_out = re.search(r": (\d+) triangles? without area", done.stderr)
    return Loaded(
        scene["polygons"],
        int(left_out[1]) if left_out else 0,
        tuple(scene["bounds"]["lower"]),
        tuple(scene["bounds"]["upper"]),
    )


def sha256(file: Path) -> str:
    """Returns the SHA-256 of a file, in hexadecimal."""
    with file.open("rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()
