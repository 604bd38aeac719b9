"""Measures two built commits in turns on this machine, for scripts/compare.

The history needs a dozen nights to separate a slowdown from noise. Two programs that take turns
on one machine need minutes. Each turn yields a pair of times measured under the same conditions,
the means over the blocks of two runs, and pairs are averaged like blocks (`block_ratio`). The
order is A B, B A, A B, ..., so that each is first equally often, and neither a drift of the
machine nor the order within a turn favors one of them.

The cells of a turn are not independent: they share a process and a moment of the machine. (The
same program was compared with itself twice, in 12 turns during builds: the mean correlation
between cells was 0.28 and 0.23; the order within a turn had no effect, -1.9% and +0.5%.) So most
or all ratios may lie on one side of 1 by chance, and several intervals may exclude 1 together.
Therefore cells are tested together, by Holm's correction, and the ratio of all cells is computed
turn by turn.

TOLERANCE is smaller than the margin of 3% within which two contenders of one run rank as equal.
Within a run, nobody needs an order of nearly equal contenders; here, one program is the other's
successor, and small losses add up.
"""

from dataclasses import dataclass
from math import log
from pathlib import Path

import numpy as np
import pandas as pd
from scipy import stats

from beambench.analysis import Ratio, block_ratio
from beambench_operations.history.alarms import SHARE
from beambench_operations.history.night import cell_titles, is_timed, keys_of
from beambench_operations.history.steps import holm
from beambench_report.base.cell_files import IDENTITY
from beambench_report.base.files import Problem, output_of, say
from beambench_report.base.records import (
    BASELINE,
    NO_RAYS,
    TIMED_VERDICTS,
    UNSUPPORTED,
    in_blocks,
    read_run,
)

LEVEL = 0.01
TOLERANCE = 0.01
_GONE = {
    NO_RAYS: "there are no longer such rays",
    UNSUPPORTED: "the structure no longer supports this",
}
LEAST_TURNS = 6
"""With fewer pairs, Student's t is so wide that only large slowdowns are found."""


@dataclass(frozen=True)
class Comparison:
    """One cell of both programs."""

    title: str
    pairs: int
    ratio: Ratio
    """B's time over A's, with its interval: above 1, B is slower."""
    p_value: float
    """The p-value of the hypothesis that B is not slower, before Holm's correction."""

    @property
    def is_decided(self) -> bool:
        """Whether the interval rules out that B is slower by more than TOLERANCE."""
        return self.ratio.high <= 1 + TOLERANCE


@dataclass(frozen=True)
class Outcome:
    """The difference between two programs."""

    cells: list[Comparison]
    slower: list[Comparison]
    """The cells slower by more than chance and TOLERANCE explain, corrected over all cells."""
    sentences: list[str]
    """Work counters and verdicts that got worse."""
    together: Ratio
    """The geometric mean of all cells, turn by turn."""

    @property
    def is_regression(self) -> bool:
        """Whether B is worse."""
        return bool(self.slower or self.sentences)

    def table(self) -> str:
        """Returns a line for each cell, the largest slowdown first."""
        named = {cell.title for cell in self.slower}
        lines = [f"{'B/A':>7}  {'95% confidence':<17} {'turns':>5}  cell"]
        for cell in sorted(self.cells, key=lambda cell: -cell.ratio.value):
            mark = "  SLOWER" if cell.title in named else ""
            lines.append(f"{_line(cell.ratio)} {cell.pairs:>5}  {cell.title}{mark}")
        lines.append(f"{_line(self.together)}        all cells together")
        return "\n".join([*lines, *self.sentences])

    def verdict(self) -> str:
        """Summarizes the table in a sentence or two."""
        rule = (
            f"by more than {TOLERANCE:.0%} and by more than chance explains (paired t test, Holm's "
            f"correction to {LEVEL:.0%} over {len(self.cells)} cells)"
        )
        if self.slower:
            worst = sorted(self.slower, key=lambda cell: -cell.ratio.value)
            named = "; ".join(
                f"{cell.title} by {ratio.value - 1:.1%} "
                f"({ratio.low - 1:+.1%} to {ratio.high - 1:+.1%})"
                for cell in worst
                for ratio in [cell.ratio]
            )
            text = f"SLOWER: {len(worst)} of {len(self.cells)} cells, {rule}: {named}."
        else:
            text = f"No cell is slower {rule}.{self._undecided()}"
        if self.sentences:
            text += f" WORSE: hits or work, in {len(self.sentences)} places named above."
        return text

    def _undecided(self) -> str:
        """Describes the slowdowns that were not ruled out, for lack of turns or due to noise."""
        open_cells = [cell for cell in self.cells if not cell.is_decided]
        if not open_cells:
            return ""
        widest = max(open_cells, key=lambda cell: cell.ratio.high)
        return (
            f" For {len(open_cells)} of them a slowdown by more than {TOLERANCE:.0%} is not ruled "
            f"out: the widest interval reaches {widest.ratio.high - 1:+.1%} ({widest.title}). "
            "More turns narrow it."
        )


def _line(ratio: Ratio) -> str:
    interval = "none" if ratio.interval is None else f"{ratio.low:.4f} to {ratio.high:.4f}"
    return f"{ratio.value:7.4f}  {interval:<17}"


