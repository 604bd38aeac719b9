"""Programs whose hits are verified: the examples of harness/verify/examples, from end to end."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from plugins import BUILD
from program import BINARY, beambench, output_of

EXAMPLES = Path(__file__).resolve().parents[2] / "harness/verify/examples"
CACHE = BUILD.parent / "examples"
SCENE = "gears:n=1"  # its polygons have up to 142 triangles each
NONE = 0xFFFFFFFF
K = 16  # the differ's tolerance, in units of rounding

Program = Callable[..., subprocess.CompletedProcess[str]]


def ran(*command: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        list(map(str, command)),
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
        env={**os.environ, **environment},
    )


def trimesh_folder() -> Path:
    """The folder in which pip installed trimesh, once; skips the test if pip fails."""
    folder, wanted = CACHE / "trimesh", EXAMPLES / "requirements.txt"
    stamp = folder / "requirements.txt"
    if stamp.exists() and stamp.read_text() == wanted.read_text():
        return folder
    shutil.rmtree(folder, ignore_errors=True)
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    done = ran(*pip, "--no-deps", "--target", folder, "-r", wanted)
    if done.returncode != 0:
        pytest.skip(f"pip cannot install trimesh: {done.stderr.strip().splitlines()[-1]}")
    shutil.copy(wanted, stamp)
    return folder


@cache
def cgal_program() -> Path:
    """Returns the CGAL example, which is built once. Skips the test if CGAL is not installed."""
    folder = CACHE / "cgal"
    launcher = shutil.which("ccache")
    speed = [f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}"] if launcher else []
    done = ran("cmake", "-G", "Ninja", "-S", EXAMPLES / "cgal", "-B", folder, *speed)
    if "CGALConfig.cmake" in done.stderr:
        pytest.skip("CMake finds no CGAL 5; scripts/setup installs libcgal-dev where apt has it")
    assert done.returncode == 0, done.stderr
    anywhere = {"CCACHE_BASEDIR": str(EXAMPLES.parents[2]), "CCACHE_NOHASHDIR": "1"}
    done = ran("cmake", "--build", folder, **anywhere)
    assert done.returncode == 0, done.stdout
    return folder / "cgal_hits"


@pytest.fixture(scope="module", params=["trimesh", "cgal-cartesian", "cgal-epick"])
def program(request: pytest.FixtureRequest) -> Program:
    """A function that calls the program with the given arguments: a mesh, rays, -o and hits."""
    if request.param == "trimesh":
        folder = str(trimesh_folder())
        script = EXAMPLES / "trimesh_hits.py"
        return lambda *words: ran(sys.executable, script, *words, PYTHONPATH=folder)
    binary = cgal_program()
    kernel = ("--kernel", request.param.removeprefix("cgal-"))
    return lambda *words: ran(binary, *words, *kernel)


@pytest.fixture(scope="module")
def mesh(tmp_path_factory: pytest.TempPathFactory) -> Path:
    obj = tmp_path_factory.mktemp("mesh") / "scene.obj"
    output_of("export", SCENE, "-o", obj)
    return obj


@pytest.fixture(scope="module")
def random_hits(program: Program, mesh: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The hits that the program wrote for random rays, which are in a file beside the hits."""
    rays = make_rays(tmp_path_factory.mktemp("random") / "r.rays", "random")
    return traced(program, mesh, rays)


def make_rays(path: Path, kind: str = "random") -> Path:
    output_of("rays", SCENE, "--rays", kind, "--resolution", "80x50", "-o", path)
    return path


def traced(program: Program, mesh: Path, rays: Path) -> Path:
    """Returns the hit file that the program wrote."""
    hits = rays.with_suffix(".hits")
    done = program(mesh, rays, "-o", hits)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["rays"] > 0
    return hits


