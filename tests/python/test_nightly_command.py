"""scripts/nightly, scripts/compare, diff and the exports, run as by a user."""

from __future__ import annotations

import json
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from beambench.analysis import Ratio
from beambench_operations.__main__ import main
from beambench_operations.nightly.compare import compare_turns, measure_in_turns
from beambench_operations.nightly.diff import diff
from beambench_operations.nightly.home import Home, only_one
from beambench_operations.nightly.run import _free_folder
from beambench_operations.site import write
from beambench_report.base.files import Problem
from beambench_report.base.records import read_run
from program import BINARY
from run_logs import begun_cells, events, forget_cell
from synthetic_nights import (
    add_all,
    counting,
    is_time,
    nothing,
    slower,
    write_night,
    write_nights,
    wrong,
)
from synthetic_run import without_times

TINY = {
    "name": "tiny",
    "description": "A night of seconds.",
    "scenes": ["stetra"],
    "structures": ["null", "samet", "embree"],
    "resolutions": ["32x20"],
    "precision": 0.5,
    "repetitions": {"minimum": 2, "maximum": 3},
    "budget_seconds": 0.2,
    "warm_up_seconds": 0,
}

needs_binary = pytest.mark.skipif(not BINARY.exists(), reason="beambench is not built")


def call(*command: str | Path, directory: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(part) for part in command], cwd=directory, capture_output=True, text=True, check=False
    )


def night(home: Path, sweep: Path, *more: str | Path) -> int:
    arguments = ["nightly", "run", "--home", home, "--sweep", sweep, "--beambench", BINARY, *more]
    return main([str(argument) for argument in arguments])


@pytest.fixture
def sweep(tmp_path: Path) -> Path:
    path = tmp_path / "tiny.json"
    path.write_text(json.dumps(TINY))
    return path


@pytest.fixture
def without_pages(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leaves each run's page empty: its plot takes longer to draw than the night to measure."""
    monkeypatch.setattr(write, "render", lambda *_, **__: "")


@pytest.mark.parametrize("script", ["nightly", "compare"])
def test_help_is_given(script: str, repository: Path) -> None:
    helped = call(repository / "scripts" / script, "--help", directory=repository)
    assert helped.returncode == 0
    assert helped.stdout.startswith(f"usage: scripts/{script}")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["HEAD"], "two commits are needed"),
        (["HEAD", "no-such-commit"], "'no-such-commit' is not a commit"),
        (["HEAD", "HEAD", "--turns", "4"], "--turns must be an even number, 6 or more"),
        (["HEAD", "HEAD", "--turns", "13"], "--turns must be an even number, 6 or more"),
        (["HEAD", "HEAD", "--sweep", "no/such"], "no/such is not a file"),
        (["HEAD", "HEAD", "--fast"], "unknown argument '--fast'"),
    ],
)
def test_compare_refuses_before_it_builds(
    arguments: list[str], message: str, repository: Path
) -> None:
    done = call(repository / "scripts/compare", *arguments, directory=repository)
    assert (done.returncode, done.stdout) == (2, "")
    assert message in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--sweep", "no/such.json"], "no/such.json: is not a file"),
        (["--published", "no/such"], "no/such: holds no results.csv"),
        (["--keep", "0"], "--keep must be at least 1"),
    ],
)
def test_a_wrong_request_is_one_sentence(
    arguments: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["nightly", "run", "--home", str(tmp_path), *arguments, "--dry-run"]) == 2
    assert message in capsys.readouterr().err


def test_two_nights_of_one_second_have_folders_of_their_own(tmp_path: Path) -> None:
    time = datetime(2026, 11, 21, 23, 59, 59, tzinfo=UTC)
    first = _free_folder(tmp_path, time)
    first.mkdir()
    assert first.name == "20261121T235959Z"
    assert _free_folder(tmp_path, time).name == "20261122T000000Z"


