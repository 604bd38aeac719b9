"""results/published/whitted: whole pictures by every structure."""

from pathlib import Path
from typing import Any

from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.net_ratios import net_ratios

_BASE = "embree:mode=single,robust=true"
_NAMES = ("sah-bvh", "tile-beam", "goldsmith-salmon", "voxel-grid", "samet-net", "samet", "beam")
_PLAIN, _CACHE = "whitted", "whitted:shadows=cache"
_KINDS = ("camera", "reflected", "refracted", "shadow")


def figures(folder: Path) -> dict[str, Any]:
    """Returns ratios to Embree's single rays, the rays by kind, shading, and the shadow cache."""
    cells = Cells(folder)
    ratios = net_ratios(cells, _BASE, {name: name for name in _NAMES}).xs(_PLAIN, level="kind")
    rays = {
        scene: {
            kind: float(cells.having(_BASE, scene=scene, ray_kind=_PLAIN).iloc[0][f"{kind}_rays"])
            for kind in _KINDS
        }
        for scene in cells.scenes
    }
    base = {scene: cells.row(_BASE, scene=scene, ray_kind=_PLAIN) for scene in cells.scenes}
    shading = [row["harness_ms"] / row["trace_ms_median"] for row in base.values()]
    beams = ratios["beam"] / ratios["samet"]
    return {
        "cells": len(cells.rows),
        "wrong": len(cells.wrong),
        "size": cells.sizes[0],
        "names": _NAMES,
        "ratios": {scene: {name: ratios[name, scene] for name in _NAMES} for scene in cells.scenes},
        "rays": rays,
        "share": {
            kind: sorted((own[kind] / sum(own.values()), scene) for scene, own in rays.items())
            for kind in _KINDS
        },
        "shading": (min(shading), max(shading)),
        "beams": sorted((value, scene) for scene, value in beams.items()),
        "cache": _cache(cells),
    }


def _cache(cells: Cells) -> list[tuple[float, str, str]]:
    """Returns the time of a picture with the shadow cache over that without it, the least first."""
    return sorted(
        (
            float(
                cells.row(name, scene=scene, ray_kind=_CACHE)["trace_ms_median"]
                / cells.row(name, scene=scene, ray_kind=_PLAIN)["trace_ms_median"]
            ),
            name,
            scene,
        )
        for name in _NAMES
        for scene in cells.scenes
    )
