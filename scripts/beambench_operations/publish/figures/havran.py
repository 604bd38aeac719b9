"""results/published/havran: Samet's traversal over TETRA, ours and Havran's."""

from pathlib import Path
from typing import Any

from beambench_report.havran.counts import PUBLISHED, read_counts

_STRUCTURE, _SCENE = "Samet 1989, center", "tetra"


def figures(folder: Path) -> dict[str, Any]:
    """The quantities of each depth: ours, then his."""
    ours, his = read_counts(folder / "counts.csv"), read_counts(PUBLISHED)
    return {
        "depths": {
            case.setting.removeprefix("depth "): (ours[case], quantities)
            for case, quantities in his.items()
            if (case.structure, case.scene) == (_STRUCTURE, _SCENE)
        }
    }
