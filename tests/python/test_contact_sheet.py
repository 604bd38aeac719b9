"""The contact sheet: its scenes, their appearance, and its behavior when a scene fails."""

from __future__ import annotations

import csv
import json
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from beambench_report.__main__ import main
from beambench_report.run.pictures import DEFAULT_GROUPS
from beambench_report.run.sheet_layout import GAP, MARGIN, WIDTH, Picture, even_rows
from program import BINARY, output_of

WIDE = """v
from 0 -5 0
at 0 0 0
up 0 0 1
angle 40
hither 0.1
resolution 64 32
#beambench aspect 2
b 0 0 1
l 0 -5 5
f 1 0 0 1 0 0 0 1
s 0 0 0 1
"""


def sheet(output: Path, *scenes: str | Path, program: Path = BINARY) -> int:
    command = ["contact-sheet", "-o", output, "--beambench", program, "--scenes", *scenes]
    return main([str(part) for part in command])


def test_two_scenes_stand_side_by_side(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = tmp_path / "sheet.png"
    assert sheet(output, "tetra:n=1", "balls:n=1") == 0
    said = capsys.readouterr()
    assert said.out.split() == [str(output)]
    assert said.err.splitlines() == [
        "rendering tetra:n=1 (1 of 2)",
        "rendering balls:n=1 (2 of 2)",
    ]
    assert list(tmp_path.iterdir()) == [output]
    pixels = imread(output)[..., :3]
    height, width, _ = pixels.shape
    assert width == 1400
    assert 340 < height < 460
    # The sky of tetra is square.
    sky = np.abs(pixels - (0.078, 0.361, 0.753)).max(axis=2) < 0.01
    rows, columns = np.nonzero(sky)
    assert np.ptp(columns) == pytest.approx(np.ptp(rows), abs=2)
    # Next to it is the yellow floor of balls, and nothing beyond.
    assert not np.array_equal(pixels[200, np.max(columns) + 50], (1, 1, 1))
    assert (pixels[:, 2 * np.max(columns) + 50 :] == 1).all()


def test_a_wide_picture_keeps_its_aspect(tmp_path: Path) -> None:
    scene = tmp_path / "wide.nff"
    scene.write_text(WIDE)
    output = tmp_path / "sheet.png"
    assert sheet(output, scene) == 0
    pixels = imread(output)[..., :3]
    rows, columns = np.nonzero((pixels[..., 2] > 0.9) & (pixels[..., 0] < 0.1))
    assert np.ptp(columns) == pytest.approx(2 * np.ptp(rows), abs=3)


def pictures_of(aspects: list[float]) -> list[Picture]:
    return [Picture("name", "counts", np.zeros((100, round(100 * a), 3))) for a in aspects]


@pytest.mark.parametrize("count", range(5, 32))
def test_rows_fill_the_width_whatever_the_number_of_pictures(count: int) -> None:
    pictures = pictures_of([(1.0, 1.6, 0.8, 1.25)[number % 4] for number in range(count)])
    rows = even_rows("heading", pictures)
    assert [picture for row in rows for picture in row.pictures] == pictures
    lengths = [len(row.pictures) for row in rows]
    assert max(lengths) <= min(lengths) + 1
    assert max(lengths) <= 6
    assert [row.heading for row in rows] == ["heading"] + [""] * (len(rows) - 1)
    for row in rows:
        edges = row.edges()
        assert (edges[0][0], edges[-1][1]) == (MARGIN, WIDTH - MARGIN)
        for (_, right), (left, _) in pairwise(edges):
            assert left - right == pytest.approx(GAP, abs=1)


def test_few_pictures_are_not_blown_up() -> None:
    (row,) = even_rows("", pictures_of([1.0, 1.0]))
    assert row.picture_height == 340


def test_the_rows_of_a_sheet_end_together(tmp_path: Path) -> None:
    output = tmp_path / "sheet.png"
    assert sheet(output, *[f"tetra:n={n}" for n in range(1, 8)]) == 0
    pixels = imread(output)[..., :3]
    blue = np.abs(pixels - (0.078, 0.361, 0.753)).max(axis=2) < 0.02
    ends = {
        (np.flatnonzero(line)[0], np.flatnonzero(line)[-1]) for line in blue if line.sum() > 400
    }
    assert ends == {(MARGIN, WIDTH - MARGIN - 1)}


def test_misil_and_soup_have_views_of_their_own(tmp_path: Path) -> None:
    program = tmp_path / "beambench"
    program.write_text(f'#!/bin/sh\necho "$@" >> {tmp_path}/calls.txt\nexec {BINARY} "$@"\n')
    program.chmod(0o755)
    assert sheet(tmp_path / "sheet.png", "misil", "soup", "tetra:n=1", program=program) == 0
    calls = (tmp_path / "calls.txt").read_text().splitlines()
    misil, soup, tetra = (call for call in calls if call.startswith("render"))
    assert all("--exposure auto" in call for call in (misil, soup, tetra))
    assert "--depth 1" in misil
    assert "--angle 12" in soup
    assert "--depth" not in tetra + soup
    assert "--angle" not in tetra + misil


def test_a_scene_that_cannot_be_rendered_is_named_and_the_sheet_is_left(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "sheet.png"
    output.write_text("the last one")
    assert sheet(output, "tetra:n=1", "nosuch") == 2
    error = capsys.readouterr().err
    assert error.startswith("error: scene 'nosuch' cannot be rendered: there is no scene 'nosuch'")
    assert error.count("\n") == 1
    assert list(tmp_path.iterdir()) == [output]
    assert output.read_text() == "the last one"


def test_wrong_requests_are_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert sheet(tmp_path / "sheet.jpg", "tetra") == 2
    assert "a contact sheet must be a .png file" in capsys.readouterr().err
    assert sheet(tmp_path / "nowhere/sheet.png", "tetra") == 2
    assert "there is no folder" in capsys.readouterr().err
    assert sheet(tmp_path / "sheet.png", "tetra", program=tmp_path / "beambench") == 2
    assert "cannot be run" in capsys.readouterr().err


def test_registered_meshes_stand_on_the_sheet_as_their_first_camera_sees_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("BEAMBENCH_CACHE", str(tmp_path))
    output = tmp_path / "sheet.png"
    command = ["contact-sheet", "-o", str(output), "--beambench", str(BINARY), "--registered"]
    assert main(command) == 2
    assert "no mesh is registered; run scripts/meshes first" in capsys.readouterr().err
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (tmp_path / "registered").mkdir()
    entry = {"path": "../a.obj", "cameras": [{"name": "near", "from": [0, 0, 1], "at": [0, 0, 0]}]}
    (tmp_path / "registered/a.json").write_text(json.dumps(entry))
    assert main(command) == 0
    assert capsys.readouterr().err == "rendering mesh:a (1 of 1)\n"
    assert output.exists()


def test_the_fifteen_scenes_of_the_thesis_come_first(repository: Path) -> None:
    with (repository / "results/thesis/scenes.csv").open() as file:
        assert list(DEFAULT_GROUPS[0].scenes) == [row["scene"] for row in csv.DictReader(file)]


def test_every_scene_of_the_catalogue_stands_on_the_sheet() -> None:
    listed = json.loads(output_of("list", "--json"))["scenes"]
    shown = [scene for group in DEFAULT_GROUPS for scene in group.scenes]
    assert sorted(shown) == [scene["name"] for scene in listed if scene["origin"] == "built in"]
