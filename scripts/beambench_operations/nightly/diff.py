"""Compares two result files of any two machines or versions, cell by cell, with intervals.

Milliseconds of two machines are not comparable. If the files are of two machines, each time is
divided by that of a contender that both files have, and these ratios are compared.
"""

import tempfile
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import groupby
from math import exp, log, sqrt
from pathlib import Path

import pandas as pd

from beambench.analysis import Median, Ratio, unpaired_ratio
from beambench_operations.history.night import (
    cell_titles,
    comparable,
    inputs_of,
    keys_of,
    views_of,
)
from beambench_report.base.cell_files import (
    CellFile,
    Identity,
    median_of,
    ratio_of,
    read_cell_files,
)
from beambench_report.base.files import Problem
from beambench_report.base.machine import Machine, machine_of
from beambench_report.base.records import (
    NO_RAYS,
    UNSUPPORTED,
    contenders_with_times,
    in_blocks,
    read_run,
)

Key = tuple
Contender = tuple[str, str]
"""Structure and parameters."""


@dataclass(frozen=True)
class Pair:
    """One cell of both files."""

    structure: str
    title: str
    ratio: Ratio
    same_input: bool


@dataclass(frozen=True)
class Difference:
    """The comparison of B with A."""

    what: str
    warning: str
    """Reasons for care: two machines, or only one file measured in blocks; may be empty.
    """
    pairs: list[Pair]
    only_a: int
    only_b: int
    wrong: list[str]

    def text(self) -> str:
        """Returns a line for all cells of each structure, followed by a line for each cell."""
        lines = [*([self.warning, ""] if self.warning else []), self.what]
        for structure, group in groupby(self.pairs, key=lambda pair: pair.structure):
            own = sorted(group, key=lambda pair: -pair.ratio.value)
            overall = _overall(own)
            mean = f"{overall.value:.3f}{_interval(overall)}"
            lines += ["", f"{structure}: {mean} over {len(own)} cells"]
            for pair in own:
                note = "" if pair.same_input else "  (different rays or scene)"
                lines.append(
                    f"  {pair.ratio.value:8.3f}{_interval(pair.ratio)}  {pair.title}{note}"
                )
        if self.only_a or self.only_b:
            lines += ["", f"Only in A: {self.only_a} cells; only in B: {self.only_b}."]
        return "\n".join([*lines, *self.wrong]) + "\n"


@dataclass(frozen=True)
class _File:
    """The parts of a file that are compared."""

    rows: pd.DataFrame
    cells: Mapping[Identity, CellFile]
    machine: Machine


def diff(first: Path, second: Path, *, relative: bool | None = None) -> Difference:
    """Compares two CSVs.

    With `relative`, times are ratios to a contender that both files have; without it, milliseconds.
    By default they are ratios if the machines differ, since milliseconds are then refused. Raises
    Problem if nothing can be compared.
    """
    file_a, file_b = _read(first), _read(second)
    warning = ""
    if file_a.machine.differs_from(file_b.machine):
        if relative is False:
            raise Problem(
                f"{first} is of machine {file_a.machine}, {second} of {file_b.machine}: "
                "milliseconds of two machines cannot be compared; leave out --no-relative"
            )
        relative = True
        warning = (
            f"WARNING: two machines. A is of machine {file_a.machine}, B of {file_b.machine}. "
            "Their milliseconds cannot be compared; ratios to a contender of both files are shown."
        )
    if in_blocks(file_a.rows) != in_blocks(file_b.rows):
        warning = (
            f"{warning}\nWARNING: one file was not measured in blocks. Its times are medians "
            "of one process, which are longer than those of blocks for that reason alone."
        ).lstrip()
    reference = _reference(file_a.rows, file_b.rows) if relative else None
    known_a, known_b = _figures(file_a, reference), _figures(file_b, reference)
    titles = cell_titles(file_b.rows)
    pairs = [
        Pair(key[2], titles[key], unpaired_ratio(b, a), inputs_a == inputs_b)
        for key in known_a.keys() & known_b.keys()
        for (a, inputs_a), (b, inputs_b) in [(known_a[key], known_b[key])]
    ]
    if not pairs:
        raise Problem(f"{first} and {second} have no cell in common that has times")
    pairs.sort(key=lambda pair: (pair.structure, pair.title))
    how = f"over that of {' '.join(reference)} in the same file" if reference else "in milliseconds"
    what = f"B over A: total {how}; above 1, B is slower. A is {first}, B is {second}."
    return Difference(
        what,
        warning,
        pairs,
        len(known_a.keys() - known_b.keys()),
        len(known_b.keys() - known_a.keys()),
        _wrong(file_a.rows, "A") + _wrong(file_b.rows, "B"),
    )


