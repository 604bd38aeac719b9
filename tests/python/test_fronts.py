"""Build or trace: fronts, the best choices, their plot, and rank correlations."""

from __future__ import annotations

from math import isfinite
from pathlib import Path

import pandas as pd
import pytest

from beambench.analysis import Ratio, break_even_rays
from beambench_operations.publish.figures.builders import correlation
from beambench_report.__main__ import main
from beambench_report.base.analysis import Standing, read_analysis
from beambench_report.run.fronts import Front, choices_of, front_of, fronts


def standing(name: str, build_ms: float, ns_per_ray: float) -> Standing:
    return Standing(name, name.partition(" ")[0], build_ms, ns_per_ray, Ratio(1.0), "unranked")


CHEAP, MIDDLE, DEAR, WASTED, DOMINATED = (
    standing("lbvh", 1, 100),
    standing("ploc", 2, 60),
    standing("sweep", 20, 50),
    standing("binned", 18, 59.9),
    standing("samet", 21, 90),
)


def test_the_front_is_by_build_and_without_the_dominated() -> None:
    front = front_of([DOMINATED, DEAR, WASTED, CHEAP, MIDDLE])
    assert front == (CHEAP, MIDDLE, WASTED, DEAR)
    assert front_of([CHEAP]) == (CHEAP,)


def test_choices_are_the_best_between_their_numbers_of_rays() -> None:
    front = front_of([DEAR, WASTED, CHEAP, MIDDLE])
    choices = choices_of(front)
    assert [choice.standing for choice in choices] == [CHEAP, MIDDLE, DEAR]
    assert [choice.rays for choice in choices] == [
        0,
        break_even_rays(2, 60, 1, 100),
        break_even_rays(20, 50, 2, 60),
    ]
    for choice in choices:
        rays = 1.01 * choice.rays + 1
        costs = {one: one.build_ms + 1e-6 * rays * one.ns_per_ray for one in front}
        assert min(costs, key=lambda one: costs[one]) == choice.standing


def test_of_those_that_overtake_at_once_the_fastest_is_chosen() -> None:
    line = [standing("a", 1, 30), standing("b", 2, 20), standing("c", 3, 10)]
    assert [choice.standing for choice in choices_of(line)] == [line[0], line[2]]


def test_fronts_are_those_of_the_analysis(run_folder: Path) -> None:
    found = fronts(read_analysis(run_folder))
    assert [front.scene for front in found] == ["escena1", "tetra:n=5"]
    for front in found:
        assert isinstance(front, Front)
        assert front.choices[-1].standing == front.view.fastest
        assert all(isfinite(choice.rays) for choice in front.choices)
        shown = {*front.members, *front.others}
        assert shown == set(front.view.ranked)
        assert {*front.never} <= {*front.members}


def test_the_command_draws_a_figure_for_each_kind_of_rays(run_folder: Path) -> None:
    assert main(["fronts", str(run_folder)]) == 0
    drawn = sorted(path.name for path in (run_folder / "plots").glob("fronts*"))
    assert drawn == ["fronts-primary.png", "fronts-primary.svg"]
    text = (run_folder / "plots/fronts-primary.svg").read_text("utf-8")
    assert "best from 0 rays on" in text
    assert "build in ms" in text


def test_a_rank_correlation_is_taken_in_each_scene_by_itself() -> None:
    costs = [1.0, 2.0, 3.0, 4.0]
    rows = pd.DataFrame(
        [("a", cost, 10 * cost**2) for cost in costs]
        + [("b", cost, 1e6 - cost) for cost in costs]
        + [("few", 1.0, 1.0)],
        columns=["scene", "sah_cost", "trace_ms"],
    )
    found = correlation(rows, "sah_cost")
    assert found is not None
    assert (found.least, found.middle, found.most) == pytest.approx((-1, 0, 1))
    assert found.scenes == 2
    assert correlation(rows[rows["scene"] == "few"], "sah_cost") is None
