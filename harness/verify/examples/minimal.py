"""Finds the fewest triangles over which a program is still wrong about one ray.

Triangles are left out, at first half of them at a time, as long as the claim's class stays the
same. Writes scene.obj, rays.csv and hits.csv, which `beambench verify` reads, and case.json: the
program's claim, the correct hit, and the commands that reproduce the case.

    python minimal.py --work build/programs --program 'tinybvh bvh8' --scene bumpy:triangles=1000 \\
        --rays inside -o results/published/programs/minimal/tinybvh
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from measure import (
    Measurement,
    add_common_options,
    call,
    hits_in,
    places_of,
    read_hits,
    read_obj,
    read_rays,
    write_rays,
)

AROUND = 16  # number of rays next to the ray in question
AROUND_BY = 1e-3  # of the length of the ray's direction


def write_obj(path: Path, corners: np.ndarray) -> None:
    """Writes triangles, each vertex once."""
    vertices, faces = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    lines = ["v " + " ".join(f"{number:.9g}" for number in vertex) for vertex in vertices]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces.reshape(-1, 3)]
    path.write_text("\n".join(lines) + "\n", "utf-8")


def around(ray: np.ndarray) -> np.ndarray:
    """Returns rays with the origin of this ray, in a cone around it."""
    direction = ray[4:7].astype(np.float64)
    side = np.cross(direction, np.eye(3)[np.abs(direction).argmin()])
    side /= np.linalg.norm(side)
    up = np.cross(direction, side)
    angles = 2 * np.pi * (np.arange(AROUND) + 0.5) / AROUND
    length = np.linalg.norm(direction)
    offsets = np.cos(angles)[:, None] * side * length + np.sin(angles)[:, None] * up
    rays = np.repeat(ray[None], AROUND, axis=0)
    rays[:, 4:7] = direction + AROUND_BY * offsets
    return rays


class Case:
    """A program, one ray, and the properties to be preserved."""

    def __init__(self, measurement: Measurement, program: dict[str, Any], ray: np.ndarray) -> None:
        """Initializes the case in a temporary folder, which is deleted with the object."""
        self.measurement, self.program = measurement, program
        self.kept = tempfile.TemporaryDirectory()
        folder = Path(self.kept.name)
        self.obj, self.rays = folder / "scene.obj", folder / "r.rays"
        self.neighbors, self.hits = folder / "around.rays", folder / "h.hits"
        write_rays(self.rays, ray[None], "one ray")
        write_rays(self.neighbors, around(ray), "around it")

    def examined(self, corners: np.ndarray) -> dict[str, Any]:
        """Returns the claim over these triangles: its class, and both hits."""
        write_obj(self.obj, corners)
        scene = str(self.obj)
        version = self.measurement.run(self.program, scene, self.obj, self.rays, self.hits)
        verified = self.measurement.verify(scene, self.rays, self.hits)
        example = (verified["examples"] or [{"class": "agree"}])[0]
        lost = verified["hits"] == 1 and hits_in(self.hits) == 0
        return {"version": version, "lost": lost, **example}

    def is_surrounded(self) -> bool:
        """Returns whether all rays around the ray hit the triangles examined last."""
        out = self.hits.with_name("around.hits")
        command = ["hits", str(self.obj), "--rays", str(self.neighbors), "-o", str(out)]
        call([self.measurement.beambench, *command])
        return hits_in(out) == AROUND


def fewest(count: int, holds: Callable[[np.ndarray], bool]) -> np.ndarray:
    """Returns indices for which `holds` is true, and becomes false if any of them is left out."""
    left, size = np.arange(count), count // 2
    while size >= 1:
        at, shrunk = 0, False
        while at < len(left):
            rest = np.delete(left, slice(at, at + size))
            if len(rest) and holds(rest):
                left, shrunk = rest, True
            else:
                at += size
        size = size if shrunk and size == 1 else size // 2
    return left


def main() -> int:
    """Returns the exit code: 0 for success, 2 if the program is not wrong about the ray."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add_common_options(parser)
    parser.add_argument("--program", required=True, help="name of the program")
    parser.add_argument("--scene", required=True)
    parser.add_argument("--rays", required=True, help="kind of rays, as measure.py names them")
    parser.add_argument(
        "--index", type=int, help="index of the ray (default: the first disputed ray)"
    )
    parser.add_argument(
        "--lost", action="store_true", help="look for a hit that the program does not find"
    )
    parser.add_argument(
        "--surrounded",
        action="store_true",
        help="keep the triangles around the ray: rays next to it must hit, so a miss is a gap",
    )
    parser.add_argument("-o", dest="out", type=Path, required=True, help="folder to write")
    arguments = parser.parse_args()
    programs = json.loads(arguments.programs.read_text("utf-8"))["programs"]
    program = next((one for one in programs if one["name"] == arguments.program), None)
    if program is None:
        parser.error(f"no program {arguments.program} in {arguments.programs}")
    measurement = Measurement(arguments.work, places_of(arguments))
    vertices, faces = read_obj(measurement.mesh(arguments.scene))
    corners = vertices[faces]
    rays = read_rays(measurement.rays(arguments.scene, arguments.rays))
    candidates = [arguments.index]
    if arguments.index is None:
        row = measurement.cell(program, arguments.scene, arguments.rays)
        candidates = [one["index"] for one in row["examples"] if one["class"] != "tie"]
    for index in candidates:
        case = Case(measurement, program, rays[index])
        whole = case.examined(corners)

        def holds(some: np.ndarray, case: Case = case, whole: dict[str, Any] = whole) -> bool:
            found = case.examined(corners[some])
            same = found["class"] == whole["class"] and found["lost"] == whole["lost"]
            return same and (not arguments.surrounded or case.is_surrounded())

        if whole["class"] in ("agree", "tie") or arguments.lost > whole["lost"]:
            continue
        if not holds(np.arange(len(corners))):
            continue
        left = fewest(len(corners), holds)
        break
    else:
        print("error: the program is right about these rays over the triangles alone")
        return 2

    found = case.examined(corners[left])
    arguments.out.mkdir(parents=True, exist_ok=True)
    write_obj(arguments.out / "scene.obj", corners[left])
    numbers = ",".join(f"{number:.9g}" for number in rays[index])
    head = "ox,oy,oz,t_min,dx,dy,dz,t_max"
    (arguments.out / "rays.csv").write_text(f"{head}\n{numbers}\n", "utf-8")
    hit = read_hits(case.hits)
    cells = [f"{number:.9g}" if np.isfinite(hit[0][0]) else "" for number in hit[0].item()]
    text = ",".join(hit.dtype.names) + "\n" + ",".join(cells) + "\n"
    (arguments.out / "hits.csv").write_text(text, "utf-8")
    record = {
        "program": found["version"],
        "found_in": {"scene": arguments.scene, "rays": arguments.rays, "ray": int(index)},
        "triangles": len(left),
        "class": found["class"],
        "reason": found["reason"],
        "claim": found["reported"],
        "right": found.get("exact") or found["oracle"],
        "repeat": [
            "beambench rays scene.obj --rays rays.csv -o r.rays",
            program["command"].format(
                **{"mesh": "scene.obj", "scene": "scene.obj", "rays": "r.rays", "hits": "h.hits"},
                **{"beambench": "beambench", "python": "python", "build": "build"},
                here="harness/verify/examples",
            ),
            "beambench verify scene.obj --rays r.rays --hits h.hits",
        ],
        "verify": "beambench verify scene.obj --rays rays.csv --hits hits.csv",
    }
    text = json.dumps(record, indent=1, ensure_ascii=False)
    (arguments.out / "case.json").write_text(text + "\n", "utf-8")
    print(f"{len(left)} triangles, {record['class']}: {record['reason']}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
