"""Every claim judged by the thesis's own figures and by a run's, and the table of them."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from math import isclose
from pathlib import Path

import pandas as pd

from beambench_report.base.files import Problem
from beambench_report.base.quantities import markdown_table, number
from beambench_thesis.chapter6.results import is_cluster_folder
from beambench_thesis.claims.chapter5 import CLAIMS
from beambench_thesis.claims.chapter6 import CLUSTER_CLAIMS, cluster_evidence
from beambench_thesis.claims.prose import PROSE_CLAIMS
from beambench_thesis.claims.verdict import Check, Claim, Outcome, Verdict, verdict_of
from beambench_thesis.paper.evidence import NO_CLUSTER, Evidence, published_evidence
from beambench_thesis.paper.measured import census_work, is_census_folder, measured_evidence


@dataclass(frozen=True)
class Finding:
    """The verdict of one set of measurements on a claim."""

    verdict: Verdict
    checks: list[Check]


@dataclass(frozen=True)
class JudgedClaim:
    """A claim, judged by the thesis's own figures and by ours."""

    claim: Claim
    thesis: Finding
    ours: Finding
    formerly: Finding | None
    """Ours by the rule that the claim had before, where it was amended."""


def judge(claim: Claim, evidence: Evidence) -> Finding:
    """Applies the claim's rule."""
    checks = claim.rule(evidence)
    return Finding(verdict_of(checks), checks)


def judge_formerly(claim: Claim, evidence: Evidence) -> Finding | None:
    """Applies the rule that the claim had before; None where it was not amended."""
    return judge(replace(claim, rule=claim.amendment.former), evidence) if claim.amendment else None


SWEPT_CLAIMS = (*CLAIMS, *PROSE_CLAIMS)
"""Those that runs of sweeps and a census decide."""

ALL_CLAIMS = (*CLAIMS, *CLUSTER_CLAIMS, *PROSE_CLAIMS)


def judge_claims(
    runs: Sequence[Path],
    claims: Sequence[Claim] = ALL_CLAIMS,
    further: Collection[Path] = (),
) -> list[JudgedClaim]:
    """Judges the claims by runs of sweeps, a folder of censuses and a simulated cluster.

    Without them ours are not tested. `further` are those of the runs that were made after a look at
    the verdicts by the others: an allowance is made for the second look (base/fastest.py).
    Raises Problem where one cannot be read.
    """
    clusters = [run for run in runs if is_cluster_folder(run)]
    censuses = [run for run in runs if is_census_folder(run)]
    for kind, folders in (("simulated cluster", clusters), ("folder of censuses", censuses)):
        if len(folders) > 1:
            raise Problem(f"{folders[1]}: there is another {kind}, {folders[0]}; name one")
    swept = measured_evidence([run for run in runs if run not in (*clusters, *censuses)], further)
    counted = [swept.work, *(census_work(folder) for folder in censuses)]
    measured = replace(
        swept,
        work=pd.concat(counted, ignore_index=True) if censuses else swept.work,
        cluster=cluster_evidence(clusters[0]) if clusters else NO_CLUSTER,
    )
    published = published_evidence()
    return [
        JudgedClaim(
            claim, judge(claim, published), judge(claim, measured), judge_formerly(claim, measured)
        )
        for claim in claims
    ]


@dataclass(frozen=True)
class SecondLook:
    """A claim of which some cells were measured again after its first verdict."""

    claim: str
    again: int
    """The number of its cells that were."""
    cells: int
    before: Verdict
    after: Verdict


def second_looks(before: Sequence[JudgedClaim], after: Sequence[JudgedClaim]) -> list[SecondLook]:
    """Compares the verdicts without and with further runs; cells with other figures have both."""
    found = []
    for first, second in zip(before, after, strict=True):
        known = {check.cell: check for check in first.ours.checks}
        own = second.ours.checks
        again = sum(check.cell in known and _is_other(known[check.cell], check) for check in own)
        if again:
            verdicts = (first.ours.verdict, second.ours.verdict)
            found.append(SecondLook(second.claim.name, again, len(own), *verdicts))
    return found


def _is_other(first: Check, second: Check) -> bool:
    """Do the figures differ by more than a common clock rate, which ratios do not depend on?"""
    if first.ratio is None or second.ratio is None:
        return first.outcome is not second.outcome
    return not isclose(first.ratio, second.ratio, rel_tol=1e-6)


_MAX_NAMED = 4