def _read(path: Path) -> _File:
    """Reads a CSV with any name, or the one in a folder."""
    if path.is_dir() or path.name == "results.csv":
        folder = path if path.is_dir() else path.parent
        rows = read_run(folder).rows
        return _File(rows, read_cell_files(folder), machine_of(rows, folder))
    with tempfile.TemporaryDirectory() as temporary:
        link = Path(temporary) / "results.csv"
        if not path.is_file():
            raise Problem(f"{path}: is not a file that can be read")
        link.symlink_to(path.resolve())
        try:
            rows = read_run(Path(temporary)).rows
        except Problem as problem:
            raise Problem(str(problem).replace(str(link), str(path))) from None
    return _File(rows, {}, machine_of(rows, path.parent))


def _reference(rows_a: pd.DataFrame, rows_b: pd.DataFrame) -> Contender:
    """Returns the contender that both files have in the most views; Embree's single rays if
    possible.

    Raises Problem if they have no contender in common.
    """
    views_a, views_b = (
        {(*view, *who) for view, who in zip(views_of(rows), _contenders(rows), strict=True)}
        for rows in (contenders_with_times(rows_a), contenders_with_times(rows_b))
    )
    counts = Counter((key[-2], key[-1]) for key in views_a & views_b)
    if not counts:
        raise Problem("the files are of two machines and have no contender with times in common")

    def preference(who: Contender) -> tuple[bool, int, Contender]:
        return (who[0] == "embree" and "mode=single" in who[1], counts[who], who)

    return max(counts, key=preference)


def _figures(file: _File, reference: Contender | None) -> dict[Key, tuple[Median, str]]:
    """Returns each cell's time, or its ratio to the reference, and its inputs."""
    timed = contenders_with_times(file.rows)
    rows = [row for _, row in timed.iterrows()]
    cells = list(
        zip(
            *(keys_of(timed), comparable(timed), _contenders(timed), rows, inputs_of(timed)),
            strict=True,
        )
    )
    if reference is None:
        return {key: (median_of(row, "total"), asked) for key, _, _, row, asked in cells}
    bases = {view: row for _, view, who, row, _ in cells if who == reference}
    return {
        key: (Median(ratio.value, ratio.low, ratio.high), asked)
        for key, view, who, row, asked in cells
        if view in bases and who != reference
        for ratio in [ratio_of("total", row, bases[view], file.cells)]
    }


def _contenders(rows: pd.DataFrame) -> list[Contender]:
    return list(zip(rows["structure"], rows["parameters"], strict=True))


def _overall(pairs: list[Pair]) -> Ratio:
    """Returns the geometric mean with an interval from the spread over cells, which are not
    repetitions.
    """
    logs = pd.Series([log(pair.ratio.value) for pair in pairs])
    if len(logs) < 2:
        return pairs[0].ratio
    half = 1.96 * logs.std() / sqrt(len(logs))
    return Ratio(exp(logs.mean()), exp(logs.mean() - half), exp(logs.mean() + half))


def _interval(ratio: Ratio) -> str:
    return "" if ratio.interval is None else f" ({ratio.low:.3f} to {ratio.high:.3f})"


def _wrong(rows: pd.DataFrame, name: str) -> list[str]:
    wrong = int((~rows["timed"] & ~rows["verdict"].isin((NO_RAYS, UNSUPPORTED))).sum())
    return [f"In {name}, {wrong} cells have no times: wrong hits."] if wrong else []
