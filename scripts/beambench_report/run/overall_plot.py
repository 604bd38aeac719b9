"""Plots all contenders over all views with one kind of rays, as multiples of the fastest."""

from collections import defaultdict

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator

from beambench.analysis import Ratio
from beambench_report.base.analysis import Mean, Overall, Standing
from beambench_report.base.figure import Look, Plot
from beambench_report.base.names import file_stems
from beambench_report.base.palette import INK, PAPER, SOFT
from beambench_report.base.quantities import number
from beambench_report.base.svg import hover
from beambench_report.run.measured import Measured, between
from beambench_report.run.panels import MOST_ROWS, finish, panels_with_legend

_MOST_DOTS = 150  # with a hover title each; beyond, one title for all dots of a row
_GAP = 1.1  # rows between contenders and references
_EXPLANATION = (
    "Small: each view at its highest resolution, the time of the first trace after a build over "
    "that of the view's fastest (build not included). Large: the geometric mean{lines}. "
    "References find nothing (null) or test everything (exhaustive): they do not compete."
)


def overalls(measured: Measured) -> list[Plot]:
    """Returns a figure for each kind of rays in which two contenders have times."""
    found = [one for one in measured.analysis.means if len(one.means) > 1]
    stems = file_stems(one.ray_kind for one in found)
    return [
        _overall(measured, one, "overall" if len(found) == 1 else f"overall-{stems[one.ray_kind]}")
        for one in found
    ]


def _overall(measured: Measured, one: Overall, stem: str) -> Plot:
    standings = [
        view for view in measured.analysis.views if view.in_means and view.ray_kind == one.ray_kind
    ]
    means = one.means[:MOST_ROWS]
    rows = [*enumerate(means)]
    rows += [(len(means) + _GAP + place, mean) for place, mean in enumerate(one.references)]
    last = rows[-1][0]
    figure, (panel,) = panels_with_legend(1, 1, 0.9 + 0.25 * (last + 1), {})
    by_contender: dict[str, list[tuple[str, Standing]]] = defaultdict(list)
    for view in standings:
        for standing in (*view.ranked, *view.references):
            by_contender[standing.contender].append((view.view, standing))
    is_titled = sum(len(by_contender[mean.contender]) for _, mean in rows) <= _MOST_DOTS
    for place, mean in rows:
        look = measured.looks[mean.contender]
        _draw_views(panel, place, by_contender[mean.contender], look, is_titled)
        _draw_mean(panel, place, mean, look)
        _write_values(panel, place, mean, one.views, is_best=place == 0)
    _label(panel, rows, one, last)
    drawn = {
        "thick line: 95% confidence interval of measurement": any(m.ratio.interval for m in means),
        "thin line: 95% confidence interval from the scatter between views": any(
            m.scatter_low is not None for m in means
        ),
    }
    lines = "; ".join(line for line, is_drawn in drawn.items() if is_drawn)
    views = f"{one.views} views" if one.views > 1 else standings[0].view
    summary = f"trace time over the fastest, {views}, {one.ray_kind} rays"
    return Plot(
        stem,
        finish(
            figure,
            f"Trace time as a multiple of the fastest: {views}, {one.ray_kind} rays",
            measured.run.rows[measured.run.rows["kind"] == one.ray_kind],
            _EXPLANATION.format(lines=f" ({lines})" if lines else ""),
        ),
        summary,
    )


def _draw_views(
    panel: Axes, place: float, own: list[tuple[str, Standing]], look: Look, is_titled: bool
) -> None:
    style = {"color": look.color, "markersize": 4, "alpha": 0.45, "markeredgewidth": 0}
    if is_titled:
        for view, one in own:
            (dot,) = panel.plot(one.ratio.value, place, "o", **style)
            text = f"{one.contender} in {view}: {_times(one.ratio)}"
            hover(dot, f"{text}; {number(one.ns_per_ray)} ns per ray")
        return
    values = [one.ratio.value for _, one in own]
    (dots,) = panel.plot(values, [place] * len(values), "o", **style)
    least, most = number(min(values)), number(max(values))
    hover(dots, f"{own[0][1].contender}: {least} to {most} times the fastest of a view")


