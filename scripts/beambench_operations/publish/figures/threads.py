"""results/published/threads: one thread and two."""

from pathlib import Path
from typing import Any

from beambench_operations.publish.figures.cells import Cells


def figures(folder: Path) -> dict[str, Any]:
    """Returns the speedup of two threads over one, by scene and structure."""
    one, two = Cells(folder / "1"), Cells(folder / "2")
    gain = {
        name: {
            scene: one.row(name, scene=scene)["trace_ms_median"]
            / two.row(name, scene=scene)["trace_ms_median"]
            for scene in one.scenes
        }
        for name in dict.fromkeys(one.rows["structure"])
    }
    classic = [gain[name].values() for name in gain if name not in ("beam", "tile-beam")]
    flat = [value for own in classic for value in own]
    return {
        "scenes": one.scenes,
        "size": one.sizes[0],
        "gain": gain,
        "range": {
            "beam": (min(gain["beam"].values()), max(gain["beam"].values())),
            "tile_beam": (min(gain["tile-beam"].values()), max(gain["tile-beam"].values())),
            "others": (min(flat), max(flat)),
        },
        "tile_beam_ms": [
            one.row("tile-beam", scene=scene)["trace_ms_median"] for scene in one.scenes
        ],
    }
