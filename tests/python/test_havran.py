"""Havran's octrees measured again: counting, comparison, and committed results."""

import json
from itertools import product
from pathlib import Path

import pytest

from beambench_report.__main__ import main
from beambench_report.base.files import Problem
from beambench_report.havran.comparison import Order, order, ratios
from beambench_report.havran.contenders import SCENES, STRUCTURES, contender_of
from beambench_report.havran.counts import PUBLISHED, Case, Counts, read_counts, write_counts
from beambench_report.havran.measure import quantities_of
from program import BINARY

ONE, TWO = STRUCTURES[:2]


def counts(*values: tuple[str, float]) -> Counts:
    return {Case(structure, "tetra", "depth 4"): {"N_TS": value} for structure, value in values}


def test_every_case_of_the_five_octrees_is_published() -> None:
    published = read_counts(PUBLISHED)
    for structure, scene, depth in product(STRUCTURES, SCENES, (4, 5, 6, 7)):
        case = Case(structure, scene, f"depth {depth}")
        assert len(published[case]) == 8, case
        assert contender_of(structure, case.setting).endswith(f"max_level={depth + 1}")
    with pytest.raises(Problem, match="expected 'depth N'"):
        contender_of(ONE, "20x20x20")


def test_steps_have_the_last_climb_and_tests_are_of_rays_that_hit() -> None:
    size = {"nodes": 9, "leaves": 8, "empty_leaves": 3, "references": 7}
    work = {"rays": 10, "rays_that_hit": 2, "primitive_tests": 6, "traversal_steps": 40}
    work |= {"last_climb": 5, "leaves": 30, "empty_leaves": 20}
    assert quantities_of({"size": size, "work": work}) == {
        "N_IN": 1, "N_V": 8, "N_EV": 3, "N_OIV": 7,
        "N_IT": 3.0, "N_TS": 4.5, "N_ETS": 3.0, "N_EETS": 2.0,
    }  # fmt: skip


def test_structures_are_in_the_same_order_level_or_reversed() -> None:
    published = counts((ONE, 100), (TWO, 200))
    assert order(counts((ONE, 10), (TWO, 11)), published, "N_TS") == Order(1, 1, 0)
    assert order(counts((ONE, 10), (TWO, 10.1)), published, "N_TS") == Order(1, 0, 1)
    assert order(counts((ONE, 11), (TWO, 10)), published, "N_TS").reversed == (tuple(published),)
    assert order(published, counts((ONE, 100), (TWO, 101)), "N_TS").pairs == 0
    assert order(counts((ONE, 1)), published, "N_TS").pairs == 0


def test_ratios_are_geometric_means_and_know_how_many_are_near() -> None:
    found = ratios(counts((ONE, 200), (TWO, 51)), counts((ONE, 100), (TWO, 50)), "N_TS")
    assert found is not None
    assert found.mean == pytest.approx((2 * 1.02) ** 0.5)
    assert found.within == 1
    assert ratios({}, {}, "N_TS") is None


def test_counts_are_read_as_they_were_written(tmp_path: Path) -> None:
    case = Case(ONE, "tetra", "depth 4")
    write_counts(tmp_path / "counts.csv", [(case, "glassner", {"N_TS": 21.5})])
    assert read_counts(tmp_path / "counts.csv") == {case: {"N_TS": 21.5}}


def test_one_scene_is_measured_resumed_and_written(tmp_path: Path) -> None:
    arguments = ["havran", "measure", str(tmp_path), "--scene", "tetra", "--program", str(BINARY)]
    assert main(arguments) == 0
    ours = read_counts(tmp_path / "counts.csv")
    assert len(ours) == 20
    case = Case("Samet 1989, center", "tetra", "depth 5")
    assert ours[case]["N_V"] == 9584
    assert ours[case]["N_TS"] == pytest.approx(23.91, rel=0.01)
    file = next((tmp_path / "census").glob("*.json"))
    assert json.loads(file.read_text())["scenes"][0]["work"]["rays"] > 513 * 513
    before = file.stat().st_mtime_ns
    assert main(arguments) == 0
    assert file.stat().st_mtime_ns == before
    assert main(["havran", "write", str(tmp_path)]) == 0
    report = (tmp_path / "report.md").read_text()
    assert "| Samet 1989, center | depth 5 | 1,369 / 1,369 |" in report
