"""Tests of the Python module: verifying the hits of any program, and running sweeps."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from module import bb

Arrays = dict[str, NDArray]

SIZE = 20  # squares along each side of the mesh, each of two triangles
K_U = 16 * 2.0**-24 * (SIZE + 3)  # a lower bound; the sum is largest coordinate + distance


def mesh() -> bb.Scene:
    """Returns a mesh of squares in the plane z = 0."""
    x, y = np.meshgrid(np.arange(SIZE + 1), np.arange(SIZE + 1), indexing="ij")
    vertices = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(SIZE), np.arange(SIZE), indexing="ij"))
    a = i * (SIZE + 1) + j
    b, c, d = a + SIZE + 1, a + SIZE + 2, a + 1
    triangles = np.concatenate([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)])
    return bb.Scene.from_triangles(vertices, triangles, name="squares")


SCENE = mesh()
WRONG = 137  # the ray whose claim is changed


def vertical_rays() -> NDArray[np.float32]:
    """Returns rays down into the lower triangle of each square, and beside the mesh."""
    i, j = (a.ravel() for a in np.meshgrid(np.arange(SIZE), np.arange(SIZE), indexing="ij"))
    origins = np.stack([i + 0.6, j + 0.25, np.full(i.shape, 2.0)], axis=-1)
    origins[::7, 0] += SIZE
    return bb.rays(origins, [0, 0, -1])


RAYS = vertical_rays()
HITS = bb.Structure(SCENE, "exhaustive").closest_hits(RAYS)
HIT = HITS.hit


def claimed(form: str) -> Arrays:
    """Returns correct claims, in new arrays each time."""
    point = np.full((len(RAYS), 3), np.inf, np.float32)
    point[HIT] = RAYS[HIT, 0:3] + HITS.t[HIT, None] * RAYS[HIT, 4:7]
    every = {
        "t": HITS.t.copy(),
        "point": point,
        "primitive": HITS.primitive.copy(),
        "triangle": np.where(HIT, HITS.primitive, -1).astype(np.int64),
        "occluded": HIT.copy(),
    }
    return {name: every[name] for name in form.split()}


CLOSEST = ["t", "t primitive", "t triangle", "point", "point primitive", "point triangle"]
ALL = [*CLOSEST, "occluded"]


def move(claims: Arrays) -> None:
    """Moves a hit along the ray by ten units of the differ."""
    if "t" in claims:
        claims["t"][WRONG] += 10 * K_U
    else:
        claims["point"][WRONG, 2] += 10 * K_U


def move_aside(claims: Arrays) -> None:
    """Moves a hit across the ray by ten units of the differ, within the same triangle."""
    claims["point"][WRONG, 0] += 10 * K_U


def exchange(claims: Arrays) -> None:
    """Exchanges two ids."""
    name = "primitive" if "primitive" in claims else "triangle"
    claims[name][[WRONG, WRONG + 1]] = claims[name][[WRONG + 1, WRONG]]


def leave_out(claims: Arrays) -> None:
    """Leaves out one hit."""
    for name, array in claims.items():
        array[WRONG] = {
            "t": np.inf,
            "point": np.inf,
            "primitive": bb.NO_PRIMITIVE,
            "triangle": -1,
            "occluded": False,
        }[name]


def invent(claims: Arrays) -> None:
    """Claims a hit for a ray that misses."""
    miss = int(np.argmin(HIT))
    for name, array in claims.items():
        array[miss] = {"t": 2, "point": RAYS[miss, 0:3], "occluded": True}.get(name, 5)


FAULTS = [
    *((move, form) for form in CLOSEST),
    *((move_aside, form) for form in CLOSEST if "point" in form),
    *((exchange, form) for form in CLOSEST if " " in form),
    *((leave_out, form) for form in ALL),
    *((invent, form) for form in ALL),
]


def test_the_rays_are_fit_for_the_tests() -> None:
    assert HIT[WRONG]
    assert HIT[WRONG + 1]
    assert HITS.primitive[WRONG] != HITS.primitive[WRONG + 1]
    assert 0 < np.count_nonzero(~HIT) < 100


@pytest.mark.parametrize("form", ALL)
def test_correct_hits_are_right_in_every_form(form: str) -> None:
    report = bb.verify(SCENE, RAYS, **claimed(form))
    assert report.ok, report
    assert report.verdict == "ok"
    assert report.rays == len(RAYS)
    assert report.hits == np.count_nonzero(HIT)
    assert report.counts == {**dict.fromkeys(bb.CLASSES, 0), "agree": len(RAYS)}
    assert report.classes.dtype == np.uint8
    assert not report.classes.any()
    assert report.examples == []
    assert str(report).startswith("ok: 400 rays")


@pytest.mark.parametrize(("fault", "form"), FAULTS, ids=lambda x: getattr(x, "__name__", x))
def test_a_planted_fault_is_found(fault: Callable[[Arrays], None], form: str) -> None:
    claims = claimed(form)
    fault(claims)
    report = bb.verify(SCENE, RAYS, **claims)
    assert (report.verdict, report.ok) == ("mismatch", False)
    wrong = np.flatnonzero(report.classes == bb.CLASSES.index("structure_error"))
    expected = {
        exchange: [WRONG, WRONG + 1],
        invent: [int(np.argmin(HIT))],
    }.get(fault, [WRONG])
    assert wrong.tolist() == expected
    assert report.counts["structure_error"] == len(expected)
    assert [example.index for example in report.examples] == expected
    example = report.examples[0]
    assert example.class_name == "structure_error"
    assert np.array_equal(example.ray, RAYS[expected[0]])
    assert f"ray {expected[0]}: structure_error" in str(report)
    if fault is invent:
        assert example.oracle_t is None
        assert example.oracle_primitive is None
    else:
        assert example.oracle_t == pytest.approx(2)
        assert example.oracle_primitive == HITS.primitive[WRONG]
    if fault is leave_out:
        assert "claimed  no hit" in str(example)
    elif form == "occluded":
        assert example.claimed_occluded is True
        assert "claimed  some hit" in str(example)
    else:
        assert example.claimed_occluded is None
        assert (example.claimed_t is None) == ("point" in form)
        assert (example.claimed_point is None) == ("point" not in form)


def test_a_hit_within_rounding_is_no_fault() -> None:
    for change in (0.1 * K_U, -0.1 * K_U):
        claims = claimed("t primitive")
        claims["t"][WRONG] += change
        assert bb.verify(SCENE, RAYS, **claims).ok


def test_a_mistake_of_every_ray_is_a_report_that_can_be_read() -> None:
    claims = claimed("t primitive")
    claims["t"] += 1
    report = bb.verify(SCENE, RAYS, **claims)
    assert report.counts["structure_error"] == np.count_nonzero(HIT)
    assert len(report.examples) == 10
    assert str(report).count("structure_error,") == 3
    assert f"{report.counts['structure_error'] - 3} more that do not agree" in str(report)


@pytest.mark.parametrize(
    "change",
    [
        lambda a: a.astype(np.float64) if a.dtype.kind == "f" else a.astype(np.int64),
        lambda a: a.astype(np.int32) if a.dtype.kind != "f" else a,
        lambda a: np.repeat(a, 2, axis=0)[::2],
        lambda a: a.tolist(),
    ],
    ids=["wide", "int32", "strided", "lists"],
)
@pytest.mark.parametrize("form", ALL)
def test_other_dtypes_are_converted(change: Callable[[NDArray], NDArray], form: str) -> None:
    report = bb.verify(SCENE, RAYS, **{n: change(a) for n, a in claimed(form).items()})
    assert report.ok


def test_a_miss_in_float64_is_a_miss() -> None:
    t = np.where(HIT, HITS.t, np.finfo(np.float64).max)
    assert bb.verify(SCENE, RAYS, t=t).ok


def test_claims_are_read_where_they_are() -> None:
    from beambench.arrays import flags, ids, reals

    assert reals("t", HITS.t, ("N",), np.float32) is HITS.t
    assert ids("primitive", HITS.primitive, ("N",)) is HITS.primitive
    occluded = flags("occluded", HIT, ("N",))
    assert occluded.__array_interface__["data"][0] == HIT.__array_interface__["data"][0]


def test_many_parts_are_one_report() -> None:
    rays = np.tile(RAYS, (100, 1))
    t = np.tile(HITS.t, 100)
    t[39_000 + WRONG] += 1
    report = bb.verify(SCENE, rays, t=t)
    assert report.rays == 40_000
    assert np.flatnonzero(report.classes).tolist() == [39_000 + WRONG]
    assert report.examples[0].index == 39_000 + WRONG
    t[30_000] = np.nan
    with pytest.raises(bb.InputError, match=r"^ray 30000: t is not a number"):
        bb.verify(SCENE, rays, t=t)


def test_a_polygon_of_several_triangles_is_named_by_either_id() -> None:
    scene = bb.Scene("tetra:n=2")
    rays = scene.rays(resolution=(32, 32))
    hits = bb.Structure(scene, "exhaustive").closest_hits(rays)
    triangle = np.where(hits.hit, hits.primitive, -1)  # each polygon here is one triangle
    assert np.array_equal(scene.triangle_primitives, np.arange(len(scene.triangles)))
    assert bb.verify(scene, rays, t=hits.t, triangle=triangle).ok


def claims_of_two(**arrays: object) -> Callable[[], bb.Report]:
    return lambda: bb.verify(SCENE, RAYS[:2], **arrays)


INVALID: dict[str, tuple[Callable[[], object], type[Exception], str]] = {
    "nothing": (claims_of_two(), TypeError, r"no hits are given; pass t or point"),
    "ids alone": (
        claims_of_two(primitive=[0, 1]),
        TypeError,
        r"primitive alone does not state a hit",
    ),
    "two places": (
        claims_of_two(t=[1, 1], point=np.zeros((2, 3))),
        TypeError,
        r"t and point cannot be combined",
    ),
    "two ids": (
        claims_of_two(t=[1, 1], primitive=[0, 0], triangle=[0, 0]),
        TypeError,
        r"t and primitive and triangle cannot be combined",
    ),
    "both queries": (
        claims_of_two(t=[1, 1], occluded=[0, 1]),
        TypeError,
        r"t and occluded cannot be combined",
    ),
    "too few": (
        claims_of_two(t=[1]),
        bb.InputError,
        r"t has 1 rows, but there are 2 rays; expected one each",
    ),
    "too many": (
        claims_of_two(t=[1, 2], primitive=[0, 0, 0]),
        bb.InputError,
        r"primitive has 3 rows, but there are 2 rays",
    ),
    "no rays": (
        lambda: bb.verify(SCENE, np.empty((0, 8)), t=[]),
        bb.InputError,
        r"there are no rays",
    ),
    "t of two dimensions": (
        claims_of_two(t=[[1], [2]]),
        bb.InputError,
        r"t has shape \(2, 1\); expected \(N,\)",
    ),
    "points of two coordinates": (
        claims_of_two(point=np.zeros((2, 2))),
        bb.InputError,
        r"point has shape \(2, 2\); expected \(N, 3\)",
    ),
    "t that is text": (claims_of_two(t=["1", "2"]), TypeError, r"t has dtype <U1; expected real"),
    "t that is None": (claims_of_two(t=[1, None]), TypeError, r"t has dtype object"),
    "ids that are real": (
        claims_of_two(t=[1, 1], primitive=[0.0, 1.0]),
        TypeError,
        r"primitive has dtype float64; expected integers",
    ),
    "t that is not a number": (
        claims_of_two(t=[1, np.nan]),
        bb.InputError,
        r"^ray 1: t is not a number; a miss has t = infinity$",
    ),
    "t that is -infinity": (claims_of_two(t=[-np.inf, 1]), bb.InputError, r"^ray 0: t is -inf"),
    "a point that is not a number": (
        claims_of_two(point=[[0, 0, 0], [0, np.nan, 0]]),
        bb.InputError,
        r"^ray 1: a coordinate of the point is not a number",
    ),
    "a point that is half infinite": (
        claims_of_two(point=[[0, 0, np.inf], [0, 0, 0]]),
        bb.InputError,
        r"^ray 0: some coordinates of the point are infinite",
    ),
    "an id beyond the scene's": (
        claims_of_two(t=[1, 1], primitive=[0, 800]),
        bb.InputError,
        r"^ray 1: there is no primitive 800: the scene's are 0 to 799",
    ),
    "a triangle beyond the scene's": (
        claims_of_two(t=[1, 1], triangle=[0, 4_000_000_000]),
        bb.InputError,
        r"^ray 1: there is no triangle 4000000000",
    ),
    "an id beyond all": (
        claims_of_two(t=[1, 1], primitive=[0, 2**32]),
        bb.InputError,
        r"primitive\[1\] is 4294967296; expected an index",
    ),
    "an id below all": (
        claims_of_two(t=[1, 1], primitive=np.array([0, -2], np.int8)),
        bb.InputError,
        r"primitive\[1\] is -2; expected an index of at least 0, or -1",
    ),
    "an id without a place": (
        claims_of_two(t=[1, np.inf], primitive=[0, 1]),
        bb.InputError,
        r"^ray 1: primitive 1 is named, but its place is infinite",
    ),
    "neither true nor false": (
        claims_of_two(occluded=[1, 256]),
        bb.InputError,
        r"occluded\[1\] is 256; expected 0 or 1",
    ),
    "an invalid ray": (
        lambda: bb.verify(SCENE, np.concatenate([RAYS[:1], np.zeros((1, 8))]), t=[1, 1]),
        bb.InputError,
        r"^ray 1: direction is zero",
    ),
    "no scene": (
        lambda: bb.verify("tetra", RAYS, t=HITS.t),
        TypeError,
        r"scene is a str; expected a beambench\.Scene",
    ),
}


@pytest.mark.parametrize("what", INVALID)
def test_malformed_claims_are_one_sentence(what: str) -> None:
    call, kind, words = INVALID[what]
    with pytest.raises(kind, match=words) as raised:
        call()
    assert "\n" not in str(raised.value)
    assert not re.search(r"incompatible function|nanobind", str(raised.value))


# Sweeps

QUICK = {
    "name": "module",
    "scenes": ["tetra:n=2"],
    "structures": [
        "null",
        "exhaustive",
        {"structure": "samet", "parameters": {"max_level": [3, 4]}},
    ],
    "resolutions": ["16x12"],
    "rays": ["primary", "random"],
    "repetitions": {"minimum": 2, "maximum": 2},
    "budget_seconds": 1,
}


def test_a_sweep_is_a_data_frame(tmp_path: Path) -> None:
    frame = bb.sweep(QUICK, tmp_path / "run")
    assert len(frame) == 8
    assert set(frame["structure"]) == {"null", "exhaustive", "samet"}
    assert set(frame["verdict"]) == {"ok", "baseline"}
    assert frame["trace_ms_median"].dtype == np.float64
    assert (frame["trace_ms_median"] > 0).all()
    assert frame["rays"].dtype == np.int64
    assert frame["dirty"].dtype == bool
    assert all(isinstance(value, str) for value in frame["scene_hash"])
    assert set(frame["scene_hash"]) == {bb.Scene("tetra:n=2").hash}
    assert "Hits:  8 cells, all verified" in frame.attrs["summary"]
    assert (tmp_path / "run/results.csv").is_file()
    with pytest.raises(bb.InputError, match="run"):
        bb.sweep(QUICK, tmp_path / "run")
    again = bb.sweep(QUICK, tmp_path / "run", resume=True)
    assert again["run_id"].tolist() == frame["run_id"].tolist()
    assert again["trace_ms_median"].tolist() == frame["trace_ms_median"].tolist()


def test_a_sweep_of_a_file_leaves_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "quick.json"
    file.write_text(json.dumps({**QUICK, "structures": ["samet"]}))
    assert len(bb.sweep(file)) == 2
    assert list(tmp_path.iterdir()) == [file]
    assert capfd.readouterr() == ("", "")
    bb.sweep(file, progress=True)
    assert "samet" in capfd.readouterr().err


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"structures": ["samt"]}, r"config: /structures/0: .*samet"),
        ({"scenes": ["nowhere"]}, r"nowhere"),
        ({"resolutions": []}, r"config: /resolutions"),
        ({"color": "red"}, r"config: /color: unknown key"),
    ],
)
def test_a_faulty_sweep_is_one_sentence(changed: dict[str, object], words: str) -> None:
    with pytest.raises(bb.InputError, match=words) as raised:
        bb.sweep({**QUICK, **changed})
    assert "\n" not in str(raised.value)


def test_a_sweep_that_cannot_be_read_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(bb.InputError, match=r"none\.json"):
        bb.sweep(tmp_path / "none.json")
    (tmp_path / "half.json").write_text('{"name": ')
    with pytest.raises(bb.InputError, match=r"half\.json"):
        bb.sweep(str(tmp_path / "half.json"))
    with pytest.raises(bb.InputError, match="pass it as output"):
        bb.sweep(QUICK, resume=True)


def test_columns_of_text_are_those_of_the_dictionary() -> None:
    from beambench.sweeps import TEXT_COLUMNS
    from beambench_report.base.columns import dictionary

    known = dictionary().columns
    assert set(TEXT_COLUMNS) == {column.name for column in known if column.type == "text"}


# Hits of a structure


def test_hits_of_a_structure_are_verified_as_a_whole() -> None:
    rays = vertical_rays()
    structure = bb.Structure(SCENE, "sah-bvh")
    hits = structure.closest_hits(rays)
    report = bb.verify(SCENE, rays, hits)
    assert report.ok
    assert report.rays == len(rays)
    assert report.classes.shape == (len(rays),)
    hits.primitive[WRONG] = (hits.primitive[WRONG] + 3) % (2 * SIZE * SIZE)
    assert bb.verify(SCENE, rays, hits).verdict == "mismatch"


@pytest.mark.parametrize("samples", [1, 4])
def test_hits_of_an_image_are_verified_in_its_shape(samples: int) -> None:
    image = {"resolution": (64, 48), "samples": samples}
    hits = bb.Structure(SCENE, "embree").trace_image(**image)
    report = bb.verify(SCENE, SCENE.rays("primary", **image), hits)
    assert report.ok
    assert report.classes.shape == hits.t.shape == ((48, 64) if samples == 1 else (48, 64, 4))
    hits.t[20, 30] += 1
    report = bb.verify(SCENE, SCENE.rays("primary", **image), hits)
    assert report.verdict == "mismatch"
    assert bb.CLASSES[np.ravel(report.classes[20, 30])[0]] == "structure_error"


def test_hits_go_alone_and_are_hits() -> None:
    rays = vertical_rays()
    hits = bb.Structure(SCENE, "embree").closest_hits(rays)
    with pytest.raises(TypeError, match="hits cannot be combined with t"):
        bb.verify(SCENE, rays, hits, t=hits.t)
    with pytest.raises(TypeError, match=r"hits is a ndarray; expected a beambench\.Hits"):
        bb.verify(SCENE, rays, hits.t)
    with pytest.raises(bb.InputError, match="rows, but there are"):
        bb.verify(SCENE, rays[:-1], hits)


def test_ids_of_triangles_given_as_primitives_are_explained() -> None:
    scene = bb.Scene("gears:n=2")
    rays = scene.rays("primary", resolution=(64, 48))
    hits = bb.Structure(scene, "exhaustive").closest_hits(rays)
    triangle = np.searchsorted(scene.triangle_primitives, hits.primitive[hits.hit])
    assert triangle.max() >= scene.primitives
    ids = np.full(len(rays), -1)
    ids[hits.hit] = triangle
    with pytest.raises(bb.InputError, match="if the ids are those of triangles, give them as 't"):
        bb.verify(scene, rays, t=hits.t, primitive=ids)

    known = ids < scene.primitives
    report = bb.verify(scene, rays[known], t=hits.t[known], primitive=ids[known])
    assert not report.ok
    assert "t is right, but another primitive is hit there" in str(report)
    assert "primitive=scene.triangle_primitives[ids]" in str(report).splitlines()[-1]
    assert bb.verify(scene, rays, t=hits.t, triangle=ids).ok
    mapped = np.where(ids >= 0, scene.triangle_primitives[ids], bb.NO_PRIMITIVE)
    right = bb.verify(scene, rays, t=hits.t, primitive=mapped)
    assert right.ok
    assert right.hint == ""
