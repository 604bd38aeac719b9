"""Converts a Quake 3 map (BSP, IBSP version 46) to OBJ.

usage: .venv/bin/python -m beambench_meshes.quake3_bsp ARCHIVE.pk3 maps/NAME.bsp OUTPUT.obj

Prints counts of converted and omitted faces, and player starts as cameras for the entry
registered/NAME.json. Coordinates stay those of the map: z is up, and a person's eyes are 50 units
above the floor. A map's faces are polygons and triangle meshes, with mesh indices that count from
the face's first vertex, curved patches, and billboards. Billboards are omitted. The sky is
omitted, too, so that rays can leave an open level, and so are faces marked as not drawn: a map
compiler that triangulates curved patches keeps the patches, with this mark, for collisions.
"""

from __future__ import annotations

import json
import math
import re
import struct
import sys
import zipfile
import zlib
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from beambench_meshes.colors import color_of_texture
from beambench_meshes.problem import Problem
from beambench_meshes.surface_mesh import Point, SurfaceMesh

LEVEL = 8  # squares along each side of a patch of 3 x 3 control points

_MAGIC, _VERSION = b"IBSP", 46
_LARGEST_MAP = 256 << 20  # bytes; the largest known ones have some 30 MB
_LUMPS = 17
_ENTITIES, _TEXTURES, _MODELS, _VERTICES, _MESH_INDICES, _FACES = 0, 1, 7, 10, 11, 13
_TEXTURE = struct.Struct("<64sii")
_MODEL = struct.Struct("<6f4i")
_VERTEX = struct.Struct("<3f32x")
_INDEX = struct.Struct("<i")
# Texture, effect, type, vertices (first, count), mesh indices (first, count), ..., patch size.
_FACE = struct.Struct("<7i68x2i")

_POLYGON, _PATCH, _TRIANGLES, _BILLBOARD = 1, 2, 3, 4
_SKY, _NOT_DRAWN = 0x4, 0x80  # flags of a texture
_VIEW_HEIGHT = 26  # height of the eyes above the point at which a player starts
_START = ("info_player_deathmatch", "info_player_start")


@dataclass
class Level:
    """The converted level, and counts of what was left out."""

    mesh: SurfaceMesh = field(default_factory=SurfaceMesh)
    entities: list[dict[str, str]] = field(default_factory=list)
    faces: Counter[str] = field(default_factory=Counter)  # by kind
    triangles: Counter[str] = field(default_factory=Counter)  # by kind

    def report(self) -> str:
        """Returns one line for each kind of face."""
        return "\n".join(
            f"{kind}: {count} faces, {self.triangles[kind]} triangles"
            for kind, count in sorted(self.faces.items())
        )

    def starts(self) -> list[dict[str, object]]:
        """Returns cameras at the eyes of players at their starts, in the form of an entry."""
        cameras: list[dict[str, object]] = []
        for entity in self.entities:
            if entity.get("classname") in _START and "origin" in entity:
                x, y, z = _origin(entity)
                angle = math.radians(_number(entity, "angle"))
                eye = (x, y, z + _VIEW_HEIGHT)
                at = (round(x + 100 * math.cos(angle), 1), round(y + 100 * math.sin(angle), 1))
                name = f"start {len(cameras) + 1}"
                cameras.append({"name": name, "from": eye, "at": (*at, eye[2]), "angle": 75})
        return cameras


def convert(data: bytes, level: int = LEVEL) -> Level:
    """Reads a map. Raises Problem, without the file's name, if the map is malformed."""
    return _Reader(data, level).level()


