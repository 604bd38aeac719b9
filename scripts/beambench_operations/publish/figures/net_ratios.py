"""Trace times without the harness's share, relative to one contender on the same rays."""

import pandas as pd

from beambench.analysis import Ratio
from beambench_operations.publish.figures.cells import Cells
from beambench_report.base.cell_files import identity
from beambench_report.base.files import Problem

NET = "trace_net_ms_median"


def paired_net_ratio(cells: Cells, over: pd.Series, under: pd.Series) -> Ratio:
    """Returns a row's trace time over that of another row, paired within blocks.

    Raises Problem if no block has both.
    """
    paired = cells.files[identity(over)].ratio(
        "trace_ms",
        cells.files[identity(under)],
        (float(over["harness_ms"]), float(under["harness_ms"])),
    )
    if paired is None:
        both = " and ".join(f"{row['contender']} at {row['view']}" for row in (over, under))
        raise Problem(f"{cells.folder}: no block has both {both}")
    return paired
