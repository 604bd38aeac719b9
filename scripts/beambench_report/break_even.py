"""The number of rays from which a structure that is dearer to build has paid for itself.

With build times b and trace times a ray t, structure A catches up with B after
(b_A - b_B) / (t_B - t_A) rays.
"""

from __future__ import annotations

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import EngFormatter

from beambench_report.bars import in_two_lines
from beambench_report.figure import Plot
from beambench_report.panels import panel_per_view
from beambench_report.records import Run
from beambench_report.style import looks

AT_ONCE = "from the first ray"
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
    # Cheaper to build but slower a ray: ahead until then, not from then on.
    return rays, f"{rays:,.0f} rays" if saved > 0 else f"ahead up to {rays:,.0f} rays"


def break_even_table(run: Run) -> pd.DataFrame:
    """Every pair of contenders of every view, at the view's highest resolution."""
    records = []
    for title in run.views:
        rows = _contenders(run.finest(title))
        for one in rows.itertuples():
            for other in rows.itertuples():
                if one.contender == other.contender:
                    continue
                rays, words = break_even_rays(
                    one.build_ms_median, one.trace_ms_per_ray,
                    other.build_ms_median, other.trace_ms_per_ray,
                )  # fmt: skip
                records.append((title, one.contender, other.contender, rays, words))
    return pd.DataFrame(
        records, columns=["view", "contender", "baseline", "break_even_rays", "in_words"]
    )


def break_even(run: Run) -> list[Plot]:
    """One figure, a panel a view, against the contender that is built the quickest."""
    table = break_even_table(run)
    all_looks = looks(run.rows)

    def select(title: str) -> pd.DataFrame:
        rows = _contenders(run.finest(title))
        if len(rows) < 2:
            return rows.iloc[:0]
        baseline = rows.loc[rows["build_ms_median"].idxmin(), "contender"]
        pairs = table[(table["view"] == title) & (table["baseline"] == baseline)]
        return pairs.merge(rows[["contender", "width", "height", "rays"]], on="contender")

    def draw(panel: Axes, pairs: pd.DataFrame) -> None:
        baseline = pairs["baseline"].iloc[0]
        image = pairs["rays"].iloc[0]
        panel.axvline(image, color="#999999", linewidth=0.8, linestyle=":")
        for place, pair in enumerate(pairs.itertuples()):
            known = pd.notna(pair.break_even_rays)
            at = pair.break_even_rays if known else image
            if known:
                look = all_looks[pair.contender]
                panel.plot(at, place, marker=look.marker, color=look.colour, markersize=7)
            panel.annotate(
                pair.in_words, (at, place), xytext=(7, 0), textcoords="offset points",
                va="center", fontsize=7.5,
            )  # fmt: skip
        panel.set_xscale("log")
        panel.set_xlim(*_limits([*pairs["break_even_rays"].dropna(), image]))
        panel.xaxis.set_major_formatter(EngFormatter(sep=" "))
        panel.set_yticks(range(len(pairs)), [in_two_lines(name) for name in pairs["contender"]])
        panel.set_ylim(len(pairs) - 0.4, -0.6)
        panel.tick_params(axis="y", length=0)
        panel.set_xlabel(f"rays until the dearer build is paid, against {baseline}")
        panel.grid(axis="x", color="#dddddd", linewidth=0.6)

    return panel_per_view(
        run,
        stem="break-even",
        select=select,
        draw=draw,
        explanation="(difference of build times) / (difference of trace times a ray), against the "
        "contender that is built the quickest; dotted: one image at the highest resolution, whose "
        "trace times are used. Every other pair is in break-even.csv.",
        summary="number of rays from which a dearer build pays",
        times=True,
    )


def _contenders(rows: pd.DataFrame) -> pd.DataFrame:
    """The rows that can be compared; `null`, which finds nothing, is no contender."""
    rows = rows[rows["timed"] & (rows["verdict"] == "ok")]
    rows = rows.dropna(subset=["build_ms_median", "trace_ms_median"])
    return rows.assign(trace_ms_per_ray=rows["trace_ms_median"] / rows["rays"])


def _limits(values: list[float]) -> tuple[float, float]:
    """A decade of room for the text on the right."""
    positive = [value for value in values if value > 0]
    return min(positive) / 3, max(positive) * 30
