"""Reads the texts of a plot's SVG file, and finds the axis and panel to which they belong.

The files do not keep matplotlib's ids, so a text belongs to an axis by its place: tick labels of
the horizontal axis are centered below the panel, those of the vertical axis end left of it. Some
tick labels are placed one by one, and start where they are.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

_SVG = "{http://www.w3.org/2000/svg}"
_NUMBER = r"(-?[\d.]+)"
_POINT = f"{_NUMBER} {_NUMBER}"
_RECTANGLE = re.compile(f"M{_POINT}L{_POINT}L{_POINT}L{_POINT}z")
_PAPER = "fill:#ffffff"
_TICK_BAND, _SLANTED_BAND = 20.0, 48.0
"""The maximum distance between a panel and its tick labels, in points; slanted ones are taller."""
_LABEL_BAND = 75.0
"""The maximum distance between a panel and the label of its horizontal axis, in points."""
_BESIDE = 9.0
"""The maximum distance of a tick label beyond the end of its axis, in points."""
_LEGEND_GAP, _LEGEND_LINE = 30.0, 6.0
"""The maximum distance from a legend's sample to its text, in points, along and across the line."""
_NEAR = 2.0
"""The maximum difference between positions that count as equal, in points."""


@dataclass(frozen=True)
class Text:
    """A text: its words, its start, center or end, and its style."""

    words: str
    x: float
    y: float
    anchor: str
    degrees: float
    color: str

    @property
    def is_upright(self) -> bool:
        """Returns whether the text is rotated by a right angle, as labels of vertical axes are."""
        return abs(self.degrees) == 90

    @property
    def is_number(self) -> bool:
        """Returns whether the text is only a number, which is meaningless without an axis label."""
        number = r"[-\N{MINUS SIGN}]?[\d,.]+(\N{MINUS SIGN}\d+|e[-+]?\d+)?%?"
        return re.fullmatch(number, self.words) is not None

    @property
    def is_size(self) -> bool:
        """Returns whether the text is a number, perhaps of thousands, or a resolution."""
        return self.is_number or re.fullmatch(r"\d+x\d+|[\d.]+ ?[kM]", self.words) is not None


@dataclass(frozen=True)
class Panel:
    """The area of a plot within its axes."""

    left: float
    top: float
    right: float
    bottom: float

    def holds(self, x: float, y: float) -> bool:
        """Returns whether a place lies within the panel."""
        return self.left < x < self.right and self.top < y < self.bottom

    def is_above(self, other: Panel) -> bool:
        """Returns whether the other panel is below this one, in the same column."""
        return abs(self.left - other.left) < _NEAR and abs(self.right - other.right) < _NEAR

    def is_beside(self, other: Panel) -> bool:
        """Returns whether both panels are in the same row."""
        return abs(self.top - other.top) < _NEAR and abs(self.bottom - other.bottom) < _NEAR


def missing_in(folder: Path) -> dict[str, list[str]]:
    """Returns the defects of a folder's plots, by name; raises ValueError if it has no plot."""
    plots = sorted(folder.rglob("*.svg"))
    if not plots:
        raise ValueError(f"{folder}: there is no SVG file")
    found = {
        str(path.relative_to(folder)): missing_texts(
            path.read_text("utf-8"), is_named_by_title=path.stem.startswith("counters-")
        )
        for path in plots
    }
    return {name: lacks for name, lacks in found.items() if lacks}


def missing_texts(svg: str, *, is_named_by_title: bool = False) -> list[str]:
    """Returns a sentence for each empty text, and each axis without tick labels or without a label.

    An axis of names needs no label, nor does a horizontal one if the panel's title names it. Panels
    of one column or row may share an axis.
    """
    root = ElementTree.fromstring(svg)
    texts, panels = list(texts_of(root)), _panels(root)
    lacks = [f"<{one.tag.removeprefix(_SVG)}> is empty" for one in _empty(root)]
    if not panels:
        lacks.append("there is no panel")
    for number, panel in enumerate(panels, 1):
        column = [one for one in panels if one.is_above(panel)]
        row = [one for one in panels if one.is_beside(panel)]
        for axis, found in (("horizontal", _across(texts, column)), ("vertical", _up(texts, row))):
            ticks, labels = found
            if not ticks or (len(ticks) == 1 and ticks[0].is_number):
                lacks.append(f"panel {number}: the {axis} axis has {len(ticks)} tick labels")
            is_named = is_named_by_title and axis == "horizontal"
            if not labels and not is_named and all(one.is_number for one in ticks):
                lacks.append(f"panel {number}: the {axis} axis has no label")
    return [
        *lacks,
        *(f"nothing names the color {color}" for color in _unnamed(root, texts, panels)),
    ]


