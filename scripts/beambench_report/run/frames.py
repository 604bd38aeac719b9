"""Draws moving scenes: the cost of each frame, and the cost of updates for the rays."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import ceil

import pandas as pd
from matplotlib.axes import Axes

from beambench_report.base.analysis import FrameSeries
from beambench_report.base.figure import Look, Plot, new_figure
from beambench_report.base.names import brief_name, file_stems
from beambench_report.base.palette import SOFT, structure_color
from beambench_report.base.quantities import number
from beambench_report.base.records import REFERENCES, size_of
from beambench_report.base.svg import hover
from beambench_report.run.labels import name_ends
from beambench_report.run.measured import Measured, between
from beambench_report.run.panels import chunks, finish, numbered, scale_axis, set_title

_UPDATE = " update="
_MOST_PANELS = 4
_HEIGHTS = (2.6, 1.5)  # inches, of the two rows of a scene
_ROOM = 0.95  # of the frames' extent, for the names at the right
_LABEL_SIZE = 6
_READING = (
    "Upper panels: time of build or update and of the first trace after it, mean over the blocks. "
    "Solid: updated from the first frame; dashed: built anew in each frame."
)
_READING_OF_RATIOS = (
    " Lower panels: trace time of the updated structure over that of a new one; bars: 95% "
    "confidence interval."
)


@dataclass(frozen=True)
class FrameLine:
    """A contender over the frames of a scene."""

    name: str
    """The contender without `update`."""
    structure: str
    contender: str
    is_updated: bool
    points: tuple[tuple[int, float], ...]
    """Frame numbers in ascending order, each with the milliseconds of the whole frame."""

    @property
    def label(self) -> str:
        """The text at the end of the line."""
        return f"{brief_name(self.name)}, updated" if self.is_updated else brief_name(self.name)


@dataclass(frozen=True)
class MovingView:
    """A scene that moves, with one kind of rays."""

    title: str
    ray_kind: str
    lines: tuple[FrameLine, ...]
    series: tuple[FrameSeries, ...]


def moving_views(measured: Measured) -> list[MovingView]:
    """Returns the views with times in two or more frames, in the order of the run."""
    if "frame" not in measured.run.rows:
        return []
    rows = measured.timed.dropna(subset=["frame"])
    rows = rows[~rows["structure"].isin(REFERENCES)]
    if rows.empty:
        return []
    scenes = rows.apply(lambda row: row["subject"].rpartition(f"@{row['frame']:.0f}")[0], axis=1)
    rows = rows.assign(moving=scenes, size=rows.apply(size_of, axis=1))
    found = []
    keys = ["moving", "camera", "size", "samples", "ray_kind"]
    for (scene, camera, size, samples, kind), own in rows.groupby(keys, sort=False):
        if own["frame"].nunique() > 1:
            subject = f"{scene}/{camera}/{size}/{samples:.0f}/{kind}"
            of_it = tuple(s for s in measured.analysis.frame_series if s.subject == subject)
            where = "" if camera == "default" else f", {camera}"
            found.append(MovingView(f"{scene}{where}, {size}", kind, tuple(_lines(own)), of_it))
    return found


def _lines(rows: pd.DataFrame) -> Iterable[FrameLine]:
    for contender, own in rows.groupby("contender", sort=False):
        start, update, end = str(contender).partition(_UPDATE)
        value, _, rest = end.partition(" ")
        name = f"{start} {rest}".strip() if update else start
        points = own.sort_values("frame")[["frame", "total_ms"]].itertuples(index=False)
        yield FrameLine(
            name,
            own["structure"].iloc[0],
            str(contender),
            value == "true",
            tuple((int(frame), float(ms)) for frame, ms in points),
        )


def frames(measured: Measured) -> list[Plot]:
    """Returns a figure, or several for many scenes, for each kind of rays."""
    views = moving_views(measured)
    kinds = file_stems(dict.fromkeys(view.ray_kind for view in views))
    plots = []
    for kind, stem in kinds.items():
        own = [view for view in views if view.ray_kind == kind]
        for index, part in enumerate(chunks(own, _MOST_PANELS)):
            plots.append(_plot(measured, kind, part, numbered(f"frames-{stem}", index)))
    return plots


def _plot(measured: Measured, kind: str, views: Sequence[MovingView], stem: str) -> Plot:
    columns = min(2, len(views))
    has_ratios = any(view.series for view in views)
    heights = _HEIGHTS if has_ratios else _HEIGHTS[:1]
    blocks = ceil(len(views) / columns)
    figure, panels = new_figure(
        blocks * sum(heights), blocks * len(heights), columns, heights * blocks
    )
    labels: list[tuple[Axes, list[tuple[float, float, str, str]]]] = []
    for place in range(blocks * columns):
        block, column = divmod(place, columns)
        first = block * len(heights) * columns + column
        own = panels[first : first + len(heights) * columns : columns]
        if place >= len(views):
            for panel in own:
                panel.set_axis_off()
            continue
        view = views[place]
        labels.append((own[0], _draw_times(own[0], view, measured.looks)))
        if len(own) > 1:
            labels.append((own[1], _draw_ratios(own[1], view)))
        own[-1].set_xlabel("frame")
        if column > 0:
            for panel in own:
                panel.set_ylabel("")
    shown = measured.run.rows[measured.run.rows["ray_kind"] == kind]
    heading = f"Update or build anew: time of each frame, {kind} rays"
    finish(figure, heading, shown, _READING + _READING_OF_RATIOS * has_ratios)
    for panel, ends in labels:
        name_ends(panel, ends, _LABEL_SIZE)
    scenes = ", ".join(view.title for view in views)
    return Plot(stem, figure, f"ms per frame, and the cost of updates for the rays: {scenes}")


def _draw_times(
    panel: Axes, view: MovingView, looks: dict[str, Look]
) -> list[tuple[float, float, str, str]]:
    """Draws the lines; returns their ends, with names and colors."""
    ends = []
    for line in view.lines:
        look = looks[line.contender]
        style = look.line | {"linestyle": "-" if line.is_updated else "--", "markersize": 3.5}
        (drawn,) = panel.plot(*zip(*line.points, strict=True), **style)
        values = "; ".join(f"frame {frame} {number(ms)} ms" for frame, ms in line.points)
        hover(drawn, f"{line.label}: {values}")
        ends.append((*line.points[-1], line.label, look.color))
    scale_axis(panel, "y", [ms for line in view.lines for _, ms in line.points])
    set_title(panel, view.title, 40)
    panel.set_ylabel("ms per frame\n(lower is better)")
    _finish_axes(panel, [frame for line in view.lines for frame, _ in line.points])
    return ends


def _draw_ratios(panel: Axes, view: MovingView) -> list[tuple[float, float, str, str]]:
    ends = []
    for series in view.series:
        structure = series.contender.partition(":")[0]
        color = structure_color(structure)
        points = [(one.frame, one.trace_ratio) for one in series.frames]
        for frame, ratio in points:
            if ratio.interval:
                panel.plot([frame] * 2, ratio.interval, color=color, linewidth=1.6, alpha=0.5)
        places = [(frame, ratio.value) for frame, ratio in points]
        (drawn,) = panel.plot(*zip(*places, strict=True), color=color, marker="o", markersize=3)
        words = [
            f"frame {frame} {number(ratio.value)}{between(*ratio.interval or ())}"
            if ratio.interval
            else f"frame {frame} {number(ratio.value)}"
            for frame, ratio in points
        ]
        hover(drawn, f"{series.contender}, trace time, updated over new: {'; '.join(words)}")
        ends.append((*places[-1], brief_name(series.contender.replace(":", " ")), color))
    panel.set_ylabel("trace, updated\nover new")
    places = [one.frame for series in view.series for one in series.frames]
    ratios = [one.trace_ratio.value for series in view.series for one in series.frames]
    panel.plot([min(places, default=0), max(places, default=1)], [1, 1], color=SOFT, linewidth=0.8)
    # The limits ignore the intervals, which are wide if there are few blocks.
    low, high = min(ratios, default=1), max(ratios, default=1)
    panel.set_ylim(
        min(low, 1) - 0.15 * (high - low) - 0.1, max(high, 1) + 0.15 * (high - low) + 0.1
    )
    _finish_axes(panel, places)
    return ends


def _finish_axes(panel: Axes, places: Sequence[int]) -> None:
    panel.grid(axis="y", linewidth=0.6)
    if not places:
        return
    first, last = min(places), max(places)
    panel.set_xlim(first - 0.04 * (last - first), last + _ROOM * (last - first))
    panel.set_xticks(sorted(set(places)))
    panel.spines["bottom"].set_bounds(first, last)
