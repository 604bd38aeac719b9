"""The ratios to Embree's fastest mode that tile beams should reach."""

from collections.abc import Mapping
from dataclasses import dataclass

from beambench_report.base.published import primitives_by_scene
from beambench_report.embree_comparison.pairings import MIRROR, PICTURE, PRIMARY, SHADOW, Pairing

SMALL, MIDDLE, LARGE = "320x200", "1280x1024", "3840x2160"
_HELD_TO_LESS = 0.5

SPHERES_ARE_WEAK = (
    "The baseline is weak: Embree's spheres are point geometry, which does not gain from AVX-512."
)


@dataclass(frozen=True)
class Group:
    """Scenes that share a target at each resolution.

    A scene is in one group for each kind of rays.
    """

    title: str
    scenes: Mapping[str, str]
    """The title of each scene by its name in records."""
    targets: Mapping[str, float]
    """The ratio that each scene should reach, by resolution."""
    mean_targets: Mapping[str, float]
    """The targets of the geometric mean of all scenes; empty if no target is set."""
    note: str = ""
    kind: str = PRIMARY
    """The kind of rays."""

    def holds(self, one: Pairing) -> bool:
        """Returns whether this group has a target for the pairing."""
        return one.kind == self.kind and one.scene in self.scenes and one.resolution in self.targets


def part_of_targets(isa: str) -> float:
    """Returns the factor for targets: a half if both are limited to a lesser instruction set."""
    return 1.0 if isa == "best" else _HELD_TO_LESS


def groups() -> list[Group]:
    """Returns the groups, in order. The thesis's `escena1` is in the group of spheres."""
    return [
        Group(
            "Scenes of triangles",
            {
                "tetra:n=6": "tetra, 4 k",
                "bumpy:triangles=15680": "bumpy, 16 k",
                "bumpy:triangles=200000": "bumpy, 200 k",
                "bumpy:triangles=1000000": "bumpy, 1 M",
                _TESSELLATED: "tessellated balls, 96 k",
                _ROOM: "closed room, 32 k",
            },
            {SMALL: 4, MIDDLE: 8, LARGE: 12},
            {SMALL: 6, MIDDLE: 12, LARGE: 15},
            "Three of the six scenes are the same bumpy sphere at different sizes, so this "
            "sphere has half the weight in the geometric mean.",
        ),
        Group(
            "Scenes of spheres",
            {_ESCENA1: "escena1", "balls:n=4": "balls", "shells:n=5": "shells"},
            {SMALL: 3, MIDDLE: 8, LARGE: 12},
            {},
            SPHERES_ARE_WEAK,
        ),
        Group(
            "The thesis's other scenes",
            {
                name: f"{name} ({_OF_SPHERES[name]})" if name in _OF_SPHERES else name
                for name in primitives_by_scene()
                if name != "escena1"
            },
            {SMALL: 1, MIDDLE: 4, LARGE: 6},
            {},
            f"Scenes of polygons, except where spheres are named. {SPHERES_ARE_WEAK}",
        ),
        Group(
            "Far more triangles than pixels",
            {"soup:seed=1,triangles=1000000": "soup, 1 M"},
            {"80x50": 1, "160x100": 1, SMALL: 1, MIDDLE: 3},
            {},
        ),
        Group(
            "Scenes of cones and spheres",
            {
                "rings:n=7": "rings",
                "tree:n=11": "tree",
                "lattice:n=12": "lattice",
                "jacks:n=4": "jacks",
            },
            {SMALL: 1, MIDDLE: 1, LARGE: 1},
            {},
            "In Embree, cones are linear curves, which it closes and tests in single precision, "
            "with directions of unit length.",
        ),
        *_of_pencils(),
    ]


def _of_pencils() -> list[Group]:
    """Returns the groups of rays through a point other than the eye, and of whole pictures."""
    return [
        Group(
            "Shadow rays, scenes of triangles",
            {
                "tetra:n=6": "tetra, 4 k",
                _TESSELLATED: "tessellated balls, 96 k",
                _ROOM: "closed room, 32 k",
                "casa-de-campo": "casa-de-campo",
                "ajedrez": "ajedrez",
                "habitacion": "habitacion",
                "teapot:n=12": "teapot",
                "bumpy:triangles=200000": "bumpy, 200 k",
            },
            {SMALL: 1.5, MIDDLE: 2.5},
            {SMALL: 2.5, MIDDLE: 4.5},
            kind=SHADOW,
        ),
        Group(
            "Shadow rays, scenes of spheres",
            {_ESCENA1: "escena1", "balls:n=4": "balls", "shells:n=5": "shells"},
            {SMALL: 3, MIDDLE: 6},
            {},
            SPHERES_ARE_WEAK,
            SHADOW,
        ),
        Group(
            "Rays from planar mirrors",
            {"teapot:n=12": "teapot, 1 mirror"},
            {SMALL: 2, MIDDLE: 4},
            {},
            kind=MIRROR,
        ),
        Group(
            "Rays from small planar mirrors",
            {"habitacion": "habitacion, 214 mirrors"},
            {SMALL: 0.9, MIDDLE: 0.9},
            {},
            kind=MIRROR,
        ),
        Group(
            "Whole pictures, without shading",
            {
                "finishes": "finishes",
                "balls:n=3": "balls, 0.8 k",
                "teapot:n=12": "teapot",
                "habitacion": "habitacion",
                "ajedrez": "ajedrez",
                "casa-de-campo": "casa-de-campo",
            },
            {SMALL: 1.5, MIDDLE: 2.5},
            {SMALL: 1.5, MIDDLE: 2.5},
            "Primary, shadow, mirror and refracted rays; rays of planar mirrors and of lights form "
            "pencils. The time of shading, measured once for each picture, is subtracted.",
            PICTURE,
        ),
    ]


_TESSELLATED = "tessellated-balls:seed=1999,slices=16,spheres=430"
_ROOM = "closed-room:detail=8"
_ESCENA1 = "escena1:seed=1999,spheres=430"
_OF_SPHERES = {"escena2": "spheres and a polygon", "caracol": "spheres"}
