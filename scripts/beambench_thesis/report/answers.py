"""Makes the first sentences of the report: one with a figure for each main question."""

from collections.abc import Sequence
from dataclasses import dataclass

from beambench_report.base.quantities import number
from beambench_thesis.claims.register import JudgedClaim, agreeing, effect
from beambench_thesis.claims.verdict import Check, Outcome, Question, Verdict, counted

_NOT_MEASURED = "Not measured here."


@dataclass(frozen=True)
class Answer:
    """A question and its answer in one sentence."""

    question: str
    text: str


def answers(claims: Sequence[JudgedClaim]) -> tuple[Answer, ...]:
    """Returns the answers to three questions: beams or rays, other structures, the cluster."""
    by_name = {one.claim.name: one for one in claims}
    return (
        Answer(
            Question.BEAMS_OR_RAYS.value,
            _beams_against(by_name["C13"], "Samet's and Samet-Net's single rays")
            + _beside(by_name["C14"], by_name["C16"]),
        ),
        Answer(
            Question.OTHER_STRUCTURES.value,
            _beams_against(by_name["C18"], "the voxel grid and Goldsmith and Salmon's hierarchy"),
        ),
        Answer(Question.PARALLEL.value, _efficiency(by_name.get("C22"))),
    )


_WORDS = {
    Verdict.SUPPORTED: "Yes",
    Verdict.MIXED: "Not everywhere",
    Verdict.CONTRADICTED: "Mostly not",
    Verdict.UNDECIDED: "Undecided",
}


def _beams_against(one: JudgedClaim, others: str) -> str:
    """Returns the sentence for a claim about times at 1280x1024."""
    if one.ours.verdict not in _WORDS:
        return _NOT_MEASURED
    none_opposes = all(check.outcome is not Outcome.NO for check in counted(one.ours.checks))
    open_but_yes = one.ours.verdict is Verdict.UNDECIDED and none_opposes
    begins = "Where decided, yes" if open_but_yes else _WORDS[one.ours.verdict]
    return (
        f"{begins}: at 1280x1024, build included, {others} take "
        f"{effect(one.claim, one.ours)} as long as the beams and are slower in "
        f"{agreeing(one.ours)} comparisons; in the thesis, {effect(one.claim, one.thesis)}."
    )


def _beside(low: JudgedClaim, best: JudgedClaim) -> str:
    """Returns further verdicts: at low resolution, and at the single rays' own best level."""
    if low.ours.verdict not in _WORDS or best.ours.verdict not in _WORDS:
        return ""
    return (
        f" Single rays can win at 320x200: {low.ours.verdict.value}. At high resolution beams win "
        f"even against single rays at their best level: {best.ours.verdict.value}."
    )


def _efficiency(one: JudgedClaim | None) -> str:
    """Returns the sentence on the efficiency of the parallel program over gato-bill."""
    checks = {check.cell: check for check in one.ours.checks} if one else {}
    found = [
        (cell, check, _with(checks, cell))
        for cell, check in checks.items()
        if cell.startswith("gato-bill") and cell.endswith("best efficiency")
    ]
    known = [(cell, check, at) for cell, check, at in found if check.value and at and at.value]
    if one is None or not known:
        return f"{_NOT_MEASURED} It is simulated by `python -m beambench_thesis cluster`."
    parts = [
        f"{number(check.value or 0)} on {at.value:.0f} processors ({cell.split(', ')[1]})"
        for cell, check, at in known
    ]
    return (
        f"Best efficiency for gato-bill: {' or '.join(parts)}; in the thesis, 0.75 on 11. "
        f"{agreeing(one.ours)} comparisons agree."
    )


def _with(checks: dict[str, Check], cell: str) -> Check | None:
    return checks.get(cell.removesuffix(" efficiency") + " with")
