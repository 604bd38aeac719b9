"""Object-space sampling, the thesis's future work: the output of `beambench sampling --json`."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from pathlib import Path
from statistics import median
from typing import Any

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from beambench_report.base.figure import Look, Plot, legend_below, new_figure
from beambench_report.base.files import Problem, load_json
from beambench_report.base.names import file_stems
from beambench_report.base.palette import INK, SOFT, structure_color
from beambench_report.base.quantities import DASH, number
from beambench_report.run.labels import place_labels
from beambench_thesis.paper.printed import milliseconds, title_of
from beambench_thesis.paper.section import (
    Section,
    SectionFigure,
    SectionTable,
    section_table,
    write_section,
)

UNIFORM = "uniform"
_OBJECT_SPACE = "object-space"


@dataclass(frozen=True)
class Point:
    """One point of a figure: a method and its setting."""

    method: str
    setting: str
    rays: float
    """Samples per pixel."""
    milliseconds: float
    error: float
    """The RMS error on a 0-255 scale, against 64 samples per pixel."""


@dataclass(frozen=True)
class Comparison:
    """The measurements of one scene."""

    path: Path
    scene: str
    structure: str
    resolution: str
    repetitions: int
    points: tuple[Point, ...]

    @property
    def title(self) -> str:
        """Returns scene and resolution, and the structure unless it is `beam`."""
        own = "" if self.structure == "beam" else f", {self.structure}"
        return f"{title_of(self.scene)}, {self.resolution}{own}"

    @property
    def methods(self) -> list[str]:
        """Returns the methods, each once, in the order of the file."""
        return list(dict.fromkeys(point.method for point in self.points))

    @property
    def thesis(self) -> Point | None:
        """Returns the thesis's setting, if it was tried.

        It has five samples in each pixel, except where a beam leaves the scene.
        """
        own = (UNIFORM, "5")
        return next((point for point in self.points if (point.method, point.setting) == own), None)

    def of(self, method: str) -> list[Point]:
        """Returns the settings of a method, the fastest first."""
        points = (point for point in self.points if point.method == method)
        return sorted(points, key=lambda point: point.milliseconds)

    def time_at_error(self, method: str, error: float) -> float | None:
        """Returns the milliseconds in which a method reaches an error; None outside the tested
        range.

        It is interpolated between two settings on logarithmic axes.
        """
        return _between([(point.error, point.milliseconds) for point in self.of(method)], error)

    def reached(self, method: str, error: float) -> tuple[float, bool] | None:
        """Returns the least time in which a method reaches at most this error, and whether it is
        exact.

        The time is exact if it is interpolated. If it is the time of a measured setting with a
        smaller error, it is an upper bound. None if every setting has a larger error.
        """
        crossing = self.time_at_error(method, error)
        settings = [point.milliseconds for point in self.of(method) if point.error <= error]
        if crossing is not None and (not settings or crossing <= min(settings)):
            return crossing, True
        return (min(settings), False) if settings else None

    def error_at_time(self, method: str, milliseconds: float) -> float | None:
        """Returns the error that a method reaches in a time; None outside the tested range."""
        return _between(
            [(point.milliseconds, point.error) for point in self.of(method)], milliseconds
        )


def read_comparison(path: Path) -> Comparison:
    """Reads a file. Raises Problem if it is not output of `beambench sampling --json`."""
    try:
        source = load_json(path)
        points = tuple(_point(entry) for entry in source["results"])
        if not points:
            raise ValueError("no results")
        names = (str(source[name]) for name in ("scene", "structure", "resolution"))
        return Comparison(path, *names, int(source["repetitions"]), points)
    except FileNotFoundError:
        raise Problem(
            f"{path}: there is no such file; write it with `beambench sampling SCENE --json`"
        ) from None
    except (ValueError, KeyError, TypeError, OSError) as error:
        raise Problem(
            f"{path}: is not what `beambench sampling SCENE --json` prints ({error})"
        ) from None


def read_comparisons(files: Iterable[Path]) -> tuple[list[Comparison], list[str]]:
    """Returns one comparison for each view, and a sentence for each file that cannot be shown."""
    found: dict[str, Comparison] = {}
    unread = []
    for path in files:
        try:
            comparison = read_comparison(path)
        except Problem as problem:
            unread.append(str(problem))
            continue
        first = found.setdefault(comparison.title, comparison)
        if first is not comparison:
            unread.append(f"{path} and {first.path} are both of {first.title}; give one of them")
    return list(found.values()), unread


def _point(entry: dict[str, Any]) -> Point:
    texts = (str(entry[name]) for name in ("method", "setting"))
    point = Point(*texts, *(float(entry[name]) for name in ("rays_per_pixel", "trace_ms", "error")))
    if not (point.milliseconds > 0 and math.isfinite(point.milliseconds) and point.error >= 0):
        raise ValueError(f"{point.method} {point.setting}: trace_ms and error must be positive")
    return point


def _between(points: Sequence[tuple[float, float]], at: float) -> float | None:
    """Returns the first crossing along a line with logarithmic axes."""
    logs = [(math.log(x), math.log(y)) for x, y in points if x > 0 and y > 0]
    wanted = math.log(at) if at > 0 else math.inf
    for (x0, y0), (x1, y1) in pairwise(logs):
        if min(x0, x1) <= wanted <= max(x0, x1):
            part = 0.0 if x0 == x1 else (wanted - x0) / (x1 - x0)
            return math.exp(y0 + part * (y1 - y0))
    return None


# The figure

_HEIGHT = 4.2  # inches
# All methods use beams. Object space, in which only beams can choose samples, has their color.
_LOOKS = {
    UNIFORM: Look(SOFT, "o", "--"),
    _OBJECT_SPACE: Look(structure_color("beam"), "s", "-"),
    "image-space": Look(INK, "D", "-."),
}
_OTHER = Look(structure_color("samet"), "^", ":")


def draw_comparison(comparison: Comparison, stem: str) -> Plot:
    """Draws a line for each method and a point for each setting; both axes are logarithmic."""
    figure, (panel,) = new_figure(_HEIGHT)
    lines = {
        method: [point for point in comparison.of(method) if point.error > 0]
        for method in comparison.methods
    }
    for method, points in lines.items():
        look = _LOOKS.get(method, _OTHER)
        panel.plot(
            [point.milliseconds for point in points],
            [point.error for point in points],
            marker=look.marker,
            linestyle=look.dashes,
            color=look.color,
            markersize=4.5,
            linewidth=1.3,
            label=method,
        )
    if (thesis := comparison.thesis) and thesis.error > 0:
        ring = {"markersize": 11, "markerfacecolor": "none", "markeredgecolor": INK}
        at = ([thesis.milliseconds], [thesis.error])
        panel.plot(*at, "o", linestyle="none", label="the thesis's five samples", **ring)
    panel.set(xscale="log", yscale="log")
    for axis in (panel.xaxis, panel.yaxis):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}"))
        axis.set_minor_formatter(NullFormatter())
    panel.margins(0.1)
    panel.set_xlabel("trace in ms (lower is better)")
    panel.set_ylabel("RMS error, 0-255 scale (lower is better)")
    panel.set_title(comparison.title)
    panel.grid(which="major", linewidth=0.6)
    legend_below(figure, len(lines) + 1)
    figure.get_layout_engine().execute(figure)
    figure.set_layout_engine("none")
    _name_settings(panel, lines, thesis)
    return Plot(stem, figure, f"{comparison.title}: error over time of sampling methods")


def _name_settings(panel: Axes, lines: Mapping[str, Sequence[Point]], ringed: Point | None) -> None:
    """Labels every point with its setting, clear of the lines; without room, only line ends.

    The ringed point is named in the legend.
    """
    corners = [[(point.milliseconds, point.error) for point in own] for own in lines.values()]
    for shown in (lines, {method: own[:: max(1, len(own) - 1)] for method, own in lines.items()}):
        points = [(method, point) for method, own in shown.items() for point in own]
        points = [(method, point) for method, point in points if point is not ringed]
        names = [point.setting.replace(" ", ", ") for _, point in points]
        placed = place_labels(
            panel,
            [(point.milliseconds, point.error) for _, point in points],
            names,
            names,
            corners,
            [_LOOKS.get(method, _OTHER).color for method, _ in points],
        )
        if placed is not None:
            return


# The section of the report, also written as separate files

_WORDS = (
    "The thesis takes five samples in every pixel of a beam that ends at an occupied leaf. It "
    "proposes, as future work, to choose this number by the leaf. Here, a pixel gets 1, 5 or 25 "
    "samples, by the number of primitives in the leaf over its width in pixels (object-space). "
    "This is compared with equal numbers in all such pixels (uniform), and with more samples in "
    "pixels that differ from their neighbors (image-space). An error is the RMS difference, on a "
    "0-255 scale, from the picture with 64 samples per pixel in preview shading; times include "
    "tracing and choosing. A setting of two numbers states the values from which a pixel gets 5 "
    "and 25 samples.",
)
_CAPTION = (
    "Every point is a setting, labeled with its values. Further left is faster, further down is "
    "better; a ring marks the thesis's setting."
)


def sampling_section(comparisons: Sequence[Comparison]) -> Section | None:
    """Returns the section, scene by scene; None if there are no comparisons."""
    if not comparisons:
        return None
    stems = file_stems(f"sampling {comparison.title}" for comparison in comparisons).values()
    figures = (
        SectionFigure(
            stem, f"{one.title}: error over time", _CAPTION, partial(draw_comparison, one, stem)
        )
        for one, stem in zip(comparisons, stems, strict=True)
    )
    return Section(
        "sampling",
        "Samples chosen in object space",
        _WORDS,
        (_against_thesis(comparisons), *map(_points, comparisons)),
        tuple(figures),
        tuple(_findings(comparisons)),
    )


def write_sampling(files: Iterable[Path], directory: Path) -> list[Path]:
    """Writes DIRECTORY/sampling.md and a plot for each file. Raises Problem for a bad file."""
    comparisons, unread = read_comparisons(files)
    if unread:
        raise Problem(unread[0])
    section = sampling_section(comparisons)
    if section is None:
        raise Problem("there is no file; write one with `beambench sampling SCENE --json`")
    directory.mkdir(parents=True, exist_ok=True)
    return write_section(section, directory / "sampling.md")


def _against_thesis(comparisons: Sequence[Comparison]) -> SectionTable:
    rows = []
    for one in comparisons:
        thesis = one.thesis
        if thesis is None:
            continue
        own = (_milliseconds(thesis.milliseconds), number(thesis.error), DASH, DASH, DASH)
        rows.append((one.title, "uniform, 5 samples (thesis)", *own))
        for method in one.methods:
            if method == UNIFORM:
                continue
            texts = (DASH, DASH)
            if reached := one.reached(method, thesis.error):
                time, is_same = reached
                texts = (_milliseconds(time), f"{time / thesis.milliseconds:.0%}")
                texts = texts if is_same else tuple(f"at most {text}" for text in texts)
            error = one.error_at_time(method, thesis.milliseconds)
            rows.append(("", method, DASH, DASH, *texts, DASH if error is None else number(error)))
    title = (
        f"Against the thesis's five samples ({DASH}: outside of the settings that were tried; at "
        "most: the fastest setting has a smaller error)"
    )
    heads = ("time", "error", "same error in", "of its time", "error in its time")
    return section_table(title, ("scene", "method"), heads, rows)


def _points(comparison: Comparison) -> SectionTable:
    rows = (
        (
            point.method,
            point.setting.replace(" ", ", "),
            f"{point.rays:.3f}",
            _milliseconds(point.milliseconds),
            f"{point.error:.3f}",
        )
        for point in comparison.points
    )
    title = f"{comparison.title} ({comparison.path.name}, {comparison.repetitions} repetitions)"
    heads = ("rays per pixel", "trace", "error")
    return section_table(title, ("method", "setting"), heads, rows, is_long=True)


def _findings(comparisons: Sequence[Comparison]) -> Iterable[str]:
    """Yields, for each other method, in how many scenes it reaches the thesis's error faster."""
    compared = [comparison for comparison in comparisons if comparison.thesis]
    for method in dict.fromkeys(name for one in compared for name in one.methods):
        if method == UNIFORM:
            continue
        tried = [one for one in compared if method in one.methods]
        found = [one.reached(method, one.thesis.error) for one in tried]
        shares = [
            reached[0] / one.thesis.milliseconds
            for one, reached in zip(tried, found, strict=True)
            if reached is not None
        ]
        if not shares:
            yield f"{method}: every setting that was tried has a larger error than five samples."
            continue
        faster = sum(share < 1 for share in shares)
        beyond = len(tried) - len(shares)
        at_most = "" if all(reached is None or reached[1] for reached in found) else "at most "
        larger = f"; in {beyond} of them, every setting has a larger error" if beyond else ""
        yield (
            f"{method} reaches the error of the thesis's five samples, or a smaller error, in less "
            f"time in {faster} of the {len(tried)} scenes that were tried; the median, of "
            f"{len(shares)}, is {at_most}{median(shares):.0%} of the thesis's time{larger}."
        )


def _milliseconds(value: float) -> str:
    return milliseconds(value / 1e3)
