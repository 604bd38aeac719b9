"""Replaying one ray, and pictures of differences."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import pytest
from PIL import Image

from program import beambench, output_of, shell
from run_logs import events

TRACE = ("trace", "tetra:n=3", "--resolution", "64x64", "--pixel", "32,40")

# Four triangles whose long edges pass through the centers of pixels, seen from fifty times their
# size. Embree, in float, misjudges many rays at these edges, more than the budget for grazes.
FAR_AWAY = f"""v
from 0 0 100
at 0 0 0
up 0 1 0
angle {2 * math.degrees(math.atan2(2, 100))}
hither 0.1
resolution 64 64
f 1 0 0 1 0 0 0 0
s 0 0 0 1
""" + "".join(f"p 3\n0 0 0\n{x} 0 0\n0 {y} 0\n" for x in [2, -2] for y in [2, -2])


@pytest.fixture
def far_away(tmp_path: Path) -> Path:
    """A folder with a scene in which embree is wrong."""
    (tmp_path / "it's $far.nff").write_text(FAR_AWAY)
    asked = ("--accel", "embree", "--resolution", "64x64")
    if beambench("verify", "it's $far.nff", *asked, cwd=tmp_path).returncode == 0:
        pytest.skip("on this machine, this Embree has no wrong hits over the scene")
    return tmp_path


def way_of(*arguments: str) -> dict:
    return json.loads(output_of(*TRACE, *arguments, "--json"))


# One ray


def test_trace_tells_the_way_the_hit_and_what_the_oracle_says() -> None:
    way = way_of("--accel", "samet:max_level=4")
    assert way["class"] == "agree"
    assert way["hit"]["primitive"] == way["oracle"]["primitive"]
    assert way["hit"]["t"] == pytest.approx(way["oracle"]["t"], rel=1e-6)
    assert way["hit"] == way["hit_alone"] == way["steps"][-1]["best"]
    for step in way["steps"]:
        assert step["place"] == "leaf"
        assert step["t_enter"] <= step["t_exit"]
        assert 1 <= step["level"] <= 4
    assert len(way["steps"]) == way["counters"]["leaves"]
    tests = [test for step in way["steps"] for test in step["tests"]]
    assert len(tests) == way["counters"]["primitive_tests"]

    text = output_of(*TRACE, "--accel", "samet:max_level=4")
    assert text.count("leaf ") == len(way["steps"])
    assert f"primitive {way['hit']['primitive']} is hit at t = " in text
    assert "pixel (32, 40) sample 0: agree" in text
    assert "oracle    primitive" in text


def test_exhaustive_tests_everything_in_one_step() -> None:
    way = way_of("--accel", "exhaustive")
    assert [len(step["tests"]) for step in way["steps"]] == [4**3]
    hits = [test["t"] for test in way["steps"][0]["tests"] if test["hit"]]
    assert min(hits) == way["hit"]["t"]


def test_a_structure_that_tells_no_steps_is_judged_all_the_same() -> None:
    way = way_of("--accel", "embree:mode=packet8")
    assert way["steps"] == []
    assert way["class"] == "agree"
    assert "lists no steps" in output_of(*TRACE, "--accel", "embree")
    assert way_of("--accel", "null")["class"] == "agree", "a baseline is right when it is silent"


def test_each_sample_has_its_own_ray() -> None:
    directions = {
        tuple(way_of("--accel", "samet", "--samples", "4", "--sample", str(i))["ray"]["direction"])
        for i in range(4)
    }
    assert len(directions) == 4


def test_alone_does_not_trace_the_image() -> None:
    way = way_of("--accel", "exhaustive", "--alone")
    assert way["asked_all"] is False
    assert way["hit"] == way_of("--accel", "exhaustive")["hit"]


# From a report to the ray


def replays(text: str) -> list[str]:
    return re.findall(r"^ *replay +(beambench .*)$", text, re.MULTILINE)


def test_every_dispute_of_verify_prints_the_command_that_replays_it(far_away: Path) -> None:
    done = beambench(
        *("verify", "it's $far.nff", "--accel", "embree,samet", "--resolution", "64x64"),
        *("--json", "verdicts.json", "--pictures", "differences"),
        cwd=far_away,
    )
    assert done.returncode == 1
    judged, right = json.loads((far_away / "verdicts.json").read_text())["cells"]
    assert judged["verdict"] == "grazes"
    assert right["verdict"] == "ok"
    assert "picture" not in right
    assert len(judged["disputes"]) >= 3
    for dispute in judged["disputes"]:
        (command,) = replays(dispute)
        shown = shell(command, far_away)
        assert shown.returncode == 0, shown.stderr
        for line in dispute.splitlines()[:4]:  # pixel, ray, engine, oracle
            assert line in shown.stdout.splitlines()
    assert replays(done.stdout) == [replays(dispute)[0] for dispute in judged["disputes"][:3]]

    with Image.open(far_away / judged["picture"]) as picture:
        colors = {color for _, color in picture.getcolors(picture.width * picture.height)}
    assert (240, 228, 66) in colors, "grazes are yellow"


def test_a_sweep_prints_and_keeps_the_command_too(far_away: Path) -> None:
    sweep = {
        "name": "far",
        "scenes": ["it's $far.nff"],
        "structures": ["embree"],
        "resolutions": ["64x64"],
        "repetitions": {"minimum": 2, "maximum": 2},
        "budget_seconds": 1,
    }
    (far_away / "far.json").write_text(json.dumps(sweep))
    done = beambench("run", "far.json", "-o", "record", cwd=far_away)
    assert done.returncode == 1
    (end,) = [event for event in events(far_away / "record") if event["event"] == "finished"]
    for text in [done.stderr, *end["examples"]]:
        command = replays(text)[0]
        assert "--accel embree" in command
        assert "graze" in shell(command, far_away).stdout


# Pictures of differences


def colors_of(file: Path) -> set[tuple[int, int, int]]:
    with Image.open(file) as picture:
        return {color for _, color in picture.getcolors(picture.width * picture.height)}


def test_a_difference_picture_of_equals_is_grey_above_its_legend(tmp_path: Path) -> None:
    done = beambench(
        *("render", "tetra:n=3", "--accel", "samet", "--difference", "exhaustive"),
        *("-o", "same.png", "--resolution", "300x80"),
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    assert "0 of 24000 rays differ from exhaustive" in done.stderr
    with Image.open(tmp_path / "same.png") as picture:
        assert picture.height > 80
        above = picture.crop((0, 0, 300, 80)).getcolors(24000)
    assert all(red == green == blue for _, (red, green, blue) in above)
    assert len(above) > 5


def test_what_is_wrong_is_vermillion(tmp_path: Path) -> None:
    done = beambench(
        *("render", "tetra:n=3", "--accel", "null", "--difference", "oracle"),
        *("-o", "wrong.png", "--resolution", "64x64", "--samples", "4"),
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    assert (213, 94, 0) in colors_of(tmp_path / "wrong.png")


def test_differences_as_numbers(tmp_path: Path) -> None:
    output_of(
        *("render", "tetra:n=3", "--accel", "null", "--difference", "embree"),
        *("-o", tmp_path / "wrong.exr", "--resolution", "16x16"),
    )
    assert b"\0class\0" in (tmp_path / "wrong.exr").read_bytes()[:2000]


def test_a_heat_map_without_work_says_why(tmp_path: Path) -> None:
    done = beambench(
        *("render", "tetra:n=1", "--accel", "embree", "--heatmap", "leaves"),
        *("-o", "dark.png", "--resolution", "16x16"),
        cwd=tmp_path,
    )
    assert done.returncode == 0
    assert "embree counts none of this work" in done.stderr
