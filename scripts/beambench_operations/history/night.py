"""A run as the history stores it: inputs, verdicts, counters and ratios."""

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from beambench.analysis import Ratio, block_ratio, unpaired_ratio
from beambench_report.base.analysis import block_totals
from beambench_report.base.cell_files import IDENTITY, median_of, name_of
from beambench_report.base.columns import COUNTER_SUFFIX
from beambench_report.base.files import Problem
from beambench_report.base.machine import machine_of
from beambench_report.base.records import FAULTLESS_VERDICTS, Run, in_blocks, size_of

Key = tuple[str, str, str, str, int, int, int, str]

# Contenders of one view traced the same rays; ratios are computed only among them.
VIEW = ("scene", "camera", "width", "height", "samples", "ray_kind")


@dataclass(frozen=True)
class Figure:
    """A cell of a night."""

    key: Key
    inputs: str
    counters: str
    """JSON of the counters per ray that were measured, sorted by name."""
    verdict: str
    reference: Key | None
    ratio: float | None
    error: float | None
    """The standard error of the ratio's logarithm; None with fewer than two blocks."""


@dataclass(frozen=True)
class Night:
    """A run in the form in which it enters the history."""

    run_id: str
    time_utc: str
    commit: str
    dirty: bool
    machine_id: str
    """The machine, with the processor if the manifest names it.

    Only nights of one machine are compared.
    """
    csv_sha256: str
    in_blocks: bool
    """Whether the night was measured in blocks. Other nights are shown but not compared."""
    figures: tuple[Figure, ...]

    @property
    def wrong(self) -> int:
        """The number of cells with wrong hits."""
        return sum(figure.verdict not in FAULTLESS_VERDICTS for figure in self.figures)


def night_of(run: Run) -> Night:
    """Reads a night from a run. Raises Problem if its rows are not those of one run."""
    rows = run.rows
    _require_one_run(run)
    references = references_of(rows)
    keys = keys_of(rows)
    ratios = _ratios(run, references)
    cells = zip(
        *(keys, views_of(rows), inputs_of(rows), counters_of(rows), rows["verdict"], ratios),
        strict=True,
    )
    figures = []
    for key, view, inputs, work, verdict, ratio in cells:
        reference = keys[references[view]] if view in references else None
        value, error = (ratio.value, ratio.error) if ratio else (None, None)
        figures.append(Figure(key, inputs, work, verdict, reference, value, error))
    last = rows.iloc[-1]
    return Night(
        last["run_id"],
        str(rows["time_utc"].max()) if "time_utc" in rows else "",
        last["commit"],
        (rows["dirty"] == "true").any(),
        str(machine_of(rows, run.directory)),
        hashlib.sha256((run.directory / "results.csv").read_bytes()).hexdigest(),
        in_blocks(rows),
        tuple(figures),
    )


def inputs_of(rows: pd.DataFrame) -> list[str]:
    """Returns the hashes of scene and rays of each row."""
    hashes = (rows.get(name, pd.Series("", rows.index)) for name in ("scene_hash", "rays_hash"))
    return [" ".join(pair) for pair in zip(*hashes, strict=True)]


def counters_of(rows: pd.DataFrame) -> list[str]:
    """Returns the work counters of each row as JSON, sorted by name.

    Times per ray, which some structures add, are left out.
    """
    names = sorted(rows.filter(regex=f"(?<!_ns){COUNTER_SUFFIX}$"))
    return [
        json.dumps(
            {name: value for name, value in row.items() if pd.notna(value)}, separators=(",", ":")
        )
        for row in rows[names].to_dict("records")
    ]


def keys_of(rows: pd.DataFrame) -> list[Key]:
    """Returns the key that identifies each row within its run."""
    whole = rows[list(IDENTITY)].astype(dict.fromkeys(("width", "height", "samples"), int))
    return list(zip(*(whole[name].tolist() for name in whole), strict=True))


def cell_titles(rows: pd.DataFrame) -> dict[Key, str]:
    """Returns the title of each row in reports, by its key."""
    named = (f"{row['contender']} in {row['view']} at {size_of(row)}" for _, row in rows.iterrows())
    return dict(zip(keys_of(rows), named, strict=True))


def views_of(rows: pd.DataFrame) -> list[tuple]:
    """Returns the view of each row; the rays of one view are the same."""
    return list(zip(*(rows[name].tolist() for name in VIEW), strict=True))


def comparable(rows: pd.DataFrame) -> list[tuple]:
    """Returns the view and the machine of each row; rows with comparable times share both."""
    return list(zip(views_of(rows), rows["machine_id"], strict=True))


def _ratios(run: Run, references: dict[tuple, int]) -> list[Ratio | None]:
    """Returns the ratio of each row to the reference of its view, paired by blocks if possible."""
    blocks = block_totals(run)
    rows = run.rows.to_dict("records")
    ratios: list[Ratio | None] = []
    for row, view, timed in zip(rows, views_of(run.rows), is_timed(run.rows), strict=True):
        if view not in references or not timed:
            ratios.append(None)
            continue
        base = rows[references[view]]
        paired = block_ratio(*(blocks.get(name_of(one), {}) for one in (row, base)))
        ratios.append(paired or unpaired_ratio(median_of(row, "total"), median_of(base, "total")))
    return ratios


def is_timed(rows: pd.DataFrame) -> pd.Series:
    """Returns whether each row has a time that can be compared."""
    return rows["timed"] & (rows["total_ms"] > 0)


def references_of(rows: pd.DataFrame) -> dict[tuple, int]:
    """Returns the reference row of each view: Embree's single rays, if possible.

    Embree is the only contender that our commits do not change.
    """
    known = rows.assign(
        place=range(len(rows)), is_other=~rows["parameters"].str.contains("mode=single")
    )
    known = known[(rows["structure"] == "embree") & is_timed(rows)]
    # Selected by identity, not by position: the order of rows varies from night to night.
    best = known.sort_values(["is_other", "parameters", "place"]).drop_duplicates(list(VIEW))
    return dict(zip(views_of(best), best["place"].tolist(), strict=True))


def _require_one_run(run: Run) -> None:
    path: Path = run.directory / "results.csv"
    for name in ("run_id", "machine_id"):
        values = run.rows[name].unique()
        if len(values) != 1 or not values[0]:
            raise Problem(
                f"{path}: {name} is {' and '.join(map(repr, values[:2])) or 'empty'}; "
                "a night is one run on one machine"
            )
    doubled = run.rows.duplicated(list(IDENTITY))
    if doubled.any():
        raise Problem(f"{path}, row {run.rows.index[doubled][0] + 2}: repeats an earlier cell")
