"""Plots what a fast trace costs: build time and memory against trace time."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beambench_report.base.figure import Look, Plot
from beambench_report.base.names import file_stems
from beambench_report.base.palette import PAPER, SOFT
from beambench_report.base.quantities import number, size_in_words
from beambench_report.base.records import size_of
from beambench_report.base.svg import hover
from beambench_report.run.fronts import pareto_front
from beambench_report.run.labels import place_labels
from beambench_report.run.measured import Measured, ns_in_words
from beambench_report.run.panels import MOST_LINES, finish, panels_with_legend, scale_axis

_MIB = 2.0**20
_ANY_NUMBER = "00"  # as wide as the numbers that are not known yet
_COSTS = {"build_ms_median": "build time in ms", "memory_mib": "memory in MiB"}
_EXPLANATION = (
    "Lower and further left is better. The stairs join the Pareto front: no other contender is "
    "both cheaper and faster. Bars: 95% confidence interval of the first trace after a build. Axes "
    "are logarithmic where values differ by a factor of more than 20. null and exhaustive, which "
    "build nothing, are left out."
)


def trade_offs(measured: Measured) -> list[Plot]:
    """Returns a figure for each view in which two contenders have times."""
    plots = []
    for view, stem in file_stems(measured.run.views).items():
        rows = measured.finest(view)
        rows = rows[~rows["is_reference"]].head(MOST_LINES)
        rows = rows.assign(memory_mib=rows["memory_bytes"] / _MIB)
        costs = [cost for cost in _COSTS if rows[cost].notna().sum() > 1]
        if costs:
            plots.append(_trade_off(measured, view, f"trade-offs-{stem}", rows, costs))
    return plots


def _trade_off(
    measured: Measured, view: str, stem: str, rows: pd.DataFrame, costs: list[str]
) -> Plot:
    contenders = list(rows["contender"])
    # A legend shifts the panels slightly, so other contenders may need numbers the second time.
    figure, numbered = _figure(measured, view, rows, costs, [])
    if numbered:
        figure, others = _figure(measured, view, rows, costs, numbered)
        if not set(others) <= set(numbered):
            figure, _ = _figure(measured, view, rows, costs, contenders)
    return Plot(stem, figure, f"{view}: build time and memory against trace time", view)


def _figure(
    measured: Measured, view: str, rows: pd.DataFrame, costs: list[str], numbered: list[str]
) -> tuple[Figure, list[str]]:
    """Returns the figure with a legend of `numbered`, and the contenders without a written name."""
    numbers = {contender: str(place) for place, contender in enumerate(numbered, 1)}
    legend = {f"{number}  {name}": measured.looks[name] for name, number in numbers.items()}
    figure, panels = panels_with_legend(len(costs), len(costs), 3.5, legend, with_lines=False)
    drawn = [
        _draw(panel, rows.dropna(subset=[cost]), cost, measured.looks)
        for panel, cost in zip(panels, costs, strict=True)
    ]
    heading = f"{view}, {size_of(rows.iloc[0])}: what a fast trace costs"
    finish(figure, heading, measured.run.view(view), _EXPLANATION)
    unnamed: set[str] = set()
    for panel, (shown, line) in zip(panels, drawn, strict=True):
        own = list(shown["contender"])
        found = place_labels(
            panel,
            list(zip(shown["ns"], shown["cost"], strict=True)),
            own,
            [numbers.get(contender, _ANY_NUMBER) for contender in own],
            [line],
            [measured.looks[contender].color for contender in own],
        )
        unnamed |= set(own) if found is None else {own[index] for index in found}
    return figure, [contender for contender in rows["contender"] if contender in unnamed]


def _draw(
    panel: Axes, rows: pd.DataFrame, cost: str, looks: dict[str, Look]
) -> tuple[pd.DataFrame, list[tuple[float, float]]]:
    """Draws a panel; returns the rows with the drawn `cost`, and the corners of the stairs."""
    scale_axis(panel, "x", rows["ns"])
    is_log = scale_axis(panel, "y", rows[cost])
    least = rows.loc[rows[cost] > 0, cost].min()
    # A logarithmic axis has no zero: a cost of zero is drawn at the lower end.
    rows = rows.assign(cost=rows[cost].clip(lower=least / 3) if is_log else rows[cost])
    panel.margins(0.14)
    for _, row in rows.iterrows():
        look = looks[row["contender"]]
        panel.plot([row["ns_low"], row["ns_high"]], [row["cost"]] * 2, color=look.color, lw=1.4)
        (point,) = panel.plot(
            row["ns"],
            row["cost"],
            look.marker,
            color=look.color,
            markersize=6,
            markeredgecolor=PAPER,
            markeredgewidth=0.6,
        )
        build, memory = row["build_ms_median"], row["memory_bytes"]
        costs = [] if pd.isna(build) else [f"build {number(build)} ms"]
        costs += [] if pd.isna(memory) else [f"memory {size_in_words(memory)}"]
        hover(point, f"{row['contender']}: {'; '.join([ns_in_words(row), *costs])}")
    line = _stairs(panel, list(zip(rows["ns"], rows["cost"], strict=True)))
    panel.plot(*zip(*line, strict=True), color=SOFT, linewidth=0.9, alpha=0.6, zorder=1)
    panel.set_xlabel("trace in ns per ray (lower is better)")
    panel.set_ylabel(f"{_COSTS[cost]} (lower is better)")
    panel.grid(linewidth=0.6)
    return rows, line


def _stairs(panel: Axes, points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Returns the stairs from the top of the panel along the front to its right end."""
    panel.autoscale_view()
    for axis in ("x", "y"):
        low, high = getattr(panel, f"get_{axis}lim")()
        is_linear = getattr(panel, f"get_{axis}scale")() == "linear"
        panel.set(**{f"{axis}lim": (0 if low < high / 3 and is_linear else low, high)})
    right, top = panel.get_xlim()[1], panel.get_ylim()[1]
    front = [points[index] for index in pareto_front(points)]
    corners = [(front[0][0], top)]
    for x, y in front:
        corners += [(x, corners[-1][1]), (x, y)]
    return [*corners, (right, corners[-1][1])]