def verified(rays: Path, hits: Path) -> tuple[int, dict]:
    """Returns the exit code and the findings."""
    report = hits.with_suffix(".json")
    done = beambench("verify", SCENE, "--rays", rays, "--hits", hits, "--json", report)
    return done.returncode, json.loads(report.read_text())["cases"][0]


def body(path: Path, kind: np.dtype | str) -> tuple[bytes, np.ndarray]:
    """Returns the first two lines of a file, and the rest as numbers."""
    with path.open("rb") as file:
        return file.readline() + file.readline(), np.fromfile(file, kind)


HIT = np.dtype([("point", "<f4", 3), ("triangle", "<u4")])


@pytest.mark.parametrize("kind", ["primary", "diffuse", "shadow"])
def test_the_hits_are_right(program: Program, mesh: Path, tmp_path: Path, kind: str) -> None:
    rays = make_rays(tmp_path / "r.rays", kind)
    code, found = verified(rays, traced(program, mesh, rays))
    assert (code, found["verdict"], found["structure_error"]) == (0, "ok", 0)
    assert found["agree"] > 0.99 * found["rays"]
    assert 0 < found["hits"] < found["rays"]


def test_the_hits_of_random_rays_are_right(random_hits: Path) -> None:
    code, found = verified(random_hits.with_suffix(".rays"), random_hits)
    assert (code, found["verdict"], found["agree"]) == (0, "ok", found["rays"])


def test_hits_are_those_between_t_min_and_t_max(
    program: Program, mesh: Path, tmp_path: Path
) -> None:
    rays = make_rays(tmp_path / "r.rays")
    head, numbers = body(rays, "<f4")
    random = np.random.default_rng(7)
    numbers = numbers.reshape(-1, 8)
    numbers[:, 3] = random.uniform(0, 12, len(numbers))
    numbers[:, 7] = numbers[:, 3] + random.uniform(0, 6, len(numbers))
    header = json.loads(head.splitlines()[1])
    del header["hash"]
    rays.write_bytes(
        b"beambench-rays 1\n" + json.dumps(header).encode() + b"\n" + numbers.tobytes()
    )
    code, found = verified(rays, traced(program, mesh, rays))
    assert (code, found["verdict"]) == (0, "ok")
    assert 0 < found["hits"] < found["rays"]


