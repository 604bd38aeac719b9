"""Limits on work and input: excessive requests are refused before the work begins."""

from __future__ import annotations

import json
import os
import time
from pathlib import Path

import pytest

from program import beambench, refused, shell

SPHERE = "l 5 5 5\nf 1 1 1 1 0 0 0 0\ns 0 0 0 1\n"


def sweep(folder: Path, **changes: object) -> Path:
    path = folder / "sweep.json"
    document = {
        "name": "test",
        "scenes": ["tetra:n=1"],
        "structures": ["null"],
        "resolutions": ["4x4"],
        "budget_seconds": 1,
    }
    path.write_text(json.dumps({**document, **changes}))
    return path


def test_a_sweep_of_too_many_cells_is_refused_before_they_are_made(tmp_path: Path) -> None:
    structures = [f"samet:max_references={1000 + i}" for i in range(10_000)]
    resolutions = [f"{1 + i}x1" for i in range(1_000)]
    path = sweep(tmp_path, structures=structures, resolutions=resolutions)
    begun = time.monotonic()
    done = beambench("run", path, "--dry-run")
    elapsed = time.monotonic() - begun
    refused(done, ["sweep.json", "10000000 cells", "more than 100000", "shorten them"])
    assert elapsed < 5, "an idle machine takes a tenth of a second"


def test_an_octree_of_too_many_references_is_refused_early(tmp_path: Path) -> None:
    scene = tmp_path / "sphere.nff"
    scene.write_text(SPHERE)
    begun = time.monotonic()
    done = beambench("stats", scene, "--accel", "samet:max_level=16", "--resolution", "8x8")
    elapsed = time.monotonic() - begun
    refused(done, ["more than 50000000 references", "max_references"])
    assert elapsed < 5, "the refusal once took 20 seconds"


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("pipe.nff", "beambench scene pipe.nff"),
        ("pipe.obj", "beambench scene pipe.obj"),
        ("pipe.json", "beambench run pipe.json"),
        ("pipe.rays", "beambench verify tetra:n=1 --rays pipe.rays"),
        ("pipe.rays", "beambench verify tetra:n=1 --rays pipe.rays --hits a.hits"),
        ("pipe.csv", "beambench verify tetra:n=1 --rays a.rays --hits pipe.csv"),
    ],
)
def test_a_pipe_without_a_writer_is_not_waited_for(tmp_path: Path, name: str, line: str) -> None:
    os.mkfifo(tmp_path / name)
    rays = shell("beambench rays tetra:n=1 --resolution 4x4 -o a.rays", tmp_path)
    assert rays.returncode == 0, rays.stderr
    refused(shell(line, tmp_path, timeout=20), [name])


def test_a_pipe_beside_a_mesh_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    mesh = tmp_path / "a.obj"
    mesh.write_text("mtllib pipe\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    done = beambench("scene", mesh)
    assert done.returncode == 0, done.stderr
    assert "its materials were left out" in done.stderr
    gltf = {"asset": {"version": "2.0"}, "buffers": [{"uri": "pipe", "byteLength": 36}]}
    mesh = tmp_path / "a.gltf"
    mesh.write_text(json.dumps(gltf))
    refused(beambench("scene", mesh), ["a.gltf", "not a regular file"])


def test_a_mesh_that_the_memory_does_not_hold_is_refused(tmp_path: Path) -> None:
    faces = "f 1 2 3\n" * 1_000_000
    (tmp_path / "a.obj").write_text(f"v 0 0 0\nv 1 0 0\nv 0 1 0\n{faces}")
    scene = "BEAMBENCH_CACHE=cache beambench scene a.obj"
    refused(shell(f"BEAMBENCH_MEMORY=1M {scene}", tmp_path), ["a.obj", "not enough memory"])
    assert shell(scene, tmp_path).returncode == 0


@pytest.mark.parametrize("arguments", [["scene", "/dev/zero"], ["run", "/dev/zero"]])
def test_a_device_without_an_end_is_read_to_a_limit(arguments: list[str]) -> None:
    refused(beambench(*arguments), ["/dev/zero", "more than 67108864 bytes"])


@pytest.mark.parametrize(
    "uri", ["/etc/passwd", "../../../../../../etc/passwd", "file:///etc/passwd", "%2e%2e/secret"]
)
def test_a_file_outside_of_the_folder_of_a_mesh_is_not_read(tmp_path: Path, uri: str) -> None:
    (tmp_path / "secret").write_bytes(b"v 424242 0 0\n" * 9)
    folder = tmp_path / "in"
    folder.mkdir()
    mesh = folder / "a.gltf"
    buffers = [{"uri": uri, "byteLength": 36}]
    mesh.write_text(json.dumps({"asset": {"version": "2.0"}, "buffers": buffers}))
    done = beambench("scene", mesh)
    refused(done, ["a.gltf"])
    assert "root:" not in done.stderr
    assert "424242" not in done.stderr
    mesh = folder / "a.obj"
    mesh.write_text(f"mtllib {uri}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    done = beambench("scene", mesh)
    assert done.returncode == 0, done.stderr
    assert "its materials were left out" in done.stderr
    assert "root:" not in done.stderr + done.stdout
