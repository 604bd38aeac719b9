"""Names beside points, so that none covers another one, or a point."""

from collections.abc import Sequence
from itertools import pairwise
from math import ceil, cos, pi, sin

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.font_manager import FontProperties
from matplotlib.transforms import Bbox

_SIZE = 6.5
_DISTANCES = (5, 7, 9)  # points; farther away it is not clear which point is meant
_DIRECTIONS = 12
_STEP = 2  # points, of the boxes along a slanting line


def place_labels(
    panel: Axes,
    points: Sequence[tuple[float, float]],
    names: Sequence[str],
    lines: Sequence[Sequence[tuple[float, float]]] = (),
    colors: Sequence[str] = (),
) -> bool:
    """Writes a name beside each point, off the lines if that is possible; False where they crowd.

    Then nothing is written. The figure's layout must be settled. A name has the color of its
    place in `colors`, where those are given.
    """
    renderer = FigureCanvasAgg(panel.figure).get_renderer()
    font = FontProperties(size=_SIZE)
    scale = panel.figure.dpi / 72
    centers = [tuple(panel.transData.transform(point)) for point in points]
    taken = [_around(x, y, 3 * scale) for x, y in centers]
    crossed = [
        box
        for line in lines
        for box in _along([tuple(panel.transData.transform(point)) for point in line], scale)
    ]
    placed: list[tuple[int, tuple[float, float]]] = []
    for index in sorted(range(len(points)), key=lambda i: -centers[i][1]):
        width, height, _ = renderer.get_text_width_height_descent(names[index], font, False)
        boxes = [
            (offset, _box(centers[index], offset, width, height, scale)) for offset in _offsets()
        ]
        free = [
            (offset, box)
            for offset, box in boxes
            if _is_inside(box, panel.bbox) and not any(box.overlaps(other) for other in taken)
        ]
        if not free:
            return False
        off_the_lines = (one for one in free if not any(one[1].overlaps(c) for c in crossed))
        offset, box = next(off_the_lines, free[0])
        taken.append(box)
        placed.append((index, offset))
    for index, offset in placed:
        _write(panel, points[index], names[index], offset, colors[index] if colors else None)
    return True


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


def _along(corners: Sequence[tuple[float, float]], scale: float) -> list[Bbox]:
    """Small boxes along a line; of its upright and level parts, one each."""
    boxes = []
    for (x0, y0), (x1, y1) in pairwise(corners):
        steps = max(1, ceil(min(abs(x1 - x0), abs(y1 - y0)) / (_STEP * scale)))
        xs, ys = (
            [a + (b - a) * k / steps for k in range(steps + 1)] for a, b in ((x0, x1), (y0, y1))
        )
        boxes += [
            Bbox([[min(a, b) - scale, min(c, d) - scale], [max(a, b) + scale, max(c, d) + scale]])
            for (a, b), (c, d) in zip(pairwise(xs), pairwise(ys), strict=True)
        ]
    return boxes


def _is_inside(box: Bbox, frame: Bbox) -> bool:
    return box.x0 >= frame.x0 and box.x1 <= frame.x1 and box.y0 >= frame.y0 and box.y1 <= frame.y1


def _write(
    panel: Axes,
    point: tuple[float, float],
    name: str,
    offset: tuple[float, float],
    color: str | None,
) -> None:
    across, upright = _alignment(offset)
    note = panel.annotate(
        name,
        point,
        offset,
        textcoords="offset points",
        ha=across,
        va=upright,
        fontsize=_SIZE,
        color=color,
    )
    note.set_in_layout(False)
