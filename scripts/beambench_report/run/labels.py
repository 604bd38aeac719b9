"""Names or numbers beside points, so that none covers another one, or a point."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import cos, hypot, inf, pi, sin

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.font_manager import FontProperties
from matplotlib.transforms import Bbox

_SIZE = 6.5
_DISTANCES = (5, 7, 9)  # points; farther away it is not clear which point is meant
_DIRECTIONS = 12
_NEARER = 5  # points, by which a name is nearer to its point than to others, or it may seem theirs


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
    line: Sequence[tuple[float, float]] = (),
) -> set[int] | None:
    """Writes beside each point its name, or where there is no room its number; none on another.

    Returns the points that have numbers; None where even these crowd, and then nothing is written.
    Labels are off the line if that is possible. The figure's layout must be settled.
    """
    room = _Room(panel, points, line)
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
        _write(panel, points[index], place.text, place.offset)
    return numbered


class _Room:
    """The room for labels of a panel's points."""

    def __init__(
        self,
        panel: Axes,
        points: Sequence[tuple[float, float]],
        line: Sequence[tuple[float, float]],
    ) -> None:
        self._scale = panel.figure.dpi / 72
        self._frame = panel.bbox
        self._renderer = FigureCanvasAgg(panel.figure).get_renderer()
        self._font = FontProperties(size=_SIZE)
        self.centers = [tuple(panel.transData.transform(point)) for point in points]
        self._points = [_around(x, y, 3 * self._scale) for x, y in self.centers]
        corners = [tuple(panel.transData.transform(point)) for point in line]
        self._crossed = _along(corners, self._scale)

    def places(self, index: int, text: str, others: Mapping[int, _Place]) -> Iterator[_Place]:
        """Where the text has room beside its point, the other points and the labels that are."""
        taken = [*self._points, *(other.box for other in others.values())]
        width, height, _ = self._renderer.get_text_width_height_descent(text, self._font, False)
        for offset in _offsets():
            box = _box(self.centers[index], offset, width, height, self._scale)
            if _is_inside(box, self._frame) and not any(box.overlaps(other) for other in taken):
                yield _Place(text, offset, box)

    def is_clear(self, place: _Place, index: int) -> bool:
        """Does it seem to be the label of no other point?"""
        away = [_distance(center, place.box) for center in self.centers]
        own = away.pop(index) + _NEARER * self._scale
        return min(away, default=inf) >= own

    def best(self, places: Sequence[_Place]) -> _Place:
        """The first of the places that is off the line; the first, where none is."""
        off = (one for one in places if not any(map(one.box.overlaps, self._crossed)))
        return next(off, places[0])


def _offsets() -> list[tuple[float, float]]:
    """To the right first, then around."""
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
    return Bbox([[left - 1, low - 1], [left + width + 1, low + height + 1]])


def _around(x: float, y: float, reach: float) -> Bbox:
    return Bbox([[x - reach, y - reach], [x + reach, y + reach]])


def _distance(point: tuple[float, float], box: Bbox) -> float:
    (x, y), (left, low, right, high) = point, box.extents
    return hypot(max(left - x, 0, x - right), max(low - y, 0, y - high))


def _along(corners: Sequence[tuple[float, float]], scale: float) -> list[Bbox]:
    """The upright and level parts of a line as boxes."""
    return [
        Bbox(
            [
                [min(a[0], b[0]) - scale, min(a[1], b[1]) - scale],
                [max(a[0], b[0]) + scale, max(a[1], b[1]) + scale],
            ]
        )
        for a, b in pairwise(corners)
    ]


def _is_inside(box: Bbox, frame: Bbox) -> bool:
    return box.x0 >= frame.x0 and box.x1 <= frame.x1 and box.y0 >= frame.y0 and box.y1 <= frame.y1


def _write(panel: Axes, point: tuple[float, float], name: str, offset: tuple[float, float]) -> None:
    across, upright = _alignment(offset)
    note = panel.annotate(
        name,
        point,
        offset,
        textcoords="offset points",
        ha=across,
        va=upright,
        fontsize=_SIZE,
    )
    note.set_in_layout(False)