def _unnamed(root: Element, texts: Sequence[Text], panels: Sequence[Panel]) -> list[str]:
    """Returns the data colors without a legend, a label in that color or a row of names."""
    marks = list(_marks(root))
    colors = dict.fromkeys(c for c, x, y in marks if any(panel.holds(x, y) for panel in panels))
    named = {text.color for text in texts}
    for color, x, y in marks:
        if any(
            0 < text.x - x < _LEGEND_GAP and abs(text.y - y) < _LEGEND_LINE and not text.is_number
            for text in texts
            if text.anchor == "start"
        ):
            named.add(color)
    rows = [_up(texts, [panel])[0] for panel in panels]
    if any(not text.is_number for row in rows for text in row):
        return []
    return [color for color in colors if color not in named]


def _marks(root: Element) -> Iterator[tuple[str, float, float]]:
    """Yields the color and the right end of each marker and line that is not gray."""
    parents = {child: parent for parent in root.iter() for child in parent}
    for element in root.iter():
        if element.tag == f"{_SVG}use":
            place = [float(element.get(name, "0")) for name in "xy"]
        elif element.tag == f"{_SVG}path" and parents[element].tag != f"{_SVG}defs":
            ends = re.findall(f"[ML]{_NUMBER} {_NUMBER}", element.get("d", ""))
            place = [float(number) for number in ends[-1]] if ends else []
        else:
            continue
        for color in _colors(element, parents):
            if place and len({color[1:3], color[3:5], color[5:7]}) > 1:
                yield color, place[0], place[1]


def texts_of(root: Element) -> Iterator[Text]:
    """Yields all texts, in the order of the file; the characters of one text are combined."""
    parents = {child: parent for parent in root.iter() for child in parent}
    for element in root.iter(f"{_SVG}text"):
        x, y = _place(element)
        transform = element.get("transform") or parents[element].get("transform", "")
        if moved := re.match(f"translate\\({_NUMBER} {_NUMBER}\\)", transform):
            x, y = x + float(moved[1]), y + float(moved[2])
        turned = re.search(f"rotate\\({_NUMBER}", transform)
        anchor = re.search("text-anchor:(\\w+)", element.get("style", ""))
        words = " ".join("".join(element.itertext()).split())
        degrees = float(turned[1]) if turned else 0.0
        color = _colors(element, parents)[-1:] or [""]
        yield Text(words, x, y, anchor[1] if anchor else "start", degrees, color[0])


def _colors(element: Element, parents: Mapping[Element, Element]) -> list[str]:
    """Returns the colors of a text: its own or else its group's."""
    styles = (one.get("style", "") for one in (element, parents.get(element, element)))
    return next(filter(None, (re.findall("(?:fill|stroke):(#\\w+)", one) for one in styles)), [])


def _place(element: Element) -> tuple[float, float]:
    """Returns the position of a text, or of the first of its characters."""
    named = next((one for one in element.iter() if "x" in one.attrib), None)
    return (0.0, 0.0) if named is None else tuple(float(named.get(name, "0")) for name in "xy")


def _empty(root: Element) -> list[Element]:
    drawn = [one for one in root.iter() if one.tag in (f"{_SVG}text", f"{_SVG}tspan")]
    return [one for one in drawn if not "".join(one.itertext()).strip()]


def _panels(root: Element) -> list[Panel]:
    """Returns the white rectangles after the first one, which is the paper."""
    shapes = [
        _RECTANGLE.fullmatch(path.get("d", ""))
        for path in root.iter(f"{_SVG}path")
        if _PAPER in path.get("style", "")
    ]
    corners = [[float(number) for number in shape.groups()] for shape in shapes if shape]
    return [Panel(c[0], c[5], c[2], c[1]) for c in corners[1:]]


def _across(texts: Sequence[Text], column: Sequence[Panel]) -> tuple[list[Text], list[Text]]:
    """Returns the tick labels and labels of the horizontal axes of a column."""
    ticks, labels = [], []
    for panel in column:
        below = [
            text
            for text in texts
            if panel.left - _BESIDE < text.x < panel.right + _BESIDE and text.y > panel.bottom
        ]
        for text in below:
            distance = text.y - panel.bottom
            is_centered = abs(text.x - (panel.left + panel.right) / 2) < _NEAR
            is_alone = sum(abs(text.y - other.y) < 1 for other in below) == 1
            if is_centered and is_alone and not text.degrees and not text.is_number:
                labels += [text] if distance < _LABEL_BAND else []
            elif text.anchor == "middle" or text.is_size:
                band = _SLANTED_BAND if text.degrees else _TICK_BAND
                ticks += [text] if distance < band and not text.is_upright else []
    return ticks, labels


def _up(texts: Sequence[Text], row: Sequence[Panel]) -> tuple[list[Text], list[Text]]:
    """Returns the tick labels and labels of the vertical axes of a row."""
    ticks, labels = [], []
    for panel in row:
        for text in texts:
            is_at_height = panel.top - _BESIDE < text.y < panel.bottom + _BESIDE
            is_inside = any(other.holds(text.x, text.y) for other in row)
            if not is_at_height or is_inside or text.x > panel.left:
                continue
            if text.is_upright:
                labels.append(text)
            elif text.anchor == "end" or text.is_size:
                ticks.append(text)
    return ticks, labels
