"""Furnishes a room with pieces of Debian's sweethome3d-furniture and writes it as OBJ and MTL.

usage: .venv/bin/python -m beambench_meshes.room FURNITURE_FOLDER OUTPUT.obj

The room has a floor and two open sides. Units are meters, and y is up. The pieces have the sizes
stated in their catalogs.
"""

from __future__ import annotations

import math
import sys
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from beambench_meshes.problem import Problem

_WIDTH, _DEPTH, _HEIGHT, _THICKNESS = 6.4, 5.0, 2.7, 0.1
_ROOM_COLORS = {"room-floor": (0.55, 0.40, 0.28), "room-wall": (0.86, 0.83, 0.76)}


@dataclass(frozen=True)
class Place:
    """The place of a piece: its center, its rotation about the vertical, and its elevation."""

    catalog: str
    model: str
    x: float
    z: float
    degrees: float = 0.0
    elevation: float = 0.0


PLACES = (
    Place("KatorLegaz", "oriental-rug", 0.1, 0.2),
    Place("KatorLegaz", "mid-century-sofa", 0.0, -2.0),
    Place("KatorLegaz", "mid-century-chair", -1.6, 0.3, 70),
    Place("BlendSwap-CC-BY", "coffeeTable", 0.0, -0.5),
    Place("BlendSwap-CC-BY", "laptop", 0.1, -0.5, 20, 0.45),
    Place("KatorLegaz", "full-bookcase", 2.3, -2.25),
    Place("BlendSwap-CC-BY", "piano", -2.75, -0.3, 90),
    Place("KatorLegaz", "office-chair", -1.8, -0.75, 200),
    Place("BlendSwap-CC-BY", "lamp", -0.4, -0.45, 0, 0.45),
    Place("BlendSwap-CC-BY", "arbolito", 1.9, 1.2, 0, 0.70),
    Place("KatorLegaz", "cafe-table", 1.9, 1.2),
    Place("KatorLegaz", "dining-chair", 1.9, 2.0, 180),
    Place("KatorLegaz", "dining-chair", 2.75, 1.2, 270),
    Place("KatorLegaz", "dining-chair", 1.05, 1.2, 90),
    Place("BlendSwap-CC-BY", "siameseCat", -0.4, 1.2, 30),
)


@dataclass
class Mesh:
    """Triangles and polygons by surface, with vertices as they will be written."""

    vertices: list[tuple[float, float, float]]
    faces: list[tuple[str, list[int]]]
    colors: dict[str, tuple[float, float, float]]


class Catalog:
    """One of the package's files: a ZIP with models and a list of their sizes."""

    def __init__(self, file: Path) -> None:
        """Reads the list. Raises Problem if the file is missing or cannot be read."""
        try:
            self._zip = zipfile.ZipFile(file)
            listed = self._zip.read("PluginFurnitureCatalog.properties").decode("latin-1")
        except (OSError, KeyError, zipfile.BadZipFile) as error:
            raise Problem(f"{file}: it cannot be read ({error})") from None
        self._file = file
        self._entries: dict[str, dict[str, str]] = {}
        numbered: dict[str, dict[str, str]] = {}
        for line in listed.splitlines():
            key, equals, value = line.partition("=")
            name, hash_sign, number = key.partition("#")
            if equals and hash_sign:
                numbered.setdefault(number, {})[name] = value.strip()
        for entry in numbered.values():
            if "model" in entry:
                self._entries[PurePosixPath(entry["model"]).stem] = entry

    def piece(self, model: str) -> tuple[dict[str, str], Mesh]:
        """Returns an entry of the list and its model."""
        if model not in self._entries:
            raise Problem(f"{self._file}: it has no model '{model}'; is this another package?")
        entry = self._entries[model]
        path = PurePosixPath(entry["model"].lstrip("/"))
        mesh = Mesh([], [], {})
        material = "room-wall"
        for words in self._lines(path):
            if words[0] == "mtllib":
                mesh.colors |= self._colors(path.parent / words[1], model)
            elif words[0] == "v":
                mesh.vertices.append((float(words[1]), float(words[2]), float(words[3])))
            elif words[0] == "usemtl":
                material = f"{model}-{words[1]}"
            elif words[0] == "f":
                mesh.faces.append((material, _indices(words[1:], len(mesh.vertices))))
        return entry, mesh

    def _lines(self, path: PurePosixPath) -> Iterator[list[str]]:
        for line in self._zip.read(str(path)).decode("latin-1").splitlines():
            words = line.split()
            if words and not words[0].startswith("#"):
                yield words

    def _colors(self, path: PurePosixPath, model: str) -> dict[str, tuple[float, float, float]]:
        colors: dict[str, tuple[float, float, float]] = {}
        name = ""
        for words in self._lines(path):
            if words[0] == "newmtl":
                name = f"{model}-{words[1]}"
                colors[name] = (0.7, 0.7, 0.7)
            elif words[0] == "Kd":
                colors[name] = (float(words[1]), float(words[2]), float(words[3]))
            elif words[0] == "map_Kd" and sum(colors[name]) == 0:
                colors[name] = (0.5, 0.5, 0.5)
        return colors


