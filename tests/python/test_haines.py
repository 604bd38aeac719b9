"""Haines's tests by kind of primitive: counting, presentation, and committed results."""

import json
from pathlib import Path

import pytest

from beambench_report.__main__ import main
from beambench_report.base.files import ROOT, Problem
from beambench_report.haines.counts import CONTENDERS, KINDS, published_tests, read_tests
from beambench_report.haines.report import write_report

COMMITTED = ROOT / "results/published/haines"


def a_census(scene: str, contender: str) -> str:
    """Returns output like `beambench census --count --json`, with half of Haines's tests."""
    work = {f"{kind}_tests": published_tests()[scene][kind] / 2 for kind in KINDS}
    return json.dumps({"structure": contender, "scenes": [{"work": work}]})


def test_his_counts_are_of_seven_scenes_by_kind() -> None:
    his = published_tests()
    assert len(his) == 7
    assert his["tetra"] == {"polygon": 964567, "sphere": 0, "cone": 0, "box": 7636497}
    assert all(set(tests) == set(KINDS) for tests in his.values())


def test_what_was_counted_is_not_counted_again(tmp_path: Path) -> None:
    census = tmp_path / "census"
    census.mkdir()
    for scene in published_tests():
        for number, contender in enumerate(CONTENDERS):
            census.joinpath(f"{scene}-{number}.json").write_text(a_census(scene, contender))
    program = tmp_path / "never-run"
    program.touch()
    assert main(["haines", str(tmp_path), "--program", str(program)]) == 0
    assert read_tests(tmp_path / "tests.csv")[CONTENDERS[0]]["rings"]["cone"] == 8_149_000
    report = (tmp_path / "report.md").read_text()
    assert "8,149 / 16,298 = 0.50" in report
    assert "| tetra | 482 / 965 = 0.50 | - | - | 3,818 / 7,636 = 0.50 |" in report


def test_a_program_that_is_not_there_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["haines", str(tmp_path), "--program", str(tmp_path / "none")]) == 2
    assert "none cannot be run: No such file" in capsys.readouterr().err
    with pytest.raises(Problem, match="haines DIR"):
        read_tests(tmp_path / "tests.csv")


def test_the_committed_report_is_of_the_committed_counts(tmp_path: Path) -> None:
    tmp_path.joinpath("tests.csv").write_bytes(COMMITTED.joinpath("tests.csv").read_bytes())
    assert write_report(tmp_path).read_text() == COMMITTED.joinpath("report.md").read_text()
