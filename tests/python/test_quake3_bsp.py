"""The converter of Quake 3 maps, on generated maps."""

from __future__ import annotations

import contextlib
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from beambench_meshes.problem import Problem
from beambench_meshes.quake3_bsp import convert, main
from synthetic_bsp import MESH, PATCH, POLYGON, Bsp, Point, arch, small_map, square


def points_of(bsp: Bsp, level: int = 8) -> list[list[Point]]:
    mesh = convert(bsp.bytes(), level).mesh
    return [[mesh.vertices[corner] for corner in corners] for _, corners in mesh.faces]


def test_every_kind_of_face_is_converted_or_counted() -> None:
    level = convert(small_map().bytes(), 4)
    assert level.triangles == {
        "polygons": 2 + 2,
        "patches": 2 * 4 * 4,
        "triangle meshes": 1,
        "billboards (left out)": 0,
        "sky (left out)": 2,
        "not drawn (left out)": 1,
    }
    assert level.mesh.triangles() == len(level.mesh.faces) == 4 + 32 + 1
    assert "patches: 1 faces, 32 triangles\n" in level.report()
    assert list(level.mesh.colors) == ["textures/base/wall"]


def test_mesh_indices_count_from_the_first_vertex_of_the_face() -> None:
    bsp = Bsp(textures=[("a", 0)])
    bsp.face(0, POLYGON, square(1), (0, 1, 2))
    bsp.face(0, MESH, square(2), (3, 0, 1))
    assert points_of(bsp) == [[square(1)[i] for i in (0, 1, 2)], [square(2)[i] for i in (3, 0, 1)]]


def test_a_door_is_where_its_entity_puts_it() -> None:
    lower = min(x for face in points_of(small_map())[-2:] for x, _, _ in face)
    assert lower == 1005


def test_a_patch_is_its_bezier_surface() -> None:
    bsp = Bsp(textures=[("a", 0)])
    bsp.face(0, PATCH, arch(8.0), size=(3, 3))
    faces = points_of(bsp)
    assert len(faces) == 2 * 8 * 8
    for t in (0.0, 0.125, 0.5, 1.0):  # (1-t)^2 p0 + 2t(1-t) p1 + t^2 p2, along the arch
        expected = (8 * t * t, 0.0, 16 * t * (1 - t) + 8 * t * t)
        assert any(expected in face for face in faces), t
    y = {point[1] for face in faces for point in face}
    assert y == {float(number) for number in range(9)}


def test_neighboring_patches_share_the_samples_of_their_border_whatever_their_direction() -> None:
    here = [(0.1, 0.0, 0.3), (0.7, 0.0, 1 / 3), (1.9, 0.0, 0.9)]
    bsp = Bsp(textures=[("a", 0)])
    up = [(x, y, z + y) for y in (0.0, 1.0, 2.0) for x, _, z in here]
    down = [(x, -y, z + y) for y in (0.0, 1.0, 2.0) for x, _, z in reversed(here)]
    bsp.face(0, PATCH, up, size=(3, 3))
    bsp.face(0, PATCH, down, size=(3, 3))
    mesh = convert(bsp.bytes()).mesh
    assert sum(y == 0.0 for _, y, _ in mesh.vertices) == 9
    assert len(mesh.vertices) == 2 * 9 * 9 - 9


def test_patches_of_one_face_share_the_samples_between_them() -> None:
    bsp = Bsp(textures=[("a", 0)])
    bsp.face(0, PATCH, [(x, y, x * y) for y in range(3) for x in range(7)], size=(7, 3))
    mesh = convert(bsp.bytes(), 2).mesh
    assert mesh.triangles() == 3 * 2 * 2 * 2
    assert len(mesh.vertices) == 7 * 3


def test_players_starts_are_cameras_at_the_height_of_their_eyes() -> None:
    (camera,) = convert(small_map().bytes()).starts()
    assert camera["from"] == (10, 20, 56)
    assert camera["at"] == (10, 120, 56)


@pytest.mark.parametrize("angle", ["inf", "nan", "1e999", "north"])
def test_an_angle_that_is_no_number_counts_as_zero(angle: str) -> None:
    bsp = small_map()
    bsp.entities = bsp.entities.replace('"angle" "90"', f'"angle" "{angle}"')
    (start,) = convert(bsp.bytes()).starts()
    assert start["at"] == (110.0, 20.0, 56.0)


def test_a_map_that_is_cut_off_anywhere_is_refused_in_the_converters_words() -> None:
    whole = small_map().bytes()
    for size in range(len(whole) - 4):
        with pytest.raises(Problem):
            convert(whole[:size])


