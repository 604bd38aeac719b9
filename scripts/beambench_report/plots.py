"""All plots of a run."""

from __future__ import annotations

import json
from pathlib import Path

from beambench_report.break_even import break_even, break_even_table
from beambench_report.build_and_trace import build_and_trace
from beambench_report.counters import counters
from beambench_report.figure import Plot, house_style, write_plot
from beambench_report.files import write_text, write_whole
from beambench_report.memory import memory
from beambench_report.names import PLOT_INDEX
from beambench_report.records import Run, read_run
from beambench_report.time_over_rays import time_over_rays

FIGURES = (time_over_rays, build_and_trace, break_even, memory, counters)


def write_plots(directory: Path) -> list[Path]:
    """Fills DIRECTORY/plots from DIRECTORY/results.csv: PNG, SVG, a table, README and index."""
    run = read_run(directory)
    folder = directory / "plots"
    folder.mkdir(exist_ok=True)
    with house_style():
        plots = [plot for make in FIGURES for plot in make(run)]
        paths = [path for plot in plots for path in write_plot(plot, folder)]
    table = break_even_table(run)
    paths.append(
        write_whole(folder / "break-even.csv", lambda path: table.to_csv(path, index=False))
    )
    for name, text in (("README.md", _readme(run, plots)), (PLOT_INDEX, _index(plots))):
        paths.append(write_text(folder / name, text))
    return paths


def _readme(run: Run, plots: list[Plot]) -> str:
    lines = [
        f"# Plots of run {run.rows['run_id'].iloc[0]}",
        "",
        "Drawn by `scripts/run` from `../results.csv`; each is there as PNG and as SVG.",
        "",
        "| file | shows |",
        "|---|---|",
        *(f"| [{plot.stem}.png]({plot.stem}.png) | {plot.summary} |" for plot in plots),
        "| [break-even.csv](break-even.csv) | break-even number of rays of every pair |",
        "",
    ]
    return "\n".join(lines)


def _index(plots: list[Plot]) -> str:
    entries = [{"stem": plot.stem, "summary": plot.summary, "view": plot.view} for plot in plots]
    return json.dumps(entries, indent=2) + "\n"
