"""Names beside points, so that none covers another one, or a point."""

from collections.abc import Sequence
from itertools import pairwise
from math import cos, pi, sin

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.font_manager import FontProperties
from matplotlib.transforms import Bbox

_SIZE = 6.5
_DISTANCES = (5, 7, 9)  # points; farther away it is not clear which point is meant
_DIRECTIONS = 12


def place_labels(
    panel: Axes,
    points: Sequence[tuple[float, float]],
    names: Sequence[str],
    line: Sequence[tuple[float, float]] = (),
) -> bool:
    """Writes a name beside each point, off the line if that is possible; False where they crowd.

    Then nothing is written. The figure's layout must be settled.
    """
    renderer = FigureCanvasAgg(panel.figure).get_renderer()
    font = FontProperties(size=_SIZE)
    scale = panel.figure.dpi / 72
    centers = [tuple(panel.transData.transform(point)) for point in points]
    taken = [_around(x, y, 3 * scale) for x, y in centers]
    crossed = _along([tuple(panel.transData.transform(point)) for point in line], scale)
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
        off_the_line = (one for one in free if not any(one[1].overlaps(c) for c in crossed))
        offset, box = next(off_the_line, free[0])
        taken.append(box)
        placed.append((index, offset))
    for index, offset in placed:
        _write(panel, points[index], names[index], offset)
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
