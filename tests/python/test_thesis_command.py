"""scripts/thesis and `python -m beambench_thesis run`, called as by a user."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from beambench_thesis.__main__ import main
from beambench_thesis.report import plan
from beambench_thesis.report.plan import make_plan, quick, read_sweep
from program import BINARY
from synthetic_thesis import texts_of, write_runs

# Replaces the program: records its arguments, and writes the files of a run.
STAND_IN = """#!/usr/bin/env bash
echo "$*" >>"$(dirname "$0")/calls"
folder="${@: -1}"
mkdir -p "$folder/cells"
[[ $folder == *interrupted* && $folder == *best-* ]] && exit 130
echo '{"finished_utc": "2026-01-02T03:08:15Z"}' >"$folder/manifest.json"
[[ $folder == *broken* ]] && exit 2
[[ $folder == *wrong* ]] && exit 1
exit 0
"""


@pytest.fixture
def stand_in(tmp_path: Path) -> Path:
    """A program that measures nothing."""
    path = tmp_path / "beambench"
    path.write_text(STAND_IN)
    path.chmod(0o755)
    return path


def calls(program: Path) -> list[str]:
    return program.with_name("calls").read_text().splitlines()


def run_thesis(*arguments: str | Path) -> int:
    return main(["run", *map(str, arguments)])


def test_a_dry_run_lists_sweeps_cells_and_time(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_thesis("--dry-run") == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 16
    assert lines[0].split() == ["synthetic", "100", "cells", "3", "min", "20", "s"]
    assert lines[-1].startswith("in all")
    assert run_thesis("--dry-run", "--table", "5.4", "--quick") == 0
    assert len(capsys.readouterr().out.splitlines()) == 3


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--table", "5.9"], "there is no table '5.9'; there are 5.2, 5.3"),
        (["--figure", "5.3"], "there is no figure '5.3'; there are 5.4, 5.5"),
        (["--resume", "no/such"], "give the folder that an earlier scripts/thesis wrote"),
        (["--resume", "x", "--quick"], "--resume continues a run"),
        (["--report-only"], "--report-only needs the folder of a run"),
    ],
)
def test_a_wrong_request_is_one_sentence_and_exit_code_2(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_thesis(*arguments) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.startswith("error: ")
    assert message in told.err
    assert told.err.count("\n") == 1


def test_each_sweep_is_run_once_and_a_finished_one_never_again(
    stand_in: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = tmp_path / "run"
    options = ["--beambench", stand_in]
    assert run_thesis("--table", "5.4", "-o", run, *options) == 0
    assert calls(stand_in) == [
        f"run {run}/sweeps/{name}.json -o {run}/{name}" for name in ("synthetic", "best-synthetic")
    ]
    assert "== run 1 of 2: synthetic: 100 cells" in capsys.readouterr().err
    # A run interrupted in the middle continues; the finished one is left alone.
    (run / "best-synthetic" / "manifest.json").write_text('{"finished_utc": null}')
    assert run_thesis("--resume", run, "--dry-run") == 0
    assert "finished" in capsys.readouterr().out.splitlines()[0]
    assert run_thesis("--resume", run, *options) == 0
    assert calls(stand_in)[2:] == [f"run --resume {run}/best-synthetic"]
    # The levels may be requested later.
    assert run_thesis("--resume", run, "--levels", *options) == 0
    assert calls(stand_in)[3:] == [f"run {run}/sweeps/levels.json -o {run}/levels"]
    assert run_thesis("--resume", run, *options) == 0
    assert len(calls(stand_in)) == 4
    assert run_thesis("--table", "5.4", "-o", run, *options) == 2  # would mix two runs
    assert "holds a run already" in capsys.readouterr().err


def test_an_interrupted_run_says_how_to_go_on(
    stand_in: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = tmp_path / "interrupted"
    assert run_thesis("--table", "5.4", "-o", run, "--beambench", stand_in) == 130
    assert f"resume with: scripts/thesis --resume '{run}'" in capsys.readouterr().err
    assert not (run / "report.html").exists()


@pytest.mark.parametrize(("name", "code"), [("wrong", 1), ("broken", 2)])
def test_the_exit_code_tells_what_went_wrong(
    name: str, code: int, stand_in: Path, tmp_path: Path
) -> None:
    run = tmp_path / name
    assert run_thesis("--table", "5.4", "-o", run, "--beambench", stand_in) == code
    assert len(calls(stand_in)) == 2  # the second is run nevertheless
    assert (run / "report.html").exists()


def test_a_report_is_written_anew_without_measuring(
    stand_in: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = write_runs(tmp_path / "run", make_plan(["5.6"], [], False))
    assert run_thesis("--resume", run, "--report-only", "--beambench", stand_in) == 0
    assert capsys.readouterr().out.splitlines()[0] == str(run / "report.html")
    assert not stand_in.with_name("calls").exists()


def test_a_program_that_is_not_there_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ("--table", "5.4", "-o", tmp_path / "run", "--beambench", tmp_path / "no-such")
    assert run_thesis(*arguments) == 2
    assert "cannot be run" in capsys.readouterr().err


def test_a_small_real_run_leaves_a_report(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if not BINARY.exists():
        pytest.skip("beambench is not built; run scripts/setup")
    folder = tmp_path / "sweeps"
    folder.mkdir()
    for name in ("synthetic", "best-synthetic"):
        source = quick(read_sweep(name)).source | {"scenes": ["escena2"], "warm_up_seconds": 0}
        source |= {"resolutions": ["320x200"], "repetitions": {"minimum": 1, "maximum": 1}}
        source["structures"] = source["structures"][:3]
        (folder / f"{name}.json").write_text(json.dumps(source))
    monkeypatch.setattr(plan, "FOLDER", folder)
    run = tmp_path / "run"
    assert run_thesis("--table", "5.4", "-o", run, "--beambench", BINARY) == 0
    text = texts_of(run)
    assert "19 measurements in 2 runs, all with correct hits." in text
    assert "### Table 5.4" in text
    assert (run / "figures" / "figure-5.12.svg").exists()
    assert (run / "synthetic" / "results.csv").exists()


def call(*arguments: str, repository: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [repository / "scripts/thesis", *arguments], capture_output=True, text=True, check=False
    )


def test_the_script_helps_lists_and_refuses_before_it_builds(repository: Path) -> None:
    helped = call("--help", repository=repository)
    assert helped.returncode == 0
    assert helped.stdout.startswith("usage: scripts/thesis")
    if not (repository / ".venv/bin/python").exists():
        pytest.skip("there is no .venv; run scripts/setup")
    listed = call("--dry-run", "--table", "5.5", repository=repository)
    assert listed.returncode == 0, listed.stderr
    assert [line.split()[0] for line in listed.stdout.splitlines()] == [
        "octree",
        "best-octree",
        "shallow",
        "in",
    ]
    refused = call("--table", "6.1", repository=repository)
    assert (refused.returncode, refused.stdout) == (2, "")
    assert refused.stderr.startswith("error: there is no table '6.1'")
    assert refused.stderr.count("\n") == 1
