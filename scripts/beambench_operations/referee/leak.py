"""A leak, reduced to the triangles at the edge that the ray passes.

`verify --minimize` reduces wrong hits. A miss beside the edge of a single triangle is a graze; it
is a leak because the triangles on both sides of the edge are there. The reduced case is a kit of
one scene and one ray.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from beambench_operations.referee.exact_ray import Triangle, closest, vector, weights

Face = tuple[int, int, int]
FOLDER = "leak"
"""The scene's folder in the kit."""


def read_mesh(path: Path) -> tuple[list[str], list[Face]]:
    """Returns the lines of the vertices and the faces of an OBJ file of triangles, from 0."""
    lines = [line.split(maxsplit=1) for line in path.read_text("utf-8").splitlines()]
    vertices = [words[1] for words in lines if words[:1] == ["v"]]
    faces = [words[1].split() for words in lines if words[:1] == ["f"]]
    return vertices, [(int(a) - 1, int(b) - 1, int(c) - 1) for a, b, c in faces]


def leaked_rays(kit: Path, cases: list[dict[str, Any]]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yields the folder and the ray of each leak among the examples of closed scenes."""
    closed = {
        case["folder"]
        for case in json.loads((kit / "kit.json").read_text("utf-8"))["cases"]
        if case["closed"]
    }
    for case in cases:
        folder = case["name"].split(",")[0]
        if case["query"] != "closest" or not case["leaks"] or folder not in closed:
            continue
        for example in case["examples"]:
            if example["class"] == "leak" and example["reported"] is None:
                yield folder, example["ray"]


def around(vertices: list[str], faces: list[Face], ray: dict[str, Any]) -> list[list[Face]]:
    """Returns sets of faces to try, smallest first: those at the nearest edge, those at its ends.

    Vertices are the same if their coordinates are. Nothing is returned if the ray hits no face.
    """
    place = [vector([float(word) for word in line.split()[:3]]) for line in vertices]
    triangles: list[Triangle] = [(place[a], place[b], place[c]) for a, b, c in faces]
    origin, direction = vector(ray["origin"]), vector(ray["direction"])
    hits = [
        (t, triangle)
        for triangle in triangles
        if (t := closest([triangle], ray["origin"], ray["direction"])) is not None
    ]
    if not hits:
        return []
    hit = min(hits)[1]
    sizes = [abs(each) for each in weights(hit, origin, direction)]
    far = sizes.index(min(sizes))  # the corner across from the edge
    ends = {corner for i, corner in enumerate(hit) if i != far}
    at = [[corner in ends for corner in triangle] for triangle in triangles]
    edge = [face for face, found in zip(faces, at, strict=True) if sum(found) == 2]
    fans = [face for face, found in zip(faces, at, strict=True) if any(found)]
    return [edge, fans]


def write_kit(
    out: Path, case: dict[str, Any], vertices: list[str], faces: list[Face], ray: dict[str, Any]
) -> None:
    """Writes a kit of one case, except scene.nff: the faces and the ray."""
    folder = out / FOLDER
    folder.mkdir(parents=True)
    used = sorted({corner for face in faces for corner in face})
    lines = [f"v {vertices[i]}" for i in used]
    lines += ["f " + " ".join(str(used.index(i) + 1) for i in face) for face in faces]
    (folder / "scene.obj").write_text("\n".join(lines) + "\n", "utf-8")
    t_max = float("inf") if ray["t_max"] is None else ray["t_max"]
    numbers = (*ray["origin"], ray["t_min"], *ray["direction"], t_max)
    for query in ("closest", "any"):
        header = {"query": query, "rays": 1, "seed": 0, "may_graze": True}
        text = f"beambench-rays 1\n{json.dumps(header, separators=(',', ':'))}\n"
        (folder / f"{query}.rays").write_bytes(text.encode() + struct.pack("<8f", *numbers))
    entry = {**case, "folder": FOLDER, "polygons": len(faces), "triangles": len(faces)}
    (out / "kit.json").write_text(json.dumps({"cases": [entry]}, indent=2) + "\n", "utf-8")


def reduced(
    kit: Path,
    cases: list[dict[str, Any]],
    leaks: Callable[[dict[str, Any], list[str], list[Face], dict[str, Any]], bool],
) -> tuple[str, dict[str, Any]] | None:
    """Returns the scene and the ray of the first leak that remains with few triangles.

    `leaks` returns whether the library misses all faces of a case, which it may write.
    """
    index = json.loads((kit / "kit.json").read_text("utf-8"))["cases"]
    entries = {case["folder"]: case for case in index}
    for folder, ray in leaked_rays(kit, cases):
        vertices, faces = read_mesh(kit / folder / "scene.obj")
        for chosen in around(vertices, faces, ray):
            if leaks(entries[folder], vertices, chosen, ray):
                return folder, ray
    return None
