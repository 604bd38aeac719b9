"""Writes a wavy height field of any size as glTF.

usage: .venv/bin/python tests/python/large_glb.py SQUARES OUTPUT.glb

SQUARES is the number of squares along each side, of two triangles each (3163: 20,009,138 in all).
"""

from __future__ import annotations

import json
import struct
import sys
from pathlib import Path

import numpy as np

_FLOAT, _UNSIGNED = 5126, 5125  # glTF's numbers of component types


def height_field(squares: int) -> tuple[np.ndarray, np.ndarray]:
    """Returns vertices, (n, 3) float32, and triangles, (m, 3) uint32."""
    along = np.linspace(-1, 1, squares + 1, dtype=np.float32)
    x, z = np.meshgrid(along, along)
    y = 0.08 * np.sin(9 * x) * np.cos(7 * z) + 0.004 * np.sin(300 * x + 200 * z)
    first = (np.arange(squares)[:, None] * (squares + 1) + np.arange(squares)).astype("<u4").ravel()
    below = first + squares + 1
    corners = [first, below, first + 1, first + 1, below, below + 1]
    vertices = np.stack([x, y, z], -1).astype("<f4").reshape(-1, 3)
    return vertices, np.stack(corners, -1).reshape(-1, 3)


def write_glb(path: Path, vertices: np.ndarray, triangles: np.ndarray) -> None:
    chunks = [vertices.tobytes(), triangles.tobytes()]
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": _FLOAT,
                "count": len(vertices),
                "type": "VEC3",
                "min": vertices.min(0).tolist(),
                "max": vertices.max(0).tolist(),
            },
            {
                "bufferView": 1,
                "componentType": _UNSIGNED,
                "count": triangles.size,
                "type": "SCALAR",
            },
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": len(chunks[0])},
            {"buffer": 0, "byteOffset": len(chunks[0]), "byteLength": len(chunks[1])},
        ],
        "buffers": [{"byteLength": sum(map(len, chunks))}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = sum(map(len, chunks))
    with path.open("wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + binary))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", binary, b"BIN\0"))
        for chunk in chunks:
            file.write(chunk)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    write_glb(Path(sys.argv[2]), *height_field(int(sys.argv[1])))
