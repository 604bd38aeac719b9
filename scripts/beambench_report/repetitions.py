"""The single repetitions of a run in one compact file, which a published run keeps.

A line for each: `line` is that of its cell in results.csv, whose header is line 1. With it, paired
ratios can be made again, and noise be drawn for a calibration, without the thousands of lines of
cells/*.json.
"""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd

from beambench_report.files import write_whole
from beambench_report.page.cell_files import REPETITIONS, identity
from beambench_report.problem import Problem
from beambench_report.records import read_run

_FIGURES = "build_ms trace_ms warm_trace_ms build_cpu_ms trace_cpu_ms clock_ghz".split()


def write_repetitions(run: Path, output: Path | None = None) -> Path:
    """Writes RUN/cells into `output`, RUN/repetitions.csv if not given; six significant digits.

    Raises Problem where the run has no repetitions, or a cell that results.csv has not.
    """
    rows = read_run(run).rows
    lines = {identity(row): place + 2 for place, row in rows.iterrows()}
    table = []
    for path in sorted(run.glob("cells/[!.]*.json")):
        try:
            cell = json.loads(path.read_text("utf-8"))
            line = lines[identity(cell["row"])]
            for one in cell["repetitions"]:
                figures = {name: one[name] for name in _FIGURES if name in one}
                table.append({"line": line, "round": one["round"], **figures})
        except (ValueError, KeyError, TypeError) as error:
            raise Problem(
                f"{path}: is not a cell of this run ({type(error).__name__}: {error}); remove it"
            ) from None
    if not table:
        raise Problem(f"{run}/cells: holds no repetitions; give the folder that a run left")
    columns = ["line", "round", *_FIGURES]
    whole = pd.DataFrame(table, columns=columns).sort_values(["line", "round"])

    def write(path: Path) -> None:
        whole.dropna(axis="columns", how="all").to_csv(path, index=False, float_format="%.6g")

    return write_whole(output or run / REPETITIONS, write)
