"""results/published/thesis-earlier: samples per pixel."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from beambench_report.base.files import Problem, read_json


def figures(folder: Path) -> dict[str, Any]:
    """Of each scene, the setting of each method that comes nearest to the thesis's time."""
    files = sorted((folder / "sampling").glob("*.json"))
    return {
        "sampling": {file.stem: _nearest(file) for file in files},
    }


_THESIS, _NINE = "5", "9"


def _nearest(file: Path) -> dict[str, Any]:
    source = read_json(file)
    if not isinstance(source, dict):
        raise Problem(f"{file}: is no comparison of samplings; restore it with git")
    results = source["results"]
    uniform = {one["setting"]: one for one in results if one["method"] == "uniform"}
    thesis = uniform[_THESIS]

    def nearest(method: str) -> dict[str, Any]:
        own = [one for one in results if one["method"] == method]
        return min(own, key=lambda one: abs(one["trace_ms"] - thesis["trace_ms"]))

    return {
        "thesis": thesis,
        "nine": uniform[_NINE],
        **{method: nearest(method) for method in sorted({r["method"] for r in results})},
    }