@pytest.mark.parametrize("fault", ["moved", "exchanged", "dropped", "invented"])
def test_a_planted_fault_is_found(program: Program, mesh: Path, tmp_path: Path, fault: str) -> None:
    rays = make_rays(tmp_path / "r.rays")
    path = traced(program, mesh, rays)
    head, hits = body(path, HIT)
    ray = body(rays, "<f4")[1].reshape(-1, 8).astype(np.float64)
    words = [line.split() for line in mesh.read_text().splitlines()]
    vertices = np.array([word[1:] for word in words if word[:1] == ["v"]], np.float64)
    corners = vertices[np.array([word[1:] for word in words if word[:1] == ["f"]], int) - 1]

    # The hit in the middle of a triangle: at an edge, a miss would be a graze.
    found = np.flatnonzero(hits["triangle"] != NONE)
    of_hits = corners[hits["triangle"][found]]
    off_center = np.linalg.norm(hits["point"][found] - of_hits.mean(1), axis=1)
    wrong = found[np.argmin(off_center / np.linalg.norm(of_hits[:, 1] - of_hits[:, 0], axis=1))]
    if fault == "moved":
        # Ten times the tolerance across the surface, along the ray.
        a, b, c = corners[hits["triangle"][wrong]]
        normal = np.cross(b - a, c - a)
        direction = ray[wrong, 4:7]
        across = abs(normal @ direction) / np.linalg.norm(normal)
        u = 2.0**-24 * (np.abs(corners).max() + np.linalg.norm(ray[wrong, 0:3]))
        hits["point"][wrong] += (10 * K * u / across * direction).astype(np.float32)
    elif fault == "exchanged":
        hits["triangle"][wrong] = (hits["triangle"][wrong] + len(corners) // 2) % len(corners)
    elif fault == "dropped":
        hits["point"][wrong], hits["triangle"][wrong] = np.inf, NONE
    else:
        hits[np.flatnonzero(hits["triangle"] == NONE)[0]] = hits[wrong]
    path.write_bytes(head + hits.tobytes())
    code, report = verified(rays, path)
    assert (code, report["verdict"], report["structure_error"]) == (1, "mismatch", 1)


def test_invalid_input_is_refused_in_a_sentence(
    program: Program, mesh: Path, tmp_path: Path
) -> None:
    rays = make_rays(tmp_path / "r.rays")
    short = tmp_path / "short.rays"
    short.write_bytes(rays.read_bytes()[:-4])
    hits = tmp_path / "h.hits"
    for words in ((mesh, mesh), (mesh, short), (mesh, tmp_path / "none"), (tmp_path, rays)):
        done = program(*words, "-o", hits)
        assert done.returncode == 2
        assert done.stderr.splitlines()[-1].startswith("error: ")
        assert "Traceback" not in done.stderr
        assert not hits.exists()


# The table, and the fewest triangles with a wrong hit


FEW_RAYS = {"primary": "64x50", "axis": 4500}


def measured(tmp_path: Path, script: str, *words: str | Path) -> subprocess.CompletedProcess[str]:
    command = "{beambench} hits {scene} --rays {rays} -o {hits}"
    programs = [
        {"name": "right", "version": "=1", "command": command},
        {"name": "blind", "version": "1", "command": f"{command} --accel null"},
        {"name": "missing", "command": "{build}/there-is-none {mesh} {rays} {hits}"},
    ]
    listed = tmp_path / "programs.json"
    listed.write_text(json.dumps({"programs": programs}))
    common = ("--programs", listed, "--beambench", BINARY, "--work", tmp_path / "work")
    program = f"import sys; sys.path.insert(0, {str(EXAMPLES)!r}); import measure\n"
    program += f"measure.RAYS |= {FEW_RAYS}\n"
    program += f"import {Path(script).stem} as script; sys.exit(script.main())"
    return ran(sys.executable, "-c", program, *common, *words)


def test_the_table_has_a_row_for_each_program_that_runs(tmp_path: Path) -> None:
    out = tmp_path / "out"
    words = ("--scenes", "tetra:n=2", "--rays", "primary", "axis", "-o", out)
    done = measured(tmp_path, "measure.py", *words)
    assert done.returncode == 0, done.stderr
    lines = (out / "hits.csv").read_text().splitlines()
    rows = [dict(zip(lines[0].split(","), line.split(","), strict=True)) for line in lines[1:]]
    assert [(row["program"], row["ray_kind"], row["verdict"]) for row in rows] == [
        ("right", "primary", "ok"),
        ("right", "axis", "ok"),
        ("blind", "primary", "mismatch"),
        ("blind", "axis", "grazes"),  # every target lies on the boundary of its primitive
    ]
    assert {row["program_hits"] for row in rows[2:]} == {"0"}
    assert {row["version"] for row in rows} == {"'=1", "1"}, "no cell is a formula"
    manifest = json.loads((out / "manifest.json").read_text())
    assert list(manifest["left_out"]) == ["missing"]


def test_a_wrong_hit_is_reduced_to_its_triangle(tmp_path: Path) -> None:
    out = tmp_path / "out"
    words = ("--scene", "tetra:n=1", "--rays", "primary", "--program", "blind", "-o", out)
    done = measured(tmp_path, "minimal.py", *words, "--lost")
    assert done.returncode == 0, done.stdout + done.stderr
    case = json.loads((out / "case.json").read_text())
    assert (case["triangles"], case["class"], case["claim"]) == (1, "structure_error", None)
    files = ("--rays", out / "rays.csv", "--hits", out / "hits.csv")
    done = beambench("verify", out / "scene.obj", *files)
    assert done.returncode == 1, done.stdout
