"""Two commits of this machine, measured in turns: what scripts/compare runs once both are built.

The history needs a dozen nights to tell a slow-down from noise. Two programs that take turns on one
machine tell within minutes: each turn gives a pair of figures that the machine treated alike.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt
from pathlib import Path

import numpy as np
import pandas as pd
from scipy import stats

from beambench_report.names import contender_labels
from beambench_report.nightly.night import cycles, keys_of
from beambench_report.page.cell_files import IDENTITY
from beambench_report.problem import Problem
from beambench_report.records import TIMED_VERDICTS, read_run

LEVEL = 0.01
TOLERANCE = 0.01
_RESAMPLES = 4000


@dataclass(frozen=True)
class Comparison:
    """One cell of both programs."""

    title: str
    pairs: int
    ratio: float
    """B's time over A's: above 1, B is slower."""
    low: float
    high: float
    p_value: float
    """That B is no slower, before Holm's correction."""


@dataclass(frozen=True)
class Outcome:
    """What two programs differ by."""

    cells: list[Comparison]
    slower: list[Comparison]
    """Slower by more than chance and TOLERANCE explain, over all cells together."""
    sentences: list[str]
    """Work and verdicts that differ."""

    @property
    def is_regression(self) -> bool:
        """Is B worse?"""
        return bool(self.slower or self.sentences)

    def table(self) -> str:
        """A line for each cell, the one that got slowest first."""
        named = {cell.title for cell in self.slower}
        lines = [f"{'B/A':>7}  {'95% interval':<17} {'turns':>5}  cell"]
        for cell in sorted(self.cells, key=lambda cell: -cell.ratio):
            mark = "  SLOWER" if cell.title in named else ""
            interval = f"{cell.low:.4f} to {cell.high:.4f}"
            lines.append(f"{cell.ratio:7.4f}  {interval:<17} {cell.pairs:>5}  {cell.title}{mark}")
        return "\n".join([*lines, *self.sentences])


def measure_in_turns(
    programs: tuple[Path, Path], sweep: Path, directory: Path, turns: int
) -> tuple[list[Path], list[Path]]:
    """Runs the sweep by A and B, B and A, ...; returns the folders of their runs."""
    folders: tuple[list[Path], list[Path]] = ([], [])
    for turn in range(turns):
        order = (0, 1) if turn % 2 == 0 else (1, 0)  # neither is always the one that warms up
        for which in order:
            folder = directory / f"{'ab'[which]}-{turn + 1:02d}"
            if not (folder / "results.csv").exists():
                print(f"== turn {turn + 1} of {turns}: {'AB'[which]}", file=sys.stderr, flush=True)
                _call([str(programs[which]), "run", str(sweep), "-o", str(folder)])
            folders[which].append(folder)
    return folders


def compare_turns(first: list[Path], second: list[Path]) -> Outcome:
    """Pairs the runs of A and B by turns."""
    if len(first) != len(second) or len(first) < 4:
        raise Problem("a comparison needs as many runs of one as of the other, four or more each")
    times_a, rows_a = _table(first)
    times_b, rows_b = _table(second)
    cells = [key for key in times_a.columns if key in times_b.columns]
    labels = _titles(rows_b)
    compared = []
    for key in cells:
        logs = np.log(times_b[key].to_numpy()) - np.log(times_a[key].to_numpy())
        logs = logs[np.isfinite(logs)]
        if len(logs) >= 4 and labels[key][1] != "baseline":
            compared.append(_compare(labels[key][0], logs))
    return Outcome(compared, _slower(compared), _differences(rows_a, rows_b, labels))


def _call(command: list[str], run: Callable = subprocess.run) -> None:
    try:
        done = run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False)
    except OSError as error:
        raise Problem(f"{command[0]} cannot be run: {error.strerror}; build it first") from None
    if done.returncode not in (0, 1):
        lines = done.stderr.decode("utf-8", "replace").strip().splitlines()
        raise Problem(f"{command[0]}: {lines[-1] if lines else 'failed without a word'}")


def _table(folders: list[Path]) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Times, a row a turn and a column a cell; and the rows of the last turn."""
    turns, rows = [], pd.DataFrame()
    for folder in folders:
        rows = read_run(folder).rows
        turns.append(pd.Series(cycles(rows).to_numpy(), index=pd.Index(keys_of(rows))))
    return pd.DataFrame(turns), rows


def _titles(rows: pd.DataFrame) -> dict[tuple, tuple[str, str]]:
    labels = contender_labels(rows)
    return {
        key: (f"{label} in {row['view']} at {row['width']:.0f}x{row['height']:.0f}", row["verdict"])
        for key, label, (_, row) in zip(keys_of(rows), labels, rows.iterrows(), strict=True)
    }


def _compare(title: str, logs: np.ndarray) -> Comparison:
    random = np.random.default_rng(1999)
    drawn = random.choice(logs, (_RESAMPLES, len(logs)))
    low, high = np.quantile(np.median(drawn, axis=1), (0.025, 0.975))
    error = max(float(logs.std(ddof=1)) / sqrt(len(logs)), 1e-6)
    p_value = float(stats.t.sf((logs.mean() - TOLERANCE) / error, len(logs) - 1))
    middle = float(np.exp(np.median(logs)))
    return Comparison(title, len(logs), middle, float(np.exp(low)), float(np.exp(high)), p_value)


def _slower(compared: list[Comparison]) -> list[Comparison]:
    """Holm's procedure; the test asks for more than TOLERANCE already."""
    kept = []
    for rank, cell in enumerate(sorted(compared, key=lambda cell: cell.p_value)):
        if cell.p_value > LEVEL / (len(compared) - rank):
            break
        kept.append(cell)
    return kept


def _differences(first: pd.DataFrame, second: pd.DataFrame, labels: dict) -> list[str]:
    """Verdicts and counters that got worse."""
    keys = [name for name in IDENTITY if name in first]
    both = first.merge(second, on=keys, suffixes=("_a", "_b"))
    sentences = []
    for row, key in zip(both.to_dict("records"), keys_of(both), strict=True):
        title = labels[key][0]
        if row["verdict_b"] not in TIMED_VERDICTS and row["verdict_a"] in TIMED_VERDICTS:
            sentences.append(f"{title}: hits are not right any more ({row['verdict_b']})")
        for name, after in row.items():
            if not name.endswith("_per_ray_b") or name.endswith("_ns_per_ray_b"):
                continue
            before = row[f"{name.removesuffix('_b')}_a"]
            if after > before * 1.001:
                counter = name.removesuffix("_per_ray_b").replace("_", " ")
                sentences.append(f"{title}: {counter} a ray from {before:.6g} to {after:.6g}")
    return sentences
