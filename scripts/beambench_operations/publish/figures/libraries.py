"""results/published/libraries: tinybvh and madmann91/bvh beside sah-bvh and Embree."""

from pathlib import Path
from typing import Any

from scipy.stats import gmean

from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.net_ratios import NET, means, net_ratios

_BASE = "embree:mode=single,robust=true"
_DEFAULT = "layout=bvh8,builder=binned,optimize=0,exact_t=true"
_CONTENDERS = {
    "`sah-bvh`, `builder=binned` (the default)": "sah-bvh:builder=binned",
    "`sah-bvh`, `builder=spatial`": "sah-bvh:builder=spatial",
    "`tinybvh:layout=bvh8` (the default)": f"tinybvh:{_DEFAULT},normalize=true",
    "the same, `normalize=false`": f"tinybvh:{_DEFAULT},normalize=false",
    "the same, `normalize=false,optimize=50`": (
        "tinybvh:layout=bvh8,builder=binned,normalize=false,optimize=50"
    ),
    "`tinybvh:layout=bvh4`": "tinybvh:layout=bvh4",
    "`madmann91-bvh`": "madmann91-bvh",
    "Embree's single rays, not watertight": "embree:mode=single,robust=false",
    "Embree's packets of 16, `coherent=true`": "embree:mode=packet16,coherent=true",
    "Embree's packets of 16, `coherent=false`": "embree:mode=packet16,coherent=false",
}
_KINDS = ("primary", "shadow", "diffuse")


def figures(folder: Path) -> dict[str, Any]:
    """Returns geometric means over watertight Embree, and sah-bvh over the best of tinybvh."""
    cells = Cells(folder)
    of_embree_4 = _of_embree_4(folder / "embree-4")
    return {
        "scenes": cells.scenes,
        "size": cells.sizes[0],
        "cells": len(cells.rows),
        "wrong": cells.wrong.to_dict("records"),
        "versions": sorted(set(cells.rows["library_version"]) - {""}),
        "means": means(net_ratios(cells, _BASE, _CONTENDERS)),
        "best_of_tinybvh": {
            builder: _over_tinybvh(cells, f"sah-bvh:builder={builder}")
            for builder in ("binned", "spatial")
        },
        "embree_4": of_embree_4,
    }


def _over_tinybvh(cells: Cells, contender: str) -> dict[str, Any]:
    """Returns ratios over the fastest correct configuration of tinybvh in each view."""
    correct = cells.rows[cells.rows["timed"] & (cells.rows["structure"] == "tinybvh")]
    best = correct.groupby(["scene", "ray_kind"])[NET].min()
    ratios = {
        (scene, kind): float(
            cells.row(contender, scene=scene, ray_kind=kind)[NET] / best[scene, kind]
        )
        for scene in cells.scenes
        for kind in _KINDS
    }
    by_kind = {
        kind: float(gmean([ratios[scene, kind] for scene in cells.scenes])) for kind in _KINDS
    }
    order = sorted(ratios, key=lambda view: ratios[view])
    return {
        "mean": by_kind,
        "worst": (*order[-1], ratios[order[-1]]),
        "best": (*order[0], ratios[order[0]]),
    }


def _of_embree_4(folder: Path) -> dict[str, Any]:
    if not (folder / "results.csv").is_file():
        return {}
    cells = Cells(folder)
    own = {
        "`sah-bvh`": "sah-bvh",
        "`tinybvh:normalize=false`": "tinybvh",
        "Embree's single rays, not watertight": "embree:mode=single,robust=false",
        "Embree's packets of 16, `coherent=true`": "embree:mode=packet16",
    }
    return {
        "cells": len(cells.rows),
        "wrong": len(cells.wrong),
        "means": means(net_ratios(cells, _BASE, own)),
    }
