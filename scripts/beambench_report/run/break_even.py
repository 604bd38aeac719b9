"""The break-even ray count: from it on, the structure that takes longer to build is ahead in total.

With build times b and trace times per ray t, structure A catches up with B after
(b_A - b_B) / (t_B - t_A) rays.
"""

import itertools

import pandas as pd
from matplotlib.ticker import EngFormatter

from beambench_report.base.records import OK, Run

AT_ONCE = "at once"
NEVER = "never"


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
    return rays, f"{'from' if saved > 0 else 'up to'} {rays_in_words(rays)}"


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


def rays_in_words(rays: float) -> str:
    """A number of rays: 250, 10.0 k, 3.2 M."""
    return EngFormatter(places=None if rays < 1000 else 1, sep=" ")(round(rays))
