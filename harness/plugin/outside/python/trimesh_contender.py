"""trimesh's own ray tracing, in double, through an R-tree. Its rays are infinite.

Its tolerances are absolute, so directions are normalized.
"""

from importlib.metadata import version

import contender_program as program
import numpy as np
import trimesh


def build(mesh):
    made = trimesh.Trimesh(mesh.vertices.astype("f8"), mesh.triangles, process=False)
    return trimesh.ray.ray_triangle.RayMeshIntersector(made)


def lines(rays):
    program.without_interval(rays)
    directions = rays[:, 4:7].astype("f8")
    return rays[:, :3].astype("f8"), directions / np.linalg.norm(directions, axis=1)[:, None]


def closest(built, rays):
    origins, directions = lines(rays)
    triangles, numbers, places = built.intersects_id(
        origins, directions, multiple_hits=False, return_locations=True
    )
    t, found = np.full(len(rays), np.inf), np.zeros(len(rays), np.int64)
    if len(numbers):
        way = rays[numbers, 4:7].astype("f8")
        t[numbers] = np.einsum("ij,ij->i", places - origins[numbers], way)
        t[numbers] = np.maximum(t[numbers] / np.einsum("ij,ij->i", way, way), 0)  # rounded places
        found[numbers] = triangles
    return t, found


def occluded(built, rays):
    return built.intersects_any(*lines(rays))


program.serve(
    program.Library(
        "trimesh",
        "trimesh of PyPI: its own triangles, an R-tree, double",
        f"trimesh {version('trimesh')}, rtree {version('rtree')}",
        build,
        closest,
        occluded,
    )
)
