"""Verifies all structures over every mesh that has a recipe, from every camera.

usage: PYTHONPATH=scripts python -m beambench_meshes.every_camera PROGRAM OUTPUT.csv

PROGRAM is beambench. Cameras are those of the recipe, or else fitted to the mesh. The output has a
row for each mesh, camera, ray kind and structure, as in `beambench verify --json`.
"""

from __future__ import annotations

import csv
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from beambench_meshes.recipes import RECIPES
from beambench_report.base.formulas import guarded

_RAYS = "primary,shadow,ao:samples=2,path:bounces=2"
_SIZE = "160x120"
_COUNTS = ("rays", "hits", "agree", "tie", "graze", "structure_error", "embree_error")
_COLUMNS = ("scene", "camera", "ray_kind", "structure", "parameters", "verdict", *_COUNTS)


_FITTED = ("three-quarter", "front", "side", "top")


def views() -> list[tuple[str, str]]:
    """Returns the mesh and camera of each view."""
    return [
        (recipe.name, camera)
        for recipe in RECIPES
        for camera in [camera.name for camera in recipe.cameras] or _FITTED
    ]


def _cells(program: str, mesh: str, camera: str) -> Iterator[dict[str, object]]:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "verified.json"
        command = [program, "verify", f"mesh:{mesh}", "--camera", camera, "--accel", "all"]
        options = ["--rays", _RAYS, "--resolution", _SIZE, "--json", str(file)]
        done = subprocess.run([*command, *options], capture_output=True, text=True, check=False)
        if not file.exists():
            sys.exit(done.stderr)
        for cell in json.loads(file.read_text("utf-8"))["cells"]:
            yield {**cell, "camera": camera}


def main() -> int:
    """Writes the rows. Returns the exit code: 2 for invalid arguments, 0 even if hits are wrong."""
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    program, output = sys.argv[1:]
    every = views()
    pending = Path(f"{output}.pending")
    with pending.open("w", encoding="utf-8", newline="") as table:
        rows = csv.DictWriter(table, _COLUMNS, extrasaction="ignore", lineterminator="\n")
        rows.writeheader()
        for number, (mesh, camera) in enumerate(every, 1):
            print(f"[{number}/{len(every)}] mesh:{mesh}, {camera}", flush=True)
            for cell in _cells(program, mesh, camera):
                rows.writerow({name: guarded(value) for name, value in cell.items()})
    pending.rename(output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