class _Reader:
    def __init__(self, data: bytes, squares: int) -> None:
        if len(data) < 8 or data[:4] != _MAGIC:
            raise Problem("it is not a Quake 3 map: it does not begin with IBSP")
        (version,) = struct.unpack_from("<i", data, 4)
        if version != _VERSION:
            raise Problem(f"it is a BSP of version {version}, but only {_VERSION} can be read")
        if len(data) < 8 + 8 * _LUMPS:
            raise Problem("it ends within its header")
        self._data = data
        self._squares = squares
        self._textures = [
            (name.split(b"\0")[0].decode("latin-1"), flags)
            for name, flags, _ in self._records(_TEXTURES, _TEXTURE, "textures")
        ]
        self._vertices: list[Point] = list(self._records(_VERTICES, _VERTEX, "vertices"))
        self._indices = [i for (i,) in self._records(_MESH_INDICES, _INDEX, "mesh indices")]
        self._faces = self._records(_FACES, _FACE, "faces")
        self._models = self._records(_MODELS, _MODEL, "models")

    def level(self) -> Level:
        level = Level(entities=_entities(self._lump(_ENTITIES).decode("latin-1")))
        offsets = self._offsets(level.entities)
        for number, face in enumerate(self._faces):
            try:
                self._add(face, offsets.get(number, (0.0, 0.0, 0.0)), level)
            except Problem as problem:
                raise Problem(f"in face {number}, {problem}") from None
        if not level.mesh.faces:
            raise Problem("it has no face that is drawn")
        return level

    def _lump(self, number: int) -> bytes:
        offset, size = struct.unpack_from("<ii", self._data, 8 + 8 * number)
        if offset < 0 or size < 0 or offset + size > len(self._data):
            raise Problem(
                f"it ends within lump {number}, which should be {size} bytes from byte {offset}"
            )
        return self._data[offset : offset + size]

    def _records(self, number: int, record: struct.Struct, what: str) -> list[tuple]:  # type: ignore[type-arg]
        lump = self._lump(number)
        if len(lump) % record.size:
            raise Problem(f"its {what} take {len(lump)} bytes, not a multiple of {record.size}")
        return list(record.iter_unpack(lump))

    def _offsets(self, entities: list[dict[str, str]]) -> dict[int, Point]:
        """Returns the offsets of faces of doors and other models that turn about a point."""
        offsets: dict[int, Point] = {}
        for entity in entities:
            name = entity.get("model", "")
            if not re.fullmatch(r"\*\d+", name) or "origin" not in entity:
                continue
            if len(name) > 10 or int(name[1:]) >= len(self._models):
                raise Problem(f"an entity has model {name:.10}, but there are {len(self._models)}")
            first, count = self._models[int(name[1:])][6:8]
            if first < 0 or count < 0 or first + count > len(self._faces):
                raise Problem(
                    f"model {name} has faces {first} to {first + count - 1}, which do not all exist"
                )
            offsets.update(dict.fromkeys(range(first, first + count), _origin(entity)))
        return offsets

    def _add(self, face: tuple[int, ...], offset: Point, level: Level) -> None:
        texture, _, kind, first, count, first_index, indices, width, height = face
        if not 0 <= texture < len(self._textures):
            raise Problem(f"the texture is {texture}, but the map has {len(self._textures)}")
        if first < 0 or count < 0 or first + count > len(self._vertices):
            raise Problem(
                f"there are vertices {first} to {first + count - 1}, but the map has "
                f"{len(self._vertices)}"
            )
        name, flags = self._textures[texture]
        corners = [
            (x + offset[0], y + offset[1], z + offset[2])
            for x, y, z in self._vertices[first : first + count]
        ]
        if kind in (_POLYGON, _TRIANGLES):
            what = "polygons" if kind == _POLYGON else "triangle meshes"
            triangles = self._indexed(first_index, indices, count)
        elif kind == _PATCH:
            what = "patches"
            corners, triangles = _tessellated(corners, width, height, self._squares)
        elif kind == _BILLBOARD:
            what, triangles = "billboards (left out)", []
        else:
            raise Problem(f"the type is {kind}, but must be from 1 to 4")
        if flags & _SKY:
            what = "sky (left out)"
        elif flags & _NOT_DRAWN:
            what = "not drawn (left out)"
        level.faces[what] += 1
        level.triangles[what] += len(triangles)
        if "left out" in what or not triangles:
            return
        level.mesh.colors.setdefault(name, color_of_texture(name))
        numbers = [level.mesh.vertex(corner) for corner in corners]
        level.mesh.faces += [(name, [numbers[corner] for corner in one]) for one in triangles]

    def _indexed(self, first: int, count: int, vertices: int) -> list[tuple[int, int, int]]:
        if first < 0 or count < 0 or first + count > len(self._indices) or count % 3:
            raise Problem(
                f"there are mesh indices {first} to {first + count - 1}, but the map has "
                f"{len(self._indices)}, three for each triangle"
            )
        indices = self._indices[first : first + count]
        if indices and not 0 <= min(indices) <= max(indices) < vertices:
            raise Problem(
                f"there are mesh indices from {min(indices)} to {max(indices)}, but the face has "
                f"{vertices} vertices"
            )
        return list(zip(indices[::3], indices[1::3], indices[2::3], strict=True))