def _draw_mean(panel: Axes, place: float, mean: Mean, look: Look) -> None:
    if mean.scatter_low is not None and mean.scatter_high is not None:
        ends = [mean.scatter_low, mean.scatter_high]
        panel.plot(ends, [place, place], "|-", color=look.color, linewidth=0.8, markersize=5)
    if mean.ratio.interval:
        low, high = mean.ratio.interval
        panel.plot([low, high], [place, place], color=look.color, linewidth=2.2)
    (point,) = panel.plot(
        mean.ratio.value,
        place,
        look.marker,
        color=look.color,
        markersize=8,
        markeredgecolor=PAPER,
        markeredgewidth=0.7,
        zorder=3,
    )
    over = f"geometric mean over {mean.views} views" if mean.views > 1 else "one view"
    hover(point, f"{mean.contender}: {_times(mean.ratio)}, {over}")


def _times(ratio: Ratio) -> str:
    interval = between(*ratio.interval) if ratio.interval else ""
    return f"{number(ratio.value)} times the fastest{interval}"


_VALUE, _INTERVAL, _WINS = 34, 92, 122  # points beside the panel: right ends, and a center


def _write_values(panel: Axes, place: float, mean: Mean, views: int, *, is_best: bool) -> None:
    style = {"va": "center", "fontsize": 8}
    weight = "bold" if is_best else "normal"
    _beside(panel, _VALUE, place, number(mean.ratio.value), ha="right", weight=weight, **style)
    if mean.ratio.interval and mean.ratio.low != mean.ratio.high:
        text = " to ".join(number(end) for end in mean.ratio.interval)
        _beside(panel, _INTERVAL, place, text, ha="right", color=SOFT, **style | {"fontsize": 7})
    if mean.wins:
        text = f"{mean.wins} of {views}"
        _beside(panel, _WINS, place, text, ha="center", weight=weight, **style)


def _beside(panel: Axes, right: float, place: float, text: str, **style: object) -> None:
    """Writes text in a column to the right of the panel."""
    panel.annotate(
        text,
        (1, place),
        (right, 0),
        xycoords=panel.get_yaxis_transform(),
        textcoords="offset points",
        annotation_clip=False,
        **style,
    )


def _label(panel: Axes, rows: list[tuple[float, Mean]], one: Overall, last: float) -> None:
    panel.set_xscale("log")
    panel.set_ylim(last + 0.6, -0.6)
    names = [
        mean.contender if mean.views == one.views else f"{mean.contender} ({mean.views} views)"
        for _, mean in rows
    ]
    panel.set_yticks([place for place, _ in rows], names, fontsize=8)
    for label, (place, _) in zip(panel.get_yticklabels(), rows, strict=True):
        label.set_weight("bold" if place == 0 else "normal")
    panel.tick_params(axis="y", length=0)
    panel.spines["left"].set_visible(False)
    low, high = panel.get_xlim()
    subs = (1, 2, 5) if high / low < 400 else (1,)
    panel.xaxis.set_major_locator(LogLocator(subs=subs, numticks=12))
    panel.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}"))
    panel.minorticks_off()
    panel.set_xlabel("times the fastest of each view (lower is better)")
    panel.axvline(1, color=INK, linewidth=0.8, zorder=0)
    panel.grid(axis="x", linewidth=0.6)
    panel.grid(axis="y", linewidth=0.4)
    head = {"va": "bottom", "fontsize": 7, "color": SOFT}
    _beside(panel, _VALUE, -0.7, "mean", ha="right", **head)
    if any(mean.ratio.interval for _, mean in rows):
        _beside(panel, _INTERVAL, -0.7, "95% confidence\ninterval", ha="right", **head)
    _beside(panel, _WINS, -0.7, "fastest\nor tied", ha="center", **head)
    if one.references:
        place = rows[len(rows) - len(one.references)][0] - 0.75
        panel.axhline(place - 0.2, color=SOFT, linewidth=0.5)
        panel.text(
            -0.01,
            place - 0.1,
            "references:",
            transform=panel.get_yaxis_transform(),
            **head | {"ha": "right", "va": "top"},
        )
