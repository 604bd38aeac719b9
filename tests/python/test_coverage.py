"""The coverage of a second run by prediction intervals, in both directions, and its script."""

import json
import subprocess
from pathlib import Path

import pytest

from beambench_report.__main__ import main
from beambench_report.base.analysis import read_analysis
from beambench_report.base.records import read_run
from beambench_report.run.coverage import coverage
from program import BINARY

SWEEP = {
    "name": "covered",
    "scenes": ["tetra:n=3", "balls:n=1"],
    "structures": ["samet", "embree"],
    "resolutions": ["32x20"],
    "repetitions": {"minimum": 6, "maximum": 9},
    "budget_seconds": 1,
    "warm_up_seconds": 0,
}


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("coverage")
    (folder / "sweep.json").write_text(json.dumps(SWEEP))
    for name in ("first", "second"):
        call = [BINARY, "run", folder / "sweep.json", "-o", folder / name]
        subprocess.run(call, check=True, capture_output=True)
    return folder / "first", folder / "second"


def test_a_run_covers_itself(runs: tuple[Path, Path]) -> None:
    one = (read_run(runs[0]), read_analysis(runs[0]))
    found = coverage(one, one)
    assert [part.what.split()[0] for part in found] == ["times", "ratios"] * 2
    assert all(part.within == part.count for part in found)
    assert found[0].count == 4
    assert found[1].count == 2


def test_every_value_of_another_run_is_counted(
    runs: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["coverage", str(runs[0]), str(runs[1])]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 6
    assert "of     4" in lines[0]
    assert lines[4].startswith("first run: ")


def test_the_script_explains_itself_and_refuses_nonsense(repository: Path) -> None:
    script = repository / "scripts/coverage"
    done = subprocess.run([script, "--help"], capture_output=True, text=True, check=True)
    assert "95% prediction intervals of the other run" in " ".join(done.stdout.split())
    for arguments in ([], ["quick", "default"], ["quick", "--pause", "soon"], ["nothing"]):
        done = subprocess.run([script, *arguments], capture_output=True, text=True, check=False)
        assert done.returncode == 2, arguments
        assert done.stderr.startswith("error: ")
