"""Two runs of one sweep, compared."""

from __future__ import annotations

from pathlib import Path

import pytest

from beambench_report.__main__ import main
from beambench_report.base.files import Problem
from beambench_report.base.records import read_run
from beambench_report.run.repeatability import repeatability
from synthetic_run import synthetic_rows, without_times, write_run


def run_in(folder: Path, rows: list[dict[str, object]]) -> Path:
    folder.mkdir()
    return write_run(folder, rows)


def slower(row: dict[str, object], factor: float) -> dict[str, object]:
    return row | {"total_mcycles_median": factor * float(str(row["total_mcycles_median"]))}


def test_medians_within_the_first_runs_intervals_are_counted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = synthetic_rows()
    again = [slower(row, 1.02) for row in rows]  # the intervals reach from 0.98 to 1.03
    again[4] = slower(rows[4], 1.5)
    first, second = run_in(tmp_path / "a", rows), run_in(tmp_path / "b", again)
    found = repeatability(read_run(first), read_run(second))
    assert len(found.cells) == len(rows)
    assert found.cells["within"].sum() == len(rows) - 1
    assert main(["repeated", str(first), str(second)]) == 0
    printed = capsys.readouterr().out.splitlines()
    assert printed[0].startswith(f"{len(rows) - 1} of {len(rows)} medians")
    assert printed[1].startswith("+50.0%")
    assert len(printed) == 2


def test_cells_that_one_run_lacks_or_could_not_time_are_left_out(tmp_path: Path) -> None:
    rows = synthetic_rows()
    again = [without_times(rows[0], "mismatch"), *rows[2:]]
    found = repeatability(
        read_run(run_in(tmp_path / "a", rows)), read_run(run_in(tmp_path / "b", again))
    )
    assert len(found.cells) == len(rows) - 2
    assert found.share == 1.0


def test_runs_of_different_sweeps_are_refused(tmp_path: Path) -> None:
    rows = synthetic_rows()
    first = read_run(run_in(tmp_path / "a", rows[:3]))
    second = read_run(run_in(tmp_path / "b", rows[5:]))
    with pytest.raises(Problem, match="no cell in common"):
        repeatability(first, second)


def test_runs_of_two_machines_are_refused(tmp_path: Path) -> None:
    rows = synthetic_rows()
    first = read_run(run_in(tmp_path / "a", rows))
    second = read_run(run_in(tmp_path / "b", [row | {"machine_id": "b"} for row in rows]))
    with pytest.raises(Problem, match=r"machine 0123456789abcdef, .* of b: a run is repeated"):
        repeatability(first, second)
