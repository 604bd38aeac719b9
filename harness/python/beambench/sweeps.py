"""Sweeps: measurements of many structures on many scenes."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from beambench import _beambench
from beambench.arrays import encoded

if TYPE_CHECKING:
    import pandas as pd

# Columns that are not numbers, even if they look like numbers: a hash may consist of digits.
TEXT_COLUMNS = (
    "run_id time_utc commit machine_id build_type flags isa structure_isa "
    "library_version library_geometry scene camera scene_hash rays_hash structure parameters "
    "ray_kind order query query_path stop_reason trace_clock verdict"
).split()


def sweep(
    config: Mapping[str, Any] | str | bytes | os.PathLike[Any],
    output: str | bytes | os.PathLike[Any] | None = None,
    *,
    resume: bool = False,
    progress: bool = False,
) -> pd.DataFrame:
    """Measures a sweep in this process; reports times only for cells with correct hits.

    This process measures all blocks, so intervals do not cover the variation between processes. For
    times that must be reproducible in other processes, use `beambench run`.

    Args:
        config: a sweep as in harness/measure/sweep.schema.json, the path of its JSON file, or the
            name of one of beambench's own sweeps, such as "quick".
        output: folder for the whole record, empty or new; None: the record is discarded.
        resume: continue the run in `output`, and keep every finished cell.
        progress: report the progress on standard error.

    Returns:
        The table of results.csv, with a row for each cell; results/README.md describes the columns.
        Cells with wrong hits have no times: see `verdict`. `attrs["summary"]` is the text of
        summary.txt. A notebook shows a table with bars for each view.

    Raises:
        InputError: an error in the configuration, with its place, or a problem with the folder.
        ImportError: pandas is not installed.
    """
    try:
        import pandas as pd

        from beambench.results import Results
    except ImportError as error:
        raise ImportError("sweeps are returned as DataFrames: install pandas first") from error
    text = json.dumps(dict(config)) if isinstance(config, Mapping) else ""
    path = b"" if isinstance(config, Mapping) else encoded("config", config)
    if resume and output is None:
        raise _beambench.InputError("resume continues the run in a folder; pass it as output")
    with tempfile.TemporaryDirectory(prefix="beambench-") as temporary:
        folder = Path(temporary) / "run" if output is None else output
        table, summary = _beambench.sweep(text, path, encoded("output", folder), resume, progress)
        # `null` is the name of a structure; only an empty field is a missing value.
        frame = pd.read_csv(
            os.fsdecode(table),
            keep_default_na=False,
            na_values=[""],
            dtype=dict.fromkeys(TEXT_COLUMNS, "str"),
        )
    frame.attrs["summary"] = summary
    results = Results(frame)
    results.attrs = frame.attrs
    return results
