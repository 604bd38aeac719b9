"""results/published/builders: build time against trace time, for sah-bvh's builders and others."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

import pandas as pd
from scipy.stats import spearmanr

from beambench.analysis import Ratio, geometric_mean
from beambench_operations.publish.figures.cells import Cells
from beambench_report.base.analysis import read_analysis
from beambench_report.base.names import brief_name, file_stems
from beambench_report.base.quantities import size_in_words
from beambench_report.run.crossings import rays_in_words
from beambench_report.run.fronts import Front, fronts

_BUILDERS = ("lbvh", "ploc", "binned", "sweep", "spatial")
_REINSERTED = ("lbvh", "ploc", "binned")
_BASE = "sweep"
_MESHES = ("bumpy", "tessellated-balls")
_QUALITIES = ("sah_cost", "epo")
_LEAST = 4
"""The fewest hierarchies of a scene for which a rank correlation is meaningful."""


@dataclass(frozen=True)
class Correlation:
    """Spearman's rank correlation with trace time within each scene."""

    middle: float
    least: float
    most: float
    scenes: int


def figures(folder: Path) -> dict[str, Any]:
    """Returns fronts, costs, gains of reinsertion, correlations and sizes."""
    cells = Cells(folder)
    found = fronts(read_analysis(folder))
    kinds = list(dict.fromkeys(front.view.ray_kind for front in found))
    largest = cells.rows.loc[cells.rows["primitives"].idxmax(), "scene"]
    return {
        "fronts": found,
        "kinds": kinds,
        "stems": file_stems(kinds),
        "titles": _titles(cells),
        "size": cells.sizes[0],
        "often": _often(found),
        "costs": {scene: _costs(cells, scene) for scene in cells.scenes},
        "built": [name for name in _variants() if name != _BASE],
        "gains": {
            builder: {kind: _gains(cells, builder, kind) for kind in kinds}
            for builder in _REINSERTED
        },
        "correlations": {
            kind: {
                (quality, hierarchies): correlation(
                    _hierarchies(cells, kind, alone=hierarchies == "sah-bvh"), quality
                )
                for quality in _QUALITIES
                for hierarchies in ("all", "sah-bvh")
            }
            for kind in kinds
        },
        "hierarchies": sorted(set(_hierarchies(cells, kinds[0], alone=False)["structure"])),
        "largest": largest,
        "largest_primitives": int(cells.rows["primitives"].max()),
        "sizes": _sizes(cells, largest, kinds[0]),
        "wrong": cells.wrong.to_dict("records"),
        "cells": len(cells.rows),
        "brief": brief_name,
        "rays_in_words": rays_in_words,
    }


def correlation(rows: pd.DataFrame, quality: str) -> Correlation | None:
    """Returns the correlation of a quality of hierarchies with their trace times, scene by scene.

    None if no scene has enough hierarchies.
    """
    found = []
    for _, own in rows.groupby("scene", sort=False):
        if own[quality].nunique() >= _LEAST:
            found.append(float(spearmanr(own[quality], own["trace_ms"]).statistic))
    return Correlation(median(found), min(found), max(found), len(found)) if found else None


def _variants() -> list[str]:
    """Returns the builders as tables name them: `lbvh`, `lbvh reinsertion`."""
    return [*_BUILDERS, *(f"{name} reinsertion" for name in _REINSERTED)]


def _contender(variant: str) -> str:
    builder, _, flag = variant.partition(" ")
    return f"sah-bvh:builder={builder},reinsertion={'true' if flag else 'false'}"


def _costs(cells: Cells, scene: str) -> dict[str, float]:
    """Returns the SAH cost of each builder relative to `sweep`."""
    known = {}
    for variant in _variants():
        rows = cells.having(_contender(variant), scene=scene).dropna(subset=["sah_cost"])
        if not rows.empty:
            known[variant] = float(rows["sah_cost"].iloc[0])
    return {name: cost / known[_BASE] for name, cost in known.items()} if _BASE in known else {}


def _titles(cells: Cells) -> dict[str, str]:
    """Returns the scenes as other texts name them, without parameters left at their defaults."""
    rows = cells.rows.drop_duplicates("scene")
    return {
        row["scene"]: row["subject"].removesuffix(f", {row['ray_kind']} rays")
        for _, row in rows.iterrows()
    }


def _gains(cells: Cells, builder: str, kind: str) -> dict[str, Ratio]:
    """Returns the speedup of the trace by reinsertion, by scene, and its means."""
    own = {"ray_kind": kind}
    names = _contender(builder), _contender(f"{builder} reinsertion")
    gains = {
        scene: cells.ratio(*names, scene=scene, **own)
        for scene in cells.scenes
        if all(cells.having(name, scene=scene, **own)["timed"].any() for name in names)
    }
    of_meshes = [gain for scene, gain in gains.items() if scene.startswith(_MESHES)]
    means = {"mean": list(gains.values()), "meshes": of_meshes}
    return gains | {name: geometric_mean(own) for name, own in means.items() if own}


def _hierarchies(cells: Cells, kind: str, *, alone: bool) -> pd.DataFrame:
    rows = cells.having(ray_kind=kind)
    rows = rows[rows["timed"]].dropna(subset=["sah_cost", "epo"])
    return rows[rows["structure"] == "sah-bvh"] if alone else rows


def _sizes(cells: Cells, scene: str, kind: str) -> list[dict[str, Any]]:
    """Returns the memory and build speed of each contender in a scene, the fastest build first."""
    rows = cells.having(scene=scene, ray_kind=kind)
    rows = rows[rows["timed"]].sort_values("build_ms_median")
    return [
        {
            "name": brief_name(row["contender"]),
            "build_ms": row["build_ms_median"],
            "speed": row["mprimitives_per_s"],
            "bytes": row["bytes_per_primitive"],
            "peak": ""
            if pd.isna(row["peak_build_bytes"])
            else size_in_words(row["peak_build_bytes"]),
        }
        for _, row in rows.iterrows()
    ]


def _often(found: Sequence[Front]) -> dict[str, int]:
    """Counts the views in which a structure or builder is best for some number of rays."""
    counts: dict[str, int] = {}
    for front in found:
        for name in {brief_name(choice.standing.name) for choice in front.choices}:
            counts[name] = counts.get(name, 0) + 1
    return dict(sorted(counts.items(), key=lambda one: (-one[1], one[0])))
