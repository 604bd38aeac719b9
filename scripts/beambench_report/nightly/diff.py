"""Two result files of any two machines or versions, cell by cell, with intervals."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from math import exp, log, sqrt
from pathlib import Path

import pandas as pd

from beambench_report.names import contender_labels
from beambench_report.nightly.night import VIEW, keys_of
from beambench_report.problem import Problem
from beambench_report.records import read_run


@dataclass(frozen=True)
class Pair:
    """One cell of both files; `low` and `high` are NaN where a file tells no interval."""

    structure: str
    title: str
    ratio: float
    low: float
    high: float
    same_input: bool


@dataclass(frozen=True)
class Difference:
    """B beside A."""

    what: str
    pairs: list[Pair]
    only_a: int
    only_b: int
    wrong: list[str]

    def text(self) -> str:
        """Structure by structure: a line for all its cells, then each cell."""
        lines = [self.what]
        structures = dict.fromkeys(pair.structure for pair in self.pairs)
        for structure in structures:
            own = [pair for pair in self.pairs if pair.structure == structure]
            ratio, low, high = _overall(own)
            lines += ["", f"{structure}: {ratio:.3f}{_interval(low, high)} over {len(own)} cells"]
            for pair in sorted(own, key=lambda pair: -pair.ratio):
                note = "" if pair.same_input else "  (other rays or scene)"
                lines.append(
                    f"  {pair.ratio:8.3f}{_interval(pair.low, pair.high)}  {pair.title}{note}"
                )
        if self.only_a or self.only_b:
            lines += ["", f"Only in A: {self.only_a} cells; only in B: {self.only_b}."]
        return "\n".join([*lines, *self.wrong]) + "\n"


def diff(first: Path, second: Path, *, relative: bool | None = None) -> Difference:
    """Compares two CSVs. `relative`: by the ratio to Embree in each file, as other machines need.

    If not given, it is so where the machines differ. Raises Problem where nothing can be compared.
    """
    rows_a, rows_b = _read(first), _read(second)
    if relative is None:
        relative = set(rows_a["machine_id"]) != set(rows_b["machine_id"])
    known_a, known_b = _figures(rows_a, relative), _figures(rows_b, relative)
    titles = _titles(rows_b)
    pairs = []
    for key in known_a.keys() & known_b.keys():
        (a, error_a, inputs_a), (b, error_b, inputs_b) = known_a[key], known_b[key]
        error = sqrt(error_a**2 + error_b**2)
        middle = b - a
        pairs.append(
            Pair(
                key[2],
                titles[key],
                exp(middle),
                exp(middle - error),
                exp(middle + error),
                inputs_a == inputs_b,
            )
        )
    if not pairs:
        raise Problem(f"{first} and {second} have no cell in common that has times")
    pairs.sort(key=lambda pair: (pair.structure, pair.title))
    how = "over Embree's single rays in the same file" if relative else "in milliseconds"
    what = f"B over A: total {how}; above 1, B is slower. A is {first}, B is {second}."
    return Difference(
        what,
        pairs,
        len(known_a.keys() - known_b.keys()),
        len(known_b.keys() - known_a.keys()),
        _wrong(rows_a, "A") + _wrong(rows_b, "B"),
    )


def _read(path: Path) -> pd.DataFrame:
    """A CSV, or the folder that holds one; whatever its name."""
    if path.is_dir() or path.name == "results.csv":
        return read_run(path if path.is_dir() else path.parent).rows
    with tempfile.TemporaryDirectory() as folder:
        link = Path(folder) / "results.csv"
        if not path.is_file():
            raise Problem(f"{path}: is not a file that can be read")
        link.symlink_to(path.resolve())
        try:
            return read_run(Path(folder)).rows
        except Problem as problem:
            raise Problem(str(problem).replace(str(link), str(path))) from None


def _figures(rows: pd.DataFrame, relative: bool) -> dict[tuple, tuple[float, float, str]]:
    """Logarithm of the time of each cell, half its 95% interval, and what was asked."""
    timed = rows[rows["timed"] & (rows["verdict"] != "baseline") & (rows["total_ms_median"] > 0)]
    views = [tuple(row) for row in timed[list(VIEW)].to_numpy().tolist()]
    figures, references = {}, {}
    for view, key, (_, row) in zip(views, keys_of(timed), timed.iterrows(), strict=True):
        inputs = f"{row.get('scene_hash', '')} {row.get('rays_hash', '')}"
        figures[key] = (view, log(row["total_ms_median"]), _half_width(row), inputs)
        if row["structure"] == "embree" and ("mode=single" in row["parameters"]):
            references[view] = (key, figures[key])
    if not relative:
        return {key: (time, error, inputs) for key, (_, time, error, inputs) in figures.items()}
    result = {}
    for key, (view, time, error, inputs) in figures.items():
        reference = references.get(view)
        if reference is None or reference[0] == key:
            continue
        _, base, base_error, _ = reference[1]
        result[key] = (time - base, sqrt(error**2 + base_error**2), inputs)
    return result


def _half_width(row: pd.Series) -> float:
    """NaN for a cell of too few repetitions: an interval must not be made up."""
    low, high = row["total_ms_ci_low"], row["total_ms_ci_high"]
    if pd.isna(low) or pd.isna(high) or low <= 0:
        return float("nan")
    middle = log(row["total_ms_median"])
    return max(log(high) - middle, middle - log(low))


def _titles(rows: pd.DataFrame) -> dict[tuple, str]:
    labels = contender_labels(rows)
    return {
        key: f"{label} in {row['view']} at {row['width']:.0f}x{row['height']:.0f}"
        for key, label, (_, row) in zip(keys_of(rows), labels, rows.iterrows(), strict=True)
    }


def _overall(pairs: list[Pair]) -> tuple[float, float, float]:
    """The geometric mean; its interval by the spread over cells, which are no repetitions."""
    logs = pd.Series([log(pair.ratio) for pair in pairs])
    if len(logs) < 2:
        return exp(logs.mean()), pairs[0].low, pairs[0].high
    half = 1.96 * logs.std() / sqrt(len(logs))
    return exp(logs.mean()), exp(logs.mean() - half), exp(logs.mean() + half)


def _interval(low: float, high: float) -> str:
    return "" if low != low else f" ({low:.3f} to {high:.3f})"


def _wrong(rows: pd.DataFrame, name: str) -> list[str]:
    wrong = int((~rows["timed"]).sum())
    return [f"In {name}, {wrong} cells have no times: their hits were not right."] if wrong else []
