"""results/published/havran: Samet's traversal over TETRA, ours and Havran's."""

from pathlib import Path
from typing import Any

from beambench_report.havran.counts import PUBLISHED, read_counts

_STRUCTURE, _SCENE = "Samet 1989, center", "tetra"


def figures(folder: Path) -> dict[str, Any]:
    """Returns the quantities of each depth: ours, then Havran's."""
    ours, his = read_counts(folder / "counts.csv"), read_counts(PUBLISHED)
    return {
        "depths": {
            setting.removeprefix("depth "): (ours.loc[_STRUCTURE, _SCENE, setting], quantities)
            for setting, quantities in his.loc[_STRUCTURE, _SCENE].iterrows()
        }
    }
