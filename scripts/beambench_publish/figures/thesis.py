"""results/published/thesis: the claims of the thesis, judged by our rows."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from beambench_publish.figures.origins import origins
from beambench_report.base.cell_files import IDENTITY
from beambench_report.base.records import Run, read_run
from beambench_report.thesis.chapter5.facts import CENSUS
from beambench_report.thesis.chapter5.mirrors import read_mirrors
from beambench_report.thesis.claims.chapter6 import CLUSTER_CLAIMS
from beambench_report.thesis.claims.register import (
    SWEPT_CLAIMS,
    JudgedClaim,
    judge_claims,
    summary,
)
from beambench_report.thesis.claims.verdict import ALIKE, Outcome, Verdict
from beambench_report.thesis.paper.measured import error_of_least
from beambench_report.thesis.report.plan import read_plan
from beambench_report.thesis.report.report import Report, gather

_TESTED = (Verdict.HOLDS, Verdict.IN_PART, Verdict.FAILS, Verdict.UNDECIDED)


def figures(folder: Path) -> dict[str, Any]:
    """Claims by verdict, each with its cells and the range of its ratios; planar mirrors."""
    report = gather(folder, read_plan(folder), None)
    cluster = folder.parent / "cluster"
    claims = [
        *report.claims,
        *(judge_claims([cluster], CLUSTER_CLAIMS) if cluster.is_dir() else ()),
    ]
    tested = [one for one in claims if one.ours.verdict is not Verdict.NOT_TESTED]
    runs, unread = read_mirrors(sorted((folder / "mirrors").glob("*.json")))
    return {
        "cells": len(report.cells.cells),
        "wrong": len(report.cells.wrong),
        "claims": {one.claim.name: _claim(one) for one in tested},
        "tested": len(tested),
        "verdicts": {
            verdict.value: [one.claim.name for one in tested if one.ours.verdict is verdict]
            for verdict in _TESTED
        },
        "alike": ALIKE,
        "again": _again(report, tested),
        "mirrors": runs,
        "unread": unread,
    }


def _again(report: Report, first: Sequence[JudgedClaim]) -> dict[str, Any] | None:
    """The verdicts of a second run beside the first one's, and those of both together.

    None without a second run of the same kind.
    """
    folder = report.directory
    again = folder.with_name(f"{folder.name}-again")
    if not again.is_dir() or _made_by(again) != _made_by(folder / "synthetic"):
        return None
    plan = read_plan(again)
    second = gather(again, plan)
    both = judge_claims([*report.cells.runs, *second.cells.runs, folder / CENSUS], SWEPT_CLAIMS)
    sweeps = [one.name for one in plan.sweeps if (again / one.name / "results.csv").is_file()]
    return compared(
        {one.claim.name: one.ours.verdict for one in first},
        {one.claim.name: one.ours.verdict for one in second.claims},
    ) | {
        "together": {
            verdict.value: [one.claim.name for one in both if one.ours.verdict is verdict]
            for verdict in _TESTED
        },
        "sweeps": sweeps,
        "planned": len(plan.sweeps),
        "times": times_found_again(
            [(read_run(folder / name), read_run(again / name)) for name in sweeps]
        ),
    }


def compared(first: dict[str, Verdict], second: dict[str, Verdict]) -> dict[str, Any]:
    """The claims that two runs test: undecided in one or both, decided alike, decided otherwise."""
    both = [name for name in first if second.get(name, Verdict.NOT_TESTED) in _TESTED]
    decided = [n for n in both if Verdict.UNDECIDED not in (first[n], second[n])]
    return {
        "tested": len(both),
        "decided": len(decided),
        "differ": [name for name in decided if first[name] is not second[name]],
        "undecided": [
            [name for name in both if run[name] is Verdict.UNDECIDED] for run in (first, second)
        ],
    }


def times_found_again(runs: Sequence[tuple[Run, Run]]) -> dict[str, Any]:
    """Do the least cycles of repeated sweeps lie in the intervals that the first ones' have?

    The claims are judged by these intervals (thesis/paper/measured.py). With them the changes that
    half and nine tenths of the cells stay below, and of the medians the same.
    """
    figures = [f"total_mcycles_{name}" for name in ("min", "min_spread", "median")]
    cells = pd.concat(
        first.rows[[*IDENTITY, *figures]]
        .merge(second.rows[[*IDENTITY, *figures]], on=list(IDENTITY), suffixes=("", "_b"))
        .dropna(subset=[*figures, f"{figures[0]}_b"])
        for first, second in runs
    )
    change = {}
    for name in ("min", "median"):
        figure = cells[f"total_mcycles_{name}"]
        change[name] = (cells[f"total_mcycles_{name}_b"] / figure - 1.0).abs()
    reach = list(map(error_of_least, cells["total_mcycles_min"], cells["total_mcycles_min_spread"]))
    return {
        "cells": len(cells),
        "within": int((change["min"] <= reach).sum()),
        "half": {name: float(changes.quantile(0.5)) for name, changes in change.items()},
        "most": {name: float(changes.quantile(0.9)) for name, changes in change.items()},
    }


def _made_by(folder: Path) -> set[tuple[str, str]]:
    return {(one.commit, one.machine_id) for one in origins(folder)}


def _claim(one: JudgedClaim) -> dict[str, Any]:
    counted = [check for check in one.ours.checks if not check.aside]
    yes = [check for check in counted if check.outcome is Outcome.YES]
    ratios = [check.ratio for check in yes if check.ratio is not None]
    open_cells = [check for check in counted if check.outcome is Outcome.UNDECIDED]
    return {
        "says": one.claim.says,
        "verdict": one.ours.verdict.value,
        "by_the_thesis": one.thesis.verdict.value,
        "formerly": one.formerly.verdict.value if one.formerly else "",
        "yes": len(yes),
        "cells": len(counted),
        "least": min(ratios, default=None),
        "most": max(ratios, default=None),
        "summary": summary(one.ours),
        "undecided": [f"{check.cell}: {check.figures}" for check in open_cells],
    }
