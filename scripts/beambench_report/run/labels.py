"""Writes names or numbers beside points, so that they cover neither each other nor a point."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise
from math import ceil, cos, hypot, inf, pi, sin

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.font_manager import FontProperties
from matplotlib.transforms import Bbox

_SIZE = 6.5
_DISTANCES = (5, 7, 9)  # points; farther away it is not clear which point is meant
_DIRECTIONS = 12
_STEP = 2  # points, of the boxes along a slanting line
_NEARER = 5  # points; a name must be nearer to its point than to others by this much


@dataclass
class _Place:
    """Where a point's label is: the offset in points, and the box in pixels."""

    text: str
    offset: tuple[float, float]
    box: Bbox


def place_labels(
    panel: Axes,
    points: Sequence[tuple[float, float]],
    names: Sequence[str],
    numbers: Sequence[str],
    lines: Sequence[Sequence[tuple[float, float]]] = (),
    colors: Sequence[str] = (),
    taken: Sequence[Bbox] = (),
) -> set[int] | None:
    """Writes beside each point its name, or its number if the name does not fit.

    Labels do not overlap. Returns the points that have numbers; if even numbers do not fit, writes
    nothing and returns None. Labels avoid the lines if possible, and have the color at
    their position in `colors`, if given. The boxes `taken`, in pixels, stay free. The layout must
    be settled.
    """
    room = _Room(panel, points, lines, taken)
    places: dict[int, _Place] = {}
    for index in sorted(range(len(points)), key=lambda i: -room.centers[i][1]):
        found = [*room.places(index, numbers[index], places)]
        if not found:
            return None
        places[index] = room.best(found)
    numbered = set(range(len(points)))
    for index in range(len(points)):
        others = {other: place for other, place in places.items() if other != index}
        found = room.places(index, names[index], others)
        if clear := [one for one in found if room.is_clear(one, index)]:
            places[index] = room.best(clear)
            numbered.remove(index)
    for index, place in places.items():
        across, upright = _alignment(place.offset)
        panel.annotate(
            place.text,
            points[index],
            place.offset,
            textcoords="offset points",
            ha=across,
            va=upright,
            fontsize=_SIZE,
            color=colors[index] if colors else None,
        ).set_in_layout(False)
    return numbered


class _Room:
    """The space for labels of a panel's points."""

    def __init__(
        self,
        panel: Axes,
        points: Sequence[tuple[float, float]],
        lines: Sequence[Sequence[tuple[float, float]]],
        taken: Sequence[Bbox],
    ) -> None:
        self._scale = panel.figure.dpi / 72
        self._frame = panel.bbox
        self._renderer = FigureCanvasAgg(panel.figure).get_renderer()
        self._font = FontProperties(size=_SIZE)
        self.centers = [tuple(panel.transData.transform(point)) for point in points]
        reach = 3 * self._scale
        self._points = [Bbox.from_extents(x, y, x, y).padded(reach) for x, y in self.centers]
        self._taken = taken
        self._crossed = [
            box
            for line in lines
            for box in _along([tuple(panel.transData.transform(at)) for at in line], self._scale)
        ]

    def places(self, index: int, text: str, others: Mapping[int, _Place]) -> Iterator[_Place]:
        """Yields places where the text is clear of its point, other points and labels."""
        taken = [*self._points, *self._taken, *(other.box for other in others.values())]
        width, height, _ = self._renderer.get_text_width_height_descent(text, self._font, False)
        for offset in _offsets():
            box = _box(self.centers[index], offset, width, height, self._scale)
            if _is_inside(box, self._frame) and not any(box.overlaps(other) for other in taken):
                yield _Place(text, offset, box)

    def is_clear(self, place: _Place, index: int) -> bool:
        """Returns whether the label is clearly nearest to this point."""
        away = [_distance(center, place.box) for center in self.centers]
        own = away.pop(index) + _NEARER * self._scale
        return min(away, default=inf) >= own

    def best(self, places: Sequence[_Place]) -> _Place:
        """Returns the first place that is off the lines; if there is none, the first place."""
        off = (one for one in places if not any(map(one.box.overlaps, self._crossed)))
        return next(off, places[0])


def _offsets() -> list[tuple[float, float]]:
    """Returns offsets in all directions, beginning with the right."""
    turns = sorted(range(_DIRECTIONS), key=lambda k: min(k, _DIRECTIONS - k))
    return [
        (distance * cos(2 * pi * k / _DIRECTIONS), distance * sin(2 * pi * k / _DIRECTIONS))
        for distance in _DISTANCES
        for k in turns
    ]


