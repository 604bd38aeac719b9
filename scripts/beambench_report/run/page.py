"""The page of a run: one HTML file that contains everything and needs no network."""

import re
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from beambench_report.base.analysis import Standings
from beambench_report.base.cell_files import read_cell_files
from beambench_report.base.columns import dictionary
from beambench_report.base.files import write_text
from beambench_report.base.machine import Manifest, read_description, read_manifest
from beambench_report.base.names import file_stems
from beambench_report.base.palette import css_color
from beambench_report.base.records import Run, read_run, size_of
from beambench_report.run.absent import absent, not_begun, report_command
from beambench_report.run.all_cells import pack
from beambench_report.run.html import environment
from beambench_report.run.images import Image, figures_of, read_pictures
from beambench_report.run.inline_svg import dark_variables
from beambench_report.run.introduction import (
    about_references,
    headline,
    kinds_of_primitives,
    tiles,
    traced,
)
from beambench_report.run.measured import Measured
from beambench_report.run.outcome import faults_of
from beambench_report.run.plots import KINDS, Kind
from beambench_report.run.reference import Compared, choose_reference, compared, why_reference
from beambench_report.run.tables import Table, compare, ratio_field, view_table, work_table


@dataclass(frozen=True)
class View:
    """The content of one view; the first table is that of the finest resolution."""

    title: str
    anchor: str
    primitives: int
    kinds_of_primitives: str
    """The kinds of the scene's primitives; empty if the record does not state them."""
    pictures: tuple[Image, ...]
    plots: tuple[Image, ...]
    tables: tuple[Table, ...]
    work: Table | None
    standings: Standings


def make_views(
    resolutions: Mapping[str, list[Compared]],
    every: Mapping[str, Standings],
    counters: list[str],
    pictures: Sequence[Image],
    plots: Sequence[Image],
    reference: str | None,
) -> list[View]:
    """Returns a section for each view; `resolutions` has the rows of a view, the finest first."""
    stems = file_stems(resolutions)
    views = []
    for title, groups in resolutions.items():
        first = groups[0].rows.iloc[0]
        views.append(
            View(
                title,
                f"view-{stems[title]}",
                0 if pd.isna(first["primitives"]) else int(first["primitives"]),
                kinds_of_primitives(pd.concat([group.rows for group in groups])),
                tuple(image for image in pictures if image.subject == first["scene"]),
                tuple(image for image in plots if image.subject == title),
                tuple(
                    view_table(
                        _caption(group.rows),
                        group.rows,
                        group.ratios,
                        reference,
                        every[title].left_out,
                    )
                    for group in groups
                ),
                work_table(f"work per ray, {_caption(groups[0].rows)}", groups[0].rows, counters),
                every[title],
            )
        )
    return views


def _caption(rows: pd.DataFrame) -> str:
    first = rows.iloc[0]
    samples = f", {first['samples']:.0f} samples per pixel" if first["samples"] > 1 else ""
    return f"{size_of(first)}{samples}, {first['rays']:,.0f} rays"


PAGE = "report.html"


def write_page(directory: Path, reference: str | None = None) -> list[Path]:
    """Writes DIRECTORY/report.html from the folder of a run.

    Ratios are to the contender named `reference`, or to one chosen by `choose_reference`.
    """
    return [write_text(directory / PAGE, render(read_run(directory), reference))]


def render(
    run: Run, wanted_reference: str | None = None, drawn_kinds: Sequence[Kind] = KINDS
) -> str:
    """Returns the page; figures of `drawn_kinds` are drawn if the folder has no plots."""
    manifest = read_manifest(run.directory) or Manifest()
    files = read_cell_files(run.directory)
    reference = choose_reference(run, wanted_reference)
    resolutions = {view: compared(run, view, reference, files) for view in run.views}
    finest = {view: groups[0] for view, groups in resolutions.items()}
    measured = Measured(run, files)
    figures = figures_of(measured, drawn_kinds)
    pictures = read_pictures(run.directory, run.rows["scene"])
    analysis = measured.analysis
    page = (
        environment()
        .get_template("page.html.j2")
        .render(
            manifest=manifest,
            description=read_description(run.directory),
            newest=run.rows.iloc[-1].to_dict(),
            outcome=faults_of(run, files),
            not_begun=not_begun(run, manifest),
            folder=shlex.quote(str(run.directory)),
            noise_is_known=manifest.noise is not None,
            is_timed=bool(run.rows["timed"].any()),
            analysis=analysis,
            absent=[*absent(run, manifest, files, figures, pictures)],
            color=css_color,
            dark=dark_variables(),
            interval=ratio_field,
            traced=traced(run.rows),
            headline=headline(analysis),
            tiles=tiles(run, analysis.overheads),
            about_references=about_references(run.rows),
            comparison=compare(reference, finest) if reference else None,
            why_reference=why_reference(reference, wanted_reference) if reference else "",
            views=make_views(
                resolutions, analysis.by_view, run.counters, pictures, figures.images, reference
            ),
            plots=[plot for plot in figures.images if not plot.subject],
            undrawn=figures.undrawn,
            draw_command=report_command(run),
            cells=pack(run),
            dictionary=dictionary(),
        )
    )
    return re.sub(r"\n +<", "\n<", page)  # a tenth of the page would be indentation
