"""results/published/beat-embree: images by tile beams and by Embree's fastest mode."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from beambench_publish.figures.comparison import figures_of, read_pairings
from beambench_publish.reports import BEAT_EMBREE

_MILLION = "bumpy:triangles=1000000"


def figures(folder: Path) -> dict[str, Any]:
    """The groups with their ratios, the growth with triangles, and builds."""
    found = read_pairings(folder, BEAT_EMBREE)
    growing = sorted(
        (
            one
            for one in found
            if one.scene.startswith("bumpy:")
            and one.resolution == "1280x1024"
            and one.isa == "best"
        ),
        key=lambda one: one.primitives,
    )
    million = [one for one in found if one.scene == _MILLION and one.isa == "best"]
    return figures_of(found) | {
        "growing": growing,
        "build": {
            "tile_beam": [one.tile.build for one in million],
            "embree": [one.embree.build for one in million],
        },
        "fastest": sorted({one.embree.contender for one in found if one.isa == "best"}),
    }
