"""Polygons with surfaces, and the OBJ files to which they are written."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from pathlib import Path

from beambench_meshes.problem import Problem

Point = tuple[float, float, float]
Color = tuple[float, float, float]

_LARGEST = 1e9  # the largest coordinate that beambench accepts
_FLOAT = struct.Struct("<f")


def _as_written(number: float) -> str:
    """Formats a number as the nearest float, with enough digits to read it back exactly."""
    rounded: float = _FLOAT.unpack(_FLOAT.pack(number))[0]
    return f"{rounded + 0.0:.9g}"  # -0 and 0 are the same place


@dataclass
class SurfaceMesh:
    """Polygons, each with the name of its surface; vertices at the same place are merged."""

    vertices: list[Point] = field(default_factory=list)
    faces: list[tuple[str, list[int]]] = field(default_factory=list)
    colors: dict[str, Color] = field(default_factory=dict)
    _places: dict[Point, int] = field(default_factory=dict)

    def vertex(self, place: Point) -> int:
        """Returns the index of the vertex at a place."""
        if not all(abs(part) <= _LARGEST for part in place):  # also catches NaN
            raise Problem(f"it has a vertex at {place}, which is too far away")
        number = self._places.setdefault(place, len(self.vertices))
        if number == len(self.vertices):
            self.vertices.append(place)
        return number

    def triangles(self) -> int:
        """Returns the number of triangles after every polygon is triangulated."""
        return sum(len(corners) - 2 for _, corners in self.faces)

    def write(self, output: Path) -> None:
        """Writes OUTPUT.mtl, then OUTPUT.obj, atomically."""
        names = {name: f"surface-{number}" for number, name in enumerate(self.colors)}
        library = output.with_suffix(".mtl")
        _write_whole(
            library,
            "".join(
                f"# {name}\nnewmtl {names[name]}\nKd {' '.join(f'{part:.3f}' for part in color)}\n"
                for name, color in self.colors.items()
            ),
        )
        lines = [f"mtllib {library.name}"]
        lines += ["v " + " ".join(_as_written(part) for part in place) for place in self.vertices]
        surface = None
        for name, corners in sorted(self.faces, key=lambda face: face[0]):
            if name != surface:
                lines.append(f"usemtl {names[name]}")
                surface = name
            lines.append("f " + " ".join(str(corner + 1) for corner in corners))
        _write_whole(output, "\n".join(lines) + "\n")


def _write_whole(path: Path, text: str) -> None:
    target = path.resolve()  # the target of a link
    pending = target.with_name(f".pending-{target.name}")
    pending.write_text(text)
    pending.replace(target)
