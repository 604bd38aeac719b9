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

# Not numbers, whatever they look like: a hash may be digits alone.
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
    """Measures a sweep in this process; a time is reported only when the hits are correct.

    All blocks are measured by this process, so that what differs between processes is in no
    interval. For times that are to hold elsewhere, use `beambench run`.

    Args:
        config: a sweep as in harness/measure/sweep.schema.json, the path of its JSON file, or the
            name of one that comes with beambench, such as "quick".
        output: folder for the whole record, which must be empty or new; None: it is not kept.
        resume: continue the run in `output`, of which every finished cell is kept.
        progress: report on the standard error.

    Returns:
        results.csv, a row for each cell; results/README.md describes the columns. Wrong cells
        have no times: look at `verdict`. `attrs["summary"]` is the text of summary.txt. A notebook
        shows a table with bars for each view.

    Raises:
        InputError: a fault in the configuration, with its place, or in the folder.
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
        raise _beambench.InputError("resume continues the run in a folder; give it as output")
    with tempfile.TemporaryDirectory(prefix="beambench-") as temporary:
        folder = Path(temporary) / "run" if output is None else output
        table, summary = _beambench.sweep(text, path, encoded("output", folder), resume, progress)
        # `null` is a structure's name; only an empty field is a missing value.
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
