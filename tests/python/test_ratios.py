"""Ratios to the reference: paired by round, with an interval where there are rounds enough."""

from __future__ import annotations

from pathlib import Path

import pytest

from beambench_report.page.cell_files import read_cell_files
from beambench_report.page.ratios import choose_reference, compared, interval_rank
from beambench_report.problem import Problem
from beambench_report.records import read_run
from made_up_run import made_up_rows, without_times, write_cell, write_run


@pytest.mark.parametrize(
    ("count", "rank"),
    # Conover, "Practical Nonparametric Statistics", table A3
    [(0, 0), (5, 0), (6, 1), (8, 1), (9, 2), (11, 2), (12, 3), (15, 4), (20, 6), (50, 18)],
)
def test_the_interval_has_the_tabulated_ranks(count: int, rank: int) -> None:
    assert interval_rank(count) == rank


def test_embree_is_the_reference_where_it_was_right(run_folder: Path) -> None:
    assert choose_reference(read_run(run_folder)) == "embree"


def test_the_reference_is_whoever_was_right_in_the_most_views(tmp_path: Path) -> None:
    rows = [
        without_times(row, "mismatch")
        if row["structure"] == "embree" and row["scene"] == "escena1"
        else row
        for row in made_up_rows()
    ]
    assert choose_reference(read_run(write_run(tmp_path, rows))) == "exhaustive"


def test_without_a_right_contender_there_is_no_reference(tmp_path: Path) -> None:
    rows = [without_times(row, "error") for row in made_up_rows()]
    run = read_run(write_run(tmp_path, rows))
    assert choose_reference(run) is None
    assert compared(run, "escena1", None, {})[0].ratios == {}


def test_a_wanted_reference_that_is_not_there_is_refused(run_folder: Path) -> None:
    with pytest.raises(
        Problem, match="no contender 'smet' was right; there are: exhaustive, samet"
    ):
        choose_reference(read_run(run_folder), "smet")


def test_rounds_are_paired(tmp_path: Path) -> None:
    """A moment in which all were ten times slower must not be seen in the ratio."""
    rows = [row for row in made_up_rows() if row["structure"] in ("embree", "samet")]
    folder = write_run(tmp_path, rows)
    slowness = {turn: 10.0 if turn in (1, 2, 5) else 1.0 for turn in range(8)}
    for row in rows:
        factor = 3.0 if row["structure"] == "samet" else 1.0
        write_cell(folder, row, {turn: factor * slow for turn, slow in slowness.items()})
    found = compared(read_run(folder), "escena1", "embree", read_cell_files(folder))
    assert found[0].rows["rays"].iloc[0] == 1280 * 1024, "the finest comes first"
    ratio = found[0].ratios["samet max_level=5"]
    assert ratio.value == ratio.low == ratio.high == pytest.approx(3.0)
    assert found[0].ratios["embree"].value == 1.0


def test_without_repetitions_it_is_the_ratio_of_medians(run_folder: Path) -> None:
    run = read_run(run_folder)
    ratio = compared(run, "escena1", "embree", {})[-1].ratios["samet max_level=5"]
    rays = 320 * 200
    assert ratio.value == pytest.approx((1.5 + 2.2e-4 * rays) / (0.6 + 6e-5 * rays))
    assert ratio.low is ratio.high is None


def test_a_file_that_is_no_cell_is_named(run_folder: Path) -> None:
    (run_folder / "cells").mkdir()
    (run_folder / "cells" / "0.json").write_text('{"row": {}}')
    with pytest.raises(Problem, match=r"cells/0\.json: is not a cell of a run"):
        read_cell_files(run_folder)
