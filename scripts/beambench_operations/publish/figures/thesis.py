"""results/published/thesis: the claims of the thesis, judged by our rows."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from beambench.analysis import MARGIN
from beambench_operations.publish.figures.origins import origins
from beambench_report.base.cell_files import IDENTITY
from beambench_report.base.fastest import with_fastest
from beambench_report.base.records import Run, read_run
from beambench_thesis.chapter5.facts import CENSUS
from beambench_thesis.chapter5.mirrors import read_mirrors
from beambench_thesis.claims.register import (
    TESTED,
    JudgedClaim,
    agreeing,
    effects,
    judge_claims,
    read_otherwise,
    variants_that_agree,
)
from beambench_thesis.claims.variants_file import NAME as VARIANTS_FILE
from beambench_thesis.claims.variants_file import with_variants
from beambench_thesis.claims.verdict import Outcome, Verdict, counted
from beambench_thesis.paper.measured import error_between_runs
from beambench_thesis.report.answers import answers
from beambench_thesis.report.plan import read_plan
from beambench_thesis.report.report import CLUSTER, Report, gather

_THESIS, _NINE = "5", "9"
_GOOD_PERCENT = 10


def figures(folder: Path) -> dict[str, Any]:
    """Returns claims by verdict, each with its cells and the range of its ratios; planar mirrors.

    If there is a second run of the same commit and machine, the repetitions of both count.
    """
    report = gather(folder, read_plan(folder), None)
    second = _second(folder)
    claims: Sequence[JudgedClaim] = report.claims
    if second is not None:
        cluster = folder.parent / CLUSTER
        others = [path for path in (folder / CENSUS, cluster) if path.is_dir()]
        claims = judge_claims([*report.cells.runs, *second.cells.runs, *others])
        claims = with_variants(claims, folder / VARIANTS_FILE)
    tested = [one for one in claims if one.ours.verdict in TESTED]
    paired = [check.is_paired for one in tested for check in one.ours.checks]
    mirrors, unread = read_mirrors(sorted((folder / "mirrors").glob("*.json")))
    return {
        "cells": len(report.cells.cells),
        "wrong": len(report.cells.wrong),
        "claims": {one.claim.name: _claim(one) for one in tested},
        "variants": max(len(one.variants) for one in claims),
        "tested": len(tested),
        "untestable": [_claim(one) for one in claims if one.ours.verdict is Verdict.NOT_TESTABLE],
        "answers": answers(claims),
        "verdicts": {
            verdict.value: [one.claim.name for one in tested if one.ours.verdict is verdict]
            for verdict in TESTED
        },
        "alone": Counter(one.ours.verdict.value for one in report.claims),
        "margin": MARGIN,
        "again": _again(report, second) if second else None,
        "compared": len(paired) - paired.count(None),
        "paired": paired.count(True),
        "mirrors": mirrors,
        "unread": unread,
        "sampling": _samplings(folder / "sampling.csv"),
        "chosen_levels": _chosen_levels(folder / "chosen-levels.csv"),
    }


def _second(folder: Path) -> Report | None:
    """Returns a second run of the same kind, if there is one."""
    again = folder.with_name(f"{folder.name}-again")
    return gather(again, read_plan(again)) if _is_of_one_kind(again, folder) else None


def _is_of_one_kind(other: Path, folder: Path) -> bool:
    """Returns whether both were made by the same commit on the same machine."""
    made_by, known = (
        {(one.commit, one.machine_id) for one in origins(where)}
        for where in (other, folder / "synthetic")
    )
    return other.is_dir() and made_by == known


def _again(first: Report, second: Report) -> dict[str, Any]:
    """Compares the verdicts of two runs."""
    names = [
        one.name
        for one in second.plan.sweeps
        if (second.directory / one.name / "results.csv").is_file()
    ]
    return compared(
        *({one.claim.name: one.ours.verdict for one in run.claims} for run in (first, second))
    ) | {
        "sweeps": names,
        "planned": len(second.plan.sweeps),
        "times": times_found_again(
            [
                (read_run(first.directory / name), read_run(second.directory / name))
                for name in names
            ]
        ),
    }


def compared(first: dict[str, Verdict], second: dict[str, Verdict]) -> dict[str, Any]:
    """Compares the claims that both runs test: those undecided in one or both, and those decided
    alike or differently.
    """
    both = [name for name in first if second.get(name, Verdict.NOT_TESTED) in TESTED]
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
    """Counts the fastest repetitions of repeated sweeps that lie within the first runs' intervals.

    The claims are judged by these intervals (thesis/paper/measured.py). The result also has the
    median and the 90% quantile of the changes, for the fastest repetitions and for the medians.
    """
    figures = {"fastest": "fastest_mcycles", "median": "total_mcycles_median"}
    columns = [*IDENTITY, "fastest_error", *figures.values()]
    pairs = [[with_fastest([run])[0][columns] for run in both] for both in runs]
    cells = pd.concat(
        first.merge(second, on=list(IDENTITY), suffixes=("", "_b")).dropna()
        for first, second in pairs
    )
    change = {
        name: (cells[f"{figure}_b"] / cells[figure] - 1.0).abs() for name, figure in figures.items()
    }
    reach = cells["fastest_error"].map(error_between_runs)
    return {
        "cells": len(cells),
        "within": int((change["fastest"] <= reach).sum()),
        "half": {name: float(changes.quantile(0.5)) for name, changes in change.items()},
        "most": {name: float(changes.quantile(0.9)) for name, changes in change.items()},
    }


def _claim(one: JudgedClaim) -> dict[str, Any]:
    checks = counted(one.ours.checks)
    open_cells = [check for check in checks if check.outcome is Outcome.UNDECIDED]
    printed, measured = effects(one)
    return {
        "name": one.claim.name,
        "says": one.claim.says,
        "why": one.claim.untestable,
        "formerly": one.ours.formerly,
        "effect": {"thesis": printed, "ours": measured},
        "agreeing": agreeing(one.ours),
        "variants": variants_that_agree(one),
        "read_otherwise": read_otherwise(one),
        "cells": len(checks),
        "undecided": [f"{check.cell}: {check.figures}" for check in open_cells],
    }


# Rows of an earlier version that the texts still need.


def _samplings(file: Path) -> dict[str, Any]:
    """Returns for each scene and method the setting with the time closest to the thesis's."""
    rows = pd.read_csv(file, dtype={"setting": str})
    return {scene: _nearest(rows[rows["scene"] == scene]) for scene in dict.fromkeys(rows["scene"])}


def _nearest(rows: pd.DataFrame) -> dict[str, Any]:
    uniform = rows[rows["method"] == "uniform"].set_index("setting")
    thesis = uniform.loc[_THESIS]
    distance = (rows["trace_ms"] - thesis["trace_ms"]).abs()
    nearest = rows.loc[distance.groupby(rows["method"]).idxmin()].set_index("method")
    return {
        "thesis": thesis,
        "nine": uniform.loc[_NINE],
        **{method: nearest.loc[method] for method in nearest.index},
    }


def _chosen_levels(file: Path) -> dict[str, Any]:
    """Returns the time that max_level=auto loses to the best fixed level, by structure."""
    losses = pd.read_csv(file).groupby("structure", sort=False)["loss_percent"]
    return {
        structure: {
            "choices": len(own),
            "good": int((own < _GOOD_PERCENT).sum()),
            "median": float(own.median()),
            "worst": float(own.max()),
        }
        for structure, own in losses
    }
