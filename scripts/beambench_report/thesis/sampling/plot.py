"""Error over time of the ways of sampling a scene."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from beambench_report.figure import Plot, new_figure
from beambench_report.style import Look
from beambench_report.thesis.sampling.read import UNIFORM, Comparison

_HEIGHT = 3.6  # inches
_OBJECT_SPACE = "object-space"
# All are the beams': object space, which only they can choose in, has their colour.
_LOOKS = {
    UNIFORM: Look("#777777", "o", "--"),
    _OBJECT_SPACE: Look("#d55e00", "s", "-"),
    "image-space": Look("#000000", "D", "-."),
}
_OTHER = Look("#0072b2", "^", ":")


def draw_comparison(comparison: Comparison, stem: str, title: str) -> Plot:
    """A line a method, a point a setting, both axes logarithmic."""
    figure, (panel,) = new_figure(_HEIGHT)
    for method in comparison.methods:
        look = _LOOKS.get(method, _OTHER)
        is_left = method == _OBJECT_SPACE  # lines run close to each other
        ways = [way for way in comparison.of(method) if way.error > 0]
        panel.plot(
            [way.milliseconds for way in ways],
            [way.error for way in ways],
            marker=look.marker,
            linestyle=look.dashes,
            color=look.colour,
            markersize=4.5,
            linewidth=1.3,
            label=method,
        )
        for way in (ways[0], ways[-1]) if len(ways) > 1 else ways:  # all of them would collide
            panel.annotate(
                way.setting.replace(" ", ", "),
                (way.milliseconds, way.error),
                xytext=(-5, -10) if is_left else (5, 4),
                ha="right" if is_left else "left",
                textcoords="offset points",
                fontsize=7,
                color=look.colour,
            )
    _mark_thesis(panel, comparison)
    panel.set(xscale="log", yscale="log")
    for axis in (panel.xaxis, panel.yaxis):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}"))
        axis.set_minor_formatter(NullFormatter())
    panel.margins(0.1)
    panel.set_xlabel("trace / ms")
    panel.set_ylabel("error / RMS of 255")
    panel.set_title(title)
    panel.grid(which="major", color="#dddddd", linewidth=0.6)
    panel.legend(frameon=False, fontsize=8)
    return Plot(stem, figure, f"{title}: error over time of ways to sample")


def _mark_thesis(panel: Axes, comparison: Comparison) -> None:
    way = comparison.thesis
    if way is None or way.error == 0:
        return
    panel.plot(
        [way.milliseconds],
        [way.error],
        "o",
        markersize=11,
        markerfacecolor="none",
        markeredgecolor="#333333",
        linestyle="none",
        label="the thesis's five samples",
    )
