"""Builds a small Quake 3 map for tests: a wall, a curved arch, a mesh, a lamp and the sky."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

ENTITIES = """{
"classname" "worldspawn"
"message" "A test"
}
{
"classname" "info_player_deathmatch"
"origin" "10 20 30"
"angle" "90"
}
{
"classname" "func_door"
"model" "*1"
"origin" "1000 0 0"
}
"""
SKY, NOT_DRAWN = 0x4, 0x80
POLYGON, PATCH, MESH, BILLBOARD = 1, 2, 3, 4
Point = tuple[float, float, float]


@dataclass
class Bsp:
    """The lumps of a map, as lists; `bytes` assembles them as the game's tools do."""

    entities: str = ""
    textures: list[tuple[str, int]] = field(default_factory=list)
    vertices: list[Point] = field(default_factory=list)
    indices: list[int] = field(default_factory=list)
    faces: list[tuple[int, int, int, int, int, int, int, int]] = field(default_factory=list)
    models: list[tuple[int, int]] = field(default_factory=list)

    def face(
        self,
        texture: int,
        kind: int,
        corners: list[Point],
        indices: tuple[int, ...] = (),
        size: tuple[int, int] = (0, 0),
    ) -> None:
        self.faces.append(
            (
                texture,
                kind,
                len(self.vertices),
                len(corners),
                len(self.indices),
                len(indices),
                *size,
            )
        )
        self.vertices += corners
        self.indices += indices

    def bytes(self) -> bytes:
        lumps = dict.fromkeys(range(17), b"")
        lumps[0] = self.entities.encode() + b"\0"
        lumps[1] = b"".join(struct.pack("<64sii", n.encode(), f, 1) for n, f in self.textures)
        lumps[7] = b"".join(struct.pack("<6f4i", *[0.0] * 6, *m, 0, 0) for m in self.models)
        lumps[10] = b"".join(struct.pack("<3f", *v) + bytes(32) for v in self.vertices)
        lumps[11] = b"".join(struct.pack("<i", i) for i in self.indices)
        lumps[13] = b"".join(
            struct.pack("<7i", face[0], -1, *face[1:6]) + bytes(68) + struct.pack("<2i", *face[6:])
            for face in self.faces
        )
        header, body = b"IBSP" + struct.pack("<i", 46), b""
        for lump in lumps.values():
            header += struct.pack("<ii", 8 + 8 * 17 + len(body), len(lump))
            body += lump + bytes(-len(lump) % 4)
        return header + body


def square(x: float) -> list[Point]:
    return [(x, 0.0, 0.0), (x, 8.0, 0.0), (x, 8.0, 8.0), (x, 0.0, 8.0)]


def arch(top: float) -> list[Point]:
    """Returns 3 x 3 control points of a quarter pipe; points at y = 0 do not depend on `top`."""
    return [
        (x, y, z)
        for y in (0.0, 4.0, 8.0)
        for x, z in ((0.0, 0.0), (0.0, top if y else 8.0), (8.0, 8.0))
    ]


def small_map() -> Bsp:
    bsp = Bsp(
        entities=ENTITIES,
        textures=[
            ("textures/base/wall", 0),
            ("textures/sky", SKY),
            ("textures/common/caulk", NOT_DRAWN),
        ],
    )
    bsp.face(0, POLYGON, square(0), (0, 1, 2, 2, 3, 0))
    bsp.face(0, PATCH, arch(8.0), size=(3, 3))
    bsp.face(0, MESH, [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 1.0)], (0, 1, 2))
    bsp.face(0, BILLBOARD, [(0.0, 0.0, 0.0)])
    bsp.face(1, POLYGON, square(50), (0, 1, 2, 2, 3, 0))
    bsp.face(2, POLYGON, square(60), (0, 1, 2))
    bsp.face(0, POLYGON, square(5), (0, 1, 2, 2, 3, 0))
    bsp.models = [(0, 6), (6, 1)]
    return bsp
