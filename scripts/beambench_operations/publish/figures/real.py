"""results/published/real: every structure over real meshes."""

from pathlib import Path
from typing import Any

import pandas as pd
from scipy.stats import gmean

from beambench_operations.publish.figures.cells import Cells
from beambench_report.base.files import read_table
from beambench_report.run.winners import with_ratios

_STREAMS = "sah-bvh builder=spatial"


def figures(folder: Path) -> dict[str, Any]:
    """Returns geometric means of the times relative to the fastest, the cameras, and the large
    scene.
    """
    cells = Cells(folder)
    kinds = list(dict.fromkeys(cells.rows["kind"]))
    means = {kind: _means(cells, kind) for kind in kinds}
    columns = ("seconds", "peak_kib")
    large = read_table(folder / "large.csv", columns, "restore it with git").iloc[0]
    others = list(means[kinds[0]]["mean"])
    return {
        "kinds": kinds,
        "scenes": cells.scenes,
        "size": cells.sizes[0],
        "cells": len(cells.rows),
        "wrong": len(cells.wrong),
        "mean": {kind: own["mean"] for kind, own in means.items()},
        "wins": {kind: own["wins"] for kind, own in means.items()},
        "embree": {
            "at its best": {kind: own["embree"] for kind, own in means.items()},
            "watertight": {kind: own["watertight"] for kind, own in means.items()},
        },
        "streams": _STREAMS,
        "tile_beam": next(name for name in others if name.split()[0] == "tile-beam"),
        "others": sorted(others, key=lambda name: means[kinds[0]]["mean"][name]),
        "cameras": _cameras(folder / "cameras.csv"),
        "large": {"seconds": large["seconds"], "gib": large["peak_kib"] / 1024**2},
    }


def _means(cells: Cells, kind: str) -> dict[str, Any]:
    """Returns means over the scenes and wins by contender, and Embree's means in the fastest mode
    of each scene.
    """
    timed = cells.having(kind=kind).query("timed")
    views = (with_ratios(own, cells.files) for _, own in timed.groupby("scene", sort=False))
    ranked = pd.concat(views)
    is_embree = ranked["structure"] == "embree"
    embree, others = ranked[is_embree], ranked[~is_embree]
    is_watertight = embree["contender"].str.contains("robust=true")
    return {
        "mean": others.groupby("contender")["ratio"].agg(gmean).to_dict(),
        "wins": others[others["is_tied"]].groupby("contender").size().to_dict(),
        "embree": _fastest(embree),
        "watertight": _fastest(embree[is_watertight]),
    }


def _fastest(rows: pd.DataFrame) -> dict[str, Any]:
    best = rows.loc[rows.groupby("scene")["ratio"].idxmin()]
    return {"mean": float(gmean(best["ratio"])), "wins": int(best["is_tied"].sum())}


def _cameras(file: Path) -> dict[str, Any]:
    columns = ("scene", "camera", "structure", "verdict", "rays", "graze", "structure_error")
    table = read_table(file, columns, "restore it with git", {"structure": str})
    table = table[table["structure"].fillna("null") != "null"]
    wrong = table[table["verdict"] != "ok"]
    return {
        "views": len(table.drop_duplicates(["scene", "camera"])),
        "cells": len(table),
        "ok": int((table["verdict"] == "ok").sum()),
        "rays": int(table["rays"].sum()),
        "errors": int(table["structure_error"].sum()),
        "grazes": int(table["graze"].sum()),
        "wrong": wrong.to_dict("records"),
    }