def _indices(corners: list[str], vertices: int) -> list[int]:
    """Returns the indices of a face's corners in the list of vertices, counted from 0."""
    numbers = [int(corner.split("/")[0]) for corner in corners]
    return [number - 1 if number > 0 else vertices + number for number in numbers]


def _turned_model(
    entry: dict[str, str], vertices: list[tuple[float, float, float]]
) -> list[tuple[float, float, float]]:
    """Applies the rotation that a catalog may specify for a model before it is scaled."""
    if "modelRotation" not in entry:
        return vertices
    m = [float(number) for number in entry["modelRotation"].split()]
    return [
        (
            m[0] * x + m[1] * y + m[2] * z,
            m[3] * x + m[4] * y + m[5] * z,
            m[6] * x + m[7] * y + m[8] * z,
        )
        for x, y, z in vertices
    ]


def _placed(entry: dict[str, str], mesh: Mesh, place: Place) -> list[tuple[float, float, float]]:
    """Returns the vertices, scaled to the catalog's centimeters and moved into place."""
    vertices = _turned_model(entry, mesh.vertices)
    low = [min(v[axis] for v in vertices) for axis in range(3)]
    high = [max(v[axis] for v in vertices) for axis in range(3)]
    size = [float(entry[key]) / 100 for key in ("width", "height", "depth")]
    scale = [s / (h - b) if h > b else 1.0 for s, h, b in zip(size, high, low, strict=True)]
    sine, cosine = math.sin(math.radians(place.degrees)), math.cos(math.radians(place.degrees))
    result = []
    for vertex in vertices:
        x = (vertex[0] - (low[0] + high[0]) / 2) * scale[0]
        y = (vertex[1] - low[1]) * scale[1]
        z = (vertex[2] - (low[2] + high[2]) / 2) * scale[2]
        result.append(
            (
                place.x + cosine * x + sine * z,
                place.elevation + y,
                place.z - sine * x + cosine * z,
            )
        )
    return result


def _box(low: tuple[float, float, float], high: tuple[float, float, float], name: str) -> Mesh:
    corners = [
        (high[0] if i & 1 else low[0], high[1] if i & 2 else low[1], high[2] if i & 4 else low[2])
        for i in range(8)
    ]
    sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]
    return Mesh(corners, [(name, side) for side in sides], {name: _ROOM_COLORS[name]})


def _shell() -> list[Mesh]:
    x, z, t = _WIDTH / 2, _DEPTH / 2, _THICKNESS
    return [
        _box((-x - t, -t, -z - t), (x, 0.0, z), "room-floor"),
        _box((-x - t, 0.0, -z - t), (-x, _HEIGHT, z), "room-wall"),
        _box((-x, 0.0, -z - t), (x, _HEIGHT, -z), "room-wall"),
    ]


def furnish(folder: Path) -> list[Mesh]:
    """Returns the room with its furniture."""
    catalogs: dict[str, Catalog] = {}
    meshes = _shell()
    for place in PLACES:
        if place.catalog not in catalogs:
            catalogs[place.catalog] = Catalog(folder / f"{place.catalog}.sh3f")
        entry, mesh = catalogs[place.catalog].piece(place.model)
        meshes.append(Mesh(_placed(entry, mesh, place), mesh.faces, mesh.colors))
    return meshes


def write(meshes: list[Mesh], output: Path) -> None:
    """Writes OUTPUT.mtl, then OUTPUT.obj, atomically."""
    library = output.with_suffix(".mtl")
    colors = {name: color for mesh in meshes for name, color in mesh.colors.items()}
    library.write_text(
        "".join(
            f"newmtl {name}\nKd {' '.join(f'{part:g}' for part in color)}\n"
            for name, color in colors.items()
        )
    )
    lines = [f"mtllib {library.name}"]
    first = 1
    for mesh in meshes:
        lines += [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in mesh.vertices]
        material = None
        for name, corners in mesh.faces:
            if name != material:
                lines.append(f"usemtl {name}")
                material = name
            lines.append("f " + " ".join(str(first + corner) for corner in corners))
        first += len(mesh.vertices)
    target = output.resolve()  # the target of a link
    pending = target.with_name(f".pending-{target.name}")
    pending.write_text("\n".join(lines) + "\n")
    pending.replace(target)


def main(arguments: list[str]) -> int:
    """Runs the command line; returns the exit code."""
    if len(arguments) != 2:
        print("usage: room FURNITURE_FOLDER OUTPUT.obj", file=sys.stderr)
        return 2
    try:
        write(furnish(Path(arguments[0])), Path(arguments[1]))
    except (Problem, OSError) as problem:
        print(f"error: {problem}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
