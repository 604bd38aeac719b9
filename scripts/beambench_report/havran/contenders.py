"""Havran's structures and scenes by our names."""

from beambench_report.base.files import Problem

SCENES = {
    "balls": "balls:n=4",
    "gears": "gears:n=4",
    "lattice": "lattice:n=12",
    "mount": "mount:n=6",
    "rings": "rings:n=7",
    "teapot": "teapot:n=12",
    "tetra": "tetra:n=6",
    "tree": "tree:n=11",
}
# Havran's octrees: the root is the scene's box, bounding boxes assign objects to nodes, and a node
# with one object is a leaf.
_OCTREE = "root=box,assign=bbox,max_objects=1"
_STRUCTURES = {
    "Glassner 1984, center": f"glassner:{_OCTREE}",
    "Glassner 1984, cost-driven planes": f"glassner:{_OCTREE},planes=cost",
    "Samet 1989, center": f"samet:{_OCTREE}",
    "Gargantini and Atkinson 1993, center": f"gargantini:{_OCTREE}",
    "Gargantini and Atkinson 1993, cost-driven planes": f"gargantini:{_OCTREE},planes=cost",
}
STRUCTURES = tuple(_STRUCTURES)
"""The structures that are measured again, by Havran's names."""


def contender_of(structure: str, setting: str) -> str:
    """Returns our structure with its parameters: his root is at depth 0, ours at level 1."""
    word, _, depth = setting.partition(" ")
    if word != "depth" or not depth.isdecimal():
        raise Problem(f"the setting '{setting}' of {structure} is unsupported: expected 'depth N'")
    return f"{_STRUCTURES[structure]},max_level={int(depth) + 1}"
