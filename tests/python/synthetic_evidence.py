"""Invented figures for which every claim of the ledger holds."""

from __future__ import annotations

from collections.abc import Callable

import pandas as pd

from beambench_report.base.published import RESOLUTIONS, primitives_by_scene
from beambench_thesis.paper.evidence import (
    HIERARCHY,
    PAPER_HIERARCHY,
    PICTURE,
    PLAIN_HIERARCHY,
    TIMES,
    WORK,
    Evidence,
    published_evidence,
)

Row = dict[str, object]

RAYS = dict(zip(RESOLUTIONS, (64000, 307200, 480000, 786432, 1310720), strict=True))
SCENES = tuple(primitives_by_scene())

# Seconds independent of the rays, and seconds for each 10,000 rays, by level.
_BASE = {4: 0.5, 5: 0.6, 6: 1.0, 7: 60.0}
_SLOPE = {4: 0.8, 5: 0.4, 6: 0.2, 7: 0.15}
_SCENE_BASE = {"escena2": 1.5, "bola-espacial": 0.5, "caracol": 0.5, "tetera": 2, "torre-eiffel": 2}
_HIERARCHY = {
    "tetera": 100,
    "bola-espacial": 300,
    "flamenco": 1000,
    "ajedrez": 3000,
    "habitacion": 9000,
}
_GRIDS = {
    "flamenco": {6: 200, 10: 120, 13: 93, 20: 150, 32: 500},
    "ajedrez": {6: 400, 10: 150, 15: 90, 22: 120, 32: 200},
    "habitacion": {32: 300},
}
# How much longer single rays take, and the pixels in exit beams: the gain grows with these pixels.
_EMPTINESS = {
    "escena1": (1.0, 4e5),
    "stetra": (1.06, 5e5),
    "gato-bill": (1.12, 6e5),
    "escena2": (1.25, 7e5),
    "misil": (1.35, 8e5),
    "casa-de-campo": (1.45, 9e5),
}


def holding(
    spoil: Callable[[Row], Row] = dict, only: Callable[[Row], bool] = lambda row: True
) -> Evidence:
    """Returns evidence for every claim, with the rows named by `only` changed by `spoil`."""
    rows = (_times(), _work(), _octrees())
    tables = [[spoil(dict(row)) if only(row) else row for row in table] for table in rows]
    return _evidence(*tables)


def without(only: Callable[[Row], bool]) -> Evidence:
    """Returns evidence for every claim, without the named rows."""
    rows = (_times(), _work(), _octrees())
    return _evidence(*([row for row in table if not only(row)] for table in rows))


def _octrees() -> list[Row]:
    at = {"level": 6, "objects": 0, "occupied_leaves": 1000}
    more = [
        {"scene": scene, "exit_pixels": pixels} | at for scene, (_, pixels) in _EMPTINESS.items()
    ]
    return [*published_evidence().octrees.to_dict("records"), *more]


def _evidence(times: list[Row], work: list[Row], octrees: list[Row]) -> Evidence:
    columns = published_evidence().octrees.columns
    return Evidence(
        pd.DataFrame(times, columns=list(TIMES)),
        pd.DataFrame(work, columns=list(WORK)),
        pd.DataFrame(octrees, columns=columns),
    )


def _times() -> list[Row]:
    rows = []
    for scene in SCENES:
        for resolution, rays in RAYS.items():
            size = rays / 1e4
            for level in _BASE:
                rows += [
                    _time(scene, "beam", resolution, _beam(scene, level, objects, samples, size))
                    | {"level": level, "objects": objects, "samples": samples}
                    for objects in (0, 10, 20, 40)
                    for samples in (1, 5)
                ]
                net = 0.3 * size * (4.0 if level < 6 else 1.0) * _EMPTINESS.get(scene, (1.0,))[0]
                rows += [
                    _time(scene, contender, resolution, seconds * (6 if samples == 5 else 1))
                    | {"level": level, "samples": samples}
                    for contender, seconds in (("samet-net", net), ("samet", 1.1 * net))
                    for samples in (1, 5)
                ]
            grids = _GRIDS.get(scene, {32: 7 + 0.4 * size})
            rows += [
                _time(scene, "voxel-grid", resolution, seconds) | {"cells": cells}
                for cells, seconds in grids.items()
            ]
            rows += [
                _time(scene, hierarchy, resolution, factor * _hierarchy(scene, size))
                for hierarchy, factor in (
                    (HIERARCHY, 1),
                    (PAPER_HIERARCHY, 1),
                    (PLAIN_HIERARCHY, 1.2),
                )
            ]
    return rows


