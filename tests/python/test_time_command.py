"""`beambench time`, and the winner according to the program and the pages."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import jsonschema
import pytest

from program import BINARY, beambench, output_of, refused

QUICK = ("--resolution", "32x20", "--seconds", "0.2")


def test_time_ranks_the_structures_and_ends_with_two_verdicts() -> None:
    text = output_of("time", "tetra:n=3", "--accel", "samet,sah-bvh,exhaustive", *QUICK)
    lines = text.splitlines()
    assert lines[0] == "tetra:n=3 32x20, 640 primary rays"
    head = "contender SIMD build ms ns per ray Mrays/s times the fastest time per ray"
    assert lines[1].split() == head.split()
    bars = [line.split()[-1] for line in lines[2:5]]
    assert [set(bar) for bar in bars] == [{"#"}] * 3
    assert max(bars, key=len) == bars[-1], "the slowest has the longest bar"
    ranked = [line.split()[0] for line in lines[2:5]]
    assert set(ranked) == {"samet", "sah-bvh", "exhaustive"}
    assert ranked[-1] == "exhaustive"
    assert "(reference)" in lines[4]
    assert "Hits:  3 cells, all verified" in lines
    assert lines[-1].startswith("Times: ")


def test_over_several_scenes_there_are_means() -> None:
    text = output_of("time", "tetra:n=2", "balls:n=1", "--accel", "samet,sah-bvh", *QUICK)
    assert "Over 2 views of primary rays, geometric means:" in text
    assert re.search(r"(samet|sah-bvh) +\d.* 2 of 2", text)


def test_save_writes_the_sweep_that_it_was(tmp_path: Path, repository: Path) -> None:
    file = tmp_path / "mine.json"
    output_of("time", "tetra:n=2", "--accel", "samet:max_level=4", "--save", str(file), *QUICK)
    sweep = json.loads(file.read_text())
    schema = json.loads((repository / "harness/measure/sweep.schema.json").read_text())
    jsonschema.Draft202012Validator(schema).validate(sweep)
    assert sweep["structures"] == ["samet:max_level=4"]
    assert "tetra:n=2" in output_of("run", str(file), "--dry-run")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["tetra", "--accel", "samett"], "did you mean 'samet'"),
        ([], "SCENE"),
        (["no-such-scene"], "no-such-scene"),
        (["tetra", "--save", "/no/such/folder/x.json"], "/no/such/folder"),
        (["tetra", "--rays", "sideways"], "sideways"),
        (["tetra", "--resolution", "wide"], "wide"),
        (["tetra", "--samples", "0"], "samples"),
        (["tetra", "--camera", "nobody"], "nobody"),
    ],
)
def test_wrong_requests_are_refused_before_anything_is_built(
    arguments: list[str], words: str
) -> None:
    refused(beambench("time", *arguments), [words])


def test_nothing_is_left_behind(tmp_path: Path) -> None:
    done = subprocess.run(
        [BINARY, "time", "tetra:n=2", "--accel", "samet", *QUICK],
        capture_output=True,
        text=True,
        check=False,
        env={"TMPDIR": str(tmp_path), "PATH": "/usr/bin:/bin"},
    )
    assert done.returncode == 0, done.stderr
    assert list(tmp_path.iterdir()) == []


def test_lists_are_separated_by_commas_or_as_before_by_blanks() -> None:
    for words in (["primary,shadow"], ["primary, shadow"], ["primary", "shadow"]):
        text = output_of("time", "tetra:n=1", "--accel", "samet, sah-bvh", *QUICK, "--rays", *words)
        assert "640 primary rays" in text
        assert "shadow rays" in text


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--accel", "samet", "embree"], "'embree' is a structure, not a scene"),
        (["--accel", "samet", "--resolution", "640"], "--resolution: expected WIDTHxHEIGHT"),
        (["--accel", "samet", "--seconds", "5s"], "--seconds: '5s' is not a number from 0.1"),
        (["--accel", "samet", "--camera", "no"], "SCENE: "),
    ],
)
def test_messages_name_the_option_and_not_a_place_in_json(words: list[str], said: str) -> None:
    done = beambench("time", "tetra:n=1", *words)
    assert done.returncode == 2
    assert said in done.stderr
    assert "/0" not in done.stderr


def test_what_is_given_twice_is_timed_once_and_said() -> None:
    done = beambench("time", "tetra:n=1", "--accel", "samet,samet", *QUICK)
    assert "timed once" in done.stderr
    assert "1 cell, all verified" in done.stdout