def test_changed_bytes_are_converted_or_refused_in_the_converters_words() -> None:
    whole = small_map().bytes()
    for place in range(0, len(whole) - 4, 4):
        for number in (-1, 0x7FFFFFFF, 2, 0x7FC00000):
            with contextlib.suppress(Problem):
                convert(whole[:place] + struct.pack("<i", number) + whole[place + 4 :], 2)


def wrong(change: Callable[[Bsp], None]) -> bytes:
    bsp = small_map()
    change(bsp)
    return bsp.bytes()


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"", "does not begin with IBSP"),
        (b"BSP2" + bytes(200), "does not begin with IBSP"),
        (b"IBSP" + struct.pack("<i", 47) + bytes(200), "version 47"),
        (b"IBSP" + struct.pack("<i", 46), "ends within its header"),
        (Bsp(textures=[("a", 0)]).bytes(), "no face that is drawn"),
        (
            wrong(lambda b: b.face(9, POLYGON, square(0), (0, 1, 2))),
            "in face 7, the texture is 9",
        ),
        (wrong(lambda b: b.face(0, POLYGON, square(0), (0, 1, 4))), "mesh indices from 0 to 4"),
        (wrong(lambda b: b.face(0, POLYGON, square(0), (0, 1))), "three for each triangle"),
        (wrong(lambda b: b.face(0, PATCH, arch(8), size=(3, 2))), "both numbers must be odd"),
        (wrong(lambda b: b.face(0, PATCH, arch(8), size=(3, 5))), "their product"),
        (wrong(lambda b: b.face(0, 7, square(0))), "the type is 7"),
        (wrong(lambda b: b.faces.append((0, 1, 90, 9, 0, 0, 0, 0))), "vertices 90 to 98"),
        (wrong(lambda b: b.models.pop()), "model *1"),
        (wrong(lambda b: b.models.append((0, 99))), ""),
        (wrong(lambda b: setattr(b, "entities", '{"a" "b"')), "ends within an entity"),
        (wrong(lambda b: setattr(b, "entities", '{"a" }')), "in a wrong place"),
        (
            wrong(lambda b: setattr(b, "entities", '{"model" "*1" "origin" "1 2"}')),
            "the origin '1 2'",
        ),
        (
            wrong(lambda b: setattr(b, "entities", '{"model" "*1" "origin" "1 2 inf"}')),
            "the origin '1 2 inf'",
        ),
        (
            wrong(
                lambda b: setattr(b, "entities", f'{{"model" "*{"9" * 5000}" "origin" "1 2 3"}}')
            ),
            "model *999999999, but there are 2",
        ),
        (
            wrong(lambda b: b.face(0, POLYGON, [(float("nan"), 0.0, 0.0)] * 3, (0, 1, 2))),
            "vertex at (nan",
        ),
    ],
)
def test_a_malformed_map_is_refused(data: bytes, why: str) -> None:
    if not why:
        assert convert(data).mesh.faces  # a model that no entity refers to is not read
        return
    with pytest.raises(Problem) as caught:
        convert(data)
    assert why in str(caught.value)


def test_the_command_writes_an_obj_and_names_the_file_at_fault(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    archive, output = tmp_path / "maps.pk3", tmp_path / "small.obj"
    with zipfile.ZipFile(archive, "w") as opened:
        opened.writestr("maps/small.bsp", small_map().bytes())
        opened.writestr("maps/cut.bsp", small_map().bytes()[:500])
    assert main([str(archive), "maps/small.bsp", str(output)]) == 0
    assert '"name": "start 1", "from": [10.0, 20.0, 56.0]' in capsys.readouterr().out
    lines = output.read_text().splitlines()
    assert sum(line.startswith("f ") for line in lines) == 4 + 128 + 1
    assert "mtllib small.mtl" in lines
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "maps.pk3",
        "small.mtl",
        "small.obj",
    ]
    for member, why in (
        ("maps/cut.bsp", "it ends within lump"),
        ("maps/no.bsp", "it has no maps"),
    ):
        assert main([str(archive), member, str(output)]) == 2
        message = capsys.readouterr().err
        assert message.startswith(f"error: {archive}: ")
        assert why in message
        assert message.count("\n") == 1
    assert main(["one"]) == 2


def test_a_map_larger_than_any_is_not_unpacked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("beambench_meshes.quake3_bsp._LARGEST_MAP", 1 << 20)
    archive = tmp_path / "maps.pk3"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as opened:
        opened.writestr("maps/bomb.bsp", bytes((1 << 20) + 1))
    assert main([str(archive), "maps/bomb.bsp", str(tmp_path / "a.obj")]) == 2
    assert "maps/bomb.bsp holds more than 1 MiB" in capsys.readouterr().err
