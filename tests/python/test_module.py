"""The Python module: scenes, structures, rays, hits and pictures on numpy's arrays."""

from __future__ import annotations

import dataclasses
import gc
import json
import re
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from module import bb
from program import output_of

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
HALVES = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)


@pytest.fixture(scope="module")
def balls() -> bb.Scene:
    return bb.Scene("balls:n=2")


@pytest.fixture(scope="module")
def rays(balls: bb.Scene) -> NDArray[np.float32]:
    return balls.rays(resolution=(64, 40))


@pytest.fixture(scope="module")
def correct(balls: bb.Scene, rays: NDArray[np.float32]) -> bb.Hits:
    return bb.Structure(balls, "exhaustive").closest_hits(rays)


def address(array: NDArray) -> int:
    return array.__array_interface__["data"][0]


# Scenes


def test_a_scene_of_the_catalogue_is_the_programs() -> None:
    scene = bb.Scene("balls:n=2")
    told = json.loads(output_of("scene", "balls:n=2", "--json"))
    assert scene.name == "balls:n=2"
    assert scene.primitives == told["primitives"]
    assert scene.hash == told["hash"]
    assert scene.lights == 3
    assert len(scene.spheres) == np.count_nonzero(scene.primitive_kinds == 0)
    assert "balls:n=2" in repr(scene)


def test_scenes_are_read_from_files(tmp_path: Path) -> None:
    file = tmp_path / "tetra.nff"
    output_of("export", "tetra:n=2", "-o", file)
    assert bb.Scene(file).hash == bb.Scene("tetra:n=2").hash
    (tmp_path / "flat.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nf 1 2 3\nf 2 4 3\nf 1 1 2\n"
    )
    with pytest.warns(UserWarning, match=r"flat\.obj"):
        mesh = bb.Scene(tmp_path / "flat.obj")
    assert mesh.primitives == 2
    with pytest.raises(bb.InputError, match=r"flat\.obj"):
        bb.Scene(tmp_path / "flat.obj", strict=True)


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.int16])
@pytest.mark.parametrize("index", [np.uint32, np.int64, np.uint8])
def test_a_mesh_is_what_its_arrays_say(dtype: type, index: type) -> None:
    scene = bb.Scene.from_triangles(SQUARE.astype(dtype), HALVES.astype(index), name="square")
    assert (scene.name, scene.primitives, scene.lights) == ("square", 2, 2)
    assert np.array_equal(scene.vertices, SQUARE)
    assert np.array_equal(scene.triangles, HALVES)
    assert np.array_equal(scene.triangle_primitives, [0, 1])
    assert np.array_equal(scene.primitive_kinds, [2, 2])
    assert np.array_equal(scene.bounds, [[0, 0, 0], [1, 1, 0]])
    assert np.array_equal(scene.source_rows, [0, 1])
    assert scene.hash == bb.Scene.from_triangles(SQUARE, HALVES).hash


def test_coordinates_are_rounded_once() -> None:
    vertices = SQUARE.astype(np.float64) + 0.1
    assert np.array_equal(
        bb.Scene.from_triangles(vertices, HALVES).vertices, vertices.astype(np.float32)
    )


def test_strided_arrays_and_lists_are_taken() -> None:
    wide = np.zeros((4, 6))
    wide[:, ::2] = SQUARE
    scene = bb.Scene.from_triangles(wide[:, ::2], HALVES.tolist())
    assert scene.hash == bb.Scene.from_triangles(SQUARE, HALVES).hash
    turned = np.asfortranarray(HALVES)
    assert bb.Scene.from_triangles(SQUARE, turned).hash == scene.hash


def test_triangles_without_area_are_named_or_skipped() -> None:
    triangles = [[0, 1, 2], [1, 1, 2], [0, 2, 3], [3, 3, 3]]
    with pytest.raises(bb.InputError, match=r"triangles\[1\] is \(1, 1, 2\), .*2 such"):
        bb.Scene.from_triangles(SQUARE, triangles)
    scene = bb.Scene.from_triangles(SQUARE, triangles, degenerate="skip")
    assert np.array_equal(scene.triangles, HALVES)
    assert np.array_equal(scene.source_rows, [0, 2])


