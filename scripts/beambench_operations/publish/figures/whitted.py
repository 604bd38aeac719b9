"""results/published/whitted: whole pictures by every structure."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from beambench.analysis import Ratio
from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.net_ratios import NET, paired_net_ratio
from beambench_report.base.names import parameter_items

_NAMES = ("sah-bvh", "tile-beam", "goldsmith-salmon", "voxel-grid", "samet-net", "samet", "beam")
_PLAIN, _CACHE = "whitted", "whitted:shadows=cache"
_KINDS = ("camera", "reflected", "refracted", "shadow")


def figures(folder: Path) -> dict[str, Any]:
    """Returns ratios to Embree's fastest mode, the rays by kind, shading, and the shadow cache."""
    cells = Cells(folder)
    embree = {scene: _embree(cells, scene) for scene in cells.scenes}
    ratios = {
        scene: {
            name: paired_net_ratio(cells, cells.row(name, scene=scene, ray_kind=_PLAIN), base)
            for name in _NAMES
        }
        for scene, base in embree.items()
    }
    beams = {
        scene: paired_net_ratio(
            cells, *(cells.row(name, scene=scene, ray_kind=_PLAIN) for name in ("beam", "samet"))
        )
        for scene in cells.scenes
    }
    rays = {
        scene: {kind: float(base[f"{kind}_rays"]) for kind in _KINDS}
        for scene, base in embree.items()
    }
    shading = [row["harness_ms"] / row["trace_ms_median"] for row in embree.values()]
    return {
        "cells": len(cells.rows),
        "wrong": len(cells.wrong),
        "size": cells.sizes[0],
        "names": _NAMES,
        "ratios": ratios,
        "modes": sorted({parameter_items(row["parameters"])["mode"] for row in embree.values()}),
        "rays": rays,
        "share": {
            kind: sorted((own[kind] / sum(own.values()), scene) for scene, own in rays.items())
            for kind in _KINDS
        },
        "shading": (min(shading), max(shading)),
        "beams": sorted(
            ((one, scene) for scene, one in beams.items()), key=lambda one: one[0].value
        ),
        "grid": [scene for scene, own in ratios.items() if _is_grid_ahead(own)],
        "cache": _cache(cells),
    }


def _embree(cells: Cells, scene: str) -> pd.Series:
    """Returns the row of Embree's fastest mode with correct hits."""
    rows = cells.having("embree", scene=scene, ray_kind=_PLAIN)
    return rows.loc[rows.loc[rows["timed"], NET].idxmin()]


def _is_grid_ahead(ratios: Mapping[str, Ratio]) -> bool:
    """Returns whether the uniform grid is faster than every hierarchy but Embree's."""
    others = [ratios[name].value for name in ("sah-bvh", "tile-beam", "goldsmith-salmon")]
    return ratios["voxel-grid"].value < min(others)


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
