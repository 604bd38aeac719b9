"""results/published/thesis: rows of an earlier version that the texts still need."""

from pathlib import Path
from typing import Any

import pandas as pd

_THESIS, _NINE = "5", "9"
_GOOD_PERCENT = 10


def samplings(file: Path) -> dict[str, Any]:
    """Returns for each scene and method the setting with the time closest to the thesis's."""
    rows = pd.read_csv(file, dtype={"setting": str})
    return {scene: _nearest(rows[rows["scene"] == scene]) for scene in dict.fromkeys(rows["scene"])}


def _nearest(rows: pd.DataFrame) -> dict[str, Any]:
    uniform = rows[rows["method"] == "uniform"].set_index("setting")
    thesis = uniform.loc[_THESIS]
    distance = (rows["trace_ms"] - thesis["trace_ms"]).abs()
    nearest = rows.loc[distance.groupby(rows["method"]).idxmin()].set_index("method")
    return {
        "thesis": thesis,
        "nine": uniform.loc[_NINE],
        **{method: nearest.loc[method] for method in nearest.index},
    }


def chosen_levels(file: Path) -> dict[str, Any]:
    """Returns the time that max_level=auto loses to the best fixed level, by structure."""
    losses = pd.read_csv(file).groupby("structure", sort=False)["loss_percent"]
    return {
        structure: {
            "choices": len(own),
            "good": int((own < _GOOD_PERCENT).sum()),
            "median": float(own.median()),
            "worst": float(own.max()),
        }
        for structure, own in losses
    }
