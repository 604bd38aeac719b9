"""Open3D's RaycastingScene: Embree, in float, on one thread. Its rays are infinite."""

from importlib.metadata import version

import contender_program as program
import numpy as np
import open3d


def build(mesh):
    scene = open3d.t.geometry.RaycastingScene(nthreads=1)
    scene.add_triangles(open3d.core.Tensor(mesh.vertices), open3d.core.Tensor(mesh.triangles))
    return scene


def lines(rays):
    program.without_interval(rays)
    return open3d.core.Tensor(np.ascontiguousarray(rays[:, [0, 1, 2, 4, 5, 6]]))


def closest(built, rays):
    found = built.cast_rays(lines(rays), nthreads=1)
    return found["t_hit"].numpy(), found["primitive_ids"].numpy()


def occluded(built, rays):
    return built.test_occlusions(lines(rays), nthreads=1).numpy()


program.serve(
    program.Library(
        "open3d",
        "Open3D of PyPI: RaycastingScene, Embree, float",
        f"open3d {version('open3d')}",
        build,
        closest,
        occluded,
    )
)
