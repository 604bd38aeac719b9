"""Table 5.1: the polygons and spheres of each scene, the thesis's beside ours."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd

from beambench_report.ledger.published import FOLDER
from beambench_report.thesis.printed import scene_title
from beambench_report.thesis.section import Column, Field, Section, SectionTable
from beambench_report.thesis.texts import DASH

_KINDS = ("polygons", "spheres", "cones")


def scene_file(directory: Path, scene: str) -> Path:
    """What `beambench scene NAME --json` printed."""
    return directory / "scenes" / f"{scene}.json"


def scenes_section(directory: Path) -> Section | None:
    """Table 5.1 with our counts; None where no scene was counted."""
    printed = pd.read_csv(FOLDER / "scenes.csv").to_dict("records")
    counted = {row["scene"]: _counts(scene_file(directory, row["scene"])) for row in printed}
    if not any(counted.values()):
        return None
    columns = (
        Column("scene", False),
        *(Column(f"{kind}, {whose}") for kind in _KINDS[:2] for whose in ("thesis", "ours")),
        Column("cones, ours"),
    )
    rows = []
    for row in printed:
        own = counted[row["scene"]]
        texts = [scene_title(row["scene"])]
        for kind in _KINDS[:2]:
            texts += [f"{row[kind]:,}", f"{own[kind]:,}" if own else DASH]
        texts.append(f"{own['cones']:,}" if own else DASH)
        rows.append(tuple(Field(text) for text in texts))
    known = {row["scene"]: row for row in printed if counted[row["scene"]]}
    other = [
        scene_title(scene)
        for scene, row in known.items()
        if any(counted[scene][kind] != row[kind] for kind in _KINDS[:2]) or counted[scene]["cones"]
    ]
    return Section(
        "scenes",
        "Table 5.1: the scenes",
        (
            "The files of the thesis's scenes are lost. Ours are stand-ins with their names and "
            "their numbers of primitives; shapes, cameras, lights and surfaces are beambench's.",
        ),
        (SectionTable("Primitives", columns, tuple(rows)),),
        findings=(
            f"{len(known) - len(other)} of {len(known)} scenes have the thesis's numbers"
            + (f"; others: {', '.join(other)}." if other else "."),
        ),
    )


def _counts(path: Path) -> dict[str, int] | None:
    try:
        source = json.loads(path.read_text("utf-8"))
        return {kind: int(source[kind]) for kind in _KINDS}
    except (OSError, ValueError, KeyError, TypeError):
        return None
