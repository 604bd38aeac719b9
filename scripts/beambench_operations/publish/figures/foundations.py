"""results/published/foundations: beams compared with the thesis's foundations."""

from pathlib import Path
from typing import Any

from beambench.analysis import Ratio, geometric_mean
from beambench_operations.publish.figures.cells import Cells
from beambench_report.base.files import load_json

BEAM = "beam:max_level=6"
_PRIMARY = {
    "polygon-beam": "polygon-beam",
    "samet": "samet:max_level=6",
    "glassner": "glassner:max_level=6,build=complete,exits=explicit",
    "glassner, hashed": "glassner:max_level=6,build=hashed,exits=explicit",
    "glassner, iterative": "glassner:max_level=6,build=complete,exits=iterative",
    "ray-classification": "ray-classification",
}
_FOLLOWED = {name: _PRIMARY[name] for name in ("samet", "ray-classification")}
_SMALL_ANGLE = 30


def figures(folder: Path) -> dict[str, Any]:
    """Returns the times relative to beams by scene, and the runs of `beambench mirrors`."""
    primary, followed = Cells(folder / "primary"), Cells(folder / "followed")
    glass = [_glass(file) for file in sorted((folder / "mirrors").glob("*.json"))]
    return {
        "primary": _table(primary, _PRIMARY, "primary"),
        "followed": {kind: _table(followed, _FOLLOWED, kind) for kind in ("mirror", "whitted")},
        "build": {
            scene: primary.row("polygon-beam", scene=scene)["build_ms_median"]
            / primary.row(BEAM, scene=scene)["build_ms_median"]
            for scene in primary.scenes
        },
        "glass": glass,
        "most_alone": max(run["alone"] for run in glass if run["alone"] is not None),
        "wrong": len(primary.wrong) + len(followed.wrong),
        "cells": len(primary.rows) + len(followed.rows),
    }


def _table(cells: Cells, contenders: dict[str, str], kind: str) -> dict[str, Any]:
    """Returns ratios of contenders to beams by scene, where both have times, and the means."""
    rows: dict[str, dict[str, Ratio]] = {}
    for scene in cells.scenes:
        own = {
            name: cells.ratio(contender, BEAM, scene=scene, kind=kind)
            for name, contender in contenders.items()
            if _are_timed(cells, (contender, BEAM), scene=scene, kind=kind)
        }
        if own:
            rows[scene] = own
    means = {
        name: geometric_mean([own[name] for own in rows.values() if name in own])
        for name in contenders
    }
    (size,) = cells.sizes
    return {"contenders": list(contenders), "rows": rows, "means": means, "size": size}


def _are_timed(cells: Cells, contenders: tuple[str, ...], **columns: str) -> bool:
    """Returns whether all contenders have times; they do not if a scene has no rays of a kind."""
    return all(cells.having(one, **columns)["timed"].any() for one in contenders)


def _glass(file: Path) -> dict[str, Any]:
    """Returns facts on the refracted rays of one picture: times, and the share of single rays at
    small angles.
    """
    source = load_json(file)
    seen = source["seen_through"]
    small = [
        one
        for part in seen
        for one in part["by_angle"]
        if one["degrees_below"] <= _SMALL_ANGLE and one["samples"]
    ]
    samples = sum(one["samples"] for one in small)
    return {
        "scene": source["scene"],
        "resolution": source["resolution"],
        "planes": len(seen),
        "rays": sum(part["samples"] for part in seen),
        "different": sum(part["different"] for part in seen),
        "ratio": sum(part["rays_ms"] for part in seen) / sum(part["beams_ms"] for part in seen),
        "alone": sum(one["alone"] for one in small) / samples if samples else None,
        "alone_in_all": sum(one["alone"] for part in seen for one in part["by_angle"])
        / sum(part["samples"] for part in seen),
    }
