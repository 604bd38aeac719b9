"""Judges every claim by the thesis's own figures and by runs, and tabulates the claims."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path
from statistics import geometric_mean, median

import pandas as pd

from beambench_report.base.files import Problem
from beambench_report.base.quantities import DASH, markdown_table, number
from beambench_thesis.chapter6.results import is_cluster_folder
from beambench_thesis.claims.chapter5 import CLAIMS
from beambench_thesis.claims.chapter6 import CLUSTER_CLAIMS, cluster_evidence
from beambench_thesis.claims.prose import PROSE_CLAIMS
from beambench_thesis.claims.verdict import (
    Check,
    Claim,
    Outcome,
    Question,
    Verdict,
    counted,
    former_verdict,
    verdict_of,
)
from beambench_thesis.paper.evidence import NO_CLUSTER, Evidence, published_evidence
from beambench_thesis.paper.measured import census_work, is_census_folder, measured_evidence


@dataclass(frozen=True)
class Finding:
    """The verdict of one set of measurements on a claim."""

    verdict: Verdict
    checks: list[Check]

    @property
    def formerly(self) -> str:
        """The verdict on the same cells in the words of version 0.2."""
        return former_verdict(self.checks)


@dataclass(frozen=True)
class JudgedClaim:
    """A claim, judged by the thesis's own figures and by ours."""

    claim: Claim
    thesis: Finding
    ours: Finding
    variants: tuple[Finding, ...] = ()
    """Our findings on perturbed scenes, one for each variant of all scenes."""
    deeper: Finding | None = None
    """Our finding by the other reading of the thesis's levels."""


def judge(claim: Claim, evidence: Evidence) -> Finding:
    """Applies the claim's rule."""
    checks = claim.rule(evidence)
    return Finding(verdict_of(checks), checks)


def judge_ours(claim: Claim, evidence: Evidence) -> Finding:
    """Applies the claim's rule to measurements of stand-ins, which cannot test every claim."""
    found = judge(claim, evidence)
    return replace(found, verdict=Verdict.NOT_TESTABLE) if claim.untestable else found


TESTED = (Verdict.SUPPORTED, Verdict.MIXED, Verdict.CONTRADICTED, Verdict.UNDECIDED)
"""The verdicts on claims all of whose comparisons were measured."""

SWEPT_CLAIMS = (*CLAIMS, *PROSE_CLAIMS)
"""The claims that are decided by runs of sweeps and a census."""

ALL_CLAIMS = (*CLAIMS, *CLUSTER_CLAIMS, *PROSE_CLAIMS)


def judge_claims(
    runs: Sequence[Path],
    claims: Sequence[Claim] = ALL_CLAIMS,
    variants: Sequence[Evidence] = (),
    deeper: Evidence | None = None,
) -> list[JudgedClaim]:
    """Judges the claims by runs of sweeps, a folder of censuses and a simulated cluster.

    Without runs, our side is not tested. `variants` are measurements of perturbed scenes, `deeper`
    of octrees by the other reading of the thesis's levels.

    Raises Problem if a folder cannot be read.
    """
    clusters = [run for run in runs if is_cluster_folder(run)]
    censuses = [run for run in runs if is_census_folder(run)]
    for kind, folders in (("simulated cluster", clusters), ("folder of censuses", censuses)):
        if len(folders) > 1:
            raise Problem(f"{folders[1]}: there is another {kind}, {folders[0]}; name one")
    swept = measured_evidence([run for run in runs if run not in (*clusters, *censuses)])
    works = [swept.work, *(census_work(folder) for folder in censuses)]
    measured = replace(
        swept,
        work=pd.concat(works, ignore_index=True) if censuses else swept.work,
        cluster=cluster_evidence(clusters[0]) if clusters else NO_CLUSTER,
    )
    published = published_evidence()
    return [
        JudgedClaim(
            claim,
            judge(claim, published),
            judge_ours(claim, measured),
            tuple(judge_ours(claim, one) for one in variants),
            judge_ours(claim, deeper) if deeper else None,
        )
        for claim in claims
    ]


def by_question(claims: Sequence[JudgedClaim]) -> list[tuple[str, list[JudgedClaim]]]:
    """Returns the claims by the question that they answer, without questions without claims."""
    asked = [
        (question.value, [one for one in claims if one.claim.question is question])
        for question in Question
    ]
    return [(question, found) for question, found in asked if found]


def claims_as_markdown(claims: Sequence[JudgedClaim]) -> str:
    """Returns a table of claims for each question."""
    heads = heads_of(claims)
    tables = [
        "\n".join(
            [f"### {question}", "", *markdown_table(heads, (row_of(one, heads) for one in asked))]
        )
        for question, asked in by_question(claims)
    ]
    return "\n\n".join(tables) + "\n"


def heads_of(claims: Sequence[JudgedClaim]) -> tuple[str, ...]:
    """Returns the heads of the table of claims, without columns for which nothing was measured."""
    varied = any(one.variants for one in claims)
    deeper = any(one.deeper for one in claims)
    return (
        "what the thesis says",
        "where",
        "verdict",
        "effect, thesis",
        "effect, ours",
        "comparisons that agree",
        *["variants that agree"] * varied,
        *["levels read otherwise"] * deeper,
        "formerly",
    )


