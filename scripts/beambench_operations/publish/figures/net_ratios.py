"""Trace times without the harness's share, over those of one contender on the same rays."""

from collections.abc import Mapping
from typing import Any

from scipy.stats import gmean

from beambench_operations.publish.figures.cells import Cells

NET = "trace_net_ms_median"


def net_ratios(
    cells: Cells, base: str, contenders: Mapping[str, str], kind: str = ""
) -> dict[str, dict[str, dict[str, float]]]:
    """Returns ratios by name in `contenders`, scene and kind of rays; `kind` selects one kind."""
    kinds = [kind] if kind else list(dict.fromkeys(cells.rows["ray_kind"]))
    found: dict[str, dict[str, dict[str, float]]] = {}
    for name, contender in contenders.items():
        for scene in cells.scenes:
            for one in kinds:
                rows = cells.having(contender, scene=scene, ray_kind=one)
                if len(rows[rows["timed"]]):
                    own = cells.row(contender, scene=scene, ray_kind=one)[NET]
                    under = cells.row(base, scene=scene, ray_kind=one)[NET]
                    found.setdefault(name, {}).setdefault(scene, {})[one] = float(own / under)
    return found


def means(ratios: Mapping[str, Mapping[str, Mapping[str, float]]], scenes: int) -> dict[str, Any]:
    """Returns the geometric mean of each name over all scenes, by kind, if all scenes have it."""
    result: dict[str, dict[str, float]] = {}
    for name, by_scene in ratios.items():
        kinds = dict.fromkeys(kind for own in by_scene.values() for kind in own)
        for kind in kinds:
            values = [own[kind] for own in by_scene.values() if kind in own]
            if len(values) == scenes:
                result.setdefault(name, {})[kind] = float(gmean(values))
    return result
