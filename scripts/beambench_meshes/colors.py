"""Picks a color for a texture by its name, because textures themselves are not read.

Texture names describe what is shown: grass, road, brick. An unrecognized name gets a muted color
that depends only on the name.
"""

from __future__ import annotations

import colorsys
import hashlib
import re

from beambench_meshes.surface_mesh import Color

# The first keyword contained in the name decides.
_KNOWN: tuple[tuple[str, Color], ...] = (
    ("lava|fire", (0.80, 0.28, 0.08)),
    ("slime|acid", (0.35, 0.55, 0.12)),
    ("water|lake|river", (0.20, 0.34, 0.42)),
    ("tree|arbor|bush|leaf|leaves|ivy|plant|palm", (0.16, 0.30, 0.12)),
    ("grass|gras|meadow|moss", (0.27, 0.38, 0.15)),
    ("snow|ice", (0.86, 0.88, 0.92)),
    ("road|asphalt|tarmac|track", (0.23, 0.23, 0.24)),
    ("sand|dirt|desert|soil|mud", (0.52, 0.42, 0.28)),
    ("brick|roof|tile", (0.48, 0.27, 0.20)),
    ("wood|plank|crate|timber|log", (0.43, 0.30, 0.18)),
    ("glass|window", (0.45, 0.55, 0.60)),
    ("light|lamp|lite|glow", (0.92, 0.88, 0.74)),
    ("metal|steel|iron|pipe|grate|support|girder|trim", (0.38, 0.39, 0.42)),
    ("concrete|conc|cement|wall|stone|rock|cliff|floor", (0.52, 0.50, 0.46)),
)


def color_of_texture(name: str) -> Color:
    """Returns the color for a texture; the same name always has the same color."""
    for pattern, color in _KNOWN:
        if re.search(pattern, name.lower()):
            return _shaded(color, name)
    digest = _digest(name)
    # From red earth to ocher, like most buildings.
    return colorsys.hls_to_rgb(0.02 + 0.12 * digest[0] / 255, 0.35 + 0.25 * digest[1] / 255, 0.16)


def _shaded(color: Color, name: str) -> Color:
    """Returns a slightly lighter or darker color, so that textures of one kind differ."""
    factor = 0.85 + 0.3 * _digest(name)[0] / 255
    red, green, blue = (min(1.0, part * factor) for part in color)
    return red, green, blue


def _digest(name: str) -> bytes:
    return hashlib.sha256(name.lower().encode("latin-1", "replace")).digest()
