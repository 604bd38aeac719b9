"""results/published/thesis: the claims of the thesis, judged by our rows."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from beambench_report.thesis.chapter5.mirrors import read_mirrors
from beambench_report.thesis.claims.chapter6 import CLUSTER_CLAIMS
from beambench_report.thesis.claims.register import JudgedClaim, judge_claims, summary
from beambench_report.thesis.claims.verdict import Outcome, Verdict
from beambench_report.thesis.report.plan import read_plan
from beambench_report.thesis.report.report import gather


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
            for verdict in (Verdict.HOLDS, Verdict.IN_PART, Verdict.FAILS, Verdict.UNDECIDED)
        },
        "mirrors": runs,
        "unread": unread,
    }


def _claim(one: JudgedClaim) -> dict[str, Any]:
    counted = [check for check in one.ours.checks if not check.aside]
    yes = [check for check in counted if check.outcome is Outcome.YES]
    ratios = [check.ratio for check in yes if check.ratio is not None]
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
    }
