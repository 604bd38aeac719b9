"""The colors of plots, each for white and for dark pages.

Plots are drawn in the colors for white pages. Within a page each color is a CSS variable, which a
dark page redefines: `run.inline_svg`.
"""

from dataclasses import dataclass
from zlib import crc32

INK = "#222222"
SOFT = "#555555"
GRID = "#dddddd"
PAPER = "#ffffff"


@dataclass(frozen=True)
class Tint:
    """One color: the name of its CSS variable, its value on white, and its value on #161616."""

    name: str
    light: str
    dark: str


_PAGE = (
    Tint("ink", INK, "#e3e6e7"),
    Tint("soft", SOFT, "#9aa4aa"),
    Tint("grid", GRID, "#3a4145"),
    Tint("card", PAPER, "#1c2023"),
)
# Embree's color is not quite black: matplotlib omits a black fill from an SVG, so a page could not
# replace it.
_STRUCTURES = (
    Tint("embree", "#0a0a0a", "#ffffff"),
    Tint("exhaustive", "#777777", "#8f8f8f"),
    Tint("null", "#b0b0b0", "#c4c4c4"),
    Tint("samet", "#0072b2", "#5b8def"),
    Tint("samet-net", "#56b4e9", "#7fd4ff"),
    Tint("glassner", "#003f5c", "#00bcd4"),
    Tint("gargantini", "#283593", "#8c9eff"),
    Tint("voxel-grid", "#009e73", "#1fbf8f"),
    Tint("hierarchical-grid", "#3f7f6b", "#5fd3c0"),
    Tint("goldsmith-salmon", "#cc79a7", "#dd8fbb"),
    Tint("sah-bvh", "#e69f00", "#f0a818"),
    Tint("kd-tree", "#7cb518", "#a8e05f"),
    Tint("beam", "#d55e00", "#ec6f14"),
    Tint("grid-beam", "#a63c00", "#ff9a5c"),
    Tint("tile-beam", "#8a7f00", "#f0e442"),
    Tint("ray-classification", "#7a00cc", "#c77dff"),
    Tint("z-buffer", "#6b4a2b", "#c9a27a"),
    Tint("polygon-beam", "#c2185b", "#ff4fa3"),
)
# Colors for plug-ins, so that no plug-in is mistaken for a structure of the project.
_SPARE = (
    Tint("plug-in-1", "#6a3d9a", "#b08be0"),
    Tint("plug-in-2", "#8c510a", "#c98f4e"),
    Tint("plug-in-3", "#b2182b", "#f0606f"),
    Tint("plug-in-4", "#1b5e20", "#7cc47f"),
    Tint("plug-in-5", "#c2278f", "#ff7ad1"),
)
SCENE_COLORS = tuple(tint.light for tint in _SPARE)
"""Colors for plots whose lines are scenes; no structure of the project has these colors."""
TINTS = (*_PAGE, *_STRUCTURES, *_SPARE)


def structure_tint(structure: str) -> Tint:
    """Returns the color of a structure; an unknown one always has the same spare color."""
    known = {tint.name: tint for tint in _STRUCTURES}
    return known.get(structure, _SPARE[crc32(structure.encode()) % len(_SPARE)])


def structure_color(structure: str) -> str:
    """Returns a structure's color for white backgrounds."""
    return structure_tint(structure).light


def css_color(structure: str) -> str:
    """Returns the CSS variable of a structure's color; dark pages redefine the variable."""
    tint = structure_tint(structure)
    return f"var(--{tint.name}, {tint.light})"