def test_spheres_are_what_their_arrays_say() -> None:
    centers = np.array([[0, 0, 0], [3, 0, 0]])
    scene = bb.Scene.from_spheres(centers, [1, 0.5])
    assert np.array_equal(scene.spheres, [[0, 0, 0, 1], [3, 0, 0, 0.5]])
    assert np.array_equal(bb.Scene.from_spheres(centers, 1).spheres[:, 3], [1, 1])
    assert np.array_equal(bb.Scene.from_spheres(centers, -2).spheres[:, 3], [2, 2])
    assert len(scene.rays("shadow", resolution=(8, 8))) > 0
    hits = bb.Structure(scene, "exhaustive").trace_image(resolution=(65, 65))
    seen, counts = np.unique(hits.primitive, return_counts=True)
    assert seen.tolist() == [0, 1, bb.NO_PRIMITIVE], "the camera sees all"
    assert counts.min() > 100


@pytest.mark.parametrize("up", ["y", "z"])
def test_fitted_cameras_know_where_up_is(up: str) -> None:
    camera = bb.Scene.from_spheres([[0, 0, 0]], 1, up=up).cameras[0]
    assert np.argmax(camera.up) == "xyz".index(up)


def test_arrays_of_a_scene_are_views_that_outlive_it() -> None:
    scene = bb.Scene.from_triangles(SQUARE, HALVES)
    arrays = [
        getattr(scene, name)
        for name in ("vertices", "triangles", "triangle_primitives", "primitive_kinds")
    ]
    for array in [*arrays, bb.Scene.from_spheres([[0, 0, 0]], 1).spheres]:
        assert not array.flags.writeable
        assert not array.flags.owndata
    assert address(scene.vertices) == address(arrays[0])
    del scene
    gc.collect()
    assert np.array_equal(arrays[0], SQUARE)
    assert np.array_equal(arrays[1], HALVES)


# Rays


@pytest.mark.parametrize("kind", ["primary", "shadow", "diffuse:seed=3", "random"])
def test_rays_of_a_kind_are_the_programs(kind: str, balls: bb.Scene, tmp_path: Path) -> None:
    made = balls.rays(kind, resolution=(16, 10), samples=4)
    assert made.dtype == np.float32
    file = tmp_path / "kind.rays"
    image = ["--resolution", "16x10", "--samples", "4"]
    output_of("rays", "balls:n=2", "--rays", kind, *image, "-o", file)
    with file.open("rb") as opened:
        opened.readline()
        opened.readline()
        saved = np.fromfile(opened, "<f4").reshape(-1, 8)
    assert np.array_equal(made, saved)
    assert np.array_equal(balls.rays(str(file)), saved)
    assert made.flags.writeable


def test_rays_are_put_together_from_parts() -> None:
    origins = np.array([[0.2, 0.3, 1], [0.5, 0.5, 2]])
    made = bb.rays(origins, [0, 0, -1], t_max=[3, np.inf])
    expected = [[0.2, 0.3, 1, 0, 0, 0, -1, 3], [0.5, 0.5, 2, 0, 0, 0, -1, np.inf]]
    assert np.array_equal(made, np.array(expected, np.float32))
    assert bb.rays([0, 0, 0], [0, 0, 1]).shape == (1, 8)
    assert bb.rays(np.zeros((0, 3)), [0, 0, 1]).shape == (0, 8)
    assert bb.rays([0, 0, 0], np.eye(3), t_min=0.5)[:, 3].tolist() == [0.5] * 3


def test_a_view_of_ones_own() -> None:
    scene = bb.Scene.from_triangles(SQUARE, HALVES)
    camera = bb.Camera(eye=(0.5, 0.5, 5), at=(0.5, 0.5, 0), up=(0, 1, 0), angle=20)
    depth = bb.Structure(scene, "exhaustive").trace_image(camera=camera, resolution=(9, 9)).t
    assert depth[4, 4] == 5
    moved = dataclasses.replace(camera, eye=(0.5, 0.5, 6))
    depth = bb.Structure(scene, "exhaustive").trace_image(camera=moved, resolution=(9, 9)).t
    assert depth[4, 4] == 6
    assert scene.camera("top").name == "top"
    top = scene.rays(camera="top", resolution=(4, 4))
    assert np.array_equal(top, scene.rays(camera=scene.camera("top"), resolution=(4, 4)))


# Structures


