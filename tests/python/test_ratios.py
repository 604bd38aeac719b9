"""Ratios to the reference: paired by round, with an interval if there are enough rounds."""

from __future__ import annotations

from math import exp
from pathlib import Path

import numpy as np
import pytest

from beambench.analysis import (
    Median,
    Ratio,
    geometric_mean,
    paired_ratio,
    unpaired_ratio,
)
from beambench_report.base.cell_files import read_cell_files
from beambench_report.base.files import Problem
from beambench_report.base.records import read_run
from beambench_report.base.run_log import logged_cells
from beambench_report.run.reference import choose_reference, compared
from beambench_report.run.tables import ratio_field
from synthetic_run import synthetic_rows, without_times, write_cell, write_run


def test_intervals_may_overlap_and_the_paired_ratio_be_clear_of_1() -> None:
    """Both times range from 10 to 20 ms; in each round, one time is 5% above the other."""
    under = {turn: 10.0 + turn for turn in range(10)}
    over = {turn: 1.05 * time for turn, time in under.items()}
    ratio = paired_ratio(over, under)
    assert ratio is not None
    assert (ratio.low, ratio.high) == pytest.approx((1.05, 1.05))
    apart = unpaired_ratio(Median(15.2, 12.0, 18.0), Median(14.5, 11.5, 17.5))
    assert apart.low < 1 < apart.high
    assert not apart.paired


def test_only_rounds_that_both_have_are_paired() -> None:
    assert paired_ratio({0: 2.0, 1: 4.0, 2: 9.0}, {1: 2.0, 2: 3.0, 3: 1.0}) == Ratio(
        2.5, paired=True
    )
    assert paired_ratio({0: 1.0}, {1: 1.0}) is None


def test_the_paired_interval_covers_what_it_says() -> None:
    """Compares twelve rounds 2,000 times, with skewed noise; binomial tables predict 96.1%."""
    random = np.random.default_rng(5)
    covered = 0
    for _ in range(2000):
        common = random.exponential(1.0, 12) + 1  # affects both contenders
        over = dict(enumerate(common * random.lognormal(0, 0.02, 12)))
        ratio = paired_ratio(over, dict(enumerate(common)))
        covered += ratio.low <= 1.0 <= ratio.high
    assert 0.95 <= covered / 2000 <= 0.972


def test_ends_of_medians_add_up_in_quadrature() -> None:
    ratio = unpaired_ratio(Median(8, 8 / exp(0.3), 8 * exp(0.03)), Median(2, 2, 2 * exp(0.4)))
    assert ratio.value == 4
    assert ratio.low == pytest.approx(4 * exp(-0.5))
    assert ratio.high == pytest.approx(4 * exp(0.03))
    assert unpaired_ratio(Median(8), Median(2, 1, 3)) == Ratio(4)


def test_the_geometric_mean_has_an_interval_where_all_have_one() -> None:
    mean = geometric_mean([Ratio(2, 1, 4), Ratio(8, 4, 16)])
    assert mean.value == pytest.approx(4)
    # The ends of each ratio are a factor of 2 away; those of the mean of two, 2^(sqrt(2) / 2).
    assert mean.low == pytest.approx(4 / 2 ** (2**0.5 / 2))
    assert mean.high == pytest.approx(4 * 2 ** (2**0.5 / 2))
    assert geometric_mean([Ratio(2, 1, 4), Ratio(8)]).interval is None


def test_embree_is_the_reference_where_it_was_right(run_folder: Path) -> None:
    assert choose_reference(read_run(run_folder)) == "embree"


def test_of_embree_s_modes_the_fastest_is_the_reference(tmp_path: Path) -> None:
    rows = synthetic_rows()
    embree = [row for row in rows if row["structure"] == "embree"]
    packets = [
        {**row, "parameters": "mode=packet16", "trace_ms_median": 0.5 * row["trace_ms_median"]}
        for row in embree
    ]
    run = read_run(write_run(tmp_path, rows + packets))
    assert choose_reference(run) == "embree mode=packet16"
    run = read_run(write_run(tmp_path, rows + packets[:3]))  # of one view
    assert choose_reference(run) == "embree mode=single"


def test_the_reference_is_whoever_was_right_in_the_most_views(tmp_path: Path) -> None:
    rows = [
        without_times(row, "mismatch")
        if row["structure"] == "embree" and row["scene"] == "escena1"
        else row
        for row in synthetic_rows()
    ]
    assert choose_reference(read_run(write_run(tmp_path, rows))) == "exhaustive"


def test_without_a_right_contender_there_is_no_reference(tmp_path: Path) -> None:
    rows = [without_times(row, "error") for row in synthetic_rows()]
    run = read_run(write_run(tmp_path, rows))
    assert choose_reference(run) is None
    assert compared(run, "escena1", None, {})[0].ratios == {}


def test_a_wanted_reference_that_is_not_there_is_refused(run_folder: Path) -> None:
    with pytest.raises(
        Problem, match="no contender 'smet' has correct hits; these have: exhaustive, samet"
    ):
        choose_reference(read_run(run_folder), "smet")


def test_rounds_are_paired(tmp_path: Path) -> None:
    """A moment in which everything was ten times slower must not affect the ratio."""
    rows = [row for row in synthetic_rows() if row["structure"] in ("embree", "samet")]
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


def test_without_repetitions_it_is_the_ratio_of_medians_not_paired(run_folder: Path) -> None:
    run = read_run(run_folder)
    ratio = compared(run, "escena1", "embree", {})[-1].ratios["samet max_level=5"]
    rays = 320 * 200
    assert ratio.value == pytest.approx((1.5 + 2.2e-4 * rays) / (0.6 + 6e-5 * rays))
    assert not ratio.paired
    assert ratio.low < ratio.value < ratio.high
    assert ratio_field(ratio).note.endswith(", not paired")


@pytest.mark.parametrize("line", ['{"event": "finished", "index": 0}', '{"row": {}}', "[1", "3"])
def test_a_line_that_is_no_event_is_named(run_folder: Path, line: str) -> None:
    (run_folder / "run.jsonl").write_text(f'{{"event": "header"}}\n{line}\n')
    with pytest.raises(Problem, match=r"run\.jsonl, line 2: (not an event|is not JSON)"):
        read_cell_files(run_folder)


def test_a_log_is_read_up_to_its_last_whole_line(run_folder: Path) -> None:
    row = read_run(run_folder).rows.iloc[0].to_dict()
    write_cell(run_folder, row, {0: 4.0, 1: 8.0})
    whole = (run_folder / "run.jsonl").read_text()
    for size in range(len(whole) + 1):
        (run_folder / "run.jsonl").write_text(whole[:size])
        lines = whole[:size].count("\n")
        cells = logged_cells(run_folder)
        assert len(cells) == min(lines, 1)
        assert sum(len(cell.repetitions) for cell in cells) == max(0, min(lines - 1, 2))
        assert all(cell.is_finished == (lines == 4) for cell in cells)
