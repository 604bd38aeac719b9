"""Whole pictures whose rays were counted by kind, as figures of the claims.

A folder of censuses holds two files that `beambench census --json` printed, of the same scenes:
`scan.json`, pixels shaded one after the other along the rows, and `beams.json`, beam by beam, each
with one shadow cache for the picture (`--shadows cache --order scan` and `--order beams`).
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pandas as pd

from beambench_report.ledger.evidence import PICTURE, WORK
from beambench_report.ledger.published import primitives_by_scene
from beambench_report.problem import Problem

ORDERS = ("scan", "beams")
"""In which pixels are shaded; a file each."""


def is_census_folder(folder: Path) -> bool:
    """Does it hold both files?"""
    return all(census_file(folder, order).exists() for order in ORDERS)


def census_file(folder: Path, order: str) -> Path:
    """`FOLDER/scan.json`."""
    return folder / f"{order}.json"


def census_work(folder: Path) -> pd.DataFrame:
    """Rows of `evidence.WORK`: rays by kind, and the hidden shadow rays that the cache knew.

    Raises Problem where a file is not what `beambench census --json` prints.
    """
    rows: list[dict[str, object]] = []
    for order in ORDERS:
        for scene, counts in _scenes(census_file(folder, order), order).items():
            quantities = {f"shadow_cached_{order}": counts["shadow_cached"]}
            if order == ORDERS[0]:
                quantities |= {
                    "eye_rays": counts["eye_rays"],
                    "secondary_rays": counts["reflected_rays"] + counts["refracted_rays"],
                    "shadow_hidden": counts["shadow_hidden"],
                }
            rows += [_row(scene, name, float(count)) for name, count in quantities.items()]
    return pd.DataFrame(rows, columns=list(WORK))


def _scenes(path: Path, order: str) -> dict[str, dict[str, Any]]:
    """The thesis's scenes in a file, by their plain names."""
    try:
        source = json.loads(path.read_text("utf-8"))
        if (source["shadows"], source["order"]) != ("cache", order):
            raise ValueError(f"not counted with --shadows cache --order {order}")
        named = {str(entry["scene"]).split(":")[0]: entry for entry in source["scenes"]}
        return {scene: named[scene] for scene in primitives_by_scene() if scene in named}
    except (ValueError, KeyError, TypeError, OSError) as error:
        raise Problem(f"{path}: is not what `beambench census --json` prints ({error})") from None


def _row(scene: str, quantity: str, value: float) -> dict[str, object]:
    setting = {"scene": scene, "contender": PICTURE, "level": 0, "objects": 0, "cells": 0}
    figures = {"quantity": quantity, "value": value, "low": value, "high": value}
    return setting | {"resolution": "", "samples": 1} | figures
