"""The command `python -m beambench_report levels RUN... [-o FILE.md]`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from beambench_report.figure import house_style, write_plot
from beambench_report.files import write_text
from beambench_report.problem import Problem
from beambench_report.thesis.cells import Cell, read_cells
from beambench_report.thesis.levels.section import levels_section
from beambench_report.thesis.section import Section, by_file, section_as_markdown


def levels_of_runs(runs: Sequence[Path]) -> Section:
    """The choices in these runs. Raises Problem where one cannot be read, or holds none."""
    cells: list[Cell] = []
    for run in runs:
        folder = run.resolve()
        found = read_cells(folder.parent, [folder.name])
        if found.unread:
            raise Problem(found.unread[0])
        if not found.runs:
            raise Problem(f"{run}: holds no results.csv; give the folder that a run wrote")
        cells += found.cells
    section = levels_section(cells)
    if section is None:
        names = ", ".join(str(run) for run in runs)
        raise Problem(
            f"{names}: no cell of max_level=auto has two fixed levels beside it; measure "
            "harness/sweeps/levels.json"
        )
    return section


def levels_text(runs: Sequence[Path]) -> str:
    """As Markdown, without its figure."""
    section = levels_of_runs(runs)
    plain = Section(**(vars(section) | {"figures": ()}))
    return section_as_markdown(plain, level=1, origin=by_file)


def write_levels(runs: Sequence[Path], file: Path) -> list[Path]:
    """Writes FILE.md, and its figure beside it."""
    section = levels_of_runs(runs)
    text = section_as_markdown(section, level=1, folder="", origin=by_file)
    paths = [write_text(file, text)]
    with house_style():
        for figure in section.figures:
            paths += write_plot(figure.draw(), file.parent)
    return paths
