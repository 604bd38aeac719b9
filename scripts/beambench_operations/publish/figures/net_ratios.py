"""Trace times without the harness's share, over those of one contender on the same rays."""

from collections.abc import Mapping

import pandas as pd
from scipy.stats import gmean

from beambench_operations.publish.figures.cells import Cells

NET = "trace_net_ms_median"


def net_ratios(cells: Cells, base: str, contenders: Mapping[str, str]) -> pd.Series:
    """Returns ratios by name in `contenders`, scene and kind of rays, of what has times."""
    found = {}
    for kind in dict.fromkeys(cells.rows["ray_kind"]):
        for scene in cells.scenes:
            view = {"scene": scene, "ray_kind": kind}
            for name, contender in contenders.items():
                if cells.having(contender, **view)["timed"].any():
                    own, under = (cells.row(one, **view)[NET] for one in (contender, base))
                    found[name, scene, kind] = own / under
    return pd.Series(found).rename_axis(["name", "scene", "kind"])


def means(ratios: pd.Series) -> dict[str, dict[str, float]]:
    """Returns the geometric mean of each name over all scenes, by kind, if all scenes have it."""
    table = ratios.groupby(["name", "kind"], sort=False).agg([gmean, "size"])
    scenes = ratios.index.get_level_values("scene").nunique()
    known = table.loc[table["size"] == scenes, "gmean"]
    return {
        name: own.droplevel("name").to_dict() for name, own in known.groupby("name", sort=False)
    }
