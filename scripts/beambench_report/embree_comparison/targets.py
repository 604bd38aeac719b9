"""The ratios to Embree's fastest mode that tile beams should reach."""

from collections.abc import Mapping
from dataclasses import dataclass

from beambench_report.base.published import primitives_by_scene
from beambench_report.embree_comparison.pairings import MIRROR, PICTURE, PRIMARY, SHADOW, Pairing

SMALL, MIDDLE, LARGE = "320x200", "1280x1024", "3840x2160"
_HELD_TO_LESS = 0.5

SPHERES_ARE_WEAK = (
    "Against a weak baseline: a sphere of Embree's is its point geometry, which does not gain from "
    "AVX-512."
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
    """The same for the geometric mean of all scenes; empty if none is set."""
    note: str = ""
    kind: str = PRIMARY
    """The kind of rays."""

    def holds(self, one: Pairing) -> bool:
        """Is there a target for this?"""
        return one.kind == self.kind and one.scene in self.scenes and one.resolution in self.targets


def part_of_targets(isa: str) -> float:
    """Half of the targets applies if both are limited to an instruction set below the best."""
    return 1.0 if isa == "best" else _HELD_TO_LESS


def groups() -> list[Group]:
    """The targets, in order. `escena1` of the thesis has the targets of the spheres."""
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
            "Three of the six scenes are the same bumpy sphere at different sizes, so that the "
            "geometric mean gives it half the weight.",
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
            f"Of polygons, but where spheres are named. {SPHERES_ARE_WEAK}",
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
            "Embree has the cones as its linear curves, which it closes and tests in single "
            "precision, with directions of unit length.",
        ),
        *_of_pencils(),
    ]


def _of_pencils() -> list[Group]:
    """Rays through one point other than the eye, and pictures, which contain such rays."""
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
            "Primary, shadow, mirror and refracted rays, of which planar mirrors and lights make "
            "pencils. The shading that is left out is measured once for each picture.",
            PICTURE,
        ),
    ]


_TESSELLATED = "tessellated-balls:seed=1999,slices=16,spheres=430"
_ROOM = "closed-room:detail=8"
_ESCENA1 = "escena1:seed=1999,spheres=430"
_OF_SPHERES = {"escena2": "spheres and a polygon", "caracol": "spheres"}
