"""results/published/frames: scenes that move, with structures updated or rebuilt."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from beambench.analysis import Ratio, geometric_mean
from beambench_operations.publish.figures.cells import Cells
from beambench_report.base.analysis import FrameComparison, FrameSeries, read_analysis
from beambench_report.base.cell_files import ratio_of
from beambench_report.base.names import brief_name, parameter_items

_BUILT_ONLY = ("samet", "voxel-grid")
"""Structures without an update: a grid and an octree."""


@dataclass(frozen=True)
class Series:
    """A structure over the frames of a scene, as the tables show it."""

    scene: str
    structure: str
    ray_kind: str
    series: FrameSeries

    def is_of(self, scene: str, structure: str) -> bool:
        """Returns whether the series is of this structure over this scene."""
        return (self.scene, self.structure) == (scene, structure)

    @property
    def last(self) -> FrameComparison:
        """The last frame, whose positions are farthest from those of the first build."""
        return self.series.frames[-1]

    @property
    def is_won(self) -> bool:
        """Whether the updated structure is clearly ahead in the last frame, trace included."""
        high = self.last.total_ratio.high
        return high is not None and high < 1

    @property
    def is_lost(self) -> bool:
        """Whether the updated structure is clearly behind in the last frame."""
        low = self.last.total_ratio.low
        return low is not None and low > 1

    @property
    def every(self) -> str:
        """The number of frames that one build serves: `one frame`, `5 frames`, `all 20 frames`."""
        after = self.series.rebuild_after
        if after == 1:
            return "one frame"
        return f"{after} frames" if after else f"all {self.last.frame + 1} frames"


def figures(folder: Path) -> dict[str, Any]:
    """Returns the series by ray kind and scene, their means by structure, and who is ahead."""
    cells = Cells(folder)
    analysis = read_analysis(folder)
    found = [_series(one) for one in analysis.frame_series]
    kinds = list(dict.fromkeys(one.ray_kind for one in found))
    structures = list(dict.fromkeys(one.structure for one in found))
    (last,) = {one.last.frame for one in found}
    return {
        "kinds": kinds,
        "structures": structures,
        "scenes": list(dict.fromkeys(one.scene for one in found)),
        "rows": [
            {"scene": scene, "structure": structure, **by_kind}
            for scene in dict.fromkeys(one.scene for one in found)
            for structure in structures
            if (by_kind := {o.ray_kind: o for o in found if o.is_of(scene, structure)})
        ],
        "series": len(found),
        "last": last,
        "frames": last + 1,
        "shown": [str(one.frame) for one in found[0].series.frames],
        "size": cells.sizes[0],
        "means": {
            structure: {kind: _means(found, structure, kind) for kind in kinds}
            for structure in structures
        },
        "embree_modes": _embree_modes(cells),
        "embree_low": cells.rows["parameters"].str.contains("quality=low", regex=False).any(),
        "over_embree": {kind: _over_embree(cells, structures, last, kind) for kind in kinds},
        "total": _mean(found, "total_ratio"),
        "won": sum(one.is_won for one in found),
        "lost": sum(one.is_lost for one in found),
        "whole": sum(one.series.rebuild_after is None for one in found),
        "fastest": _fastest(cells, last),
        "wrong": len(cells.wrong),
        "cells": len(cells.rows),
    }


def _series(series: FrameSeries) -> Series:
    scene, *_, kind = series.subject.rsplit("/", 4)
    structure, _, parameters = series.contender.partition(":")
    mode = parameter_items(parameters).get("mode", "")
    return Series(scene, f"{structure} {mode}".strip(), kind, series)


def _mean(found: Sequence[Series], which: str) -> Ratio:
    return geometric_mean([getattr(one.last, which) for one in found])


def _means(found: Sequence[Series], structure: str, kind: str) -> dict[str, Ratio]:
    own = [one for one in found if (one.structure, one.ray_kind) == (structure, kind)]
    return {which: _mean(own, f"{which}_ratio") for which in ("total", "trace")}


def _embree_modes(cells: Cells) -> str:
    """Returns how Embree traces images: `in packets of 16 or in streams`."""
    texts = {"single": "ray by ray", "packet16": "in packets of 16", "stream": "in streams"}
    modes = cells.having("embree")["parameters"].map(
        lambda text: parameter_items(text).get("mode", "single")
    )
    return " or ".join(texts[mode] for mode in dict.fromkeys(modes))


def _over_embree(
    cells: Cells, structures: Sequence[str], frame: int, kind: str
) -> dict[str, Ratio]:
    """Returns Embree's time of a frame over that of each updated structure, the fastest first.

    Embree is updated or rebuilt, whichever is faster in the scene.
    """
    scenes = cells.rows.loc[cells.rows["frame"] == frame, "scene"].unique()
    found: dict[str, list[Ratio]] = {}
    for scene in scenes:
        embree = cells.having("embree", scene=scene, ray_kind=kind)
        embree = embree[embree["timed"]]
        fastest = embree.loc[embree["total_ms"].idxmin()]
        for structure in structures:
            if not structure.startswith("embree"):
                own = cells.row(f"{structure}:update=true", scene=scene, ray_kind=kind)
                found.setdefault(structure, []).append(ratio_of("total", fastest, own, cells.files))
    means = {structure: geometric_mean(ratios) for structure, ratios in found.items()}
    return dict(sorted(means.items(), key=lambda one: -one[1].value))


def _name(contender: str) -> str:
    """Returns the name without the parameter that the column states: `sah-bvh lbvh`."""
    return brief_name(contender.replace(" update=true", ""))


def _fastest(cells: Cells, frame: int) -> list[dict[str, Any]]:
    """Returns the least times of the last frames: updated, rebuilt, and of a grid or octree.

    Each row has a scene and a ray kind, with milliseconds and contender.
    """
    rows = cells.rows[cells.rows["timed"] & (cells.rows["frame"] == frame)]
    updated = rows["parameters"].str.contains("update=true", regex=False)
    never = rows["structure"].isin(_BUILT_ONLY)
    ways = {"updated": updated, "built": ~updated & ~never, "grid": never}
    found = []
    for (_, kind), own in rows.groupby(["scene", "ray_kind"], sort=False):
        best = {way: own[is_so[own.index]].sort_values("total_ms") for way, is_so in ways.items()}
        title = own["subject"].iloc[0].rpartition("@")[0]
        found.append(
            {"scene": title, "ray_kind": kind}
            | {way: of_way.iloc[0].to_dict() for way, of_way in best.items()}
            | {"name": {way: _name(of_way.iloc[0]["contender"]) for way, of_way in best.items()}}
        )
    return found