@pytest.mark.parametrize("info", bb.structures(), ids=lambda info: info.name)
def test_every_structure_returns_the_programs_hits(
    info: bb.StructureInfo, balls: bb.Scene, rays: NDArray[np.float32], correct: bb.Hits
) -> None:
    if info.name == "polygon-beam":
        with pytest.raises(bb.InputError, match="kinds of primitives"):
            bb.Structure(balls, info.name)
        return
    structure = bb.Structure(balls, info.name)
    if info.name == "z-buffer":
        image = structure.trace_image(resolution=(64, 40), threads=2)
        assert np.array_equal(image.t.ravel(), correct.t)
        assert np.array_equal(image.primitive.ravel(), correct.primitive)
        for query in (structure.closest_hits, structure.any_hits):
            with pytest.raises(bb.InputError, match="images only"):
                query(rays)
        return
    hits = structure.closest_hits(rays)
    assert (hits.t.dtype, hits.primitive.dtype) == (np.float32, np.uint32)
    assert hits.counters is None
    counted = structure.closest_hits(rays, counters=True)
    assert np.array_equal(counted.primitive, hits.primitive)
    assert set(counted.counters or {}) <= set(info.counters)
    image = structure.trace_image(resolution=(64, 40), threads=2)
    assert image.t.shape == image.primitive.shape == (40, 64)
    if info.conformance == "bit-exact":
        for found in (hits, counted):
            assert np.array_equal(found.t, correct.t)
            assert np.array_equal(found.primitive, correct.primitive)
        assert np.array_equal(image.t.ravel(), correct.t)
        assert np.array_equal(image.primitive.ravel(), correct.primitive)
    if info.conformance != "baseline":
        assert np.array_equal(structure.any_hits(rays), correct.hit)
        assert bb.verify(balls, rays, t=hits.t, primitive=hits.primitive).ok
        assert set(structure.any_hit_counters(rays)) <= set(info.counters)
    else:
        assert not hits.hit.any()


def test_counters_and_sizes_are_the_programs(balls: bb.Scene, rays: NDArray[np.float32]) -> None:
    told = json.loads(
        output_of("stats", "balls:n=2", "--accel", "samet", "--resolution", "64x40", "--json")
    )
    (cell,) = told["structures"]
    structure = bb.Structure(balls, "samet")
    counters = structure.closest_hits(rays, counters=True).counters
    assert counters is not None
    image = structure.trace_image(resolution=(64, 40), counters=True, threads=2)
    assert image.counters == counters
    per_ray = {name: count / len(rays) for name, count in counters.items()}
    assert per_ray == pytest.approx(cell["per_ray"])
    assert structure.any_hit_counters(rays)["primitive_tests"] > 0
    assert structure.statistics["leaves"] == cell["leaves"]
    assert structure.statistics["bytes"] > 0


def test_parameters_are_given_in_the_name_or_beside_it(balls: bb.Scene) -> None:
    structure = bb.Structure(balls, "samet:max_level=4", max_objects=3, root="box")
    assert "max_level=4" in structure.name
    assert "max_objects=3" in structure.name
    assert "root=box" in structure.name
    flag = bb.Structure(balls, "sah-bvh", parallel=True)
    assert "parallel=true" in flag.name
    assert structure.scene is balls
    assert structure.name in repr(structure)


def test_samples_have_a_dimension_of_their_own(balls: bb.Scene) -> None:
    hits = bb.Structure(balls, "sah-bvh").trace_image(resolution=(12, 7), samples=4)
    assert hits.t.shape == (7, 12, 4)
    listed = bb.Structure(balls, "sah-bvh").closest_hits(balls.rays(resolution=(12, 7), samples=4))
    assert np.array_equal(hits.t.ravel(), listed.t)


def test_no_rays_have_no_hits(balls: bb.Scene) -> None:
    none = np.empty((0, 8), np.float32)
    structure = bb.Structure(balls, "sah-bvh")
    assert structure.closest_hits(none).t.shape == (0,)
    assert structure.any_hits(none).shape == (0,)


def test_rays_are_read_where_they_are(balls: bb.Scene, rays: NDArray[np.float32]) -> None:
    from beambench.arrays import rays_in_place

    assert rays_in_place(rays) is rays
    shut = rays.copy()
    shut.flags.writeable = False
    assert rays_in_place(shut) is shut
    assert bb.Structure(balls, "sah-bvh").any_hits(shut).dtype == np.bool_


