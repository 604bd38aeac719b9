"""The break-even ray count: from it on, the structure that takes longer to build is ahead in total.

With build times b and trace times per ray t, structure A catches up with B after
(b_A - b_B) / (t_B - t_A) rays.
"""

import itertools

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle
from matplotlib.ticker import EngFormatter

from beambench_report.base.figure import Plot
from beambench_report.base.records import OK, Run
from beambench_report.run.bars import in_two_lines, panel_per_view

AT_ONCE = "at once"
NEVER = "never"
_FILLS = {AT_ONCE: "#bfe6d9", "from": "#d5edfb", "up to": "#fbf7cf", NEVER: "#eeeeee"}


def break_even_rays(
    build: float, trace_per_ray: float, baseline_build: float, baseline_trace_per_ray: float
) -> tuple[float | None, str]:
    """The number of rays, if there is one, and the same in words."""
    dearer = build - baseline_build
    saved = baseline_trace_per_ray - trace_per_ray
    if dearer <= 0 and saved >= 0:
        return None, AT_ONCE
    if saved <= 0 <= dearer:
        return None, NEVER
    rays = dearer / saved
    # Cheaper to build but slower per ray: ahead until then, not from then on.
    return rays, f"{'from' if saved > 0 else 'up to'} {_short(rays)}"


def break_even_table(run: Run) -> pd.DataFrame:
    """Every ordered pair of contenders of every view."""
    records = []
    for title in run.views:
        rows = _timed(run.view(title))
        for one, other in itertools.permutations(rows["contender"].unique(), 2):
            both = _at_largest_common_image(rows, one, other)
            if both is None:
                continue
            mine, theirs = both
            rays, words = break_even_rays(
                mine["build_ms_median"], mine["trace_ms_median"] / mine["rays"],
                theirs["build_ms_median"], theirs["trace_ms_median"] / theirs["rays"],
            )  # fmt: skip
            image = f"{mine['width']:.0f}x{mine['height']:.0f}"
            records.append((title, one, other, image, rays, words))
    return pd.DataFrame(
        records,
        columns=["view", "contender", "baseline", "resolution", "break_even_rays", "in_words"],
    )


def break_even(run: Run) -> list[Plot]:
    """One figure, one panel per view: a table of each contender against each other."""
    table = break_even_table(run)

    def select(title: str) -> pd.DataFrame:
        rows = _timed(run.view(title)).drop_duplicates("contender")
        return rows if len(rows) > 1 else rows.iloc[:0]

    def draw(panel: Axes, rows: pd.DataFrame) -> None:
        pairs = table[table["view"] == rows["view"].iloc[0]]
        place = {contender: index for index, contender in enumerate(rows["contender"])}
        for pair in pairs.itertuples():
            _draw_cell(panel, place[pair.baseline], place[pair.contender], pair.in_words)
        numbers = range(1, len(place) + 1)
        labels = [
            f"{in_two_lines(name)}  {number}" for name, number in zip(place, numbers, strict=True)
        ]
        panel.set_yticks(range(len(place)), labels)
        panel.set_xticks(range(len(place)), [f"against {number}" for number in numbers])
        panel.set_xlim(-0.5, len(place) - 0.5)
        panel.set_ylim(len(place) - 0.5, -0.5)
        panel.tick_params(length=0, labelsize=7.5)
        panel.tick_params(axis="x", labeltop=True, labelbottom=False)
        panel.spines[:].set_visible(False)

    return panel_per_view(
        run,
        stem="break-even",
        select=select,
        draw=draw,
        explanation="From how many rays on the contender of a row, build included, is ahead of "
        "the one with the column's number: (difference of build times) / (difference of trace "
        "times per ray), by the medians of the largest image that both traced. 'up to': it is "
        "ahead until then. The same in digits, with the images: break-even.csv.",
        summary="break-even ray count",
        times=True,
    )


def _draw_cell(panel: Axes, column: int, row: int, words: str) -> None:
    kind = next(kind for kind in _FILLS if words.startswith(kind))
    panel.add_patch(Rectangle((column - 0.47, row - 0.42), 0.94, 0.84, color=_FILLS[kind]))
    panel.annotate(words, (column, row), ha="center", va="center", fontsize=7)


def _timed(rows: pd.DataFrame) -> pd.DataFrame:
    """The rows with times; `null`, which finds nothing, is no contender."""
    rows = rows[rows["timed"] & (rows["verdict"] == OK)]
    rows = rows.dropna(subset=["build_ms_median", "trace_ms_median"])
    return rows.drop_duplicates(["contender", "rays"])


def _at_largest_common_image(
    rows: pd.DataFrame, one: str, other: str
) -> tuple[pd.Series, pd.Series] | None:
    """The rows of both; None where they traced no image in common."""
    mine = rows[rows["contender"] == one].set_index("rays", drop=False)
    theirs = rows[rows["contender"] == other].set_index("rays", drop=False)
    common = mine.index.intersection(theirs.index)
    if common.empty:
        return None
    return mine.loc[common.max()], theirs.loc[common.max()]


def _short(rays: float) -> str:
    return EngFormatter(places=None if rays < 1000 else 1, sep=" ")(round(rays))
