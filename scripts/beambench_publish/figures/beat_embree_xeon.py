"""results/published/beat-embree-xeon: images by tile beams and Embree on another machine."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from beambench_publish.figures.comparison import figures_of, read_pairings


def figures(folder: Path) -> dict[str, Any]:
    """The groups of scenes with their ratios."""
    return figures_of(read_pairings(folder, ["main"]))
