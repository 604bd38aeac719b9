"""Claims are ranked as contenders are: by paired ratios and a margin."""

from __future__ import annotations

import re
from math import nan
from pathlib import Path
from random import Random

import pytest

from beambench.analysis import MARGIN
from beambench_report.base.published import COARSEST, FINEST
from beambench_thesis.claims.verdict import Outcome, below
from beambench_thesis.paper.evidence import (
    NO_BLOCKS,
    Blocks,
    Measured,
    smallest,
)
from beambench_thesis.paper.measured import measured_evidence
from synthetic_run import synthetic_rows, write_repeated_cell, write_run

YES, NO, UNDECIDED, MISSING = Outcome

# A disturbance of a block slows all of its contenders: by up to half.
COMMON = [Random(5).uniform(1, 1.5) for _ in range(8)]


def timed(factor: float, noise: float = 0.002, first: int = 0) -> Measured:
    """Returns a time of eight blocks, whose interval is as wide as their common noise."""
    own = {
        first + block: common * factor * (1 + noise * (-1) ** block)
        for block, common in enumerate(COMMON)
    }
    return Measured(1.25 * factor, factor, 1.5 * factor, Blocks(own))


@pytest.mark.parametrize(
    ("larger", "outcome"),
    [
        (timed(1.06, -0.002), YES),
        (timed(0.94, -0.002), NO),
        (timed(1.02, -0.002), NO),  # surely larger, and equal within the margin
        (timed(1.0, 0.01), NO),
        (timed(1.04, -0.05), UNDECIDED),
        (timed(0.98, -0.05), UNDECIDED),
    ],
)
def test_noise_that_is_common_to_a_block_cancels(larger: Measured, outcome: Outcome) -> None:
    """The intervals of the two times overlap widely, but the interval of their ratio is narrow."""
    found = below("cell", timed(1), larger)
    assert (found.outcome, found.is_paired) == (outcome, True)
    assert found.ratio == pytest.approx(larger.value / 1.25, rel=2e-3)
    apart = below("cell", *(Measured(one.value, one.low, one.high) for one in (timed(1), larger)))
    assert (apart.outcome, apart.is_paired) == (UNDECIDED, False)


def test_a_ratio_within_the_margin_is_a_tie_whether_paired_or_not() -> None:
    assert MARGIN == 0.03
    for tied in (
        below("cell", timed(1), timed(1.02, -0.002)),
        below("cell", Measured(10, 9.95, 10.05), Measured(10.1, 10.0, 10.2)),
    ):
        assert tied.outcome is NO
        assert "equal within 3%" in tied.figures
    four_percent = below("cell", Measured(10, 9.9, 10.1), Measured(10.2, 10.0, 10.4))
    assert four_percent.outcome is UNDECIDED


@pytest.mark.parametrize(
    ("larger", "outcome"), [(2.1, YES), (1.9, NO), (2.0, UNDECIDED), (2.02, UNDECIDED)]
)
def test_a_factor_is_met_by_the_ratio_of_blocks(larger: float, outcome: Outcome) -> None:
    found = below("cell", timed(1), timed(larger, -0.002), 2)
    assert found.outcome is outcome
    assert found.ratio == pytest.approx(larger, rel=2e-3)


def test_times_of_other_blocks_are_not_paired() -> None:
    """Blocks of another view or of another run are different processes."""
    found = below("cell", timed(1), timed(1.06, first=8))
    assert (found.outcome, found.is_paired) == (UNDECIDED, False)
    one_in_common = below("cell", timed(1), timed(1.06, first=7))
    assert (one_in_common.outcome, one_in_common.is_paired) == (UNDECIDED, False)


def test_counts_are_exact_and_need_no_pairs() -> None:
    found = below("cell", Measured.exact(1000), Measured.exact(1001))
    assert (found.outcome, found.is_paired) == (YES, None)


def test_a_time_without_an_interval_is_not_ranked() -> None:
    without = Measured(1, nan, nan)
    for smaller, larger in ((without, Measured(9, 8.9, 9.1)), (Measured.exact(9), without)):
        found = below("cell", smaller, larger)
        assert found.outcome is UNDECIDED
        assert found.figures.endswith("too few repetitions to rank")
    assert below("cell", smallest([without, Measured(9, 8, 10)]), timed(99)).outcome is UNDECIDED


def test_the_better_of_two_is_compared_as_the_fastest_of_a_view_is() -> None:
    better = smallest([timed(1.3), timed(1)])
    assert below("cell", better, timed(1.06, -0.002)).outcome is YES
    assert smallest([timed(1.3, first=8), timed(1)]).blocks is NO_BLOCKS


def test_a_ratio_is_made_block_by_block_where_it_can_be() -> None:
    paired, apart = timed(1.06, -0.002) / timed(1), timed(1.06, first=8) / timed(1)
    assert paired.value == pytest.approx(1.06, rel=1e-4)
    assert 1.05 < paired.low < paired.high < 1.07
    assert apart.low < 0.9 < 1.2 < apart.high


def test_an_undecided_pair_says_what_would_decide_it() -> None:
    found = below("cell", timed(1), timed(1.04, -0.05))
    words = re.search(r"about (\d+) times as many blocks would decide it", found.figures)
    assert words is not None
    assert int(words[1]) >= 2
    assert "blocks would" not in below("cell", timed(1), timed(1.5)).figures


# Runs in blocks

OCTREE = "max_level=6,max_objects=0,root=cube,assign=surface"
FACTORS = {"samet": 1.0, "samet-net": 1.06}


def write_in_blocks(folder: Path, blocks: int = 8) -> Path:
    """Writes a run of two contenders at two resolutions, with the noise of their blocks."""
    folder.mkdir()
    rows = []
    for structure, factor in FACTORS.items():
        for width, height in ((320, 200), (1280, 1024)):
            row = synthetic_rows()[0] | {"scene": "escena1:seed=1999,spheres=430"}
            row |= {"structure": structure, "parameters": OCTREE, "width": width, "height": height}
            rows.append(row | {"blocks": blocks, "trace_ms": 100.0, "total_ms": 100.0})
            repetitions = [
                {"round": 0, "position": 0, "block": block, "build_ms": 1.0, "build_cpu_ms": 1.0}
                | dict.fromkeys(("trace_ms", "trace_cpu_ms"), 100 * factor * common)
                | {"clock_ghz": 3.0}
                for block, common in enumerate(COMMON[:blocks])
            ]
            write_repeated_cell(folder, rows[-1], repetitions)
    return write_run(folder, rows)


def test_the_contenders_of_a_view_of_one_run_are_paired(tmp_path: Path) -> None:
    found = measured_evidence([write_in_blocks(tmp_path / "run")])
    quick, slow = (found.time("escena1", one, FINEST) for one in FACTORS)
    assert below("cell", quick, slow).outcome is YES
    coarse = found.time("escena1", "samet-net", COARSEST)
    assert below("cell", quick, coarse).is_paired is False


def test_pairs_of_several_runs_count_together(tmp_path: Path) -> None:
    both = [write_in_blocks(tmp_path / name, 3) for name in "ab"]
    quick, slow = (measured_evidence(both).time("escena1", one, FINEST) for one in FACTORS)
    assert quick is not None
    assert slow is not None
    assert len(quick.blocks.ms) == 6
    assert quick.blocks.ms.keys() == slow.blocks.ms.keys()
