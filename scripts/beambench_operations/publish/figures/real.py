"""results/published/real: every structure over real meshes."""

from pathlib import Path
from typing import Any

import pandas as pd
from scipy.stats import gmean

from beambench_operations.publish.figures.cells import Cells
from beambench_report.base.files import read_table
from beambench_report.base.names import parameter_items
from beambench_report.run.winners import with_ratios

_WATERTIGHT = "embree, watertight"


def figures(folder: Path) -> dict[str, Any]:
    """Returns geometric means of the times relative to the fastest, the cameras, and the large
    scene.
    """
    cells = Cells(folder)
    kinds = list(dict.fromkeys(cells.rows["kind"]))
    means = {kind: _means(cells, kind) for kind in kinds}
    embree = {
        kind: min((value, name) for name, value in own["mean"].items() if _is_embree(name))
        for kind, own in means.items()
    }
    columns = ("seconds", "peak_kib")
    large = read_table(folder / "large.csv", columns, "restore it with git").iloc[0]
    others = [name for name in means[kinds[0]]["mean"] if not _is_embree(name)]
    return {
        "kinds": kinds,
        "scenes": cells.scenes,
        "size": cells.sizes[0],
        "cells": len(cells.rows),
        "about_backs": cells.about_backs,
        "wrong": len(cells.wrong),
        "mean": {kind: own["mean"] for kind, own in means.items()},
        "wins": {kind: own["wins"] for kind, own in means.items()},
        "embree": embree,
        "watertight": _WATERTIGHT,
        "tile_beam": next(name for name in others if name.split()[0] == "tile-beam"),
        "others": sorted(others, key=lambda name: means[kinds[0]]["mean"][name]),
        "few": float((cells.rows["repetitions"] < 6).mean()),
        "cameras": _cameras(folder / "cameras.csv"),
        "large": {"seconds": large["seconds"], "gib": large["peak_kib"] / 1024**2},
    }


def _is_embree(name: str) -> bool:
    return name.startswith("embree ")


def _name(row: pd.Series) -> str:
    own = parameter_items(row["parameters"])
    if row["structure"] == "embree" and own.get("robust") == "true":
        return _WATERTIGHT
    return str(row["contender"])


def _means(cells: Cells, kind: str) -> dict[str, dict]:
    timed = cells.having(kind=kind).query("timed")
    timed = timed.assign(name=timed.apply(_name, axis=1))
    views = (with_ratios(own, cells.files) for _, own in timed.groupby("scene", sort=False))
    ranked = pd.concat(views)
    return {
        "mean": ranked.groupby("name")["ratio"].agg(gmean).to_dict(),
        "wins": ranked[ranked["is_tied"]].groupby("name").size().to_dict(),
    }


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