@pytest.mark.parametrize(
    "change",
    [
        lambda r: r.astype(np.float64),
        lambda r: np.asfortranarray(r),
        lambda r: np.repeat(r, 2, axis=0)[::2],
        lambda r: np.pad(r, ((0, 0), (0, 3)))[:, :8],
        lambda r: np.frombuffer(b"x" + r.tobytes(), np.float32, offset=1).reshape(-1, 8),
        lambda r: r.astype(">f4"),
    ],
    ids=["float64", "columns first", "every second row", "padded", "misaligned", "big-endian"],
)
def test_other_arrays_are_converted(
    change: Callable[[NDArray], NDArray],
    balls: bb.Scene,
    rays: NDArray[np.float32],
    correct: bb.Hits,
) -> None:
    hits = bb.Structure(balls, "sah-bvh").closest_hits(change(rays))
    assert np.array_equal(hits.t, correct.t)
    assert np.array_equal(hits.primitive, correct.primitive)


def test_results_own_their_memory(balls: bb.Scene, rays: NDArray[np.float32]) -> None:
    structure = bb.Structure(balls, "sah-bvh")
    hits = structure.closest_hits(rays)
    kept, ids, expected = hits.t, hits.primitive, hits.t.copy()
    assert not kept.flags.owndata
    assert kept.flags.writeable
    assert kept.base is not None
    del hits, structure
    gc.collect()
    assert np.array_equal(kept, expected)
    kept[:] = 0  # each call returns hits in memory of its own
    assert ids.max() > 0


# Pictures


def test_pictures_are_drawn(balls: bb.Scene) -> None:
    picture = balls.render(resolution=(32, 20))
    assert picture.shape == (20, 32, 3)
    assert picture.dtype == np.float32
    assert not picture.flags.owndata
    exact = balls.render(resolution=(32, 20), shading="whitted", structure="exhaustive", threads=1)
    again = bb.Structure(balls, "samet").render(resolution=(32, 20), shading="whitted", threads=2)
    assert np.array_equal(exact, again)
    encoded = bb.to_srgb(picture)
    assert encoded.dtype == np.uint8
    assert encoded.shape == picture.shape
    assert bb.to_srgb([[[0, 1, 0.21404114]]]).tolist() == [[[0, 255, 128]]]


# Errors


def plane() -> bb.Scene:
    return bb.Scene.from_triangles(SQUARE, HALVES)


def trace(rays: object) -> bb.Hits:
    return bb.Structure(plane(), "exhaustive").closest_hits(rays)


def row(**changed: float) -> list[float]:
    """Returns a valid ray with the given changes."""
    values = dict(
        zip("ox oy oz t_min dx dy dz t_max".split(), [0, 0, 0, 0, 0, 0, 1, np.inf], strict=True)
    )
    return list({**values, **changed}.values())


NOT_A_NUMBER = SQUARE.copy()
NOT_A_NUMBER[2, 1] = np.nan

