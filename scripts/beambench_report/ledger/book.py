"""The ledger itself: every claim beside the thesis's own figures and beside a run's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import pandas as pd

from beambench_report.cluster.results import is_cluster_folder
from beambench_report.ledger.census_run import census_work, is_census_folder
from beambench_report.ledger.claim import Claim
from beambench_report.ledger.cluster_evidence import NO_CLUSTER
from beambench_report.ledger.cluster_rules import CLUSTER_CLAIMS
from beambench_report.ledger.cluster_run import cluster_evidence
from beambench_report.ledger.evidence import Evidence
from beambench_report.ledger.further_rules import FURTHER_CLAIMS
from beambench_report.ledger.own_run import measured_evidence
from beambench_report.ledger.published import published_evidence
from beambench_report.ledger.rules import CLAIMS
from beambench_report.ledger.verdict import Check, Verdict, verdict_of
from beambench_report.problem import Problem


@dataclass(frozen=True)
class Finding:
    """What one set of measurements says of a claim."""

    verdict: Verdict
    checks: list[Check]


@dataclass(frozen=True)
class Entry:
    """A claim, judged by the thesis's own figures and by ours."""

    claim: Claim
    thesis: Finding
    ours: Finding
    formerly: Finding | None = None
    """Ours by the rule that the claim had before, where it was amended."""


def judge(claim: Claim, evidence: Evidence) -> Finding:
    """Applies the claim's rule."""
    checks = claim.rule(evidence)
    return Finding(verdict_of(checks), checks)


def judge_formerly(claim: Claim, evidence: Evidence) -> Finding | None:
    """Applies the rule that the claim had before; None where it was not amended."""
    if claim.amendment is None:
        return None
    checks = claim.amendment.former(evidence)
    return Finding(verdict_of(checks), checks)


SWEPT_CLAIMS = (*CLAIMS, *FURTHER_CLAIMS)
"""Those that runs of sweeps and a census decide."""

ALL_CLAIMS = (*CLAIMS, *CLUSTER_CLAIMS, *FURTHER_CLAIMS)


def ledger(runs: Sequence[Path], claims: Sequence[Claim] = ALL_CLAIMS) -> list[Entry]:
    """What is said of the claims by runs of sweeps, a folder of censuses and a simulated cluster.

    Without them ours are not tested. Raises Problem where one cannot be read.
    """
    clusters = [run for run in runs if is_cluster_folder(run)]
    censuses = [run for run in runs if is_census_folder(run)]
    for kind, folders in (("simulated cluster", clusters), ("folder of censuses", censuses)):
        if len(folders) > 1:
            raise Problem(f"{folders[1]}: there is another {kind}, {folders[0]}; name one")
    swept = measured_evidence([run for run in runs if run not in (*clusters, *censuses)])
    counted = [swept.work, *(census_work(folder) for folder in censuses)]
    measured = replace(
        swept,
        work=pd.concat(counted, ignore_index=True) if censuses else swept.work,
        cluster=cluster_evidence(clusters[0]) if clusters else NO_CLUSTER,
    )
    published = published_evidence()
    return [
        Entry(
            claim, judge(claim, published), judge(claim, measured), judge_formerly(claim, measured)
        )
        for claim in claims
    ]
