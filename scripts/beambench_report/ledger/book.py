"""The ledger itself: every claim beside the thesis's own figures and beside a run's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from beambench_report.cluster.results import is_cluster_folder
from beambench_report.ledger.claim import Claim
from beambench_report.ledger.cluster_evidence import NO_CLUSTER
from beambench_report.ledger.cluster_rules import CLUSTER_CLAIMS
from beambench_report.ledger.cluster_run import cluster_evidence
from beambench_report.ledger.evidence import Evidence
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


def judge(claim: Claim, evidence: Evidence) -> Finding:
    """Applies the claim's rule."""
    checks = claim.rule(evidence)
    return Finding(verdict_of(checks), checks)


ALL_CLAIMS = (*CLAIMS, *CLUSTER_CLAIMS)


def ledger(runs: Sequence[Path], claims: Sequence[Claim] = ALL_CLAIMS) -> list[Entry]:
    """What is said of the claims by runs of sweeps, and by one folder of a simulated cluster.

    Without them ours are not tested. Raises Problem where one cannot be read.
    """
    clusters = [run for run in runs if is_cluster_folder(run)]
    if len(clusters) > 1:
        raise Problem(f"{clusters[1]}: there is another simulated cluster, {clusters[0]}; name one")
    measured = replace(
        measured_evidence([run for run in runs if run not in clusters]),
        cluster=cluster_evidence(clusters[0]) if clusters else NO_CLUSTER,
    )
    published = published_evidence()
    return [Entry(claim, judge(claim, published), judge(claim, measured)) for claim in claims]