@needs_binary
def test_two_nights_in_a_row(
    tmp_path: Path, sweep: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    home = tmp_path / "home"
    assert night(home, sweep, "--dry-run") == 0
    assert "(0 nights)" in capsys.readouterr().out
    assert not home.exists()
    assert night(home, sweep) == 0
    (home / "20250101T000000Z").mkdir()  # as left by a killed run
    assert night(home, sweep) == 0
    assert not (home / "20250101T000000Z").exists()
    [page] = (home / "site/history").glob("tiny-*.html")
    assert "Since the run before" in page.read_text()
    [newest] = sorted(home.glob("2*T*Z"))[-1:]
    names = {path.name for path in newest.iterdir()}
    assert {"benchmark-bigger-is-better.json", "benchmark-google.json", "results.csv"} <= names


@needs_binary
@pytest.mark.usefixtures("without_pages")
def test_a_run_that_was_cut_off_is_resumed(tmp_path: Path, sweep: Path) -> None:
    home = tmp_path / "home"
    assert night(home, sweep) == 0
    [folder] = home.glob("2*T*Z")
    (home / "history.sqlite").unlink()
    count = len(begun_cells(folder))
    forget_cell(folder, 0)
    kept = events(folder)
    assert night(home, sweep, "--resume") == 0
    assert [*home.glob("2*T*Z")] == [folder]
    assert events(folder)[: len(kept)] == kept
    assert len(read_run(folder).rows) == count
    assert night(home, sweep, "--resume") == 2


def test_a_second_run_is_refused_while_one_goes_on(
    tmp_path: Path, sweep: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with only_one(Home(tmp_path).lock):
        assert night(tmp_path, sweep) == 2
    assert "a nightly run is in progress (process " in capsys.readouterr().err


@pytest.mark.usefixtures("without_pages")
def test_a_wrong_hit_ends_with_1_and_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    home = Home(tmp_path)
    *earlier, last = write_nights(home, 3, wrong("samet", "escena1", 2))
    add_all(home, earlier)
    arguments = ["nightly", "add", last, "--home", home.folder, "--beambench", "/bin/false"]
    assert main([str(argument) for argument in arguments]) == 1
    told = capsys.readouterr()
    assert "samet max_level=5 in escena1 at 320x200: wrong hits (mismatch)" in told.err
    assert told.out == f"{home.page}\n"


@pytest.mark.usefixtures("without_pages")
def test_a_run_from_elsewhere_is_copied_so_that_a_rebuild_finds_it(tmp_path: Path) -> None:
    [folder] = write_nights(Home(tmp_path / "elsewhere"), 1, nothing)
    arguments = ["nightly", "add", folder, "--home", tmp_path / "home"]
    assert main([str(argument) for argument in arguments]) == 0
    (tmp_path / "home/history.sqlite").unlink()
    assert main(["nightly", "rebuild", "--home", str(tmp_path / "home")]) == 0
    assert main([str(argument) for argument in arguments]) == 0
    assert len(list((tmp_path / "home").glob("2*Z/results.csv"))) == 1


# Comparisons


def test_a_slow_down_by_5_percent_is_told_by_turns(tmp_path: Path) -> None:
    before, after = Home(tmp_path / "a"), Home(tmp_path / "b")
    outcome = compare_turns(
        write_nights(before, 12, nothing, seed=1),
        write_nights(after, 12, slower("exhaustive", "escena1", 1.05, 0), seed=2),
    )
    assert {cell.title for cell in outcome.slower} <= {
        f"exhaustive in escena1 at {size}" for size in ("320x200", "640x480", "1280x1024")
    }
    assert len(outcome.slower) >= 1
    assert outcome.is_regression
    assert "SLOWER" in outcome.table()
    named = outcome.slower[0]
    assert outcome.verdict().startswith(f"SLOWER: {len(outcome.slower)} of 24 cells, by more than")
    assert f"{named.title} by {named.ratio.value - 1:.1%} ({named.ratio.low - 1:+.1%}" in (
        outcome.verdict()
    )


def test_turns_of_noise_tell_nothing(tmp_path: Path) -> None:
    first = write_nights(Home(tmp_path / "a"), 12, nothing, seed=1)
    second = write_nights(Home(tmp_path / "b"), 12, nothing, seed=2)
    outcome = compare_turns(first, second)
    assert outcome.slower == []
    assert outcome.sentences == []
    assert outcome.verdict().startswith("No cell is slower by more than 1%")
    assert "not ruled out" in outcome.verdict()
    assert outcome.table().splitlines()[-1].endswith("all cells together")
    with pytest.raises(Problem, match="6 or more of each, not 5 and 5"):
        compare_turns(first[:5], second[:5])


def test_turns_before_blocks_are_compared_with_none_in_blocks(tmp_path: Path) -> None:
    old = write_nights(Home(tmp_path / "a"), 6, nothing, seed=1, old=6)
    new = write_nights(Home(tmp_path / "b"), 6, nothing, seed=2)
    with pytest.raises(Problem, match=r"a/\S+: was measured by a program that does not"):
        compare_turns(old, new)
    assert compare_turns(old, old).slower == []


def test_turns_without_noise_leave_nothing_open(tmp_path: Path) -> None:
    first = write_nights(Home(tmp_path / "a"), 6, nothing, seed=1)
    second = write_nights(Home(tmp_path / "b"), 6, nothing, seed=1)
    outcome = compare_turns(first, second)
    assert outcome.together == Ratio(1.0, 1.0, 1.0, True, 1.0, 1.0, 0.0)
    assert outcome.verdict().endswith("over 24 cells).")


def test_ratios_on_one_side_by_a_common_cause_are_no_verdict(tmp_path: Path) -> None:
    """Comparing a program with itself gave only ratios below 1, because a turn is one event."""

    def moment(night: int, row: dict) -> dict:
        factor = (0.97, 1.02, 0.95, 0.96, 1.01, 0.98)[night]
        return row | {name: row[name] * factor for name in row if is_time(name, row)}

    first = write_nights(Home(tmp_path / "a"), 6, nothing, seed=1)
    outcome = compare_turns(first, write_nights(Home(tmp_path / "b"), 6, moment, seed=1))
    assert all(cell.ratio.value < 1 for cell in outcome.cells)
    assert outcome.together.low < 1 < outcome.together.high
    assert outcome.slower == []


def test_each_program_goes_first_equally_often(tmp_path: Path, sweep: Path) -> None:
    for turns in (5, 7, 4):
        with pytest.raises(Problem, match=f"{turns} turns: give an even number from 6 on"):
            measure_in_turns((Path("/bin/true"), Path("/bin/true")), sweep, tmp_path, turns)


def test_turns_tell_of_work_and_of_wrong_hits(tmp_path: Path) -> None:
    first = write_nights(Home(tmp_path / "a"), 6, nothing)
    more = counting("samet", "escena1", [1.1] * 6)
    bad = wrong("exhaustive", "escena1", 0)
    second = write_nights(Home(tmp_path / "b"), 6, lambda n, row: bad(n, more(n, row)))
    outcome = compare_turns(first, second)
    sentences = outcome.sentences
    assert f"WORSE: hits or work, in {len(sentences)} places" in outcome.verdict()
    assert "exhaustive in escena1 at 320x200: the hits are now wrong (mismatch)" in sentences
    assert any("traversal steps per ray from 11.5 to 12.65" in one for one in sentences)


def test_diff_puts_two_files_beside_each_other(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    [a] = write_nights(Home(tmp_path / "a"), 1, nothing)
    [b] = write_nights(Home(tmp_path / "b"), 1, slower("exhaustive", "escena1", 2.0, 0))
    renamed = tmp_path / "b.csv"
    (b / "results.csv").rename(renamed)
    assert main(["diff", str(a / "results.csv"), str(renamed)]) == 0
    told = capsys.readouterr().out
    assert "in milliseconds" in told
    pairs = {pair.title: pair for pair in diff(a, renamed).pairs}
    slow = pairs["exhaustive in escena1 at 320x200"]
    assert slow.ratio.low < 2.0 < slow.ratio.high
    assert slow.ratio.value == pytest.approx(2.0, rel=0.05)
    assert pairs["exhaustive in tetra:n=5 at 320x200"].ratio.value == pytest.approx(1.0, rel=0.05)


def elsewhere(_night: int, row: dict) -> dict:
    """Simulates a machine that takes three times as long."""
    times = {name: 3 * row[name] for name in row if is_time(name, row)}
    return {**row, **times, "machine_id": "b"}


def test_files_of_two_machines_are_compared_by_ratios_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    [a] = write_nights(Home(tmp_path / "a"), 1, nothing)
    [b] = write_nights(Home(tmp_path / "b"), 1, elsewhere)
    told = diff(a, b)
    assert "over that of embree mode=single in the same file" in told.what
    assert all(pair.ratio.value == pytest.approx(1.0, rel=0.1) for pair in told.pairs)
    assert "embree" not in {pair.structure for pair in told.pairs}
    assert told.text().startswith(
        "WARNING: two machines. A is of machine 0123456789abcdef, B of b."
    )
    assert main(["diff", "--no-relative", str(a), str(b)]) == 2
    assert "milliseconds of two machines cannot be compared" in capsys.readouterr().err


def processor(folder: Path, name: str) -> None:
    manifest = json.loads((folder / "manifest.json").read_text())
    (folder / "manifest.json").write_text(json.dumps(manifest | {"machine": {"cpu": name}}))


def test_one_id_and_two_processors_are_two_machines(tmp_path: Path) -> None:
    """A Xeon and an EPYC shared an id that came from the host's name."""
    [a] = write_nights(Home(tmp_path / "a"), 1, nothing)
    [b] = write_nights(Home(tmp_path / "b"), 1, nothing)
    assert diff(a, b).warning == ""
    processor(a, "Xeon")
    assert diff(a, b).warning == "", "the processor of the other file is unknown"
    processor(b, "EPYC")
    assert "0123456789abcdef (Xeon), B of 0123456789abcdef (EPYC)" in diff(a, b).warning
    processor(b, "Xeon")
    assert diff(a, b).warning == ""


def test_without_embree_another_common_contender_is_the_reference(tmp_path: Path) -> None:
    def without_embree(night: int, row: dict) -> dict:
        row = elsewhere(night, row)
        return without_times(row, "error") if row["structure"] == "embree" else row

    [a] = write_nights(Home(tmp_path / "a"), 1, nothing)
    [b] = write_nights(Home(tmp_path / "b"), 1, without_embree)
    told = diff(a, b)
    assert "over that of samet max_level=6,max_objects=0 in the same file" in told.what
    assert all(pair.ratio.value == pytest.approx(1.0, rel=0.1) for pair in told.pairs)


def test_diff_warns_of_a_file_from_before_blocks(tmp_path: Path) -> None:
    [a] = write_nights(Home(tmp_path / "a"), 1, nothing, old=1)
    [b] = write_nights(Home(tmp_path / "b"), 1, nothing)
    assert diff(a, b).warning.startswith("WARNING: one file was not measured in blocks.")


def test_diff_refuses_what_it_cannot_read(tmp_path: Path) -> None:
    [a] = write_nights(Home(tmp_path / "a"), 1, nothing)
    with pytest.raises(Problem, match=r"nothing\.csv: is not a file"):
        diff(a, tmp_path / "nothing.csv")
    broken = tmp_path / "broken.csv"
    broken.write_text("no,columns\n1,2\n")
    with pytest.raises(Problem, match=r"broken\.csv.*schema_version"):
        diff(a, broken)


def test_exports_hold_every_timed_cell(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = write_night(Home(tmp_path), 0, np.random.default_rng(1), wrong("samet", "escena1", 0))
    rows = read_run(folder).rows
    timed = rows[rows["verdict"] == "ok"]
    assert main(["benchmarks", str(folder), "--format", "customBiggerIsBetter"]) == 0
    bigger = json.loads(capsys.readouterr().out)
    assert len(bigger) == len(timed)
    assert {"name", "unit", "value", "range", "extra"} == set(bigger[0])
    assert bigger[0]["name"] == "escena1/default/320x200/1/primary/exhaustive"
    first = timed.iloc[0]
    assert bigger[0]["value"] == pytest.approx(first["rays"] / first["total_ms_median"] / 1000)
    google = ["benchmarks", str(folder), "--format", "google-benchmark"]
    assert main(google) == 2
    assert "beambench analyze --write" in capsys.readouterr().err
    (folder / "google-benchmark.json").write_text('{"benchmarks": []}\n')
    assert main(google) == 0
    assert capsys.readouterr().out == '{"benchmarks": []}\n'


def test_compare_builds_each_commit_and_measures_in_turns(
    repository: Path, tmp_path: Path, sweep: Path
) -> None:
    """Runs in a clone, with a cmake that only copies the program: building would take minutes."""
    if not BINARY.exists() or not (repository / ".git").exists():
        pytest.skip("beambench is not built, or this is not a repository")
    clone = tmp_path / "clone"
    call("git", "clone", "-q", "--shared", repository, clone, directory=tmp_path)
    # The code under test, committed or not.
    for script in ("compare", "arguments.sh", "beambench_report", "beambench_operations"):
        call("cp", "-r", repository / "scripts" / script, clone / "scripts/", directory=tmp_path)
    tools = tmp_path / "tools"
    tools.mkdir()
    cmake = tools / "cmake"
    cmake.write_text(
        "#!/usr/bin/env bash\n"
        f"mkdir -p build/release/bin && ln -sf {BINARY.resolve()} build/release/bin/beambench\n"
    )
    cmake.chmod(0o755)
    python = clone / ".venv/bin/python"
    python.parent.mkdir(parents=True)
    python.write_text(f'#!/bin/sh\nPYTHONPATH={clone}/scripts exec {sys.executable} "$@"\n')
    python.chmod(0o755)
    done = subprocess.run(
        ["bash", "-c", f"PATH={tools}:$PATH scripts/compare HEAD~1 HEAD --sweep {sweep} --turns 6"],
        cwd=clone,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode in (0, 1), done.stderr  # times on a busy machine are not judged here
    assert done.stdout.startswith("    B/A  95% confidence")
    assert "samet in stetra at 32x20" in done.stdout
    assert done.stdout.splitlines()[-1].startswith(("No cell is slower", "SLOWER"))
    turns = [line for line in done.stderr.splitlines() if line.startswith("== turn")]
    assert [line[-1] for line in turns] == list("ABBAABBAABBA")
    assert len(list((clone / "results/runs").glob("compare-*/?-0?/results.csv"))) == 12
