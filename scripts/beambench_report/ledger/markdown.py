"""The ledger as a Markdown table, and its cells one by one."""

from __future__ import annotations

from collections.abc import Sequence

from beambench_report.ledger.book import Entry, Finding
from beambench_report.ledger.verdict import Check, Outcome
from beambench_report.quantities import number

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