def row_of(one: JudgedClaim, heads: Sequence[str]) -> tuple[str, ...]:
    """Returns the fields of a claim's row below these heads."""
    thesis, ours = effects(one)
    fields = {
        "what the thesis says": f"{one.claim.says} ({one.claim.name})",
        "where": one.claim.where,
        "verdict": f"**{one.ours.verdict.value}**",
        "effect, thesis": thesis,
        "effect, ours": ours,
        "comparisons that agree": agreeing(one.ours),
        "variants that agree": variants_that_agree(one),
        "levels read otherwise": read_otherwise(one),
        "formerly": one.ours.formerly,
    }
    return tuple(fields[head] for head in heads)


def effects(one: JudgedClaim) -> tuple[str, str]:
    """Returns the thesis's effect and ours; for a list of figures, our ratio to it."""
    if not one.claim.is_figures:
        return effect(one.claim, one.thesis) or DASH, effect(one.claim, one.ours) or DASH
    printed = {check.cell: check.value for check in counted(one.thesis.checks) if check.value}
    ratios = [
        check.value / printed[check.cell]
        for check in counted(one.ours.checks)
        if check.value and check.cell in printed
    ]
    over = f"{number(geometric_mean(ratios))} times these{_range(ratios)}" if ratios else DASH
    return "these figures", over


def effect(claim: Claim, finding: Finding) -> str:
    """Returns the geometric mean of a claim's ratios or the median of its figures, with the range.

    It is empty if nothing was measured, or if the comparisons have no common unit.
    """
    known = [check for check in counted(finding.checks) if check.outcome is not Outcome.MISSING]
    ratios = [check.ratio for check in known if check.ratio is not None and check.ratio > 0]
    values = [check.value for check in known if check.value is not None]
    if claim.quantity is None or not (ratios or values):
        return ""
    of_ratios = len(ratios) >= len(values)
    middle = geometric_mean(ratios) if of_ratios else median(values)
    return f"{number(middle)} {claim.quantity}{_range(ratios if of_ratios else values)}"


def _range(figures: Sequence[float]) -> str:
    least, most = number(min(figures)), number(max(figures))
    return "" if least == most else f" ({least} to {most})"


def agreeing(finding: Finding) -> str:
    """Returns `5 of 6`, with undecided and missing comparisons; a dash if none was measured."""
    number_of = Counter(check.outcome for check in counted(finding.checks))
    if number_of[Outcome.MISSING] == number_of.total():
        return DASH
    return _share(number_of, Outcome.YES, (Outcome.UNDECIDED, Outcome.MISSING))


def variants_that_agree(one: JudgedClaim) -> str:
    """Returns `7 of 8`: how many variants support a claim, and how many test it."""
    number_of = Counter(found.verdict for found in one.variants if found.verdict in TESTED)
    if not number_of:
        return DASH
    return _share(number_of, Verdict.SUPPORTED, TESTED[1:])


def _share(number_of: Counter, agree: Enum, others: Sequence[Enum]) -> str:
    rest = ", ".join(f"{number_of[one]} {one.value}" for one in others if number_of[one])
    return f"{number_of[agree]} of {number_of.total()}" + f" ({rest})" * bool(rest)


_MOST_NAMED = 2


def named(finding: Finding, outcome: Outcome) -> str:
    """Returns the first comparisons with that outcome, with figures, and the number of others."""
    found = [check for check in counted(finding.checks) if check.outcome is outcome]
    first = [f"{check.cell}: {check.figures}" for check in found[:_MOST_NAMED]]
    rest = len(found) - len(first)
    return "; ".join([*first, *[f"{rest} more"] * (rest > 0)])


def read_otherwise(one: JudgedClaim) -> str:
    """Returns the verdict by the other reading of the thesis's levels, if it was measured."""
    return one.deeper.verdict.value if one.deeper and one.deeper.verdict in TESTED else DASH


def cells_as_markdown(claims: Sequence[JudgedClaim]) -> str:
    """Returns every cell that the verdicts rest on, claim by claim."""
    return "\n".join(line for one in claims for line in (*_cells(one), "")).rstrip() + "\n"


def cells_of(one: JudgedClaim) -> list[tuple[str, Check, Check]]:
    """Returns every cell that a claim's verdicts rest on: the thesis's check and ours."""
    thesis, ours = ({c.cell: c for c in each.checks} for each in (one.thesis, one.ours))
    nothing = Check("", Outcome.MISSING)
    return [
        (cell, thesis.get(cell, nothing), ours.get(cell, nothing))
        for cell in dict.fromkeys([*thesis, *ours])
    ]


def rule_in_words(one: JudgedClaim) -> str:
    """Returns the explanation of the claim's rule, with its thresholds."""
    return " ".join((one.claim.rule.__doc__ or "").split())


def _cells(one: JudgedClaim) -> list[str]:
    rows = (
        (cell, thesis.outcome.value, thesis.figures, ours.outcome.value, ours.figures)
        for cell, thesis, ours in cells_of(one)
    )
    lines = [
        f"## {one.claim.name}: {one.claim.says}",
        "",
        f"{one.claim.where}. {rule_in_words(one)}",
        "",
    ]
    lines += [one.claim.untestable, ""] * bool(one.claim.untestable)
    lines += markdown_table(("cell", "thesis", "figures", "ours", "figures"), rows)
    return lines
