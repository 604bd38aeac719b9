"""results/published/beams: the thesis's beams beside single rays."""

from pathlib import Path
from typing import Any

import pandas as pd

from beambench_operations.publish.figures.cells import Cells
from beambench_report.base.names import parameter_items

_LEVELS = ("6", "7", "8")
_THESIS, _HANDOVER = "0", "48"


def figures(folder: Path) -> dict[str, Any]:
    """Returns the speedup of the beams over Samet's rays, by level and by option."""
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
        "finest": _finest(folder / "finest.csv"),
        "options": _options(folder / "options.csv"),
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


def _finest(file: Path) -> dict[str, Any]:
    """The rows of an earlier run at the highest resolution."""
    rows = _with_parameters(file)
    scenes = list(dict.fromkeys(rows["scene"]))

    def least(scene: str, structure: str, column: str, **wanted: str) -> float:
        own = rows[(rows["scene"] == scene) & (rows["structure"] == structure)]
        chosen = own[own["chosen"].map(lambda chosen: wanted.items() <= chosen.items())]
        return float(chosen[column].min())

    def ratio(scene: str, level: str, handover: str) -> float:
        column = "trace_ms_median"
        return least(scene, "samet", column, max_level=level) / least(
            scene, "beam", column, max_level=level, handover=handover
        )

    def own_best(rays: str, scene: str) -> float:
        column = "total_ms_median"
        return least(scene, rays, column) / least(scene, "beam", column, handover=_HANDOVER)

    return {
        "size": "3840x2160",
        "by_level": {
            scene: {
                level: {
                    handover: ratio(scene, level, handover) for handover in (_THESIS, _HANDOVER)
                }
                for level in ("7", "8")
            }
            for scene in scenes
        },
        "own_best": {
            rays: [own_best(rays, scene) for scene in scenes] for rays in ("samet", "samet-net")
        },
    }


def _options(file: Path) -> dict[str, Any]:
    """The rows of an earlier run with the beams' options."""
    rows = _with_parameters(file)

    def ratio(scene: str, samples: int, **wanted: str) -> float | None:
        view = rows[(rows["scene"] == scene) & (rows["samples"] == samples)]
        samet = view[view["structure"] == "samet"].iloc[0]["trace_ms_median"]
        own = view[view["structure"] == "beam"]
        own = own[own["chosen"].map(lambda chosen: wanted.items() <= chosen.items())]
        return None if own.empty else float(samet / own.iloc[0]["trace_ms_median"])

    plain = {"continue": "rays", "share_corners": "false"}
    columns: dict[str, tuple[int, dict[str, str]]] = {
        "1 sample: thesis": (1, plain),
        "`continue=beams`": (1, {"continue": "beams"}),
        "5 samples: thesis": (5, plain),
        "`continue=beams`, 5 samples": (5, {"continue": "beams"}),
        "`share_corners=true`, 5 samples": (5, {"share_corners": "true"}),
    }
    return {
        "size": "640x480",
        "columns": list(columns),
        "ratios": {
            scene: [ratio(scene, samples, **wanted) for samples, wanted in columns.values()]
            for scene in dict.fromkeys(rows["scene"])
        },
    }


def _with_parameters(file: Path) -> pd.DataFrame:
    rows = pd.read_csv(file)
    return rows.assign(chosen=rows["parameters"].map(parameter_items))
