"""Compares two runs of one sweep, cell by cell: ratios within each run, and milliseconds if both
ran on one machine.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from beambench.analysis import Median, Ratio, unpaired_ratio
from beambench_operations.site.entry import Cell, Ends, Entry
from beambench_report.base.records import BASELINE

_MOST = 25


@dataclass(frozen=True)
class Pair:
    """A cell of both runs."""

    before: Cell
    after: Cell
    ratios: tuple[Ends | None, Ends | None]
    """The ratio to the reference within each run; None without a reference."""
    ratio: Ratio | None
    """The later ratio to the reference over the earlier one; None if one is missing."""
    ms: Ratio | None
    """The same for milliseconds; None across machines."""

    @property
    def side(self) -> str:
        """`slower` or `faster` if the interval of the ratio is on one side of 1."""
        if self.ratio is None or self.ratio.interval is None:
            return ""
        low, high = self.ratio.interval
        return "slower" if low > 1 else "faster" if high < 1 else ""


@dataclass(frozen=True)
class Comparison:
    """A later run compared with an earlier one."""

    before: Entry
    after: Entry
    reference: str
    """Structure and parameters of the reference; empty if the runs share none."""
    warning: str
    """A note on machines; empty if both ran on one machine."""
    sentences: tuple[str, ...]
    pairs: tuple[Pair, ...]

    @property
    def reference_label(self) -> str:
        """The reference as the later run names it."""
        names = (cell.contender for cell in self.after.cells if cell.who == self.reference)
        return next(names, "")

    @property
    def same_machine(self) -> bool:
        """Whether milliseconds are compared."""
        return not self.warning

    def count(self, side: str) -> int:
        """Returns the number of ratios whose interval is above 1 (`slower`) or below (`faster`)."""
        return sum(pair.side == side for pair in self.pairs)

    @property
    def compared(self) -> int:
        """The number of ratios that both runs have."""
        return sum(pair.ratio is not None for pair in self.pairs)


def compare(before: Entry, after: Entry) -> Comparison:
    """Pairs the cells of two runs; the largest changes come first."""
    warning = ""
    if before.machine.differs_from(after.machine):
        warning = (
            f"{before.machine} before, {after.machine} after. Their milliseconds "
            "are not compared, and ratios depend on the processor, too: these changes are not "
            "due to the program alone."
        )
    reference, then_ratios, now_ratios = _ratios(before, after)
    known = {cell.key: cell for cell in before.cells}
    both = [(known[cell.key], cell) for cell in after.cells if cell.key in known]
    alike = [(then, cell) for then, cell in both if then.inputs == cell.inputs]
    pairs = []
    for then, cell in alike:
        ratios = (then_ratios.get(cell.key), now_ratios.get(cell.key))
        ms = None if warning else _change(then.ms, cell.ms)
        pairs.append(Pair(then, cell, ratios, _change(*ratios), ms))
    verdicts = [
        f"{cell.contender} in {cell.view} at {cell.size}: {then.verdict} before, "
        f"{cell.verdict} now."
        for then, cell in alike
        if then.verdict != cell.verdict
    ]
    counts = (
        (sum(then.work != cell.work for then, cell in alike), "has", "have", "different counters."),
        (len(both) - len(alike), "has", "have", "different rays or scenes; they are not compared."),
        (len(after.cells) - len(both), "is", "are", "new."),
        (len(before.cells) - len(both), "is", "are", "gone."),
    )
    sentences = verdicts[:_MOST]
    sentences += [
        f"{count:,} cell {one} {words}" if count == 1 else f"{count:,} cells {many} {words}"
        for count, one, many, words in counts
        if count
    ]
    pairs.sort(key=lambda pair: -abs((pair.ratio.value if pair.ratio else 1.0) - 1))
    return Comparison(before, after, reference, warning, tuple(sentences), tuple(pairs))


def _ratios(before: Entry, after: Entry) -> tuple[str, dict[str, Ends], dict[str, Ends]]:
    """Returns the reference of both runs, and the ratios to it by the keys of the cells.

    If the runs have different references, a contender that both have is taken, Embree's single rays
    if possible; the ratios are then of medians, not paired. Contenders that find no hits have no
    ratio.
    """
    if before.reference == after.reference != "":
        name = after.reference
        then, now = ({cell.key: cell.ratio for cell in run.cells} for run in (before, after))
    else:
        timed = [{cell.key: cell for cell in run.cells if cell.ms} for run in (before, after)]
        common = Counter(
            cell.who
            for key, cell in timed[1].items()
            if key in timed[0] and cell.verdict != BASELINE
        )

        def preference(who: str) -> tuple[bool, int, str]:
            return (who.startswith("embree ") and "mode=single" in who, common[who], who)

        name = max(common, key=preference, default="")
        then, now = (_over(name, list(cells.values())) for cells in timed)
    leave_out = {cell.key for cell in after.cells if cell.who == name or cell.verdict == BASELINE}
    return name, *(
        {key: ratio for key, ratio in ratios.items() if ratio and key not in leave_out}
        for ratios in (then, now)
    )


def _over(reference: str, cells: Sequence[Cell]) -> dict[str, Ends]:
    bases = {cell.rays: cell.ms for cell in cells if cell.who == reference}
    return {
        cell.key: (ratio.value, ratio.low, ratio.high)
        for cell in cells
        if (ratio := _change(bases.get(cell.rays), cell.ms))
    }


def _change(before: Ends | None, after: Ends | None) -> Ratio | None:
    return unpaired_ratio(Median(*after), Median(*before)) if before and after else None
