"""Checks whether the prediction intervals of one run hold for another run of the sweep."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from beambench.analysis import Ratio
from beambench_report.base.analysis import Analysis, Standing, read_analysis
from beambench_report.base.cell_files import Identity, identity
from beambench_report.base.files import Problem
from beambench_report.base.records import Run, read_run

_Interval = tuple[float, float, float]
"""A value, and the ends of its prediction interval."""


@dataclass(frozen=True)
class Coverage:
    """The number of values of one run that lie within the prediction intervals of another."""

    what: str
    within: int
    count: int

    def __str__(self) -> str:
        """Formats a line of the table."""
        share = f"{100 * self.within / self.count:5.1f}%" if self.count else "    -"
        return f"{self.what:<52} {self.within:>5} of {self.count:>5}  {share}"


def write_coverage(first: Path, second: Path) -> str:
    """Returns the table for the runs in two folders, as text."""
    runs = [(read_run(folder), read_analysis(folder)) for folder in (first, second)]
    return describe(coverage(*runs), (runs[0][1], runs[1][1]))


def coverage(first: tuple[Run, Analysis], second: tuple[Run, Analysis]) -> list[Coverage]:
    """Compares times and ratios both ways. Raises Problem if nothing can be compared."""
    found = []
    for name, (one, other) in (
        ("of the second run within the first's intervals", (first, second)),
        ("of the first run within the second's intervals", (second, first)),
    ):
        for what, intervals in (("times", _times), ("ratios", _ratios)):
            found.append(_covered(f"{what} {name}", intervals(*one), intervals(*other)))
    if not any(one.count for one in found):
        raise Problem(
            f"{first[0].directory} and {second[0].directory} have no interval in common; give two "
            "runs of one sweep, with two blocks or more"
        )
    return found


def describe(found: list[Coverage], analyses: tuple[Analysis, Analysis]) -> str:
    """Returns the table, and what each run reports on its machine."""
    lines = [str(one) for one in found]
    for name, analysis in zip(("first", "second"), analyses, strict=True):
        reasons = "; ".join(analysis.reasons_for_care) or "no reason to distrust its times"
        lines.append(f"{name} run: {reasons}")
    return "\n".join(lines) + "\n"


def _covered(
    what: str, stated: Mapping[object, _Interval], values: Mapping[object, _Interval]
) -> Coverage:
    common = [key for key in stated if key in values]
    within = [key for key in common if stated[key][1] <= values[key][0] <= stated[key][2]]
    return Coverage(what, len(within), len(common))


def _times(run: Run, _: Analysis) -> dict[Identity, _Interval]:
    rows = run.rows
    if "trace_ms_pi_low" not in rows:
        return {}
    known = rows[rows["timed"] & rows["trace_ms_pi_low"].notna()]
    return {
        identity(row): (row["trace_ms"], row["trace_ms_pi_low"], row["trace_ms_pi_high"])
        for row in known.to_dict("records")
    }


def _ratios(_: Run, analysis: Analysis) -> dict[tuple[str, str], _Interval]:
    """Returns each contender's ratio to the fastest, if both runs have the same fastest one."""
    return {
        (f"{view.view} {view.size} {_first(view.ranked)}", one.contender): interval
        for view in analysis.views
        for one in view.ranked[1:]
        if (interval := _interval(one.ratio)) is not None
    }


def _first(ranked: tuple[Standing, ...]) -> str:
    return ranked[0].contender


def _interval(ratio: Ratio) -> _Interval | None:
    if ratio.predicted_low is None or ratio.predicted_high is None:
        return None
    return ratio.value, ratio.predicted_low, ratio.predicted_high
