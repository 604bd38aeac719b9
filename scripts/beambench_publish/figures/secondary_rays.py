"""results/published/secondary-rays: shadow and reflection rays alone."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from beambench_publish.figures.cells import Cells
from beambench_publish.figures.net_ratios import net_ratios

_CONTENDERS = {
    "Embree, 16 at a time": "embree:mode=packet16",
    **{name: name for name in ("sah-bvh", "goldsmith-salmon", "voxel-grid", "samet-net", "samet")},
}


def figures(folder: Path) -> dict[str, Any]:
    """Ratios to Embree's single rays."""
    cells = Cells(folder)
    return {
        "scenes": cells.scenes,
        "size": cells.sizes[0],
        "ratios": net_ratios(cells, "embree:mode=single", _CONTENDERS),
    }