def claims_as_markdown(claims: Sequence[JudgedClaim], *, cells: bool = False) -> str:
    """Returns a row for each claim; with `cells`, also every cell that its verdicts rest on."""
    rows = []
    for one in claims:
        parts = [
            f"{whose}: {found}"
            for whose, finding in (("thesis", one.thesis), ("ours", one.ours))
            if (found := summary(finding))
        ]
        bound = " (it is these figures)" if one.claim.is_figures else ""
        former = f" (formerly: {one.formerly.verdict.value})" if one.formerly else ""
        verdicts = (f"{one.thesis.verdict.value}{bound}", f"{one.ours.verdict.value}{former}")
        figures = "; ".join([*parts, *filter(None, [amendment(one)])])
        rows.append((one.claim.name, one.claim.where, one.claim.says, *verdicts, figures))
    heads = ("claim", "where", "what the thesis says", "by its own figures", "by ours", "figures")
    lines = markdown_table(heads, rows)
    for one in claims if cells else ():
        lines += ["", *_cells(one)]
    return "\n".join(lines) + "\n"


def summary(finding: Finding) -> str:
    """Returns the number of cells that say yes and names the others; empty if none was measured."""
    by_outcome = {
        outcome: [one for one in finding.checks if not one.aside and one.outcome is outcome]
        for outcome in Outcome
    }
    count = sum(map(len, by_outcome.values()))
    parts = []
    if len(by_outcome[Outcome.MISSING]) < count:
        yes = by_outcome.pop(Outcome.YES)
        parts.append(f"{len(yes)} of {count} cells{_range_of(yes)}")
        parts += [_named(one.value, checks) for one, checks in by_outcome.items() if checks]
        parts += _unpaired([check for check in finding.checks if not check.aside])
    parts += [
        f"beside it: {check.cell}: {check.outcome.value} ({check.figures})"
        for check in finding.checks
        if check.aside and check.outcome is not Outcome.MISSING
    ]
    return "; ".join(parts)


def amendment(one: JudgedClaim) -> str:
    """Returns why the rule was amended, and the verdict of the former one; else an empty string."""
    if one.claim.amendment is None or one.formerly is None:
        return ""
    found = summary(one.formerly)
    former = f"; ours by the former rule: {found}" if found else ""
    return f"rule amended: {one.claim.amendment.why}{former}"


def cells_of(one: JudgedClaim) -> list[tuple[str, Check, Check]]:
    """Returns every cell that a claim's verdicts rest on: the thesis's check and ours."""
    thesis, ours = ({c.cell: c for c in each.checks} for each in (one.thesis, one.ours))
    nothing = Check("", Outcome.MISSING)
    return [
        (cell, thesis.get(cell, nothing), ours.get(cell, nothing))
        for cell in dict.fromkeys([*thesis, *ours])
    ]


def _range_of(checks: Sequence[Check]) -> str:
    """Returns the ratios of cells that compare two figures: 1.13 to 2.06 times."""
    ratios = [check.ratio for check in checks if check.ratio is not None]
    if not ratios:
        return "".join(f", {check.cell}: {check.figures}" for check in checks[:_MAX_NAMED])
    least, most = number(min(ratios)), number(max(ratios))
    return f" ({least} times)" if least == most else f" ({least} to {most} times)"


def _unpaired(checks: Sequence[Check]) -> list[str]:
    """Returns `not paired`, and which where some are: those decided by two intervals."""
    compared = [check for check in checks if check.is_paired is not None]
    apart = [check for check in compared if not check.is_paired]
    if len(apart) == len(compared):
        return ["not paired"] * bool(apart)
    return [_named("not paired", [replace(one, figures="") for one in apart])] if apart else []


def _named(what: str, checks: Sequence[Check]) -> str:
    named = [f"{check.cell}{f' ({check.figures})' * bool(check.figures)}" for check in checks]
    rest = len(named) - _MAX_NAMED
    more = [f"{rest} more"] if rest > 0 else []
    return f"{what}: " + ", ".join(named[:_MAX_NAMED] + more)


def _cells(one: JudgedClaim) -> list[str]:
    rows = (
        (cell, thesis.outcome.value, thesis.figures, ours.outcome.value, ours.figures)
        for cell, thesis, ours in cells_of(one)
    )
    lines = [f"### {one.claim.name}: {one.claim.says}", ""]
    lines += markdown_table(("cell", "thesis", "figures", "ours", "figures"), rows)
    if one.formerly is not None:
        former = ((check.cell, check.outcome.value, check.figures) for check in one.formerly.checks)
        lines += ["", "By the former rule, ours:", ""]
        lines += markdown_table(("cell", "ours", "figures"), former)
    return lines
