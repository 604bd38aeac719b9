"""The converter of AC3D files, on a generated file."""

from __future__ import annotations

import contextlib
from pathlib import Path

import pytest

from beambench_meshes.ac3d import convert, main
from beambench_meshes.problem import Problem
from synthetic_track import TRACK


def test_polygons_and_strips_are_converted_and_lines_counted() -> None:
    model = convert(TRACK)
    assert model.triangles == {
        "strips": 2,
        "joints of strips (left out)": 2,
        "polygons": 2 + 1,
        "lines (left out)": 0,
    }
    assert model.mesh.triangles() == 5
    assert [len(corners) for _, corners in model.mesh.faces] == [3, 3, 4, 3]
    assert list(model.mesh.colors) == ["Road.png", "plain"]


def test_groups_turn_and_move_what_is_in_them() -> None:
    mesh = convert(TRACK).mesh
    corners = [mesh.vertices[corner] for corner in mesh.faces[0][1]]
    assert corners == [(100, 0, 0), (100, 0, -1), (101, 0, 0)]
    last = [mesh.vertices[corner] for corner in mesh.faces[-1][1]]
    assert last == [(0, 1, 0), (1, 1, 0), (0, 1, 1)]


def test_a_file_that_lacks_objects_which_it_counts_is_read() -> None:
    model = convert(TRACK.replace("kids 2", "kids 4"))
    assert model.surfaces["objects that the file lacks"] == 2
    assert model.mesh.triangles() == 5


def test_a_file_that_is_cut_off_is_refused_or_lacks_whole_objects() -> None:
    lines = TRACK.splitlines(keepends=True)
    for count in range(len(lines)):
        with contextlib.suppress(Problem):
            model = convert("".join(lines[:count]))
            assert model.surfaces["objects that the file lacks"] == 1


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "does not begin with AC3D"),
        ("v 0 0 0\n", "does not begin with AC3D"),
        ("AC3Db\nOBJECT world\nkids 0\n", "no polygon"),
        (TRACK.replace("refs 6", "refs six"), "line 24 is malformed"),
        (TRACK.replace("refs 6", "refs -6"), "line 24: a count must not be negative"),
        (TRACK.replace("numvert 5", "numvert 6"), "line 21"),
        (TRACK.replace("\n4 0 0", "\n5 0 0"), "line 30: a surface has a corner beyond its 5"),
        (TRACK.replace("SURF 0x34", "SURF 0x37"), "type 7"),
        (
            TRACK.replace("kids 1\nOBJECT poly", "kids 1\npoly"),
            "line 9: an object is expected here",
        ),
        (TRACK.replace("0 0 0 0 1 0", "nan 0 0 0 1 0"), "vertex at (nan"),
        (TRACK.replace("rot 0 0 1", "rot 0 1"), "nine numbers"),
    ],
)
def test_a_malformed_file_is_refused_with_its_line(text: str, why: str) -> None:
    with pytest.raises(Problem) as caught:
        convert(text)
    assert why in str(caught.value)


def test_the_command_writes_an_obj_and_names_the_file_at_fault(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source, output = tmp_path / "track.acc", tmp_path / "track.obj"
    source.write_text(TRACK)
    assert main([str(source), str(output)]) == 0
    assert "strips: 1 surfaces, 2 triangles" in capsys.readouterr().out
    assert output.read_text().count("\nf ") == 4
    source.write_text("AC3Db\nOBJECT poly\nnumvert x\n")
    assert main([str(source), str(output)]) == 2
    message = capsys.readouterr().err
    assert message.startswith(f"error: {source}: line 3")
    assert message.count("\n") == 1
