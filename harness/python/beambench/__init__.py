"""Ray tracing acceleration structures, and the verification of hits from any program.

    import beambench as bb

    scene = bb.Scene.from_triangles(vertices, triangles)
    rays = bb.rays(origins, directions)
    report = bb.verify(scene, rays, t=t, primitive=ids)
    print(report)

Rays are arrays of shape (N, 8), float32: origin, t_min, direction, t_max. A hit is a `t` and the
index of a primitive; a miss is `t` = inf and `NO_PRIMITIVE`. Invalid numbers, names and files raise
`InputError`, a ValueError whose message is one sentence; wrong types raise TypeError. Long work
runs without the GIL, and Ctrl-C ends it.
"""

from beambench._beambench import NO_PRIMITIVE, InputError
from beambench._beambench import version as _version
from beambench.catalogue import (
    Parameter,
    RayKindInfo,
    SceneInfo,
    StructureInfo,
    ray_kinds,
    scenes,
    structures,
)
from beambench.explain import Page, explain
from beambench.picture import to_srgb
from beambench.ray_arrays import rays
from beambench.scene import Camera, Scene
from beambench.structure import Hits, Structure
from beambench.sweeps import sweep
from beambench.verification import CLASSES, Example, Report, verify

__version__: str = _version()
"""The version of beambench."""

__all__ = [
    "CLASSES",
    "NO_PRIMITIVE",
    "Camera",
    "Example",
    "Hits",
    "InputError",
    "Page",
    "Parameter",
    "RayKindInfo",
    "Report",
    "Scene",
    "SceneInfo",
    "Structure",
    "StructureInfo",
    "__version__",
    "explain",
    "ray_kinds",
    "rays",
    "scenes",
    "structures",
    "sweep",
    "to_srgb",
    "verify",
]
