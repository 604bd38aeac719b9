"""results/published/threads: one thread and two."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from beambench.analysis import Ratio
from beambench_operations.publish.figures.cells import Cells
from beambench_operations.publish.figures.formats import fixed, interval
from beambench_operations.publish.figures.origins import require_one_origin
from beambench_report.base.cell_files import unpaired_ratio_of

_THREADS = 2


def is_implausible(speedup: Ratio, threads: int) -> bool:
    """Returns whether a speedup exceeds the number of threads: a run was probably disturbed.

    If its interval includes the number of threads, chance explains the excess.
    """
    return (speedup.value if speedup.low is None else speedup.low) > threads


def figures(folder: Path) -> dict[str, Any]:
    """Returns the speedup of two threads over one, by scene and structure."""
    one, two = Cells(folder / "1"), Cells(folder / str(_THREADS))
    require_one_origin(one.folder, two.folder)
    gain = {
        name: {
            scene: unpaired_ratio_of(
                "trace", *(cells.row(name, scene=scene) for cells in (one, two))
            )
            for scene in one.scenes
        }
        for name in dict.fromkeys(one.rows["structure"])
    }
    every = [speedup for own in gain.values() for speedup in own.values()]
    classic = [gain[name].values() for name in gain if name not in ("beam", "tile-beam")]
    return {
        "scenes": one.scenes,
        "size": one.sizes[0],
        "threads": _THREADS,
        "gain": gain,
        "shown": _shown,
        "all": len(every),
        "implausible": sum(is_implausible(one, _THREADS) for one in every),
        "range": {
            "beam": _range(gain["beam"].values()),
            "tile_beam": _range(gain["tile-beam"].values()),
            "others": _range(speedup for own in classic for speedup in own),
        },
        "tile_beam_ms": [
            one.row("tile-beam", scene=scene)["trace_ms_median"] for scene in one.scenes
        ],
    }


def _shown(speedup: Ratio) -> str:
    """Formats a cell of the table, with a note if the speedup is implausible."""
    text = interval(speedup) if speedup.interval else fixed(speedup)
    return f"{text}, implausible" if is_implausible(speedup, _THREADS) else text


def _range(speedups: Iterable[Ratio]) -> tuple[float, float]:
    """Returns the least and the largest plausible speedup."""
    known = [one.value for one in speedups if not is_implausible(one, _THREADS)]
    return min(known), max(known)
