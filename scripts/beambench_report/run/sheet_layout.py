"""Lays out a contact sheet: in each row, pictures of equal height fill the sheet's width."""

import math
import textwrap
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

# All in pixels of the sheet.
WIDTH = 1400
MARGIN = 12
GAP = 10
LINE = 20  # of a label
LABEL_FONT = 15
HEADING = 40
HEADING_FONT = 22
_LETTER = 8.2  # mean width at LABEL_FONT
_HIGHEST = 340  # of a picture in a group of one row

_LONGEST_ROW = 6  # pictures


@dataclass(frozen=True)
class Picture:
    """The picture of one scene, with the text of its label."""

    scene: str
    counts: str
    pixels: np.ndarray

    @property
    def aspect(self) -> float:
        """Returns the width over the height."""
        return self.pixels.shape[1] / self.pixels.shape[0]


@dataclass(frozen=True)
class Row:
    """Pictures of equal height, each with its name and counts below it."""

    heading: str
    pictures: list[Picture]
    picture_height: float

    @property
    def height(self) -> float:
        """Returns the height with heading, labels and the space below."""
        lines = max(len(label(picture, self.picture_height)) for picture in self.pictures)
        return (HEADING if self.heading else 0) + self.picture_height + LINE * lines + 2 * GAP

    def edges(self) -> list[tuple[int, int]]:
        """Returns the left and right edge of each picture."""
        edges = []
        left = float(MARGIN)
        for picture in self.pictures:
            right = left + picture.aspect * self.picture_height
            edges.append((round(left), round(right)))
            left = right + GAP
        return edges


def even_rows(heading: str, pictures: list[Picture]) -> list[Row]:
    """Returns as few rows as possible, with about equal numbers of pictures; each fills the width.

    A few pictures that would become too high leave space beside them.
    """
    count = math.ceil(len(pictures) / _LONGEST_ROW)
    ends = [math.ceil(len(pictures) * number / count) for number in range(count + 1)]
    rows = [pictures[start:end] for start, end in pairwise(ends)]
    heights = [_space(row) / sum(picture.aspect for picture in row) for row in rows]
    if count == 1:
        heights = [min(_HIGHEST, heights[0])]
    return [
        Row("" if number else heading, row, height)
        for number, (row, height) in enumerate(zip(rows, heights, strict=True))
    ]


def _space(row: list[Picture]) -> float:
    return WIDTH - 2 * MARGIN - GAP * (len(row) - 1)


def label(picture: Picture, height: float) -> list[tuple[str, str]]:
    """Returns the lines under a picture of this height, each with its weight."""
    letters = max(12, int(height * picture.aspect / _LETTER))
    name = [(line, "bold") for line in textwrap.wrap(picture.scene, letters - 1)]
    return name + [(line, "normal") for line in textwrap.wrap(picture.counts, letters)]
