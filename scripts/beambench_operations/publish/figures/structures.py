"""results/published/structures: which structure wins where."""

from pathlib import Path
from typing import Any

import pandas as pd
from scipy.stats import gmean

from beambench_operations.publish.figures.cells import Cells
from beambench_report.run.winners import races

_KINDS = ("primary", "shadow", "diffuse")
_NOT_OLDER = ("embree", "tile-beam", "sah-bvh", "kd-tree", "beam", "grid-beam")
"""Modern structures, and beams, which do not trace rays one by one."""


def figures(folder: Path) -> dict[str, Any]:
    """Returns the mean over the scenes and the wins of each structure, by ray kind."""
    cells = Cells(folder)
    found = races(cells.rows, cells.files)
    by_kind = {kind: [race for race in found if race.ray_kind == kind] for kind in _KINDS}
    best = {
        kind: pd.concat([race.ranked for race in races_])
        .groupby("structure")
        .agg(mean=("ratio", gmean), scenes=("ratio", "size"), wins=("is_tied", "sum"))
        .to_dict("index")
        for kind, races_ in by_kind.items()
    }
    order = sorted(best["primary"], key=lambda name: best["primary"][name]["mean"])
    wrong = cells.wrong
    return {
        "best": best,
        "order": order,
        "scenes": {kind: len(races_) for kind, races_ in by_kind.items()},
        "views": len(found),
        "undecided": sum(not race.is_decided for race in found),
        "cells": len(cells.rows),
        "wrong": wrong.to_dict("records"),
        "older": [name for name in order if name not in _NOT_OLDER],
        "size": cells.sizes[0],
    }
