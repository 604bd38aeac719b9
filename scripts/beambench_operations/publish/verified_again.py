"""Verifies the committed rows again, and lists what differs with the present program.

Each view of the published runs is traced once by each of its contenders. Times are not compared.
"""

import csv
import json
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from beambench_report.base.files import Problem, load_json, output_of, say, write_text

CLASSES = ("agree", "tie", "graze", "structure_error", "embree_error")
_OTHER_LIBRARIES = ("embree-4", "libraries")
"""Folders whose hits come from libraries that this build does not have."""


@dataclass(frozen=True, order=True)
class View:
    """The scene, camera and rays that some rows share."""

    scene: str
    camera: str
    resolution: str
    samples: int
    rays: str

    def title(self) -> str:
        """Returns the view in words."""
        return f"{self.scene}, {self.camera}, {self.resolution}, {self.samples}, {self.rays}"


@dataclass
class Committed:
    """The rows of a view: its hash, and by contender the verdict and the counts of classes."""

    rays_hash: str
    contenders: dict[str, dict[str, Any]] = field(default_factory=dict)


def committed(published: Path) -> dict[View, Committed]:
    """Returns the views of all committed runs; of a cell that several runs have, the last row."""
    views: dict[View, Committed] = {}
    for path in sorted(published.rglob("results.csv")):
        if path.relative_to(published).parts[0] in _OTHER_LIBRARIES:
            continue
        for row in _rows(path):
            if row["verdict"] in ("no_rays", "unsupported", "error"):
                continue
            view = View(
                row["scene"],
                row["camera"],
                f"{row['width']}x{row['height']}",
                int(row["samples"]),
                row["ray_kind"],
            )
            found = views.setdefault(view, Committed(row["rays_hash"]))
            found.contenders[_contender(row)] = {
                "verdict": row["verdict"],
                **{name: int(row[name]) for name in CLASSES},
            }
    return dict(sorted(views.items()))


def verify_again(published: Path, beambench: Path, record: Path) -> list[dict[str, Any]]:
    """Verifies each view; returns what was found of each, in the order of the views.

    `record` gets a line for each view when it is done; views that it has are not verified again.
    """
    done = {line["view"]: line for line in _lines(record)}
    views = committed(published)
    for number, (view, rows) in enumerate(views.items(), 1):
        if view.title() in done:
            continue
        say(f"[{number}/{len(views)}] {view.title()}")
        line: dict[str, Any] = {"view": view.title(), "verified": 0, "cells": []}
        try:
            line |= _compared(rows, _verified(view, rows, beambench))
        except Problem as problem:  # a mesh that is not here
            line["problem"] = str(problem)
        record.parent.mkdir(parents=True, exist_ok=True)
        with record.open("a", encoding="utf-8") as file:
            file.write(json.dumps(line) + "\n")
        done[view.title()] = line
    return [done[view.title()] for view in views]


def summary(lines: list[dict[str, Any]], commit: str) -> dict[str, Any]:
    """Returns what is committed: the hashes, verdicts and classes that differ."""
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


def _rows(path: Path) -> Iterator[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            if "engine_error" in row:  # the column's first name
                row["structure_error"] = row["engine_error"]
            yield row


def _is_new_verdict(cell: dict[str, Any]) -> bool:
    return bool(cell["before"]["verdict"] != cell["now"]["verdict"])


def _contender(row: dict[str, Any]) -> str:
    return ":".join(text for text in (row["structure"], row["parameters"]) if text)


def _lines(record: Path) -> Iterator[dict[str, Any]]:
    """Yields the findings of an interrupted run; an incomplete line is left out."""
    if not record.is_file():
        return
    for line in record.read_text("utf-8").splitlines():
        try:
            yield json.loads(line)
        except json.JSONDecodeError:
            return


def _verified(view: View, rows: Committed, beambench: Path) -> list[dict[str, Any]]:
    with TemporaryDirectory() as folder:
        found = Path(folder) / "verified.json"
        output_of(
            [
                *(str(beambench), "verify", view.scene, "--camera", view.camera),
                *("--resolution", view.resolution, "--samples", str(view.samples)),
                *("--rays", view.rays, "--accel", ",".join(rows.contenders)),
                *("--json", str(found)),
            ],
            success=(0, 1),
        )
        report = load_json(found)
    cells: list[dict[str, Any]] = report["cells"]
    if len(cells) != len(rows.contenders):
        raise Problem(f"{view.title()}: {len(cells)} of {len(rows.contenders)} cells were verified")
    return cells


def _compared(rows: Committed, cells: list[dict[str, Any]]) -> dict[str, Any]:
    """Returns what differs. Counts of classes are compared only where the rays are the same."""
    now_hash = next((cell["rays_hash"] for cell in cells if "rays_hash" in cell), rows.rays_hash)
    same_rays = now_hash == rows.rays_hash
    changed = []
    # The program verifies the exhaustive search first, the others in their order.
    order = sorted(rows.contenders, key=lambda each: not each.startswith("exhaustive"))
    for contender, cell in zip(order, cells, strict=True):
        before = rows.contenders[contender]
        now = {name: cell[name] for name in ("verdict", *CLASSES) if name in cell}
        keys = ("verdict", *CLASSES) if same_rays else ("verdict",)
        if any(before[key] != now.get(key) for key in keys):
            changed.append({"contender": contender, "before": before, "now": now})
    line: dict[str, Any] = {"verified": len(cells), "cells": changed}
    if not same_rays:
        line["hash"] = {"before": rows.rays_hash, "now": now_hash}
    return line
