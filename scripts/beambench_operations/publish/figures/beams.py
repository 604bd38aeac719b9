"""results/published/beams: the thesis's beams compared with single rays."""

from pathlib import Path
from typing import Any

import pandas as pd

from beambench.analysis import Ratio
from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.formats import is_ahead, is_behind
from beambench_report.base.cell_files import ratio_of
from beambench_report.base.names import parameter_items

_LEVELS = ("6", "7", "8")
_THESIS, _HANDOVER = "0", "48"


def figures(folder: Path) -> dict[str, Any]:
    """Returns the speedup of the beams over Samet's rays, by level and by option."""
    cells = Cells(folder)
    by_level = _by_level(cells, _LEVELS)
    handed_over = [by[_HANDOVER] for own in by_level.values() for by in own.values()]
    return {
        "scenes": cells.scenes,
        "sizes": cells.sizes,
        "cells": len(cells.rows),
        "wrong": len(cells.wrong),
        "blocks": (cells.rows["blocks"].min(), cells.rows["blocks"].max()),
        "levels": _LEVELS,
        "by_level": by_level,
        "all": len(handed_over),
        "won": sum(map(is_ahead, handed_over)),
        "lost": sum(map(is_behind, handed_over)),
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
                )
                for handover in (_THESIS, _HANDOVER)
            }
            for level in levels
        }
        for size in cells.sizes
        for scene in cells.scenes
    }


def _own_best(cells: Cells, rays: str, handover: str, **view: str) -> Ratio:
    """Returns the ratio of total times (build and trace), each contender at its best level."""

    def best(contender: str) -> pd.Series:
        rows = cells.having(contender, **view)
        return rows.loc[rows.loc[rows["timed"], "total_ms"].idxmin()]

    return ratio_of("total", best(rays), best(f"beam:handover={handover}"), cells.files)


def _finest(file: Path) -> dict[str, Any]:
    """Returns the beams' speedups in an earlier run at the highest resolution."""
    rows = _with_parameters(file)
    scenes = list(dict.fromkeys(rows["scene"]))
    settings = ["structure", "scene", "max_level", "handover"]
    trace = rows.groupby(settings)["trace_ms_median"].min()
    of_handover = rows[(rows["structure"] != "beam") | (rows["handover"] == _HANDOVER)]
    total = of_handover.groupby(["structure", "scene"])["total_ms_median"].min()
    return {
        "size": "3840x2160",
        "by_level": {
            scene: {
                level: {
                    handover: trace["samet", scene, level, ""]
                    / trace["beam", scene, level, handover]
                    for handover in (_THESIS, _HANDOVER)
                }
                for level in ("7", "8")
            }
            for scene in scenes
        },
        "own_best": {
            rays: [total[rays, scene] / total["beam", scene] for scene in scenes]
            for rays in ("samet", "samet-net")
        },
    }


def _options(file: Path) -> dict[str, Any]:
    """Returns the speedups of the beams' options in an earlier run."""
    rows = _with_parameters(file)

    def ratio(scene: str, samples: int, wanted: dict[str, str]) -> float | None:
        view = rows[(rows["scene"] == scene) & (rows["samples"] == samples)]
        samet, beams = (view[view["structure"] == name] for name in ("samet", "beam"))
        own = beams.loc[
            (beams[list(wanted)] == pd.Series(wanted)).all(axis="columns"), "trace_ms_median"
        ]
        return None if own.empty else float(samet["trace_ms_median"].iloc[0] / own.iloc[0])

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
            scene: [ratio(scene, samples, wanted) for samples, wanted in columns.values()]
            for scene in dict.fromkeys(rows["scene"])
        },
    }


def _with_parameters(file: Path) -> pd.DataFrame:
    """Returns the rows with a column for each parameter; empty if a structure lacks it."""
    rows = pd.read_csv(file)
    chosen = pd.DataFrame(rows["parameters"].map(parameter_items).tolist(), rows.index)
    return rows.join(chosen.fillna(""))
