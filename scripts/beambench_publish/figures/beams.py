"""results/published/beams, beams-4k and beam-options: the thesis's beams beside single rays."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from beambench_publish.figures.cells import Cells

_LEVELS = ("6", "7", "8")
_THESIS, _HANDOVER = "0", "48"


def figures(folder: Path) -> dict[str, Any]:
    """How many times as fast the beams are as Samet's rays, by level and by option."""
    cells = Cells(folder)
    return {
        "scenes": cells.scenes,
        "sizes": cells.sizes,
        "cells": len(cells.rows),
        "wrong": len(cells.wrong),
        "repetitions": (cells.rows["repetitions"].min(), cells.rows["repetitions"].max()),
        "levels": _LEVELS,
        "by_level": _by_level(cells, _LEVELS),
        "own_best": {
            rays: {
                (scene, size): {
                    handover: _own_best(cells, rays, handover, scene=scene, size=size)
                    for handover in (_THESIS, _HANDOVER)
                }
                for size in cells.sizes
                for scene in cells.scenes
            }
            for rays in ("samet", "samet-net")
        },
        "finest": _finest(folder.parent / "beams-4k"),
        "options": _options(folder.parent / "beam-options"),
    }


def _by_level(cells: Cells, levels: tuple[str, ...]) -> dict[tuple[str, str], dict[str, Any]]:
    return {
        (scene, size): {
            level: {
                handover: cells.ratio(
                    f"samet:max_level={level}",
                    f"beam:max_level={level},handover={handover}",
                    scene=scene,
                    size=size,
                ).value
                for handover in (_THESIS, _HANDOVER)
            }
            for level in levels
        }
        for size in cells.sizes
        for scene in cells.scenes
    }


def _own_best(cells: Cells, rays: str, handover: str, **view: str) -> float:
    """Build and trace together, each at its best level."""

    def least(contender: str) -> float:
        rows = cells.having(contender, **view)
        return float(rows[rows["timed"]]["total_ms_median"].min())

    return least(rays) / least(f"beam:handover={handover}")


def _finest(folder: Path) -> dict[str, Any]:
    cells = Cells(folder)
    size = cells.sizes[0]
    return {
        "size": size,
        "scenes": cells.scenes,
        "by_level": _by_level(cells, ("7", "8")),
        "own_best": {
            rays: [
                _own_best(cells, rays, _HANDOVER, scene=scene, size=size) for scene in cells.scenes
            ]
            for rays in ("samet", "samet-net")
        },
    }


def _options(folder: Path) -> dict[str, Any]:
    cells = Cells(folder)

    def ratio(scene: str, samples: float, option: str) -> float | None:
        rows = cells.rows[(cells.rows["scene"] == scene) & (cells.rows["samples"] == samples)]
        samet = rows[rows["structure"] == "samet"].iloc[0]["trace_ms_median"]
        own = rows[rows["structure"] == "beam"]
        own = own[own["parameters"].str.contains(option, regex=False)]
        return None if own.empty else float(samet / own.iloc[0]["trace_ms_median"])

    plain = "continue=rays,share_corners=false"
    columns = {
        "1 sample: thesis": (1, plain),
        "`continue=beams`": (1, "continue=beams"),
        "5 samples: thesis": (5, plain),
        "`continue=beams`, 5 samples": (5, "continue=beams"),
        "`share_corners=true`, 5 samples": (5, "share_corners=true"),
    }
    return {
        "size": cells.sizes[0],
        "columns": list(columns),
        "ratios": {
            scene: [ratio(scene, *choice) for choice in columns.values()] for scene in cells.scenes
        },
    }
