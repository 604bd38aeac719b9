"""The ledger's rules of chapter 6, with invented figures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from beambench_report.base.files import Problem
from beambench_thesis.chapter6.results import write_results
from beambench_thesis.claims.chapter6 import CLUSTER_CLAIMS, cluster_evidence
from beambench_thesis.claims.register import ALL_CLAIMS, judge, judge_claims
from beambench_thesis.claims.verdict import Outcome, Verdict
from beambench_thesis.paper.evidence import FIGURES, NOTHING, ClusterEvidence, Evidence

CLAIMS = {claim.name: claim for claim in CLUSTER_CLAIMS}
CAT, TOWER = "gato-bill", "torre-eiffel"

# Figures with which every claim holds.
HOLDING = {
    CAT: {
        "best_processors": 11,
        "best_efficiency": 0.75,
        "mean_efficiency": 0.72,
        "last_efficiency": 0.7,
        "beams": 3000,
        "fewest_beams": 150,
        "most_beams": 300,
        "first_end": 99,
        "last_end": 100,
        "producer_busy": 0.4,
        "consumers_that_saturate": 60,
        "slowdown_slow": 0.74,
        "capacity_slow": 0.75,
        "slowdown_used": 0.81,
        "capacity_used": 0.82,
    },
    TOWER: {
        "best_processors": 7,
        "best_efficiency": 0.66,
        "mean_efficiency": 0.62,
        "last_efficiency": 0.5,
        "beams": 4000,
        "fewest_beams": 200,
        "most_beams": 400,
        "first_end": 49,
        "last_end": 50,
        "producer_busy": 0.9,
        "consumers_that_saturate": 14,
        "slowdown_slow": 0.74,
        "capacity_slow": 0.75,
        "slowdown_used": 0.81,
        "capacity_used": 0.82,
    },
}

# Changes that make each claim fail in part: another value for a figure of one scene.
PART = {
    "C22": [
        (CAT, "best_processors", 4),
        (CAT, "best_efficiency", 0.95),
        (CAT, "last_efficiency", 0.8),
        (TOWER, "best_processors", 14),
        (TOWER, "best_efficiency", 0.55),
        (TOWER, "last_efficiency", 0.7),
    ],
    "C23": [(CAT, "most_beams", 155), (TOWER, "first_end", 40)],
    "C38": [(CAT, "slowdown_slow", 0.5), (TOWER, "slowdown_used", 0.5)],
    "C24": [
        (TOWER, "beams", 2000),
        (TOWER, "producer_busy", 0.3),
        (TOWER, "consumers_that_saturate", 100),
    ],
}
FAILS = {
    "C22": {
        CAT: {"best_processors": 3, "best_efficiency": 0.5, "last_efficiency": 0.6},
        TOWER: {"best_processors": 15, "best_efficiency": 0.55, "last_efficiency": 0.6},
    },
    "C23": {
        CAT: {"most_beams": 151, "first_end": 50},
        TOWER: {"most_beams": 201, "first_end": 20},
    },
    "C38": {scene: {"slowdown_slow": 0.4, "slowdown_used": 0.5} for scene in (CAT, TOWER)},
    "C24": {
        TOWER: {"beams": 2000, "producer_busy": 0.3, "consumers_that_saturate": 100},
    },
}


def evidence(changes: dict[str, dict[str, float]] | None = None) -> Evidence:
    rows = [
        {"scene": scene, "network": "made up", "quantity": quantity}
        | dict.fromkeys(
            ("value", "low", "high"), (changes or {}).get(scene, {}).get(quantity, value)
        )
        for scene, figures in HOLDING.items()
        for quantity, value in figures.items()
    ]
    return replace(NOTHING, cluster=ClusterEvidence(pd.DataFrame(rows, columns=list(FIGURES))))


@pytest.mark.parametrize("name", sorted(CLAIMS))
def test_each_verdict_can_be_had(name: str) -> None:
    claim = CLAIMS[name]
    assert judge(claim, evidence()).verdict is Verdict.SUPPORTED
    assert judge(claim, evidence(FAILS[name])).verdict is Verdict.CONTRADICTED
    assert judge(claim, NOTHING).verdict is Verdict.NOT_TESTED
    for scene, quantity, value in PART[name]:
        found = judge(claim, evidence({scene: {quantity: value}}))
        assert found.formerly == "holds in part", (scene, quantity)


@pytest.mark.parametrize("name", sorted(CLAIMS))
def test_without_a_scene_nothing_is_tested(name: str) -> None:
    rows = evidence().cluster.figures
    cut = replace(NOTHING, cluster=ClusterEvidence(rows[rows["scene"].ne(TOWER)]))
    assert judge(CLAIMS[name], cut).verdict is Verdict.NOT_TESTED


def test_the_thesis_tells_part_of_its_figures() -> None:
    (entry,) = (entry for entry in judge_claims([]) if entry.claim.name == "C22")
    told = [check for check in entry.thesis.checks if check.outcome is not Outcome.MISSING]
    assert entry.thesis.verdict is Verdict.NOT_TESTED  # its plots are lost
    assert {check.outcome for check in told} == {Outcome.YES}
    assert len(told) == 5


def test_the_ledger_has_all_claims() -> None:
    names = sorted(claim.name for claim in ALL_CLAIMS)
    assert names == [f"C{number:02}" for number in range(1, 39)]


def answer(scene: str, consumers: int, seconds: float, busy: float, **more: object) -> dict:
    """Returns an invented result of the simulator."""
    processes = [
        {
            "process": number,
            "role": "consumer" if number else "producer",
            "tasks": 10 * number,
            "samples": 100,
            "busy_seconds": 1.0,
            "wait_seconds": 0.5,
            "last_seconds": seconds - 0.01 * number if number else 0.0,
        }
        for number in range(consumers + 1)
    ]
    sums = dict.fromkeys(
        (
            "traced_seconds build_seconds walk_seconds work_seconds accept_seconds "
            "messages_from_producer bytes_from_producer messages_to_producer bytes_to_producer"
        ).split(),
        1.0,
    )
    setting = {
        "era": "1999",
        "scene": scene,
        "network": "made up",
        "options": "thesis",
        "machines": "equal",
        "consumers": consumers,
    }
    told = {"tasks": 500, "seconds": seconds, "sequential_seconds": 100.0, "producer_busy": busy}
    return sums | setting | told | {"processes": processes} | more


def test_figures_come_from_the_simulations(tmp_path: Path) -> None:
    # The efficiency is 100 / (p T). It is best with 5 processors, where T = 20.
    answers = [
        answer(CAT, n, 100 / ((n + 1) * (0.9 - 0.05 * abs(n - 4))), 0.06 * n) for n in range(1, 15)
    ]
    answers.append(answer(CAT, 31, 10.0, 0.95))
    answers.append(answer(CAT, 14, 1.0, 0.99, options="two in flight"))
    answers.append(answer(CAT, 14, 25.0, 0.9, machines="every other one half as fast"))
    write_results(tmp_path, answers)
    figures = cluster_evidence(tmp_path)
    value = {q: figures.figure(q, CAT, "made up") for q in figures.figures["quantity"]}
    assert figures.networks == ["made up"]
    assert value["best_processors"].value == 5
    assert value["best_efficiency"].value == pytest.approx(0.9)
    assert value["last_efficiency"].value == pytest.approx(0.4)
    assert (value["fewest_beams"].value, value["most_beams"].value) == (10, 140)
    assert value["producer_busy"].value == pytest.approx(0.84)
    assert value["consumers_that_saturate"].value == 31
    assert value["beams"].value == 500
    assert value["slowdown_slow"].value == pytest.approx(100 / (15 * 0.4) / 25.0, rel=1e-4)
    assert "slowdown_used" not in value


def test_one_cluster_is_judged_at_a_time(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        write_results(tmp_path / name, [answer(CAT, 1, 60.0, 0.1)])
    with pytest.raises(Problem, match="another simulated cluster"):
        judge_claims([tmp_path / "a", tmp_path / "b"])
    entries = {entry.claim.name: entry.ours.verdict for entry in judge_claims([tmp_path / "a"])}
    assert entries["C22"] is Verdict.NOT_TESTED
