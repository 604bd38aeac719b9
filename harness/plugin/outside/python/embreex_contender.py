"""embreex: Embree 4 for Python, in float. Its rays have t_max and no t_min."""

import sys
from importlib.metadata import version

import contender_program as program
import numpy as np
from embreex import rtcore_scene
from embreex.mesh_construction import TriangleMesh


def build(mesh):
    scene = rtcore_scene.EmbreeScene()
    kept = TriangleMesh(scene, mesh.vertices, mesh.triangles.astype(np.int32))
    return scene, kept


def closest(built, rays):
    program.without_t_min(rays)
    found = built[0].run(
        np.ascontiguousarray(rays[:, :3]), np.ascontiguousarray(rays[:, 4:7]),
        dists=np.ascontiguousarray(np.minimum(rays[:, 7], np.finfo("f4").max)),
        query="INTERSECT", output=True,
    )  # fmt: skip
    hit = found["primID"] >= 0
    return np.where(hit, found["tfar"], np.inf), found["primID"]


def occluded(built, rays):
    return np.isfinite(closest(built, rays)[0])  # the query OCCLUDED ignores distances


program.serve(
    program.Library(
        "embreex",
        "embreex of PyPI: Embree 4, float; any-hit queries by closest hits",
        f"embreex {version('embreex')}, Python {sys.version_info[0]}.{sys.version_info[1]}",
        build,
        closest,
        occluded,
    )
)
