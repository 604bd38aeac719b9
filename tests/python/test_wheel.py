"""`scripts/wheel` builds wheels of the program and the Python module that need nothing else."""

from __future__ import annotations

import re
import resource
import subprocess
import zipfile
from pathlib import Path

import pytest

from bare_system import REPOSITORY, BareSystem

LIMIT = 35_000_000
PYTHON_OF_SUITE = {"bookworm": "3.11", "trixie": "3.13"}
TAGS = "manylinux2014 manylinux_2_27 manylinux_2_28 manylinux_2_34 manylinux_2_35".split()
SECONDS = 60
"""The limit for the time to the first results, including the installation.

It is processor time, because other tests may run at the same time.
"""

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


def test_help_is_printed_and_other_arguments_are_refused() -> None:
    script = REPOSITORY / "scripts/wheel"
    helped = subprocess.run([script, "--help"], capture_output=True, text=True, check=True)
    assert helped.stdout.startswith("usage: scripts/wheel")
    for arguments in (["--fast"], ["a", "b"]):
        done = subprocess.run([script, *arguments], capture_output=True, text=True, check=False)
        assert done.returncode == 2
        assert "--help" in done.stderr


@pytest.fixture(scope="session")
def wheels(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with both wheels and, for both systems, the packages that they and reports need."""
    folder = tmp_path_factory.mktemp("wheels")
    subprocess.run([REPOSITORY / "scripts/wheel", folder], check=True)
    for version in PYTHON_OF_SUITE.values():
        download = (
            "build/wheel-tools/bin/python -m pip download --quiet --only-binary=:all:".split()
        )
        download += [f"--dest={folder}", "beambench[report]"]
        platforms = [f"--platform={name}_x86_64" for name in TAGS]
        subprocess.run(
            [*download, f"--python-version={version}", *platforms, f"--find-links={folder}"],
            cwd=REPOSITORY,
            check=True,
        )
    return folder


@pytest.mark.full
@pytest.mark.parametrize("name", ["beambench_program-*-py3-none", "beambench-*-cp311-abi3"])
def test_a_wheel_is_small_and_has_the_licenses_of_its_libraries(wheels: Path, name: str) -> None:
    (wheel,) = wheels.glob(f"{name}-manylinux_*.whl")
    glibc = re.search(r"manylinux_2_(\d+)_x86_64\.whl$", wheel.name)
    assert glibc
    assert int(glibc[1]) <= 39
    assert wheel.stat().st_size <= LIMIT
    names = zipfile.ZipFile(wheel).namelist()
    bundled = [name for name in names if re.match(r"[^/]*\.libs/lib", name)]
    licenses = [name for name in names if ".dist-info/licenses/" in name]
    assert len(licenses) > len(bundled) > 3
    assert {"three", "datatables.net"} <= {name.rsplit("/", 1)[1] for name in licenses}
    assert not any(name.endswith((".hpp", ".a", ".cmake")) for name in names)
    assert not any("OpenImageIO" in name for name in names)


def processor_seconds() -> float:
    """Returns the processor time of all ended processes."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


@pytest.mark.full
@pytest.mark.parametrize("suite", PYTHON_OF_SUITE)
def test_a_bare_system_has_results_within_a_minute(
    wheels: Path, tmp_path: Path, suite: str
) -> None:
    system = BareSystem(suite, "python3-venv", tmp_path / "system")
    subprocess.run(["cp", "--recursive", wheels, system.path("wheels")], check=True)
    system.path("root/own_hits.py").write_text(OWN_HITS, "utf-8")
    program = "/root/venv/bin/beambench"
    pip = "/root/venv/bin/python -m pip install --quiet --no-index --find-links=/wheels".split()

    begin = processor_seconds()
    system.run("python3", "-m", "venv", "/root/venv")
    system.run(*pip, "beambench")
    assert system.run("/root/venv/bin/python", "own_hits.py").startswith("ok")
    assert "embree" in system.run(program, "time", "tetra", "--accel", "samet,embree")
    assert processor_seconds() - begin <= SECONDS

    fingerprint = system.run(program, "fingerprint")
    committed = (REPOSITORY / "tests/golden/fingerprint.txt").read_text("utf-8")
    assert fingerprint.split("all\t")[0] == committed.split("all\t")[0]
    for picture in ("a.png", "a.exr"):
        system.run(program, "render", "tetra:n=1", "--resolution", "8x8", "-o", picture)
        assert system.path(f"root/{picture}").stat().st_size > 0

    system.run(program, "run", "quick", "-o", "run", "--benchmark_filter=tetra.*(samet|embree)")
    system.run("sh", "-c", f"! {program} report run 2> words")
    assert "pipx install 'beambench[report]'" in system.path("root/words").read_text("utf-8")
    system.run(*pip, "beambench[report]")
    assert system.run(program, "report", "run") == "run/report.html\n"
    page = system.path("root/run/report.html").read_text("utf-8")
    assert "/*! DataTables " in page, "its tables sort and filter"
    for made in ("report.html", "plots/overall.svg", "pictures"):
        assert system.path(f"root/run/{made}").exists()
    by_name = "import beambench as bb\ntry: bb.sweep('quik')\nexcept bb.InputError as e: print(e)"
    assert "'quick'" in system.run("/root/venv/bin/python", "-c", by_name)
