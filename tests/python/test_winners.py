"""The winning structures: each counts once, with its own best parameters."""

from pathlib import Path

import pytest

from beambench_report.__main__ import main
from beambench_report.base.cell_files import CellFile, identity
from beambench_report.base.records import read_run
from beambench_report.run.winners import races
from synthetic_run import synthetic_rows, write_run


def a_run(folder: Path, times: dict[tuple[str, str], tuple[float, float, float]]) -> Path:
    """Returns one view, with the median of each contender's trace time and its interval."""
    example = synthetic_rows()[0]
    rows = [
        example
        | {"structure": structure, "parameters": parameters, "verdict": "ok"}
        | {"trace_ms_median": median, "trace_ms_ci_low": low, "trace_ms_ci_high": high}
        | {"total_ms_median": median + 1}
        for (structure, parameters), (median, low, high) in times.items()
    ]
    write_run(folder, rows)
    return folder


def test_a_structure_counts_once_with_its_best_parameters(tmp_path: Path) -> None:
    run = a_run(
        tmp_path,
        {
            ("samet", "max_level=5"): (30, 29, 31),
            ("samet", "max_level=6"): (20, 19, 21),
            ("sah-bvh", "max_leaf=8"): (10, 9, 11),
            ("exhaustive", ""): (1, 1, 1),
        },
    )
    (race,) = races(read_run(run).rows, {})
    assert list(race.ranked["structure"]) == ["sah-bvh", "samet"]
    assert list(race.ranked["ratio"]) == [1, 2]
    assert list(race.ranked["parameters"]) == ["max_leaf=8", "max_level=6"]
    assert race.tied == ["sah-bvh"]
    assert race.words == "`sah-bvh`; 2.00 `samet`"


def test_a_structure_counts_with_its_better_order_of_rays(tmp_path: Path) -> None:
    example = synthetic_rows()[0] | {"parameters": "", "verdict": "ok"}
    times = {
        ("embree", "diffuse"): 20,
        ("embree", "diffuse:order=sorted"): 12,
        ("sah-bvh", "diffuse"): 15,
    }
    rows = [
        example
        | {"structure": structure, "ray_kind": kind, "trace_ms_median": ms}
        | {"trace_ms_ci_low": 0.99 * ms, "trace_ms_ci_high": 1.01 * ms, "total_ms_median": ms + 1}
        for (structure, kind), ms in times.items()
    ]
    (race,) = races(read_run(write_run(tmp_path, rows)).rows, {})
    assert race.ray_kind == "diffuse"
    assert race.words == "`embree`; 1.25 `sah-bvh`"
    assert list(race.ranked["contender"]) == ["embree, sorted rays", "sah-bvh"]


def test_ratios_of_blocks_may_be_undecided(tmp_path: Path) -> None:
    """A ratio of blocks is a tie only if it is equivalent within 3%."""
    run = read_run(a_run(tmp_path, {("samet", ""): (11, 9, 12), ("sah-bvh", ""): (10, 9, 11)}))
    blocks = {"sah-bvh": [9.8, 10, 10.2, 10], "samet": [10, 11, 11.5, 10.2]}
    files = {
        identity(row): CellFile(
            "", (), {}, dict(enumerate(blocks[row["structure"]])), in_blocks=True
        )
        for row in run.rows.to_dict("records")
    }
    (race,) = races(run.rows, files)
    assert race.tied == ["sah-bvh"]
    assert not race.is_decided
    assert race.words.endswith("`samet`, undecided")


def test_a_ratio_whose_interval_holds_1_is_a_tie(tmp_path: Path) -> None:
    run = a_run(
        tmp_path,
        {
            ("samet", ""): (11, 10, 12),
            ("sah-bvh", ""): (10, 9, 10.5),
            ("kd-tree", ""): (15, 14, 16),
        },
    )
    (race,) = races(read_run(run).rows, {})
    assert race.tied == ["sah-bvh", "samet"]
    assert race.words == "`sah-bvh`, `samet`; 1.50 `kd-tree`"


def test_intervals_of_medians_may_overlap_without_a_tie(tmp_path: Path) -> None:
    run = a_run(tmp_path, {("samet", ""): (11.4, 10.4, 12), ("sah-bvh", ""): (10, 9, 10.5)})
    (race,) = races(read_run(run).rows, {})
    assert race.tied == ["sah-bvh"]
    assert race.is_decided


def test_a_ratio_is_that_of_the_rounds_where_repetitions_are_known(tmp_path: Path) -> None:
    """A slow round affects both times; in the medians, it affects only one."""
    run = read_run(a_run(tmp_path, {("samet", ""): (12, 9, 20), ("sah-bvh", ""): (10, 8, 18)}))
    rounds = {"sah-bvh": [8, 9, 10, 10, 10, 17, 18], "samet": [8.8, 9.9, 11, 11, 12, 18.7, 19.8]}
    files = {
        identity(row): CellFile("", (), {}, dict(enumerate(rounds[row["structure"]])))
        for row in run.rows.to_dict("records")
    }
    (race,) = races(run.rows, files)
    assert list(race.ranked["ratio"]) == pytest.approx([1, 1.1])
    assert race.tied == ["sah-bvh"]


def test_the_medians_decide_where_a_ratio_has_no_interval(tmp_path: Path) -> None:
    none = float("nan")
    run = a_run(tmp_path, {("samet", ""): (10.1, none, none), ("sah-bvh", ""): (10, none, none)})
    (race,) = races(read_run(run).rows, {})
    assert race.tied == ["sah-bvh"]
    assert not race.is_decided


def test_the_tables_are_printed_or_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = a_run(tmp_path, {("samet", ""): (20, 19, 21), ("sah-bvh", ""): (10, 9, 11)})
    assert main(["winners", str(run)]) == 0
    printed = capsys.readouterr().out
    assert "## primary rays, 1 views" in printed
    assert "| `samet` | 2.00 | 0 of 1 |" in printed
    assert main(["winners", str(run), "-o", str(tmp_path / "winners.md")]) == 0
    assert (tmp_path / "winners.md").read_text() == printed


def test_a_run_without_times_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["winners", str(a_run(tmp_path, {("exhaustive", ""): (1, 1, 1)}))]) == 2
    assert "no structure has times" in capsys.readouterr().err
