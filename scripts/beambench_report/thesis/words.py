"""What the report says in words, the same in Markdown and on the page."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from beambench_report.ledger.verdict import Verdict

if TYPE_CHECKING:
    from beambench_report.thesis.report import Report

TABLE_WORDS = (
    "Beside the thesis's seconds (a Pentium of 350 MHz, 1999) stand our milliseconds; seconds of "
    "so different machines are not to be compared. What compares are the shapes, in brackets: each "
    "time over that of the same part's first row at 320x200, the thesis's and ours. Times contain "
    "the building of the structure, as the thesis's do; our part of it stands behind the total. "
    "Parameters are the thesis's: octrees of level 6 unless the table says otherwise, 32 voxels an "
    "axis filled lazily, objects inserted as given beside terminal nodes (insert=terminal), Kay "
    "and Kajiya's queue, no handover. Rows marked (of today) or (Goldsmith and Salmon 1987) are "
    "not the thesis's."
)
BEST_WORDS = (
    "Each contender with those of its parameters that made it quickest, building included, in "
    "brackets its time over that of the first row and the interval of that ratio."
)


def headline(report: Report) -> str:
    """How much was measured, and whether it was right."""
    cells, wrong = len(report.cells.cells), len(report.cells.wrong)
    if not cells:
        return "Nothing was measured yet."
    right = "all of them right" if not wrong else f"{wrong} of them not right, and without times"
    return f"{cells:,} cells in {len(report.cells.runs)} runs, {right}."


def notice(report: Report) -> str:
    """What a reader must know before reading on; nothing where all was measured in full."""
    sentences = []
    if not report.is_complete:
        sentences.append("Not everything that was planned is there (see Runs).")
    if report.plan.is_quick:
        sentences.append(
            "This was a quick run: low resolutions and few repetitions, for a look, not for "
            f"verdicts. {decided(report)}"
        )
    elif not report.plan.is_everything:
        sentences.append("Only some tables and figures were asked for.")
    return " ".join(sentences)


def decided(report: Report) -> str:
    """Which claims have all their cells; the others need what was not measured."""
    names = [e.claim.name for e in report.ledger if e.ours.verdict is not Verdict.NOT_TESTED]
    which = f": {', '.join(names)}" if names else ""
    return (
        f"Its cells are enough for {len(names)} of {len(report.ledger)} claims{which}; the others "
        "need cells that were not measured."
    )


def verdict_counts(report: Report) -> str:
    """How many claims hold by the thesis's own figures and by ours."""
    told = []
    for whose, verdicts in (
        ("By the thesis's own figures", [entry.thesis.verdict for entry in report.ledger]),
        ("by ours", [entry.ours.verdict for entry in report.ledger]),
    ):
        counts = Counter(verdicts)
        listed = ", ".join(f"{counts[v]} {_plural(v, counts[v])}" for v in Verdict if counts[v])
        told.append(f"{whose}: {listed}")
    return f"{'; '.join(told)}."


def _plural(verdict: Verdict, count: int) -> str:
    words = {
        Verdict.HOLDS: ("holds", "hold"),
        Verdict.IN_PART: ("holds in part", "hold in part"),
        Verdict.FAILS: ("fails", "fail"),
    }
    one, more = words.get(verdict, (verdict.value, verdict.value))
    return one if count == 1 else more
