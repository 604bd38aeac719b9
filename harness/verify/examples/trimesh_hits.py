"""Traces the rays of a .rays file with trimesh and writes the hits for `beambench verify --hits`.

    beambench export SCENE -o scene.obj
    beambench rays SCENE --rays random -o r.rays
    python trimesh_hits.py scene.obj r.rays -o trimesh.hits
    beambench verify SCENE --rays r.rays --hits trimesh.hits

Needs trimesh, and rtree for its own engine or embreex for Embree. Prints one line of JSON: the
versions, and the times. README.md, in this folder, explains the treatment of t_min and t_max.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import json
import sys
import time
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

RAYS_LINE = b"beambench-rays 1\n"
NO_TRIANGLE = 0xFFFFFFFF
HIT = np.dtype([("point", "<f4", 3), ("triangle", "<u4")])
PROGRESS_SECONDS = 10.0
# trimesh's own engine holds about 500 bytes per tested triangle for all rays of a call.
TESTS_OF_A_CALL = 1_000_000

# trimesh is imported where it is used, so that --help works without it.
Hits = tuple[np.ndarray, np.ndarray, np.ndarray]  # the triangle, the ray and the point of each hit


class ProblemError(Exception):
    """Raised for a problem with the files, which the message states in a sentence."""


def open_rays(path: Path) -> tuple[BinaryIO, dict[str, Any]]:
    """Returns the file, opened at its first ray, and the JSON before the rays."""
    file = path.open("rb")
    if file.readline(64) != RAYS_LINE:
        raise ProblemError(f"{path} is not a .rays file of beambench")
    header = json.loads(file.readline())
    expected = file.tell() + 32 * header["rays"]
    if path.stat().st_size != expected:
        raise ProblemError(f"{path} has {path.stat().st_size} bytes instead of {expected}")
    return file, header


def load_triangles(path: Path) -> Any:  # noqa: ANN401
    """Returns the mesh with its faces in the order of the file."""
    import trimesh

    mesh = trimesh.load_mesh(path, process=False, maintain_order=True)
    with path.open(encoding="utf-8") as lines:
        faces = sum(line.startswith("f ") for line in lines)
    if len(mesh.faces) != faces:
        raise ProblemError(f"trimesh reads {len(mesh.faces)} of the {faces} faces of {path}")
    # The scene's coordinates are floats; the file has enough digits for them.
    mesh.vertices = mesh.vertices.astype(np.float32).astype(np.float64)
    return mesh


class Tracer:
    """One of trimesh's engines over a mesh."""

    def __init__(self, mesh: Any, engine: str) -> None:  # noqa: ANN401
        """`engine` is `rtree` or `embree`."""
        if engine == "rtree":
            from trimesh.ray.ray_triangle import RayMeshIntersector

            self.packages = ["trimesh", "rtree"]
            self.rays_of_a_call = max(16, min(4096, TESTS_OF_A_CALL // max(1, len(mesh.faces))))
        else:
            from trimesh.ray.ray_pyembree import RayMeshIntersector

            self.packages = ["trimesh", "embreex"]
            self.rays_of_a_call = 1 << 16
        # Requests all hits from trimesh's own engine, so that a hit before t_min does not hide
        # those behind it. The other engine finds further hits by moving the origin, so only its
        # first hit is requested.
        self.all_hits = engine == "rtree"
        self.intersector = RayMeshIntersector(mesh)
        self.intersections(np.zeros((1, 3)), np.ones((1, 3)))  # builds the engine's tree

    def intersections(self, origins: np.ndarray, directions: np.ndarray) -> Hits:
        """Returns the hits of rays without ends, in arbitrary order."""
        triangles, rays, points = self.intersector.intersects_id(
            origins, directions, multiple_hits=self.all_hits, return_locations=True
        )
        return triangles, rays, np.reshape(points, (-1, 3))

    def closest(self, rays: np.ndarray) -> np.ndarray:
        """Returns the closest hit of each ray in [t_min, t_max]."""
        origins, t_min = rays[:, 0:3], rays[:, 3]
        directions, t_max = rays[:, 4:7], rays[:, 7]
        starts = origins + t_min[:, None] * directions
        triangles, of_ray, points = self.intersections(starts, directions)
        along = np.einsum("ij,ij->i", points - origins[of_ray], directions[of_ray])
        t = along / np.einsum("ij,ij->i", directions, directions)[of_ray]
        inside = (t >= t_min[of_ray]) & (t <= t_max[of_ray])
        order = np.flatnonzero(inside)
        order = order[np.lexsort((triangles[order], t[order], of_ray[order]))]
        which, first = np.unique(of_ray[order], return_index=True)
        hits = np.zeros(len(rays), HIT)
        hits["point"], hits["triangle"] = np.inf, NO_TRIANGLE
        hits["point"][which] = points[order[first]]
        hits["triangle"][which] = triangles[order[first]]
        return hits


def trace(mesh_path: Path, rays_path: Path, hits_path: Path, engine: str) -> dict[str, Any]:
    """Writes the hit file, completely or not at all, and returns the values to print."""
    file, header = open_rays(rays_path)
    mesh = load_triangles(mesh_path)
    begin = time.perf_counter()
    tracer = Tracer(mesh, engine)
    build_seconds = time.perf_counter() - begin
    any_hits = header["query"] == "any"
    count = header["rays"]
    columns = ["occluded"] if any_hits else ["x", "y", "z", "triangle"]
    partial = hits_path.with_name(hits_path.name + ".partial")
    seconds, reported = 0.0, time.monotonic()
    with file, partial.open("wb") as out:
        out.write(b"beambench-hits 1\n")
        out.write(json.dumps({"hits": count, "columns": columns}).encode() + b"\n")
        for done in range(0, count, tracer.rays_of_a_call):
            some = np.fromfile(file, "<f4", 8 * min(tracer.rays_of_a_call, count - done))
            begin = time.perf_counter()
            hits = tracer.closest(some.reshape(-1, 8).astype(np.float64))
            seconds += time.perf_counter() - begin
            found = hits["triangle"] != NO_TRIANGLE
            out.write((found.astype(np.uint8) if any_hits else hits).tobytes())
            if time.monotonic() - reported > PROGRESS_SECONDS:
                reported = time.monotonic()
                print(f"{done + len(hits):,} of {count:,} rays", file=sys.stderr, flush=True)
    partial.replace(hits_path)
    version = " ".join(f"{name} {importlib.metadata.version(name)}" for name in tracer.packages)
    return {
        "version": version,
        "triangles": len(mesh.faces),
        "rays": count,
        "build_seconds": round(build_seconds, 3),
        "trace_seconds": round(seconds, 3),
    }


def main() -> int:
    """Returns the exit code: 0 for success, 2 for invalid arguments or input."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("mesh", type=Path, help="OBJ file that `beambench export` wrote")
    parser.add_argument("rays", type=Path, help=".rays file")
    parser.add_argument("-o", dest="hits", type=Path, required=True, help=".hits file to write")
    parser.add_argument(
        "--engine",
        choices=("rtree", "embree"),
        default="rtree",
        help="trimesh's own, which needs rtree, or Embree through embreex (default: rtree)",
    )
    arguments = parser.parse_args()
    try:
        print(json.dumps(trace(arguments.mesh, arguments.rays, arguments.hits, arguments.engine)))
    except ModuleNotFoundError as problem:
        print(f"error: {problem.name} is missing; install it with pip", file=sys.stderr)
        return 2
    except (ProblemError, OSError, ValueError) as problem:
        print(f"error: {problem}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
