"""Scenes from the literature that no registry has: users download and `--from` registers them.

Every fact about them cites its source. Where no checksum is published, the number of triangles
identifies the version, and the checksum of the user's file is stored, so that a later run notices a
different file.
"""

from __future__ import annotations

from dataclasses import dataclass

from beambench_meshes.entry import Camera

_MCGUIRE = "the McGuire Computer Graphics Archive (casual-effects.com/data)"


@dataclass(frozen=True)
class Version:
    """A version of a scene, identified by its number of triangles, with the cameras that fit it."""

    triangles: int
    which: str
    within: int = 0  # allowed difference, where papers print rounded numbers
    up: str = ""
    front: str = ""
    cameras: tuple[Camera, ...] = ()
    cameras_by: str = ""
    sha256: str = ""


@dataclass(frozen=True)
class Download:
    """A scene, where to get it, and which files identify it."""

    name: str
    what: str
    where: str
    license: str
    files: tuple[str, ...]  # the first of these that exists is used
    versions: tuple[Version, ...]
    up: str = ""
    front: str = ""


# From the list of cameras in the GPU ray traversal framework of Aila, Laine and Karras (its
# App.cpp and benchmark.cmd), decoded; 73.74 degrees.
_AILA = "the benchmark of Aila, Laine and Karras (2012)"
_CONFERENCE = tuple(
    Camera(f"aila-laine-{number}", eye, at, 73.74, (0.0, 0.0, 1.0))
    for number, (eye, at) in enumerate(
        (
            ((6.974, 8.768, 4.64), (14.792, 14.175, 1.532)),
            ((6.974, 8.769, 4.64), (14.682, 2.455, 3.784)),
            ((15.301, 5.199, 4.395), (25.283, 4.622, 4.241)),
        ),
        1,
    )
)
_SAN_MIGUEL = tuple(
    Camera(f"aila-laine-{number}", eye, at, 73.74, (0.0, 1.0, 0.0))
    for number, (eye, at) in enumerate(
        (
            ((-1.898, 1.576, 25.445), (-1.396, 0.586, 15.507)),
            ((-2.211, 7.505, 22.792), (3.617, 2.751, 16.2)),
            ((2.266, 1.179, 23.814), (-2.482, 1.489, 15.019)),
        ),
        1,
    )
)
_NAVE = (Camera("nave", (-1050.0, 170.0, -40.0), (1000.0, 250.0, -40.0), 65.0),)

DOWNLOADS = (
    Download(
        "sponza",
        "The atrium of the palace Sponza in Dubrovnik",
        f"Crytek's or Dabrovic's Sponza of {_MCGUIRE}",
        "CC-BY-3.0 (Crytek's), CC-BY-NC (Dabrovic's)",
        ("sponza.obj",),
        (
            # The camera is ours: papers do not publish coordinates for their views of the nave.
            Version(262267, "Crytek's", cameras=_NAVE, cameras_by="this project"),
            Version(66450, "Dabrovic's"),
        ),
    ),
    Download(
        "san-miguel",
        "A hacienda's courtyard",
        f"San Miguel of {_MCGUIRE}",
        "CC-BY-3.0",
        ("san-miguel.obj", "sanmiguel.obj"),
        (
            Version(9980699, "version 2.0 of that archive"),
            Version(
                10500000,
                "the version of papers before 2017",
                within=50000,
                cameras=_SAN_MIGUEL,
                cameras_by=_AILA,
            ),
        ),
    ),
    Download(
        "bistro",
        "A street in Paris, outside of a bistro",
        f"Amazon Lumberyard Bistro of {_MCGUIRE}, or of NVIDIA's ORCA (developer.nvidia.com/orca)",
        "CC-BY-4.0",
        ("exterior.obj", "BistroExterior.fbx"),
        (
            Version(2837181, "the OBJ of the former"),
            Version(2832120, "the FBX of the latter"),
        ),
    ),
    Download(
        "bistro-interior",
        "The bistro from inside",
        f"Amazon Lumberyard Bistro of {_MCGUIRE}, or of NVIDIA's ORCA (developer.nvidia.com/orca)",
        "CC-BY-4.0",
        ("interior.obj", "BistroInterior.fbx"),
        (
            Version(1020907, "the OBJ of the former"),
            Version(1046609, "the FBX of the latter"),
        ),
    ),
    Download(
        "conference",
        "A conference room",
        f"Conference Room of {_MCGUIRE}; the version of papers, with z up, of the scenes of Aila, "
        "Laine and Karras",
        "credit to Anat Grynberg and Greg Ward",
        ("conference.obj",),
        (
            Version(
                282750,
                "the version that papers print as 282 k or 283 k",
                within=500,
                up="z",
                front="-y",
                cameras=_CONFERENCE,
                cameras_by=_AILA,
            ),
        ),
    ),
    Download(
        "hairball",
        "A ball of hairs",
        f"Hairball of {_MCGUIRE}",
        "CC-BY-3.0",
        ("hairball.obj",),
        (Version(2880000, "that archive's"),),
    ),
    Download(
        "lucy",
        "A statue of an angel, scanned",
        "the Stanford 3D Scanning Repository (graphics.stanford.edu/data/3Dscanrep)",
        "Stanford's terms: research, with credit",
        ("lucy.ply", "lucy.ply.gz"),
        (Version(28055742, "that repository's"),),
        up="z",
        front="-y",
    ),
    Download(
        "power-plant",
        "A coal-fired power plant",
        f"Power Plant of {_MCGUIRE}, which has the UNC Power Plant as one file",
        "UNC's terms: no commercial use",
        ("powerplant.obj",),
        (
            Version(
                12759246,
                "that archive's",
                # Published by one user of the archive's copy; the archive itself publishes no
                # count.
                sha256="1bda60ac06a11a6299799c95f4caac63b5c2a3654464040ff5b7d4bb8db190a8",
            ),
        ),
    ),
)
