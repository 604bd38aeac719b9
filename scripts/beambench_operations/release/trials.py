"""Tries the files of a release in bare systems without a network."""

import resource
import shutil
import tempfile
from pathlib import Path
from typing import Protocol

from beambench_operations.release.bare_system import BareSystem
from beambench_operations.release.container_steps import Stage, replay
from beambench_report.base.files import ROOT, Problem, output_of

PYTHON_OF_SUITE = {"bookworm": "3.11", "trixie": "3.13"}
"""The suites of Debian in which releases are tried, 12 and 13, with the version of their Python."""
FINGERPRINT = ROOT / "tests/golden/fingerprint.txt"
_TAGS = "manylinux2014 manylinux_2_27 manylinux_2_28 manylinux_2_34 manylinux_2_35".split()
_LEAST_PAGE = 500_000
"""The least bytes of a page of `explain`, which contains the library that draws the scene."""

OWN_HITS = """
import numpy as np
import beambench as bb

scene = bb.Scene("tetra:n=2")
rays = scene.rays("primary", resolution=(40, 30))
origin, direction = rays[:, None, 0:3].astype(float), rays[:, None, 4:7].astype(float)
a, b, c = (scene.vertices[scene.triangles[:, k]].astype(float) for k in range(3))
p = np.cross(direction, c - a)
with np.errstate(divide="ignore", invalid="ignore"):
    scale = 1 / np.sum((b - a) * p, axis=2)
    u = np.sum((origin - a) * p, axis=2) * scale
    q = np.cross(origin - a, b - a)
    v = np.sum(direction * q, axis=2) * scale
    t = np.sum((c - a) * q, axis=2) * scale
t[~((u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0))] = np.inf
nearest = t.min(axis=1)
assert np.isfinite(nearest).sum() > 100
triangle = np.where(np.isfinite(nearest), t.argmin(axis=1), -1)
report = bb.verify(scene, rays, t=nearest, triangle=triangle)
print(report)
assert report.ok
nearest[np.isfinite(nearest)] *= 1.1
assert not bb.verify(scene, rays, t=nearest).ok
"""
"""A script that verifies hits computed by numpy, and checks that wrong hits are found."""


class Program(Protocol):
    """The program in a bare system."""

    def __call__(self, *arguments: str) -> str:
        """Runs the program in its own folder; returns the output. Raises Problem on failure."""


def try_program(program: Program, folder: Path) -> None:
    """Measures, compares the fingerprint, and draws pictures and a page.

    The program writes to `folder`. Raises Problem if anything is wrong.
    """
    if "embree" not in program("time", "tetra", "--accel", "samet,embree", "--seconds", "5"):
        raise Problem("'beambench time' does not name its contenders")
    _require_fingerprint(program("fingerprint"))
    for picture in ("a.png", "a.exr"):
        program("render", "tetra:n=1", "--resolution", "8x8", "-o", picture)
        _require_file(folder / picture, 1)
    program("explain", "tetra:n=2", "--accel", "samet", "-o", "page.html")
    page = _require_file(folder / "page.html", _LEAST_PAGE).read_text("utf-8")
    if "<script src=" in page:
        raise Problem("the page of 'beambench explain' loads scripts from elsewhere")
    program("run", "quick", "-o", "run", "--benchmark_filter=tetra.*(samet|embree)")
    _require_file(folder / "run/results.csv", 1)