def _tessellated(
    points: list[Point], width: int, height: int, squares: int
) -> tuple[list[Point], list[tuple[int, int, int]]]:
    """Samples a grid of biquadratic Bezier patches, and makes the triangles between the samples.

    Samples on an edge depend only on the control points of that edge, in an order that is the same
    from both sides, so neighboring patches of the same level share their samples.
    """
    if min(width, height) < 3 or not width & height & 1 or width * height != len(points):
        raise Problem(
            f"there is a patch of {width} x {height} control points with {len(points)} vertices, "
            "but both numbers must be odd, at least 3, and their product that of the vertices"
        )
    rows = [_curve(points[row * width : (row + 1) * width], squares) for row in range(height)]
    across = len(rows[0])
    columns = [_curve([row[column] for row in rows], squares) for column in range(across)]
    down = len(columns[0])
    samples = [columns[column][row] for row in range(down) for column in range(across)]
    triangles = []
    for row in range(down - 1):
        for column in range(across - 1):
            corner = row * across + column
            below = corner + across
            triangles += [(corner, below, corner + 1), (corner + 1, below, below + 1)]
    return samples, triangles


def _curve(points: list[Point], squares: int) -> list[Point]:
    """Samples a row of quadratic Bezier curves, each of which shares a point with the next."""
    samples = [points[0]]
    for first in range(0, len(points) - 2, 2):
        start, middle, end = points[first : first + 3]
        for step in range(1, squares + 1):
            t = step / squares
            a, b, c = (1 - t) ** 2, 2 * t * (1 - t), t**2
            x, y, z = ((a * p + c * r) + b * q for p, q, r in zip(start, middle, end, strict=True))
            samples.append((x, y, z))
    return samples


def _entities(text: str) -> list[dict[str, str]]:
    entities: list[dict[str, str]] = []
    inside: dict[str, str] | None = None
    key: str | None = None
    for word in re.findall(r'[{}]|"[^"]*"', text.rstrip("\0")):
        if word == "{" and inside is None:
            inside = {}
        elif word == "}" and inside is not None and key is None:
            entities.append(inside)
            inside = None
        elif word[0] == '"' and inside is not None and key is None:
            key = word[1:-1]
        elif word[0] == '"' and inside is not None and key is not None:
            inside[key] = word[1:-1]
            key = None
        else:
            raise Problem(f"its list of entities has {word} in a wrong place")
    if inside is not None:
        raise Problem("its list of entities ends within an entity")
    return entities


def _origin(entity: dict[str, str]) -> Point:
    try:
        x, y, z = (_finite(part) for part in entity["origin"].split())
    except ValueError:
        raise Problem(
            f"an entity has the origin '{entity['origin']}', but must have three numbers"
        ) from None
    return x, y, z


def _number(entity: dict[str, str], key: str) -> float:
    """Returns the number of a key; 0 if it is missing or invalid."""
    try:
        return _finite(entity.get(key, "0"))
    except ValueError:
        return 0.0


def _finite(text: str) -> float:
    """Returns a finite number. Raises ValueError for any other text."""
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(text)
    return number


def read_map(archive: Path, member: str) -> bytes:
    """Returns the bytes of a map in an archive."""
    try:
        with zipfile.ZipFile(archive) as opened:
            if opened.getinfo(member).file_size > _LARGEST_MAP:
                raise Problem(f"{archive}: {member} holds more than {_LARGEST_MAP >> 20} MiB")
            return opened.read(member)
    except KeyError:
        raise Problem(f"{archive}: it has no {member}; is this another package?") from None
    except (OSError, RuntimeError, zipfile.BadZipFile, zlib.error) as error:
        raise Problem(f"{archive}: it cannot be read ({error})") from None


def main(arguments: list[str]) -> int:
    """Runs the command line; returns the exit code."""
    if len(arguments) != 3:
        print("usage: quake3_bsp ARCHIVE.pk3 maps/NAME.bsp OUTPUT.obj", file=sys.stderr)
        return 2
    archive, member = Path(arguments[0]), arguments[1]
    try:
        data = read_map(archive, member)
        try:
            level = convert(data)
        except Problem as problem:
            raise Problem(f"{archive}: {member}: {problem}; use a whole, unchanged file") from None
        level.mesh.write(Path(arguments[2]))
    except (Problem, OSError) as problem:
        print(f"error: {problem}", file=sys.stderr)
        return 2
    print(level.report())
    for camera in level.starts():
        print(json.dumps(camera))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
