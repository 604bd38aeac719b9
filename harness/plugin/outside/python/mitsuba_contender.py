"""Mitsuba 3 on one thread: Embree, in float, a wavefront compiled by LLVM. Its rays have no t_min."""

from importlib.metadata import version

import contender_program as program
import drjit as dr
import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
dr.set_thread_count(1)


def build(mesh):
    shape = mi.Mesh("triangles", len(mesh.vertices), len(mesh.triangles))
    values = mi.traverse(shape)
    values["vertex_positions"] = mesh.vertices.ravel()
    values["faces"] = mesh.triangles.ravel()
    values.update()
    scene = mi.load_dict({"type": "scene", "triangles": shape})
    dr.sync_thread()
    return scene


def converted(rays):
    program.without_t_min(rays)
    columns = [mi.Float(np.ascontiguousarray(rays[:, i])) for i in range(8)]
    reach = mi.Float(np.minimum(rays[:, 7], np.finfo("f4").max))
    return mi.Ray3f(mi.Point3f(*columns[0:3]), mi.Vector3f(*columns[4:7]), reach, 0.0, mi.Color0f())


def closest(built, rays):
    found = built.ray_intersect_preliminary(converted(rays), coherent=False)
    return np.array(found.t), np.array(found.prim_index)


def occluded(built, rays):
    return np.array(built.ray_test(converted(rays), coherent=False))


program.serve(
    program.Library(
        "mitsuba",
        "Mitsuba 3 of PyPI: llvm_ad_rgb on one thread, Embree, float",
        f"mitsuba {version('mitsuba')}",
        build,
        closest,
        occluded,
    )
)
