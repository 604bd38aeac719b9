"""Gathers the report from the runs of a folder and writes it as Markdown and as one page."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from beambench_report.figure import house_style, write_plot
from beambench_report.files import write_text, write_whole
from beambench_report.ledger.book import SWEPT_CLAIMS, ledger
from beambench_report.ledger.book import Entry as LedgerEntry
from beambench_report.ledger.census_run import is_census_folder
from beambench_report.page.manifest import Manifest, read_manifest
from beambench_report.thesis.best import BestTable, best_table
from beambench_report.thesis.catalogue import TABLES, Table
from beambench_report.thesis.cells import Cell, Cells, read_cells
from beambench_report.thesis.drawing import FigureData, draw
from beambench_report.thesis.facts.gather import CENSUS
from beambench_report.thesis.figures import make_figures
from beambench_report.thesis.pictures import PictureFigure, octree_figures
from beambench_report.thesis.plan import Plan
from beambench_report.thesis.printed import parts_of
from beambench_report.thesis.runner import state_of
from beambench_report.thesis.section import Section
from beambench_report.thesis.sections import extra_sweeps, sections_of
from beambench_report.thesis.sweeps import LEVELS, Sweep
from beambench_report.thesis.tables import PartTable, fill
from beambench_report.thesis.work import WorkTable, work_of_lines


@dataclass(frozen=True)
class Part:
    """A part of a table: as in the thesis, what stands behind it, and best against best."""

    table: PartTable
    best: BestTable | None

    @cached_property
    def work(self) -> WorkTable:
        """Memory and work of every cell of the table."""
        return work_of_lines(self.table.lines)


@dataclass(frozen=True)
class RunSummary:
    """What is told of a run."""

    name: str
    description: str
    state: str
    planned: int
    cells: tuple[Cell, ...]
    manifest: Manifest

    @property
    def wrong(self) -> int:
        """Cells without times."""
        return sum(cell.time is None for cell in self.cells)


@dataclass(frozen=True)
class Report:
    """All that is written, in whichever form."""

    directory: Path
    plan: Plan
    cells: Cells
    tables: tuple[tuple[Table, tuple[Part, ...]], ...]
    figures: tuple[FigureData, ...]
    pictures: tuple[PictureFigure, ...]
    ledger: tuple[LedgerEntry, ...]
    sections: tuple[Section, ...]
    """What goes beyond the thesis's own tables and figures."""
    runs: tuple[RunSummary, ...]

    @property
    def is_complete(self) -> bool:
        """Was all that was planned measured?"""
        return all(run.state == "finished" for run in self.runs)


@dataclass(frozen=True)
class Written:
    """The files of a report, and how many of its cells were not right."""

    paths: tuple[Path, ...]
    cells: int
    wrong: int
    notice: str
    """What a reader must know before reading it; nothing where all was measured in full."""


def gather(directory: Path, plan: Plan, beambench: Path | None = None) -> Report:
    """Reads the runs; what was not measured is left out and told so."""
    sweeps = [*plan.sweeps, *extra_sweeps(directory, plan)]
    every = read_cells(directory, (sweep.name for sweep in sweeps))
    # Tables, figures and ledger have one sweep for each of their cells, and none of them is LEVELS.
    cells = every.without(LEVELS)
    sections, unread = sections_of(directory, every)
    shown = [table for table in TABLES if table.number in plan.tables]
    pictures = ()
    if beambench is not None and cells.cells:
        pictures = tuple(octree_figures(plan.figures, directory, beambench))
    return Report(
        directory,
        plan,
        replace(every, unread=(*every.unread, *unread)),
        tuple((table, _parts(table, cells, directory, plan)) for table in shown),
        tuple(make_figures(plan.figures, cells)),
        pictures,
        tuple(ledger([*cells.runs, *_censuses(directory)], SWEPT_CLAIMS)),
        tuple(sections),
        tuple(_summary(directory, sweeps, every)),
    )


def write_report(directory: Path, plan: Plan, beambench: Path | None = None) -> Written:
    """Writes DIRECTORY/report.html and report.md, the figures, and the list of rows."""
    # These import this module: importing them above would be circular.
    from beambench_report.thesis import words
    from beambench_report.thesis.markdown import as_markdown
    from beambench_report.thesis.page import as_page

    report = gather(directory, plan, beambench)
    folder = directory / "figures"
    folder.mkdir(exist_ok=True)
    with house_style():
        for data in report.figures:
            write_plot(draw(data), folder)
        for figure in (one for section in report.sections for one in section.figures):
            write_plot(figure.draw(), folder)
    paths = (
        write_text(directory / "report.html", as_page(report)),
        write_text(directory / "report.md", as_markdown(report)),
        _write_rows(report.cells, directory / "rows.csv"),
    )
    return Written(paths, len(report.cells.cells), len(report.cells.wrong), words.notice(report))


def _censuses(directory: Path) -> list[Path]:
    """The folder of censuses, where there is one."""
    folder = directory / CENSUS
    return [folder] if is_census_folder(folder) else []


def _parts(table: Table, cells: Cells, directory: Path, plan: Plan) -> tuple[Part, ...]:
    sweeps = [sweep for sweep in plan.sweeps if sweep.name in table.first]

    def why(resolution: str) -> str:
        asked = [sweep for sweep in sweeps if resolution in sweep.source["resolutions"]]
        if not asked:
            return "quick run" if plan.is_quick else "not asked for"
        states = {state_of(directory / sweep.name) for sweep in asked}
        return {"waiting": "not run", "begun": "run cut off"}.get(states.pop(), "not measured")

    return tuple(
        Part(fill(part, cells, why), best_table(part, cells)) for part in parts_of(table.number)
    )


def _summary(directory: Path, sweeps: Iterable[Sweep], cells: Cells) -> list[RunSummary]:
    return [
        RunSummary(
            sweep.name,
            sweep.description,
            state_of(directory / sweep.name),
            len(sweep.cells()),
            tuple(cell for cell in cells.cells if cell.run == sweep.name),
            read_manifest(directory / sweep.name) or Manifest(),
        )
        for sweep in sweeps
    ]


def _write_rows(cells: Cells, path: Path) -> Path:
    """The numbers that figures carry in the report, and the row of the file behind each."""

    def write(pending: Path) -> None:
        with pending.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(["row", "file", "line", "cell", "repetitions", "verdict"])
            for cell in cells.cells:
                file_name = f"{cell.run}/results.csv"
                writer.writerow(
                    [cell.number, file_name, cell.line, cell.name, cell.repetitions, cell.verdict]
                )

    return write_whole(path, write)