INVALID: dict[str, tuple[Callable[[], object], type[Exception], str]] = {
    "a coordinate that is not a number": (
        lambda: bb.Scene.from_triangles(NOT_A_NUMBER, HALVES),
        bb.InputError,
        r"vertices\[2\] is \(1, nan, 0\)",
    ),
    "a coordinate too large": (
        lambda: bb.Scene.from_triangles(SQUARE * 2e9, HALVES),
        bb.InputError,
        r"vertices\[1\] is \(2e\+09, 0, 0\)",
    ),
    "an index that is not a vertex": (
        lambda: bb.Scene.from_triangles(SQUARE, [[0, 1, 2], [0, 2, 4]]),
        bb.InputError,
        r"triangles\[1\] is \(0, 2, 4\), but there are 4 vertices",
    ),
    "a negative index": (
        lambda: bb.Scene.from_triangles(SQUARE, [[0, 1, -2]]),
        bb.InputError,
        r"triangles\[0, 2\] is -2",
    ),
    "an index of no vertex, -1": (
        lambda: bb.Scene.from_triangles(SQUARE, [[0, 1, -1]]),
        bb.InputError,
        r"triangles\[0\] is \(0, 1, -1\)",
    ),
    "triangles of four corners": (
        lambda: bb.Scene.from_triangles(SQUARE, [[0, 1, 2, 3]]),
        bb.InputError,
        r"triangles has shape \(1, 4\); expected \(T, 3\)",
    ),
    "triangles that are not integers": (
        lambda: bb.Scene.from_triangles(SQUARE, HALVES.astype(float)),
        TypeError,
        r"triangles has dtype float64; expected integers",
    ),
    "no triangles": (
        lambda: bb.Scene.from_triangles(SQUARE, np.empty((0, 3), int)),
        bb.InputError,
        r"expected at least one triangle",
    ),
    "vertices of complex numbers": (
        lambda: bb.Scene.from_triangles(SQUARE.astype(complex), HALVES),
        TypeError,
        r"vertices has dtype complex128; expected real numbers",
    ),
    "vertices of unequal length": (
        lambda: bb.Scene.from_triangles([[0, 0, 0], [1, 0]], HALVES),
        bb.InputError,
        r"vertices is not an array",
    ),
    "a scene too small": (
        lambda: bb.Scene.from_triangles(SQUARE * 1e-12, HALVES),
        bb.InputError,
        r"diagonal of its box",
    ),
    "up that is not an axis": (
        lambda: bb.Scene.from_triangles(SQUARE, HALVES, up="w"),
        bb.InputError,
        r"up is 'w'; expected 'y' or 'z'",
    ),
    "an unknown way with degenerate ones": (
        lambda: bb.Scene.from_triangles(SQUARE, HALVES, degenerate="keep"),
        bb.InputError,
        r"degenerate is 'keep'",
    ),
    "a radius of 0": (
        lambda: bb.Scene.from_spheres([[0, 0, 0]] * 3, [1, 1e-60, 1]),
        bb.InputError,
        r"radii\[1\] is 1e-60",
    ),
    "fewer radii": (
        lambda: bb.Scene.from_spheres([[0, 0, 0]] * 3, [1, 2]),
        bb.InputError,
        r"3 centers and 2 radii",
    ),
    "no spheres": (
        lambda: bb.Scene.from_spheres(np.empty((0, 3)), []),
        bb.InputError,
        r"at least one sphere",
    ),
    "an unknown scene": (lambda: bb.Scene("bals"), bb.InputError, r"no scene 'bals'.*balls"),
    "a missing file": (lambda: bb.Scene("no/such.obj"), bb.InputError, r"no/such\.obj"),
    "an unknown camera": (
        lambda: plane().rays(camera="back"),
        bb.InputError,
        r"no camera 'back' in mesh; expected one of three-quarter, front, side, top",
    ),
    "a camera that looks nowhere": (
        lambda: plane().rays(camera=bb.Camera(eye=(1, 1, 1), at=(1, 1, 1))),
        bb.InputError,
        r"the eye is the point looked at",
    ),
    "something that is not a camera": (
        lambda: plane().rays(camera=3),
        TypeError,
        r"camera is 3; expected a Camera, a name, or None",
    ),
    "an image without size": (
        lambda: plane().rays(resolution=(0, 3)),
        bb.InputError,
        r"resolution is \(0, 3\)",
    ),
    "an image of one number": (lambda: plane().rays(resolution=8), TypeError, r"resolution is 8"),
    "a number of samples": (lambda: plane().rays(samples=3), bb.InputError, r"3 samples"),
    "a broken number of samples": (
        lambda: plane().rays(samples=1.5),
        TypeError,
        r"samples is 1\.5; expected a whole number",
    ),
    "a number as a kind of rays": (lambda: plane().rays(3), TypeError, r"kind is 3"),
    "a number as a structure": (lambda: bb.Structure(plane(), 3), TypeError, r"spec is 3"),
    "half a thread": (
        lambda: bb.Structure(plane(), "samet", threads=0.5),
        TypeError,
        r"threads is 0\.5",
    ),
    "whole pictures as rays": (lambda: plane().rays("whitted"), bb.InputError, r"whitted"),
    "a structure that is not Unicode": (
        lambda: bb.Structure(plane(), "\udcff"),
        bb.InputError,
        r"spec is '\\udcff'; expected a string that UTF-8 can encode",
    ),
    "a file name that no file has": (
        lambda: bb.Scene("\ud800.nff"),
        bb.InputError,
        r"spec is '\\ud800.nff'",
    ),
    "a number as a scene": (
        lambda: bb.Scene(3),
        TypeError,
        r"spec is 3; expected a string or a path",
    ),
    "an unknown kind of rays": (lambda: plane().rays("light"), bb.InputError, r"'light'"),
    "an unknown structure": (lambda: bb.Structure(plane(), "same"), bb.InputError, r"samet"),
    "an unknown parameter": (
        lambda: bb.Structure(plane(), "samet", depth=3),
        bb.InputError,
        r"'depth'.*max_level",
    ),
    "a parameter out of range": (
        lambda: bb.Structure(plane(), "samet", max_level=77),
        bb.InputError,
        r"max_level is '77'.*from 1 to 16",
    ),
    "no scene": (
        lambda: bb.Structure("balls", "samet"),
        TypeError,
        r"scene is a str; expected a beambench\.Scene",
    ),
    "less than no threads": (
        lambda: plane().render(threads=-1),
        bb.InputError,
        r"threads is -1",
    ),
    "a structure of another scene": (
        lambda: plane().render(structure=bb.Structure(plane(), "samet")),
        bb.InputError,
        r"another scene",
    ),
    "an unknown shading": (lambda: plane().render(shading="nice"), bb.InputError, r"'nice'"),
    "rays of seven numbers": (
        lambda: trace(np.zeros((5, 7))),
        bb.InputError,
        r"rays has shape \(5, 7\); expected \(N, 8\)",
    ),
    "rays of text": (lambda: trace([["a"] * 8]), TypeError, r"rays has dtype <U1"),
    "a ray that is not a number": (
        lambda: trace([row(), row(), row(oy=np.nan)]),
        bb.InputError,
        r"^ray 2: origin\.y is nan",
    ),
    "a ray without direction": (
        lambda: trace([row(), row(dz=0)]),
        bb.InputError,
        r"^ray 1: direction is zero",
    ),
    "a ray that begins behind": (
        lambda: trace([row(t_min=-1)]),
        bb.InputError,
        r"^ray 0: interval is \[-1, inf\]",
    ),
    "a ray too large for float32": (
        lambda: trace([row(ox=1e300)]),
        bb.InputError,
        r"^ray 0: origin\.x is inf",
    ),
    "parts of unequal length": (
        lambda: bb.rays(np.zeros((3, 3)), np.ones((4, 3))),
        bb.InputError,
        r"3 origins, 4 directions",
    ),
    "a part of points in the plane": (
        lambda: bb.rays(np.zeros((3, 2)), [0, 0, 1]),
        bb.InputError,
        r"origins has shape \(3, 2\); expected \(N, 3\)",
    ),
    "a part that is invalid": (
        lambda: bb.rays(np.zeros((3, 3)), [[0, 0, 1], [0, np.inf, 0], [0, 0, 1]]),
        bb.InputError,
        r"^ray 1: direction\.y is inf",
    ),
    "a picture of two colors": (
        lambda: bb.to_srgb(np.zeros((4, 4, 2))),
        bb.InputError,
        r"picture has shape \(4, 4, 2\); expected \(height, width, 3\)",
    ),
}


