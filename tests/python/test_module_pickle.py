"""The Python module: scenes that are pickled and copied, and file names that are not UTF-8."""

from __future__ import annotations

import copy
import json
import multiprocessing
import os
import pickle
import shutil
import warnings
from pathlib import Path

import numpy as np
import pytest

from module import bb
from program import output_of

VERTICES = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1 / 3], [2, 2, 2]], np.float64)
TRIANGLES = np.array([[0, 1, 2], [1, 1, 2], [0, 2, 3], [2, 3, 4]])


def _array_scene() -> bb.Scene:
    return bb.Scene.from_triangles(VERTICES, TRIANGLES, name="blätter", degenerate="skip")


def _file_scene(folder: Path) -> bb.Scene:
    """Returns a scene with every kind of primitive, light and camera; its reader warns."""
    path = folder / "scene.nff"
    output_of("export", "escena1", "-o", path)
    path.write_text(
        path.read_text() + "p 3\n0 0 0\n0 0 0\n1 0 0\ns 1 2 3 -0.5\nc\n0 0 0 1\n0 0 1 0\n"
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return bb.Scene(path)


def _mesh_scene(folder: Path) -> bb.Scene:
    path = folder / "mesh.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 1\nf 1//1 2//2 3//1\n")
    return bb.Scene(path)


SCENES = {
    "generated": lambda _: bb.Scene("balls:n=2"),
    "spheres, cones and finishes": lambda _: bb.Scene("finishes"),
    "polygons": lambda _: bb.Scene("teapot:n=2"),
    "file": _file_scene,
    "mesh": _mesh_scene,
    "triangles": lambda _: _array_scene(),
    "spheres": lambda _: bb.Scene.from_spheres(VERTICES, [1, -2, 3, 4, 0.1], up="y"),
}


def _require_same(one: bb.Scene, other: bb.Scene) -> None:
    assert other.hash == one.hash
    assert other.name == one.name
    assert other.cameras == one.cameras
    assert other.lights == one.lights
    assert other._compiled.warnings == one._compiled.warnings
    assert other._compiled.pickled() == one._compiled.pickled()
    for part in (
        "bounds vertices triangles triangle_primitives spheres primitive_kinds source_rows"
    ).split():
        assert np.array_equal(getattr(one, part), getattr(other, part)), part


@pytest.mark.parametrize("what", SCENES)
@pytest.mark.parametrize("protocol", [0, pickle.HIGHEST_PROTOCOL])
def test_a_pickled_scene_is_the_same_scene(what: str, protocol: int, tmp_path: Path) -> None:
    scene = SCENES[what](tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # the warning was given when the scene was read
        restored = pickle.loads(pickle.dumps(scene, protocol))
    _require_same(scene, restored)
    image = {"resolution": (32, 24), "shading": "whitted"}
    assert np.array_equal(restored.render(**image), scene.render(**image)), "surfaces and lights"


def test_a_pickled_scene_needs_no_file(tmp_path: Path) -> None:
    scene = _file_scene(tmp_path)
    pickled = pickle.dumps(scene)
    (tmp_path / "scene.nff").unlink()
    _require_same(scene, pickle.loads(pickled))


def test_a_copied_scene_is_itself() -> None:
    scene = _array_scene()
    assert copy.copy(scene) is scene
    assert copy.deepcopy([scene, scene]) == [scene, scene]


def _hash(scene: bb.Scene) -> tuple[str, str]:
    return scene.name, scene.hash


@pytest.mark.parametrize("method", ["spawn", "fork"])
def test_scenes_are_passed_to_other_processes(method: str) -> None:
    scene = _array_scene()
    with multiprocessing.get_context(method).Pool(1) as pool:
        assert pool.map(_hash, [scene, scene]) == [_hash(scene)] * 2


def test_a_damaged_pickle_is_refused() -> None:
    scene = bb.Scene("tetra:n=1")
    restore, (pickled, *rest) = scene.__reduce__()
    damaged = bytearray(pickled)
    damaged[len(damaged) // 2] ^= 1
    for bad in (bytes(damaged), pickled[:-3], pickled[:20], pickled + b"x"):
        with pytest.raises(bb.InputError, match="damaged"):
            restore(bad, *rest)
    for bad in (b"", pickled.replace(b"scene 2", b"scene 9")):
        with pytest.raises(bb.InputError, match="another version"):
            restore(bad, *rest)


@pytest.fixture
def awkward(tmp_path: Path) -> Path:
    """A scene in a folder, both with names that are not UTF-8."""
    folder = tmp_path / os.fsdecode(b"\xfe")
    folder.mkdir()
    output_of("export", "balls:n=1", "-o", tmp_path / "scene.nff")
    return (tmp_path / "scene.nff").rename(folder / os.fsdecode(b"sc\xe9ne \xff.nff"))


def _forms(path: Path) -> tuple[bytes, str, Path]:
    """Returns all forms of a path."""
    return os.fsencode(path), str(path), path


def test_a_file_name_that_is_not_utf8_is_read(awkward: Path) -> None:
    for spec in _forms(awkward):
        scene = bb.Scene(spec)
        assert scene.hash == bb.Scene("balls:n=1").hash
        assert scene.name.endswith(r"sc\xe9ne \xff.nff"), "printable"
        _require_same(scene, pickle.loads(pickle.dumps(scene)))


def test_a_missing_file_name_that_is_not_utf8_is_named(awkward: Path) -> None:
    for missing in _forms(awkward.with_name(os.fsdecode(b"none \xff.nff"))):
        with pytest.raises(bb.InputError, match=r"none \\xff\.nff"):
            bb.Scene(missing)
    for missing in _forms(awkward.with_name(os.fsdecode(b"none \xff.rays"))):
        with pytest.raises(bb.InputError, match=r"none \\xff\.rays"):
            bb.Scene("balls:n=1").rays(missing)


def test_rays_are_read_from_a_file_name_that_is_not_utf8(awkward: Path, tmp_path: Path) -> None:
    scene = bb.Scene(awkward)
    output_of("rays", "balls:n=1", "--rays", "diffuse", "-o", tmp_path / "a.rays")
    rays = (tmp_path / "a.rays").rename(awkward.with_name(os.fsdecode(b"\xe9.rays")))
    for path in _forms(rays):
        assert np.array_equal(scene.rays(path), scene.rays("diffuse"))


def test_a_sweep_is_read_and_kept_under_names_that_are_not_utf8(awkward: Path) -> None:
    pytest.importorskip("pandas")
    config = {
        "name": "test",
        "scenes": ["tetra:n=1"],
        "structures": ["exhaustive"],
        "resolutions": ["16x12"],
        "repetitions": {"minimum": 1, "maximum": 1},
        "budget_seconds": 1,
        "warm_up_seconds": 0,
    }
    sweep = awkward.with_name(os.fsdecode(b"sweep \xff.json"))
    sweep.write_text(json.dumps(config))
    folder = awkward.with_name(os.fsdecode(b"run \xff"))
    for path, output in zip(_forms(sweep), _forms(folder), strict=True):
        assert list(bb.sweep(path, output)["verdict"]) == ["ok"]
        assert (folder / "results.csv").exists()
        with pytest.raises(bb.InputError, match=r"run \\xff.*holds a run"):
            bb.sweep(path, output)
        shutil.rmtree(folder)
