"""Scenes that move, on the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from PIL import Image, ImageChops

from program import beambench, output_of, refused, shell

SMALL = "waving-sheet:triangles=200,frames=12"
PICTURE = ("--resolution", "24x18")


def facts(scene: str, *options: str) -> dict:
    return json.loads(output_of("scene", scene, "--json", *options))


def test_a_scene_tells_its_frames() -> None:
    first = facts(SMALL)
    assert (first["frames"], first["frame"]) == (12, 0)
    fifth = facts(SMALL, "--frame", "5")
    assert (fifth["frames"], fifth["frame"]) == (12, 5)
    assert fifth["name"] == first["name"]
    assert fifth["primitives"] == first["primitives"] == 200
    assert fifth["hash"] != first["hash"]
    assert fifth["bounds"] != first["bounds"]
    assert facts(SMALL, "--frame", "0") == first
    assert "12; this is frame 5" in output_of("scene", SMALL, "--frame", "5")
    still = facts("tetra:n=1")
    assert (still["frames"], still["frame"]) == (1, 0)
    assert "frame" not in output_of("scene", "tetra:n=1")


def test_the_list_marks_the_scenes_that_move() -> None:
    listed = {
        scene["name"]: scene["frames"]
        for scene in json.loads(output_of("list", "--json"))["scenes"]
    }
    moving = {name for name, frames in listed.items() if frames > 1}
    assert moving == {
        "exploding-mesh",
        "falling-spheres",
        "turning-solids",
        "twisting-body",
        "waving-sheet",
    }
    assert {listed[name] for name in moving} == {20}
    assert "  waving-sheet  [moves: 20 frames]" in output_of("list", "waving-sheet")
    assert "moves" not in output_of("list", "escena1").split("\n")[2]


@pytest.mark.parametrize(
    "command",
    [
        ("scene",),
        ("export", "-o", "a.nff"),
        ("render", "-o", "a.png"),
        ("verify", "--accel", "sah-bvh"),
        ("trace", "--accel", "sah-bvh", "--pixel", "1,1"),
    ],
    ids=lambda command: command[0],
)
def test_a_frame_that_is_not_there_is_refused(command: tuple[str, ...], tmp_path: Path) -> None:
    name, *options = command
    refused(beambench(name, SMALL, *options, "--frame", "12", cwd=tmp_path), ["frames 0 to 11"])
    refused(beambench(name, "tetra:n=1", *options, "--frame", "1", cwd=tmp_path), ["does not move"])
    assert not list(tmp_path.iterdir())


def test_an_exported_frame_is_that_frame(tmp_path: Path) -> None:
    output_of("export", SMALL, "--frame", "5", "-o", tmp_path / "a.nff")
    assert facts(str(tmp_path / "a.nff"))["hash"] == facts(SMALL, "--frame", "5")["hash"]


def test_pictures_of_frames_are_numbered(tmp_path: Path) -> None:
    done = shell(
        f"beambench render {SMALL} --frames 3-5 -o out.png --resolution 24x18 && "
        f"beambench render {SMALL} --frame 4 -o four.png --resolution 24x18",
        tmp_path,
    )
    assert done.returncode == 0, done.stderr
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["four.png", "out_0003.png", "out_0004.png", "out_0005.png"]
    assert "out_0003.png to out_0005.png: 3 pictures" in done.stderr
    assert "[2/3]" in done.stderr
    four, fourth, fifth = (
        Image.open(tmp_path / name) for name in ("four.png", "out_0004.png", "out_0005.png")
    )
    assert ImageChops.difference(four, fourth).getbbox() is None
    assert ImageChops.difference(fourth, fifth).getbbox() is not None


@pytest.mark.parametrize(
    "frames", ["5", "5-", "-5", "a-b", "5-3", "0-12", "99999999999-3", "1-2-3"]
)
def test_frames_that_are_none_are_refused(frames: str, tmp_path: Path) -> None:
    done = beambench("render", SMALL, f"--frames={frames}", "-o", "a.png", *PICTURE, cwd=tmp_path)
    refused(done, [f"--frames '{frames}'", "0-11"])
    assert not list(tmp_path.iterdir())


def test_frames_of_a_still_scene_and_both_options_are_refused(tmp_path: Path) -> None:
    done = beambench(
        "render", "tetra:n=1", "--frames", "0-0", "-o", "a.png", *PICTURE, cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr  # it has frame 0
    done = beambench("render", "tetra:n=1", "--frames", "0-1", "-o", "a.png", cwd=tmp_path)
    refused(done, ["does not move"])
    both = ("--frames", "0-1", "--frame", "1")
    assert beambench("render", SMALL, *both, "-o", "a.png", cwd=tmp_path).returncode == 2


def test_pictures_that_cannot_be_written_are_refused_first(tmp_path: Path) -> None:
    (tmp_path / "out_0004.png").mkdir()
    done = beambench("render", SMALL, "--frames", "3-5", "-o", "out.png", *PICTURE, cwd=tmp_path)
    refused(done, ["out_0004.png"])
    assert not (tmp_path / "out_0003.png").exists()


@pytest.mark.parametrize("scene", ["waving-sheet", "twisting-body", "turning-solids"])
def test_the_hits_of_a_frame_are_verified(scene: str) -> None:
    text = output_of(
        *("verify", scene, "--frame", "11", "--accel", "sah-bvh,embree", "--resolution", "40x30")
    )
    assert " ok" in text
    refused(beambench("verify", "--frame", "1"), ["--frame", "name them"])


def test_a_ray_is_traced_in_its_frame() -> None:
    ray = ("--accel", "sah-bvh", "--pixel", "20,20", "--resolution", "40x40", "--json")
    first = json.loads(output_of("trace", "waving-sheet", *ray))
    later = json.loads(output_of("trace", "waving-sheet", *ray, "--frame", "9"))
    assert first != later