def _alignment(offset: tuple[float, float]) -> tuple[str, str]:
    across = "left" if offset[0] > 1 else "right" if offset[0] < -1 else "center"
    upright = "center" if abs(offset[0]) > abs(offset[1]) else "bottom" if offset[1] > 0 else "top"
    return across, upright


def _box(
    center: tuple[float, float],
    offset: tuple[float, float],
    width: float,
    height: float,
    scale: float,
) -> Bbox:
    across, upright = _alignment(offset)
    x, y = center[0] + scale * offset[0], center[1] + scale * offset[1]
    left = x - width * {"left": 0, "center": 0.5, "right": 1}[across]
    low = y - height * {"bottom": 0, "center": 0.5, "top": 1}[upright]
    return Bbox.from_bounds(left, low, width, height).padded(1)


def _distance(point: tuple[float, float], box: Bbox) -> float:
    (x, y), (left, low, right, high) = point, box.extents
    return hypot(max(left - x, 0, x - right), max(low - y, 0, y - high))


def _along(corners: Sequence[tuple[float, float]], scale: float) -> list[Bbox]:
    """Returns small boxes along a line; one each for its vertical and horizontal parts."""
    boxes = []
    for (x0, y0), (x1, y1) in pairwise(corners):
        steps = max(1, ceil(min(abs(x1 - x0), abs(y1 - y0)) / (_STEP * scale)))
        xs, ys = (
            [a + (b - a) * k / steps for k in range(steps + 1)] for a, b in ((x0, x1), (y0, y1))
        )
        boxes += [
            Bbox.from_extents(min(a, b), min(c, d), max(a, b), max(c, d)).padded(scale)
            for (a, b), (c, d) in zip(pairwise(xs), pairwise(ys), strict=True)
        ]
    return boxes


def _is_inside(box: Bbox, frame: Bbox) -> bool:
    return box.x0 >= frame.x0 and box.x1 <= frame.x1 and box.y0 >= frame.y0 and box.y1 <= frame.y1


def spread(places: Sequence[float], low: float, high: float, step: float) -> list[float]:
    """Moves ascending places at least `step` apart between low and high; closer if necessary."""
    step = min(step, (high - low) / max(1, len(places) - 1))
    upward = list(accumulate(places, lambda before, place: max(place, before + step)))
    downward = list(accumulate(reversed(places), lambda after, place: min(place, after - step)))
    middle = [(a + b) / 2 for a, b in zip(upward, reversed(downward), strict=True)]
    last = len(middle) - 1
    return [
        min(max(place, low + index * step), high - (last - index) * step)
        for index, place in enumerate(middle)
    ]


End = tuple[float, float, str, str]
"""The last point of a line, its name and its color."""

_LINE_OF_NAME = 1.2  # of the size
_CHARACTER = 0.58  # of the size; the mean width of a character
_GAP = 11  # points, between a line and its name


def share_for_names(names: Iterable[str], width: float) -> float:
    """Returns the share of a panel, `width` inches wide, that names at its right end take."""
    longest = max(map(len, names), default=0)
    return min(0.6, (_GAP + _CHARACTER * _SIZE * longest) / (72 * width))


def name_ends(panel: Axes, ends: Sequence[End], size: float = _SIZE) -> None:
    """Writes the names to the right of the lines' ends, without overlaps.

    The layout must be settled.
    """
    scale = 72 / panel.figure.dpi
    ordered = sorted(ends, key=lambda end: end[1])
    at = [float(panel.transData.transform(end[:2])[1]) * scale for end in ordered]
    low, high = (float(edge) * scale for edge in (panel.bbox.y0, panel.bbox.y1))
    for (x, y, name, color), own, place in zip(
        ordered, at, spread(at, low, high, _LINE_OF_NAME * size), strict=True
    ):
        panel.annotate(
            name,
            (x, y),
            (_GAP, place - own),
            textcoords="offset points",
            va="center",
            fontsize=size,
            color=color,
            arrowprops={
                **{"arrowstyle": "-", "color": color, "linewidth": 0.5, "alpha": 0.6},
                **{"shrinkA": 0, "shrinkB": 3, "relpos": (0, 0.5)},
            },
        ).set_in_layout(False)
