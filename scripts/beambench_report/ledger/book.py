"""The ledger itself: every claim beside the thesis's own figures and beside a run's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from beambench_report.ledger.claim import Claim
from beambench_report.ledger.evidence import Evidence
from beambench_report.ledger.own_run import measured_evidence
from beambench_report.ledger.published import published_evidence
from beambench_report.ledger.rules import CLAIMS
from beambench_report.ledger.verdict import Check, Verdict, verdict_of


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


def ledger(runs: Sequence[Path]) -> list[Entry]:
    """All claims; without runs ours are not tested. Raises Problem where a run cannot be read."""
    published, measured = published_evidence(), measured_evidence(runs)
    return [Entry(claim, judge(claim, published), judge(claim, measured)) for claim in CLAIMS]
