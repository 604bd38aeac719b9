"""Converts a file in the format AC3D, or its variant ACC with triangle strips, to OBJ.

usage: .venv/bin/python -m beambench_meshes.ac3d INPUT.ac OUTPUT.obj

Assimp's importer does not support strips. Lines are left out, and so are the degenerate triangles
that join strips. Coordinates stay those of the file: y is up.
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from beambench_meshes.colors import color_of_texture
from beambench_meshes.problem import Problem
from beambench_meshes.surface_mesh import Point, SurfaceMesh

_POLYGON, _CLOSED_LINE, _LINE, _STRIP = 0, 1, 2, 4
_UNTURNED = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)


@dataclass
class Model:
    """The converted model, and counts of what was left out."""

    mesh: SurfaceMesh = field(default_factory=SurfaceMesh)
    surfaces: Counter[str] = field(default_factory=Counter)  # by kind
    triangles: Counter[str] = field(default_factory=Counter)  # by kind

    def report(self) -> str:
        """Returns one line for each kind of surface."""
        return "\n".join(
            f"{kind}: {count} surfaces, {self.triangles[kind]} triangles"
            for kind, count in sorted(self.surfaces.items())
        )


@dataclass(frozen=True)
class _Motion:
    """A rotation, row by row, followed by a translation."""

    rows: tuple[float, ...] = _UNTURNED
    offset: Point = (0.0, 0.0, 0.0)

    def moved(self, point: Point) -> Point:
        if self.rows == _UNTURNED and self.offset == (0.0, 0.0, 0.0):
            return point
        x, y, z = (
            sum(self.rows[3 * row + i] * point[i] for i in range(3)) + self.offset[row]
            for row in range(3)
        )
        return x, y, z

    def after(self, other: _Motion) -> _Motion:
        """Returns the motion that applies `other` first and then this one."""
        rows = tuple(
            sum(self.rows[3 * row + i] * other.rows[3 * i + column] for i in range(3))
            for row in range(3)
            for column in range(3)
        )
        return _Motion(rows, self.moved(other.offset))


def convert(text: str) -> Model:
    """Reads a model. Raises Problem, without the file's name, if the model is malformed."""
    if not text.startswith("AC3D"):
        raise Problem("it is not an AC3D model: it does not begin with AC3D")
    reader = _Reader(text)
    try:
        reader.read()
    except (ValueError, IndexError, RecursionError):
        raise Problem(f"line {reader.line} is malformed or cut off") from None
    except Problem as problem:
        raise Problem(f"line {reader.line}: {problem}") from None
    if not reader.model.mesh.faces:
        raise Problem("it has no polygon")
    return reader.model


class _Reader:
    def __init__(self, text: str) -> None:
        self.model = Model()
        self.line = 1
        self._lines = text.splitlines()

    def read(self) -> None:
        """Reads all objects. Parents precede their children, so recursion needs no tree."""
        while self._has_more():
            if self._words()[0] == "OBJECT":
                self._object(_Motion())

    def _has_more(self) -> bool:
        while self.line < len(self._lines) and not self._lines[self.line].strip():
            self.line += 1
        return self.line < len(self._lines)

    def _words(self) -> list[str]:
        """Returns the words of the next line that is not empty."""
        while True:
            self.line += 1
            words = self._lines[self.line - 1].split()
            if words:
                return words

    def _object(self, parent: _Motion) -> None:
        texture, rows, offset = "plain", _UNTURNED, (0.0, 0.0, 0.0)
        points: list[Point] = []
        while True:
            word, *rest = self._words()
            if word == "texture" and (texture == "plain" or rest[-1] == "base"):
                texture = rest[0].strip('"')
            elif word == "loc":
                offset = _point(rest)
            elif word == "rot":
                rows = tuple(float(part) for part in rest[:9])
                if len(rows) != 9:
                    raise Problem("a rotation must have nine numbers")
            elif word == "data":
                self.line += 1
            elif word == "numvert":
                motion = parent.after(_Motion(rows, offset))
                points = [motion.moved(_point(self._words())) for _ in range(_count(rest))]
            elif word == "numsurf":
                for _ in range(_count(rest)):
                    self._surface(texture, points)
            elif word == "kids":
                below = parent.after(_Motion(rows, offset))
                for number in range(_count(rest)):
                    if not self._has_more():  # files of TORCS count objects that are missing
                        self.model.surfaces["objects that the file lacks"] += _count(rest) - number
                        return
                    if self._words()[0] != "OBJECT":
                        raise Problem("an object is expected here")
                    self._object(below)
                return

    def _surface(self, texture: str, points: list[Point]) -> None:
        word, flags = self._words()
        if word != "SURF":
            raise Problem("a surface is expected here")
        words = self._words()
        if words[0] == "mat":
            words = self._words()
        if words[0] != "refs":
            raise Problem("the corners of a surface are expected here")
        corners = [int(self._words()[0]) for _ in range(_count(words[1:]))]
        if corners and not 0 <= min(corners) <= max(corners) < len(points):
            raise Problem(f"a surface has a corner beyond its {len(points)} vertices")
        kind, what = int(flags, 16) & 15, ""
        faces: list[list[int]] = []
        if kind == _POLYGON and len(corners) > 2:
            what, faces = "polygons", [corners]
        elif kind == _STRIP:
            what = "strips"
            every = [corners[i : i + 3] for i in range(len(corners) - 2)]
            faces = [face for face in every if len(set(face)) == 3]
            self.model.triangles["joints of strips (left out)"] += len(every) - len(faces)
            self.model.surfaces["joints of strips (left out)"] += len(every) - len(faces)
        elif kind in (_POLYGON, _CLOSED_LINE, _LINE):
            what = "lines (left out)"
        else:
            raise Problem(f"a surface has type {kind}, but must have 0, 1, 2 or 4")
        self.model.surfaces[what] += 1
        self.model.triangles[what] += sum(len(face) - 2 for face in faces)
        mesh = self.model.mesh
        if faces:
            mesh.colors.setdefault(texture, color_of_texture(texture))
        mesh.faces += [(texture, [mesh.vertex(points[i]) for i in face]) for face in faces]


def _point(words: list[str]) -> Point:
    return float(words[0]), float(words[1]), float(words[2])


def _count(words: list[str]) -> int:
    count = int(words[0])
    if count < 0:
        raise Problem("a count must not be negative")
    return count


def main(arguments: list[str]) -> int:
    """Runs the command line; returns the exit code."""
    if len(arguments) != 2:
        print("usage: ac3d INPUT.ac OUTPUT.obj", file=sys.stderr)
        return 2
    source = Path(arguments[0])
    try:
        try:
            model = convert(source.read_text("latin-1"))
        except Problem as problem:
            raise Problem(f"{source}: {problem}; use a whole, unchanged file") from None
        model.mesh.write(Path(arguments[1]))
    except (Problem, OSError) as problem:
        print(f"error: {problem}", file=sys.stderr)
        return 2
    print(model.report())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
