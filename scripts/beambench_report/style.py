"""The looks of a contender: one colour a structure, the same in every plot of every run.

Colours of Okabe and Ito ("Color Universal Design", 2008), which colour-blind readers can
distinguish, their yellow darkened so that it can be seen on white, and two greys. Variants of one
structure share its colour and differ in marker and dashes.
"""

from __future__ import annotations

from dataclasses import dataclass
from zlib import crc32

import pandas as pd

_COLOURS = {
    "embree": "#000000",
    "exhaustive": "#777777",
    "null": "#b0b0b0",
    "samet": "#0072b2",
    "samet-net": "#56b4e9",
    "voxel-grid": "#009e73",
    "goldsmith-salmon": "#cc79a7",
    "sah-bvh": "#e69f00",
    "beam": "#d55e00",
    "tile-beam": "#8a7f00",
}
_MARKERS = "osD^vP*X<>"
_DASHES = ("-", "--", "-.", ":")


@dataclass(frozen=True)
class Look:
    """How one contender is drawn."""

    colour: str
    marker: str
    dashes: str


def structure_colour(structure: str) -> str:
    """The colour of a structure; a newcomer gets one of the others', always the same."""
    spare = list(_COLOURS.values())
    return _COLOURS.get(structure, spare[crc32(structure.encode()) % len(spare)])


def looks(rows: pd.DataFrame) -> dict[str, Look]:
    """The look of every contender of a run."""
    result = {}
    for structure, group in rows.groupby("structure", sort=False):
        for index, contender in enumerate(dict.fromkeys(group["contender"])):
            result[contender] = variant_look(structure, index)
    return result


def variant_look(structure: str, index: int) -> Look:
    """The look of one of several variants of a structure, counted from 0."""
    return Look(
        structure_colour(structure),
        _MARKERS[index % len(_MARKERS)],
        _DASHES[index % len(_DASHES)],
    )
