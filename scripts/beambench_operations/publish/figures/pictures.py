"""results/published/pictures: whole pictures in waves, by Embree's modes."""

from pathlib import Path
from typing import Any

from scipy.stats import gmean

from beambench_operations.publish.figures.cells import Cells
from beambench_report.base.files import read_table

_MODES = ("single", "packet4", "packet8", "packet16", "stream")
_NS = 1e6  # nanoseconds in a millisecond


def figures(folder: Path) -> dict[str, Any]:
    """Returns nanoseconds per ray by mode, the share of shading, a gain, and the profile."""
    cells = Cells(folder)
    per_ray = {
        scene: {mode: _ns(cells, scene, f"embree:mode={mode},robust=true") for mode in _MODES}
        for scene in cells.scenes
    }
    shading = {
        scene: _NS * (row := cells.having(scene=scene).iloc[0])["harness_ms"] / row["rays"]
        for scene in cells.scenes
    }
    share = {scene: shading[scene] / min(per_ray[scene].values()) for scene in cells.scenes}
    return {
        "size": cells.sizes[0],
        "cells": len(cells.rows),
        "wrong": cells.wrong.to_dict("records"),
        "modes": _MODES,
        "ns": per_ray,
        "shading": shading,
        "share": share,
        "mean_share": float(gmean(list(share.values()))),
        "not_robust": {mode: _not_robust(cells, mode) for mode in _MODES},
        "gain": _gain(folder / "before-and-after.csv"),
        "profile": _profile(folder / "profile.csv"),
    }


def _ns(cells: Cells, scene: str, contender: str) -> float:
    row = cells.row(contender, scene=scene)
    return _NS * row["trace_ms_median"] / row["rays"]


def _not_robust(cells: Cells, mode: str) -> float:
    """Returns the time without `robust` over that with it, as a mean over the scenes that have
    both.
    """
    ratios = []
    for scene in cells.scenes:
        with_it = cells.row(f"embree:mode={mode},robust=true", scene=scene)
        without = cells.having(f"embree:mode={mode},robust=false", scene=scene)
        without = without[without["timed"]]
        if len(without):
            ratios.append(without.iloc[0]["trace_ms_median"] / with_it["trace_ms_median"])
    return float(gmean(ratios))


def _gain(file: Path) -> dict[str, Any]:
    """Returns times per ray before a change over those after, from the medians over rounds."""
    columns = [f"{when}_ns_per_ray" for when in ("before_single", "after_single", "after_best")]
    table = read_table(file, ("scene", *columns), "restore it with git")
    medians = table.groupby("scene", sort=False)[columns].median()
    best = medians[columns[0]] / medians[columns[2]]
    single = medians[columns[0]] / medians[columns[1]]
    return {
        "rounds": int(table.groupby("scene").size().max()),
        "best": best.to_dict(),
        "mean": float(gmean(best)),
        "single": float(gmean(single)),
        "least": (str(best.idxmin()), float(best.min())),
        "most": (str(best.idxmax()), float(best.max())),
    }


def _profile(file: Path) -> dict[str, Any]:
    """Returns the percentage of each part by scene, the largest parts first."""
    table = read_table(file, ("scene", "part", "percent"), "restore it with git")
    parts = table.pivot(index="part", columns="scene", values="percent").fillna(0.0)
    order = parts.sum(axis=1).sort_values(ascending=False).index
    return {
        "scenes": list(dict.fromkeys(table["scene"])),
        "parts": {str(part): parts.loc[part].to_dict() for part in order},
    }
