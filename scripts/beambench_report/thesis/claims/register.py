"""Every claim judged by the thesis's own figures and by a run's, and the table of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import pandas as pd

from beambench_report.base.files import Problem
from beambench_report.base.quantities import number
from beambench_report.thesis.chapter6.results import is_cluster_folder
from beambench_report.thesis.claims.chapter5 import CLAIMS
from beambench_report.thesis.claims.chapter6 import CLUSTER_CLAIMS, cluster_evidence
from beambench_report.thesis.claims.text import FURTHER_CLAIMS
from beambench_report.thesis.claims.verdict import Check, Claim, Outcome, Verdict, verdict_of
from beambench_report.thesis.paper.evidence import NO_CLUSTER, Evidence, published_evidence
from beambench_report.thesis.paper.measured import census_work, is_census_folder, measured_evidence


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


_MOST_NAMED = 4


def as_markdown(entries: Sequence[Entry], *, cells: bool = False) -> str:
    """A row a claim; with `cells`, also every cell that its verdicts rest on."""
    lines = [
        "| claim | where | what the thesis says | by its own figures | by ours | figures |",
        "|---|---|---|---|---|---|",
    ]
    for entry in entries:
        parts = [
            f"{whose}: {found}"
            for whose, finding in (("thesis", entry.thesis), ("ours", entry.ours))
            if (found := summary(finding))
        ]
        parts += [sentence for sentence in (amendment(entry),) if sentence]
        bound = " (it is these figures)" if entry.claim.is_figures else ""
        former = f" (formerly: {entry.formerly.verdict.value})" if entry.formerly else ""
        lines.append(
            f"| {entry.claim.name} | {entry.claim.where} | {entry.claim.says} "
            f"| {entry.thesis.verdict.value}{bound} | {entry.ours.verdict.value}{former} "
            f"| {'; '.join(parts)} |"
        )
    if cells:
        for entry in entries:
            lines += ["", *_cells(entry)]
    return "\n".join(lines) + "\n"


def summary(finding: Finding) -> str:
    """How many cells say yes, and those that do not, named; nothing if no cell was measured."""
    counted = [check for check in finding.checks if not check.aside]
    asides = [
        check for check in finding.checks if check.aside and check.outcome is not Outcome.MISSING
    ]
    parts = []
    if any(check.outcome is not Outcome.MISSING for check in counted):
        yes = [check for check in counted if check.outcome is Outcome.YES]
        parts.append(f"{len(yes)} of {len(counted)} cells{_range_of(yes)}")
        for outcome in (Outcome.NO, Outcome.UNDECIDED, Outcome.MISSING):
            parts += _named(outcome, [check for check in counted if check.outcome is outcome])
    parts += [
        f"beside it: {check.cell}: {check.outcome.value} ({check.figures})" for check in asides
    ]
    return "; ".join(parts)


def amendment(entry: Entry) -> str:
    """Why the claim has another rule than it had, and what the former one finds; else nothing."""
    if entry.claim.amendment is None or entry.formerly is None:
        return ""
    found = summary(entry.formerly)
    return f"rule amended: {entry.claim.amendment.why}" + (
        f"; ours by the former rule: {found}" if found else ""
    )


def _range_of(checks: Sequence[Check]) -> str:
    """The ratios of cells that compare two figures: 1.13 to 2.06 times."""
    ratios = [check.ratio for check in checks if check.ratio is not None]
    if not ratios:
        return "".join(f", {check.cell}: {check.figures}" for check in checks[:_MOST_NAMED])
    least, most = number(min(ratios)), number(max(ratios))
    return f" ({least} times)" if least == most else f" ({least} to {most} times)"


def _named(outcome: Outcome, checks: Sequence[Check]) -> list[str]:
    if not checks:
        return []
    named = [f"{check.cell}{f' ({check.figures})' * bool(check.figures)}" for check in checks]
    rest = len(named) - _MOST_NAMED
    more = [f"{rest} more"] if rest > 0 else []
    return [f"{outcome.value}: " + ", ".join(named[:_MOST_NAMED] + more)]


def _cells(entry: Entry) -> list[str]:
    lines = [
        f"### {entry.claim.name}: {entry.claim.says}",
        "",
        "| cell | thesis | figures | ours | figures |",
        "|---|---|---|---|---|",
    ]
    both = ({check.cell: check for check in each.checks} for each in (entry.thesis, entry.ours))
    thesis, ours = both
    nothing = Check("", Outcome.MISSING)
    for cell in dict.fromkeys([*thesis, *ours]):
        theirs, own = thesis.get(cell, nothing), ours.get(cell, nothing)
        lines.append(
            f"| {cell} | {theirs.outcome.value} | {theirs.figures} "
            f"| {own.outcome.value} | {own.figures} |"
        )
    if entry.formerly is not None:
        lines += ["", "By the former rule, ours:", "", "| cell | ours | figures |", "|---|---|---|"]
        lines += [
            f"| {check.cell} | {check.outcome.value} | {check.figures} |"
            for check in entry.formerly.checks
        ]
    return lines