def _beam(scene: str, level: int, objects: int, samples: int, size: float) -> float:
    more = 1.2 if scene in ("tetera", "torre-eiffel") else 5.0
    slope = _SLOPE[level] * (1 + objects / 10) * (more if samples == 5 else 1)
    return _BASE[level] * _SCENE_BASE.get(scene, 1) + slope * size


def _hierarchy(scene: str, size: float) -> float:
    if scene == "escena1":
        return 20 + 2 * size
    return _HIERARCHY[scene] * size / 131 if scene in _HIERARCHY else 4 + 0.35 * size


def _time(scene: str, contender: str, resolution: str, seconds: float) -> Row:
    setting = {"scene": scene, "contender": contender, "resolution": resolution}
    numbers = {"level": 0, "objects": 0, "cells": 0, "samples": 1}
    figures = {"seconds": seconds, "low": 0.99 * seconds, "high": 1.01 * seconds}
    return {"table": ""} | setting | numbers | figures


def _work() -> list[Row]:
    printed = published_evidence().work
    rows = printed[~printed["quantity"].str.contains("seconds|share")].to_dict("records")
    rows += [row | {"contender": PAPER_HIERARCHY} for row in rows if row["contender"] == HIERARCHY]
    for index, scene in enumerate(SCENES):
        for level in (6, 7) if scene == "maceta" else (6,):
            beams = {6: 8701, 7: 37718}[level] + (0 if scene == "maceta" else 100 * index)
            inner = {6: 4071, 7: 17751}[level]
            seconds = {6: 1.5, 7: 38.0}[level] if scene == "maceta" else 0.5 + 0.02 * index
            rows += [
                _count(scene, level, "", "beams", beams),
                _count(scene, level, "", "beams_made", beams),
                _count(scene, level, "", "beams_occupied", 0.63 * beams),
            ]
            for resolution, rays in RAYS.items():
                each = {6: 0.275, 7: 0.187}[level] * rays / 1e4
                figures = {
                    "seconds_nonterminal": seconds,
                    "seconds_occupied": each,
                    "seconds_leaving": 1e-3,
                    "seconds_build": 1e-3,
                    "beams_nonterminal": inner,
                    "beam_clips": (seconds - 1e-6 * inner) / 1e-5,
                    "neighbor_searches": 1,
                    "beams_occupied": 0.63 * beams,
                    "samples_in_leaves": each * 1e5,
                    "rays_after_leaf": each * 5e3,
                    "primitive_tests": 10 * rays,
                    "traversal_steps": 30 * rays,
                }
                rows += [_count(scene, level, resolution, *figure) for figure in figures.items()]
    return rows + _pictures()


def _pictures() -> list[Row]:
    """Returns the rays of whole pictures by kind."""
    counts = {
        "eye_rays": 262144,
        "secondary_rays": 100000,
        "shadow_hidden": 5000,
        "shadow_cached_scan": 2500,
        "shadow_cached_beams": 3500,
    }
    return [
        _count(scene, 0, "", *count) | {"contender": PICTURE}
        for scene in SCENES
        for count in counts.items()
    ]


def _count(scene: str, level: int, resolution: str, quantity: str, value: float) -> Row:
    setting = {"scene": scene, "contender": "beam", "level": level, "resolution": resolution}
    figures = {"quantity": quantity, "value": value, "low": value, "high": value}
    return setting | {"objects": 0, "cells": 0, "samples": 1} | figures
