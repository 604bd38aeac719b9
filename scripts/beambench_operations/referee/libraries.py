"""The libraries of the referee's table: how each is installed, computes, and traces rays."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Library:
    """The facts that the page states about a library besides its results."""

    install: str
    """The command that prints its plug-in."""
    precision: str
    traced: str
    """How a batch is traced, and what the time includes."""


_CALLS = "a call for each ray, including conversion"
_BATCH = "one call, including conversion in Python, self-reported"

LIBRARIES = {
    "obvhs": Library("scripts/outside obvhs", "float", f"CWBVH, {_CALLS}"),
    "parry3d": Library("scripts/outside parry3d", "float", f"TriMesh, {_CALLS}"),
    "bvh-rs": Library("scripts/outside bvh", "float", f"all leaves met, {_CALLS}"),
    "tinybvh": Library("TINYBVH=DIR scripts/outside tinybvh", "float", _CALLS),
    "madmann91-bvh": Library("MADMANN91_BVH=DIR/src scripts/outside madmann91-bvh", "float",
                             _CALLS),
    "cgal": Library("scripts/outside cgal", "double", f"AABB tree, {_CALLS}"),
    "embreex": Library("scripts/outside embreex", "float", f"Embree 4, {_BATCH}"),
    "open3d": Library("scripts/outside open3d", "float", f"Embree, {_BATCH}"),
    "mitsuba": Library("scripts/outside mitsuba", "float", f"llvm_ad_rgb with Embree, {_BATCH}"),
    "vtk": Library("scripts/outside vtk", "double",
                   "vtkStaticCellLocator, a call for each ray from Python, self-reported"),
    "trimesh": Library("scripts/outside trimesh", "double",
                       f"its own intersector over an R-tree, without embreex, {_BATCH}"),
    "three-mesh-bvh": Library("scripts/outside three-mesh-bvh", "vertices float, tests double",
                              "a call for each ray from JavaScript, self-reported"),
}  # fmt: skip
"""The libraries, by the names of their structures."""

PRECISIONS = {"tinybvh:layout=double": "double"}
"""The precision of structures with parameters, where it differs from the library's."""


def library(contender: str) -> Library:
    """Returns the library of a structure with parameters. Raises KeyError if it is unknown."""
    return LIBRARIES[contender.partition(":")[0]]


def precision(contender: str) -> str:
    """Returns the precision of a structure with parameters."""
    for name, each in PRECISIONS.items():
        if contender == name or contender.startswith(f"{name},"):
            return each
    return library(contender).precision


def traced(contender: str) -> str:
    """Returns how a structure with parameters traces a batch, and what the time includes."""
    return library(contender).traced
