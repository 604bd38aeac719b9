"""`beambench time`, and the winner according to the program and the pages."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import jsonschema
import pytest

from beambench_report.base.cell_files import read_cell_files
from beambench_report.base.records import read_run
from beambench_report.run.standings import overall, standings
from program import BINARY, beambench, output_of, refused

QUICK = ("--resolution", "32x20", "--seconds", "0.2")


def test_time_ranks_the_structures_and_ends_with_two_verdicts() -> None:
    text = output_of("time", "tetra:n=3", "--accel", "samet,sah-bvh,exhaustive", *QUICK)
    lines = text.splitlines()
    assert lines[0] == "tetra:n=3 32x20, 640 primary rays"
    assert lines[1].split() == "contender build ms ns per ray Mrays/s times the fastest".split()
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


def test_the_program_and_the_page_name_the_same_winners(tmp_path: Path) -> None:
    sweep = {
        "name": "both",
        "scenes": ["tetra:n=3", "balls:n=2"],
        "structures": ["null", "exhaustive", "samet:max_level=4", "samet:max_level=6", "embree"],
        "resolutions": ["32x20", "64x40"],
        "rays": ["primary", "shadow"],
        "repetitions": {"minimum": 7, "maximum": 7},
        "budget_seconds": 1,
        "exclude": [{"structure": "exhaustive", "primitives_above": 70}],
    }
    (tmp_path / "sweep.json").write_text(json.dumps(sweep))
    run = tmp_path / "run"
    done = beambench("run", str(tmp_path / "sweep.json"), "-o", str(run))
    assert done.returncode == 0, done.stderr
    views = standings(read_run(run), read_cell_files(run), sweep["exclude"])
    printed = [re.split(r"  +", line.strip()) for line in done.stderr.splitlines()]
    for view in views:
        line = next(
            words
            for words in printed
            if words[0].endswith(f"{view.size}")
            and view.ray_kind in words[0]
            and words[0].split(",")[0] in view.view
        )
        names = ", ".join(one.contender for one in view.ranked if one.is_tied)
        assert line[1].removeprefix("tie: ") == names
        if view.behind:
            assert line[2].startswith(f"{view.behind.contender} {view.behind.ratio.value:.3g} [")
    for kind in overall(views):
        for mean in kind.means:
            interval = f" [{mean.ratio.low:.3g}, {mean.ratio.high:.3g}]"
            is_certain = mean.ratio.low == mean.ratio.high
            ratio = f"{mean.ratio.value:.3g}{'' if is_certain else interval}"
            wins = f"{mean.wins} of {kind.views}"
            assert any(words[:3] == [mean.contender, ratio, wins] for words in printed), mean
    assert any(
        "no time for exhaustive in 2 views: left out by the sweep" in " ".join(words)
        for words in printed
    )
