"""results/published/nightly: one night, and how often nights raise a false alarm."""

from pathlib import Path
from typing import Any

from beambench_operations.publish.figures.cells import Cells
from beambench_report.base.files import Problem, read_json
from beambench_report.base.machine import read_manifest


def figures(folder: Path) -> dict[str, Any]:
    """Returns the night's cells and time, and the calibration."""
    cells = Cells(folder)
    manifest = read_manifest(folder)
    if manifest is None or manifest.seconds is None:
        raise Problem(f"{folder}/manifest.json: does not state how long the night took")
    return {
        "cells": len(cells.rows),
        "wrong": len(cells.wrong),
        "seconds": manifest.seconds,
        "calibration": _calibration(folder / "calibration.json"),
    }


def _calibration(file: Path) -> dict[str, Any]:
    source = read_json(file)
    if not isinstance(source, dict):
        raise Problem(f"{file}: there is no calibration; restore it with git")
    return source | {"found": {one["slowdown"]: one for one in source["power"]}}