@pytest.mark.parametrize("what", INVALID)
def test_invalid_input_is_one_sentence(what: str) -> None:
    call, kind, words = INVALID[what]
    with pytest.raises(kind, match=words) as raised:
        call()
    assert "\n" not in str(raised.value)
    assert not re.search(r"incompatible function|nanobind|_beambench\.", str(raised.value))


def test_input_errors_are_value_errors() -> None:
    assert issubclass(bb.InputError, ValueError)


# Threads


def slow_scene() -> bb.Scene:
    return bb.Scene("tetra:n=7")


@pytest.mark.parametrize("work", ["closest_hits", "any_hits", "trace_image", "render", "verify"])
def test_other_threads_go_on_while_rays_are_traced(work: str) -> None:
    scene = slow_scene()
    structure = bb.Structure(scene, "exhaustive")
    rays = scene.rays(resolution=(96, 72))
    many = np.repeat(rays, 200, axis=0)
    calls = {
        "closest_hits": lambda: structure.closest_hits(rays),
        "any_hits": lambda: structure.any_hits(rays),
        "trace_image": lambda: structure.trace_image(resolution=(96, 72)),
        "render": lambda: structure.render(resolution=(96, 72), threads=1),
        "verify": lambda: bb.verify(scene, many, t=np.zeros(len(many))),
    }
    thread = threading.Thread(target=calls[work])
    begin = time.perf_counter()
    thread.start()
    steps, longest, last = 0, 0.0, begin
    while thread.is_alive():
        time.sleep(0.001)
        steps += 1
        now = time.perf_counter()
        longest, last = max(longest, now - last), now
    taken = time.perf_counter() - begin
    assert taken > 0.1, "too short to tell anything"
    assert steps > 20
    assert longest < 0.8 * taken, "this thread waited for the other"


def test_one_structure_serves_several_threads(
    balls: bb.Scene, rays: NDArray[np.float32], correct: bb.Hits
) -> None:
    structure = bb.Structure(balls, "sah-bvh")
    found: list[bb.Hits] = []
    threads = [
        threading.Thread(target=lambda: found.append(structure.closest_hits(rays)))
        for _ in range(8)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 8
    assert all(np.array_equal(hits.t, correct.t) for hits in found)