def measure_in_turns(
    programs: tuple[Path, Path], sweep: Path, directory: Path, turns: int
) -> tuple[list[Path], list[Path]]:
    """Runs the sweep by A and B, B and A, ...; returns the folders of their runs.

    Raises Problem if `turns` is odd or below LEAST_TURNS, or if a program cannot be run.
    """
    if turns < LEAST_TURNS or turns % 2:
        raise Problem(
            f"{turns} turns: give an even number from {LEAST_TURNS} on, so that each program goes "
            "first equally often and the ratios have intervals"
        )
    folders: tuple[list[Path], list[Path]] = ([], [])
    for turn in range(turns):
        order = (0, 1) if turn % 2 == 0 else (1, 0)  # each warms up the machine equally often
        for which in order:
            folder = directory / f"{'ab'[which]}-{turn + 1:02d}"
            if not (folder / "results.csv").exists():
                say(f"== turn {turn + 1} of {turns}: {'AB'[which]}")
                command = [str(programs[which]), "run", str(sweep), "-o", str(folder)]
                output_of(command, success=(0, 1))
            folders[which].append(folder)
    return folders


def compare_turns(first: list[Path], second: list[Path]) -> Outcome:
    """Compares the runs of A and B, paired by turns."""
    if len(first) != len(second) or len(first) < LEAST_TURNS:
        raise Problem(
            f"a comparison needs equal numbers of runs of both programs, {LEAST_TURNS} or more of "
            f"each, not {len(first)} and {len(second)}"
        )
    times_a, rows_a = _table(first)
    times_b, rows_b = _table(second)
    if in_blocks(rows_a) != in_blocks(rows_b):
        old = first if in_blocks(rows_b) else second
        raise Problem(
            f"{old[-1]}: was measured by a program that does not measure in blocks; compare "
            "two programs that do, or two that do not"
        )
    titles = cell_titles(rows_b)
    baselines = set(keys_of(rows_b[rows_b["verdict"] == BASELINE]))
    shared = [key for key in times_a.columns if key in times_b.columns]
    cells = [key for key in shared if key not in baselines]
    ratios = ((titles[key], *_ratio(times_b[key], times_a[key])) for key in cells)
    compared = [
        Comparison(title, pairs, ratio, _p_value(ratio, pairs))
        for title, pairs, ratio in ratios
        if ratio and ratio.interval
    ]
    if not compared:
        raise Problem("no cell has times in enough turns of both programs; were their hits right?")
    _, together = _ratio(_mean_cell(times_b[cells]), _mean_cell(times_a[cells]))
    return Outcome(
        compared,
        holm(compared, len(compared), LEVEL),  # each test is already for more than TOLERANCE
        _differences(rows_a, rows_b, titles),
        together or Ratio(float("nan")),
    )


def _table(folders: list[Path]) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Returns times, with a row per turn and a column per cell, and the rows of the last turn."""
    runs = [read_run(folder).rows for folder in folders]
    turns = [
        pd.Series(rows["total_ms"].where(is_timed(rows)).to_numpy(), pd.Index(keys_of(rows)))
        for rows in runs
    ]
    return pd.DataFrame(turns), runs[-1]


def _ratio(times_b: pd.Series, times_a: pd.Series) -> tuple[int, Ratio | None]:
    """Returns the number of turns with both times, and the ratio of the times, paired by turns."""
    known = times_b.notna() & times_a.notna()
    ratio = block_ratio(times_b[known].to_dict(), times_a[known].to_dict())
    return int(known.sum()), ratio


def _mean_cell(times: pd.DataFrame) -> pd.Series:
    """Returns the geometric mean of the cells in each turn; NaN in turns that lack a cell."""
    return pd.Series(np.exp(np.log(times.to_numpy(float)).mean(axis=1)), index=times.index)


def _p_value(ratio: Ratio, pairs: int) -> float:
    error = max(ratio.error or 0.0, 1e-6)
    return float(stats.t.sf((log(ratio.value) - TOLERANCE) / error, pairs - 1))


def _differences(first: pd.DataFrame, second: pd.DataFrame, titles: dict) -> list[str]:
    """Returns the verdicts and counters that got worse."""
    keys = [name for name in IDENTITY if name in first]
    both = first.merge(second, on=keys, suffixes=("_a", "_b"))
    sentences = []
    for row, key in zip(both.to_dict("records"), keys_of(both), strict=True):
        title = titles[key]
        verdict = row["verdict_b"]
        if row["verdict_a"] in TIMED_VERDICTS and verdict not in TIMED_VERDICTS:
            what = _GONE.get(verdict, f"the hits are now wrong ({verdict})")
            sentences.append(f"{title}: {what}")
        for name, after in row.items():
            counter = name.removesuffix("_per_ray_b")
            if counter == name or counter.endswith("_ns"):
                continue
            before = row[f"{counter}_per_ray_a"]
            if after > before * (1 + SHARE):
                words = counter.replace("_", " ")
                sentences.append(f"{title}: {words} per ray from {before:.6g} to {after:.6g}")
    return sentences
