"""The fastest repetitions of a cell: their cycles, and the expected range in a further run."""

from __future__ import annotations

from math import isnan
from random import Random

import pytest

from beambench_report.base.cell_files import CellFile
from beambench_report.base.fastest import Fastest, fastest_of, with_fastest
from beambench_report.base.files import ROOT
from beambench_report.base.records import read_run
from beambench_thesis.paper.measured import error_between_runs

PUBLISHED = ROOT / "results" / "published" / "thesis"


def repeated(*repetitions: tuple[float, float]) -> CellFile:
    """Returns a cell with the given milliseconds and gigahertz of each repetition."""
    times, clocks = zip(*repetitions, strict=True)
    total = dict(enumerate(times))
    trace = {turn: 0.75 * ms for turn, ms in total.items()}
    return CellFile("", (), total, trace, clock_ghz=dict(enumerate(clocks)))


def test_of_ten_repetitions_the_five_fastest_count() -> None:
    quiet = [(100.0, 3.0), (101.0, 3.0), (102.0, 3.0), (103.0, 3.0), (104.0, 3.0)]
    found = fastest_of([repeated(*[(200.0, 3.0)] * 5, *quiet)])
    assert found == Fastest(102.0, 76.5, 306.0, pytest.approx(4 / 102))


def test_a_clock_that_was_read_in_a_disturbed_moment_makes_no_repetition_cheaper() -> None:
    """A third of the clock readings show 2 GHz instead of 3."""
    quiet = [(100.0, 3.0), (101.0, 2.0), (102.0, 3.0), (103.0, 3.0), (104.0, 2.0), (105.0, 3.0)]
    found = fastest_of([repeated(*quiet)])
    assert found is not None
    assert found.mcycles == pytest.approx(300, rel=0.02)
    assert found.error == pytest.approx(0.04)  # the range of the wall times; of the cycles: a third


def test_a_clock_that_changed_makes_the_work_no_dearer() -> None:
    changing = [(1000 / ghz, ghz) for ghz in (3.0, 3.1, 2.0, 2.1, 2.2)]
    found = fastest_of([repeated(*changing)])
    assert found is not None
    assert (found.mcycles, found.error) == (pytest.approx(1000), pytest.approx(0))


@pytest.mark.parametrize("count", [1, 3])
def test_of_too_few_repetitions_the_fastest_counts_and_has_no_error(count: int) -> None:
    found = fastest_of([repeated(*[(120.0, 3.0), (100.0, 3.0), (110.0, 3.0)][-count:])])
    assert found is not None
    assert (found.ms, found.mcycles) == ({1: 110.0, 3: 100.0}[count], {1: 330.0, 3: 300.0}[count])
    assert isnan(found.error)


def test_repetitions_without_a_clock_rate_do_not_count() -> None:
    assert fastest_of([CellFile("", (), dict.fromkeys(range(9), 100.0))]) is None


def test_the_repetitions_of_several_runs_count_together() -> None:
    runs = [repeated((100.0, 3.0), (200.0, 3.0)), repeated((101.0, 3.0), (102.0, 3.0))]
    found = fastest_of(runs)
    assert found is not None
    assert found.ms == pytest.approx(101.5)
    assert found.error == pytest.approx(300 / 304.5)


@pytest.mark.parametrize("repetitions", [6, 10, 20])
def test_a_further_run_lies_within_the_error_in_nine_of_ten_cases(repetitions: int) -> None:
    """A third of the repetitions and a tenth of the clock readings are disturbed."""
    random = Random(1999)

    def repetition() -> tuple[float, float]:
        ms, ghz = 100 * (1 + random.expovariate(50)), random.gauss(3, 0.015)
        if random.random() < 1 / 3:
            ms *= 1 + 0.5 * random.random()
        if random.random() < 0.1:
            ghz *= 1 - 0.3 * random.random()
        return ms, ghz

    def run() -> Fastest:
        found = fastest_of([repeated(*(repetition() for _ in range(repetitions)))])
        assert found is not None
        return found

    pairs = [(run(), run()) for _ in range(2000)]
    within = sum(
        abs(second.mcycles / first.mcycles - 1) <= error_between_runs(first.error)
        for first, second in pairs
    )
    assert within / len(pairs) > 0.9


def test_published_rows_have_figures_by_their_fastest_repetitions() -> None:
    (rows,) = with_fastest([read_run(PUBLISHED / "octree")])
    known = rows[rows["timed"]]
    assert (known["fastest_ms"] >= known["total_ms_min"] * 0.9999).all()  # six digits
    assert (known["fastest_ms"] <= known["total_ms_median"] * 1.0001).all()
    assert known["fastest_error"].between(0, 1).all()
