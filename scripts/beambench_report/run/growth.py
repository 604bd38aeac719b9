"""Plots the growth of generated scenes from `beambench scene NAME --growth --csv`."""

from pathlib import Path

import pandas as pd
from matplotlib.axes import Axes

from beambench_report.base.figure import (
    LINE_COLORS,
    MARKERS,
    PAGE_WIDTH,
    Plot,
    house_style,
    new_figure,
    write_plot,
)
from beambench_report.base.files import Problem, read_table
from beambench_report.base.quantities import size_in_words

_COLUMNS = ("generator", "parameter", "size", "primitives", "bytes", "seconds", "scene")


def write_growth(files: list[Path], output: Path | None = None) -> list[Path]:
    """Draws memory and time over the primitives, a line for each file's generator.

    Writes PNG and SVG, by default beside the first file and named like it.
    """
    tables = [read_growth(file) for file in files]
    target = (output or files[0]).with_suffix("")
    with house_style():
        return write_plot(growth_plot(tables, target.name), target.parent)


def read_growth(file: Path) -> pd.DataFrame:
    """Returns the rows of one file. Raises Problem if beambench did not write it."""
    rows = read_table(file, _COLUMNS, "write it with: beambench scene NAME --growth --csv")
    if rows.empty:
        raise Problem(f"{file}: it has no rows")
    for column in ("primitives", "bytes", "seconds"):
        numbers = pd.to_numeric(rows[column], errors="coerce")
        if not (numbers >= 0).all():
            raise Problem(f"{file}: column '{column}' holds something that is not a number >= 0")
        rows[column] = numbers
    return rows


def growth_plot(tables: list[pd.DataFrame], stem: str) -> Plot:
    """Returns two panels over one axis of primitives: memory above, seconds below."""
    figure, (memory, seconds) = new_figure(PAGE_WIDTH * 0.95, rows=2)
    for index, rows in enumerate(tables):
        look = {
            "color": LINE_COLORS[index % len(LINE_COLORS)],
            "marker": MARKERS[index % len(MARKERS)],
            "markersize": 4,
            "linewidth": 1.2,
            "label": rows["generator"].iloc[0],
        }
        memory.plot(rows["primitives"], rows["bytes"], **look)
        timed = rows[rows["seconds"] > 0]
        seconds.plot(timed["primitives"], timed["seconds"], **look)
    _finish(memory, "Memory of the scene's arrays", "memory")
    memory.set_yscale("log", base=2)
    memory.yaxis.set_major_formatter(lambda size, _: size_in_words(size))
    _finish(seconds, "Time to generate the scene", "seconds")
    memory.legend(fontsize=8, frameon=False, ncols=2)
    seconds.set_xlabel("primitives")
    return Plot(stem, figure, "memory and time of generated scenes over their primitives")


def _finish(panel: Axes, title: str, unit: str) -> None:
    panel.set_title(title)
    panel.set_ylabel(unit)
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.grid(alpha=0.3)