def try_wheels(suite: str, wheelhouse: Path, folder: Path) -> float:
    """Installs the wheels of a folder in a bare system in `folder`, and uses them.

    Returns the seconds of processor time until the first results, since other work may run at the
    same time. Raises Problem if anything is wrong.
    """
    system = BareSystem(suite, "python3-venv", folder)
    shutil.copytree(wheelhouse, system.path("wheels"))
    system.path("root/own_hits.py").write_text(OWN_HITS, "utf-8")
    python, command = "/root/venv/bin/python", "/root/venv/bin/beambench"
    pip = (python, *"-m pip install --quiet --no-index --find-links=/wheels".split())

    def program(*arguments: str) -> str:
        return system.run(command, *arguments, network=False)

    begin = _processor_seconds()
    system.run("python3", "-m", "venv", "/root/venv")
    system.run(*pip, "beambench", network=False)
    if not system.run(python, "own_hits.py", network=False).startswith("ok"):
        raise Problem("the Python module does not find the hits of numpy correct")
    program("time", "tetra", "--accel", "samet,embree")
    seconds = _processor_seconds() - begin

    try_program(program, system.path("root"))
    system.run("sh", "-c", f"! {command} report run 2> words", network=False)
    if "pipx install 'beambench[report]'" not in system.path("root/words").read_text("utf-8"):
        raise Problem("'beambench report' does not say how to install what it lacks")
    system.run(*pip, "beambench[report]", network=False)
    program("report", "run")
    if "/*! DataTables " not in system.path("root/run/report.html").read_text("utf-8"):
        raise Problem("the tables of the report do not sort and filter: DataTables is missing")
    for made in ("report.html", "plots/overall.svg", "pictures"):
        if not system.path(f"root/run/{made}").exists():
            raise Problem(f"'beambench report' does not write {made}")
    by_name = "import beambench as bb\ntry: bb.sweep('quik')\nexcept bb.InputError as e: print(e)"
    if "'quick'" not in system.run(python, "-c", by_name, network=False):
        raise Problem("the wheel has no sweeps that are found by name")
    return seconds


def download_dependencies(wheelhouse: Path, python: str) -> None:
    """Downloads what the wheels in a folder and reports need for a version of Python."""
    words = f"-m pip download --quiet --only-binary=:all: --python-version={python}".split()
    words += [f"--platform={name}_x86_64" for name in _TAGS]
    words += [f"--find-links={wheelhouse}", f"--dest={wheelhouse}", "beambench[report]"]
    output_of([str(ROOT / "build/wheel-tools/bin/python"), *words])


def package_of(suite: str, archive: Path | None, folder: Path) -> Path:
    """Replays the Dockerfile in systems of a suite, in `folder`, and uses the installed package.

    The sources are those of the archive or, by default, the working tree. Returns the Debian
    package. Raises Problem if anything is wrong.
    """

    def make(_: str) -> BareSystem:
        return BareSystem(suite, "", Path(tempfile.mkdtemp(dir=folder)))

    stages = replay(make, archive)
    try_image(stages[""])
    (package,) = stages["build"].system.path("packages").glob("*.deb")
    return package


def try_image(image: Stage) -> None:
    """Uses the program of an image as its user. Raises Problem if anything is wrong."""
    if "uid=0" in image.system.run("id", folder="/", user=image.user):
        raise Problem("the user of the image is root")
    image.system.run("chown", image.user, image.folder)  # like a user's volume
    folder = image.system.path(image.folder)

    def program(*arguments: str) -> str:
        return image.run(*arguments, network=False)

    try_program(program, folder)
    if (folder / "a.png").stat().st_uid == 0:
        raise Problem("files written by the image's user are owned by root")


def _require_fingerprint(printed: str) -> None:
    """Compares everything except the hits within tolerance, which depend on the processor."""
    if printed.split("tolerance\t")[0] != FINGERPRINT.read_text("utf-8").split("tolerance\t")[0]:
        raise Problem(f"'beambench fingerprint' does not print {FINGERPRINT}")


def _require_file(path: Path, least: int) -> Path:
    """Returns a file that the program wrote. Raises Problem if it is smaller than expected."""
    size = path.stat().st_size if path.is_file() else 0
    if size < least:
        raise Problem(f"{path}: the program wrote {size} bytes instead of at least {least}")
    return path


def _processor_seconds() -> float:
    """Returns the processor time of all ended processes."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
