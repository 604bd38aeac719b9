"""Havran's octrees measured again: counting, comparison, and committed results."""

import json
from itertools import product
from pathlib import Path

import pandas as pd
import pytest

from beambench_report.__main__ import main
from beambench_report.base.files import Problem
from beambench_report.havran.contenders import SCENES, STRUCTURES, contender_of
from beambench_report.havran.counts import CASE, PUBLISHED, quantities_of, read_counts
from beambench_report.havran.report import SIZES, WORK, order, ratios
from program import BINARY

ONE, TWO = STRUCTURES[:2]


def counts(*values: tuple[str, float]) -> pd.DataFrame:
    index = pd.MultiIndex.from_tuples(
        [(structure, "tetra", "depth 4") for structure, _ in values], names=CASE
    )
    known = [value for _, value in values]
    return pd.DataFrame(dict.fromkeys(SIZES + WORK, known), index=index)


def test_every_case_of_the_five_octrees_is_published() -> None:
    published = read_counts(PUBLISHED)
    for structure, scene, depth in product(STRUCTURES, SCENES, (4, 5, 6, 7)):
        case = (structure, scene, f"depth {depth}")
        assert published.loc[case].notna().sum() == 8, case
        assert contender_of(structure, f"depth {depth}").endswith(f"max_level={depth + 1}")
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

    def signs(first: float, second: float) -> list[tuple[float, float]]:
        found = order(counts((ONE, first), (TWO, second)), published, "N_TS")
        return list(zip(found["ours"], found["his"], strict=True))

    assert signs(10, 11) == [(-1, -1)]
    assert signs(10, 10.1) == [(0, -1)]
    assert signs(11, 10) == [(1, -1)]
    assert order(published, counts((ONE, 100), (TWO, 101)), "N_TS").empty
    assert order(counts((ONE, 1)), published, "N_TS").empty


def test_ratios_are_of_common_counts_above_0() -> None:
    found = ratios(counts((ONE, 200), (TWO, 51)), counts((ONE, 100), (TWO, 0)))
    assert found["N_TS"].dropna().tolist() == [2]


def test_one_scene_is_measured_resumed_and_written(tmp_path: Path) -> None:
    arguments = ["havran", "measure", str(tmp_path), "--scene", "tetra", "--program", str(BINARY)]
    assert main(arguments) == 0
    ours = read_counts(tmp_path / "counts.csv")
    assert len(ours) == 20
    case = ours.loc["Samet 1989, center", "tetra", "depth 5"]
    assert case["N_V"] == 9584
    assert case["N_TS"] == pytest.approx(23.91, rel=0.01)
    file = next((tmp_path / "census").glob("*.json"))
    assert json.loads(file.read_text())["scenes"][0]["work"]["rays"] > 513 * 513
    before = file.stat().st_mtime_ns
    assert main(arguments) == 0
    assert file.stat().st_mtime_ns == before
    assert main(["havran", "write", str(tmp_path)]) == 0
    report = (tmp_path / "report.md").read_text()
    assert "| Samet 1989, center | depth 5 | 1,369 / 1,369 |" in report
