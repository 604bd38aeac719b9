"""Verifies the committed rows again, and lists differences from the current program.

Each view of the published runs is traced once by each of its contenders. Times are not compared.
"""

import json
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pandas as pd

from beambench_report.base.columns import RENAMED_COLUMNS
from beambench_report.base.files import Problem, load_json, output_of, say, write_text
from beambench_report.base.records import ERROR, NO_RAYS, UNSUPPORTED

CLASSES = ("agree", "tie", "graze", "structure_error", "embree_error")
_VIEW = ["scene", "camera", "resolution", "samples", "ray_kind"]
_OTHER_LIBRARIES = ("embree-4", "libraries")
"""Folders whose hits come from libraries that this build does not have."""


def committed(published: Path) -> dict[tuple, pd.DataFrame]:
    """Returns the rows of each view of all committed runs; if several have a cell, the last row.

    The columns `resolution` and `contender` (as for the option --accel) are added.
    """
    rows = pd.concat(
        pd.read_csv(path, dtype=str, keep_default_na=False).rename(columns=RENAMED_COLUMNS)
        for path in sorted(published.rglob("results.csv"))
        if not {*path.relative_to(published).parts} & {*_OTHER_LIBRARIES}
    )
    rows = rows[~rows["verdict"].isin((NO_RAYS, UNSUPPORTED, ERROR))]
    rows = rows.assign(
        resolution=rows["width"] + "x" + rows["height"],
        samples=rows["samples"].astype(int),
        contender=(rows["structure"] + ":" + rows["parameters"]).str.rstrip(":"),
    )
    rows["rays_hash"] = rows.groupby(_VIEW)["rays_hash"].transform("first")
    return dict(iter(rows.drop_duplicates([*_VIEW, "contender"], keep="last").groupby(_VIEW)))


def verify_again(published: Path, beambench: Path, record: Path) -> list[dict[str, Any]]:
    """Verifies each view; returns the findings in the order of the views.

    `record` receives a line for each finished view; the views in it are not verified again.
    """
    done = {line["view"]: line for line in _lines(record)}
    views = {", ".join(map(str, view)): rows for view, rows in committed(published).items()}
    record.parent.mkdir(parents=True, exist_ok=True)
    for number, (title, rows) in enumerate(views.items(), 1):
        if title in done:
            continue
        say(f"[{number}/{len(views)}] {title}")
        line: dict[str, Any] = {"view": title, "verified": 0, "cells": []}
        try:
            line |= _compared(rows, _verified(title, rows, beambench))
        except Problem as problem:  # for example, a mesh that is not registered here
            line["problem"] = str(problem)
        with record.open("a", encoding="utf-8") as file:
            file.write(json.dumps(line) + "\n")
        done[title] = line
    return [done[title] for title in views]


def summary(lines: list[dict[str, Any]], commit: str) -> dict[str, Any]:
    """Returns the hashes, verdicts and classes that differ from the committed ones."""
    kinds: dict[str, dict[str, int]] = defaultdict(lambda: {"views": 0, "hashes_changed": 0})
    for line in lines:
        kind = kinds[line["view"].rsplit(", ", 1)[1]]
        kind["views"] += 1
        kind["hashes_changed"] += "hash" in line
    cells = [{"view": line["view"], **cell} for line in lines for cell in line["cells"]]
    return {
        "commit": commit,
        "views": len(lines),
        "cells": sum(line["verified"] for line in lines),
        "not_verified": {one["view"]: one["problem"] for one in lines if "problem" in one},
        "ray_kinds": dict(sorted(kinds.items())),
        "verdicts_changed": [one for one in cells if _is_new_verdict(one)],
        "classes_changed": [one for one in cells if not _is_new_verdict(one)],
        "hashes_changed": [
            {"view": line["view"], **line["hash"]} for line in lines if "hash" in line
        ],
    }


def write_summary(path: Path, lines: list[dict[str, Any]], commit: str) -> Path:
    """Writes the summary as JSON."""
    return write_text(path, json.dumps(summary(lines, commit), indent=1) + "\n")


def _is_new_verdict(cell: dict[str, Any]) -> bool:
    return bool(cell["before"]["verdict"] != cell["now"]["verdict"])


def _lines(record: Path) -> Iterator[dict[str, Any]]:
    """Yields the findings of an interrupted run; an incomplete line is skipped."""
    if not record.is_file():
        return
    for line in record.read_text("utf-8").splitlines():
        try:
            yield json.loads(line)
        except json.JSONDecodeError:
            return


def _verified(title: str, rows: pd.DataFrame, beambench: Path) -> list[dict[str, Any]]:
    view = rows.iloc[0]
    with TemporaryDirectory() as folder:
        found = Path(folder) / "verified.json"
        output_of(
            [
                *(str(beambench), "verify", view["scene"], "--camera", view["camera"]),
                *("--resolution", view["resolution"], "--samples", str(view["samples"])),
                *("--rays", view["ray_kind"], "--accel", ",".join(rows["contender"])),
                *("--json", str(found)),
            ],
            success=(0, 1),
        )
        cells: list[dict[str, Any]] = load_json(found)["cells"]
    if len(cells) != len(rows):
        raise Problem(f"{title}: {len(cells)} of {len(rows)} cells were verified")
    return cells


def _compared(rows: pd.DataFrame, cells: list[dict[str, Any]]) -> dict[str, Any]:
    """Returns the differences. Counts of classes are compared only if the rays are the same."""
    rays_hash = rows["rays_hash"].iloc[0]
    now_hash = next((cell["rays_hash"] for cell in cells if "rays_hash" in cell), rays_hash)
    same_rays = now_hash == rays_hash
    keys = ("verdict", *CLASSES) if same_rays else ("verdict",)
    changed = []
    # The program verifies the exhaustive search first, the others in their order.
    order = sorted(rows.to_dict("records"), key=lambda row: row["structure"] != "exhaustive")
    for row, cell in zip(order, cells, strict=True):
        before = {"verdict": row["verdict"], **{name: int(row[name]) for name in CLASSES}}
        now = {name: cell[name] for name in before if name in cell}
        if any(before[key] != now.get(key) for key in keys):
            changed.append({"contender": row["contender"], "before": before, "now": now})
    line: dict[str, Any] = {"verified": len(cells), "cells": changed}
    if not same_rays:
        line["hash"] = {"before": rays_hash, "now": now_hash}
    return line
