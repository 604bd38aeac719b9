"""The break-even number of rays."""

from __future__ import annotations

from pathlib import Path

import pytest

from beambench_report.base.records import read_run
from beambench_report.run.crossings import break_even, break_even_table
from synthetic_run import synthetic_rows, write_run


@pytest.mark.parametrize(
    ("costs", "rays", "words"),
    [
        # build in ms, trace in ns a ray, and the baseline's
        ((10.0, 1e3, 0.0, 2e3), 10_000, "from 10.0 k"),
        ((0.0, 2e3, 10.0, 1e3), 10_000, "up to 10.0 k"),
        ((1.0, 1e3, 0.5, 3e3), 250, "from 250"),
        ((1.0, 1e3, 2.0, 2e3), None, "at once"),
        ((1.0, 1e3, 1.0, 2e3), None, "at once"),
        ((2.0, 2e3, 1.0, 1e3), None, "never"),
        ((2.0, 1e3, 1.0, 1e3), None, "never"),
        ((1.0, 2e3, 1.0, 1e3), None, "never"),
    ],
)
def test_break_even(costs: tuple[float, ...], rays: float | None, words: str) -> None:
    found, found_words = break_even(costs[:2], costs[2:])
    assert found == (None if rays is None else pytest.approx(rays))
    assert found_words == words


def test_a_pair_is_compared_over_the_largest_image_that_both_traced(tmp_path: Path) -> None:
    rows = [
        row for row in synthetic_rows() if row["structure"] != "exhaustive" or row["width"] == 320
    ]
    table = break_even_table(read_run(write_run(tmp_path, rows)))
    with_exhaustive = (table["contender"] == "exhaustive") | (table["baseline"] == "exhaustive")
    assert with_exhaustive.any()
    small = {f"{row['width']}x{row['height']}" for row in rows if row["width"] == 320}
    assert set(table.loc[with_exhaustive, "resolution"]) == small
    assert small.isdisjoint(table.loc[~with_exhaustive, "resolution"])


def test_a_pair_without_a_common_image_has_no_row(tmp_path: Path) -> None:
    rows = [
        row
        for row in synthetic_rows()
        if (row["structure"] == "exhaustive") == (row["width"] == 320)
    ]
    table = break_even_table(read_run(write_run(tmp_path, rows)))
    assert not table.empty
    assert "exhaustive" not in {*table["contender"], *table["baseline"]}


def test_the_table_has_every_ordered_pair_but_none_with_null(run_folder: Path) -> None:
    table = break_even_table(read_run(run_folder))
    assert len(table) == 2 * 4 * 3
    assert "null" not in {*table["contender"], *table["baseline"]}
    pair = table[
        (table["view"] == "escena1")
        & (table["contender"] == "samet max_level=5")
        & (table["baseline"] == "exhaustive")
    ]
    assert pair["break_even_rays"].item() == pytest.approx((1.5 - 0.001) / (2e-3 - 2.2e-4))
