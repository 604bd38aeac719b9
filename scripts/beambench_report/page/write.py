"""Writes the page of a run."""

from __future__ import annotations

from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template
from markupsafe import Markup

from beambench_report.dictionary import dictionary
from beambench_report.files import write_text
from beambench_report.page.all_cells import pack
from beambench_report.page.cell_files import read_cell_files
from beambench_report.page.comparison import compare
from beambench_report.page.images import read_pictures, read_plots
from beambench_report.page.manifest import Manifest, read_description, read_manifest
from beambench_report.page.outcome import judge_run
from beambench_report.page.ratios import choose_reference, compared
from beambench_report.page.view import make_views
from beambench_report.quantities import duration_in_words
from beambench_report.records import Run, read_run

PAGE = "report.html"
_TEMPLATES = Path(__file__).with_name("templates")


def write_page(directory: Path, reference: str | None = None) -> list[Path]:
    """Writes DIRECTORY/report.html from what the folder of a run holds.

    Ratios are to the contender named `reference`, or to one that suits (see `choose_reference`).
    """
    return [write_text(directory / PAGE, render(read_run(directory), reference))]


def render(run: Run, wanted_reference: str | None = None) -> str:
    """The text of the page."""
    manifest = read_manifest(run.directory) or Manifest()
    files = read_cell_files(run.directory)
    reference = choose_reference(run, wanted_reference)
    resolutions = {view: compared(run, view, reference, files) for view in run.views}
    finest = {view: groups[0] for view, groups in resolutions.items()}
    plots = read_plots(run.directory)
    pictures = read_pictures(run.directory, run.rows["scene"])
    return _template().render(
        manifest=manifest,
        description=read_description(run.directory),
        newest=run.rows.iloc[-1].to_dict(),
        outcome=judge_run(run, files),
        tiles=_tiles(run, manifest),
        comparison=compare(reference, finest) if reference else None,
        views=make_views(resolutions, run.counters, pictures, plots),
        plots=[plot for plot in plots if not plot.subject],
        cells=pack(run),
        dictionary=dictionary(),
    )


def _tiles(run: Run, manifest: Manifest) -> list[tuple[str, str]]:
    """A few figures that say how large the run was and how well it could measure."""
    timed = run.rows[run.rows["timed"]]
    tiles = [
        (f"{len(run.views):,}", "views" if len(run.views) != 1 else "view"),
        (f"{run.rows['contender'].nunique():,}", "contenders"),
    ]
    if "stop_reason" in timed and len(timed) > 0:
        precise = (timed["stop_reason"] == "precision").mean()
        tiles.append((f"{100 * precise:.0f}%", "of timed cells as precise as wanted"))
    if manifest.overhead is not None:
        tiles.append(
            (f"{100 * manifest.overhead:.2g}%", "of the fastest trace is the harness's, at most")
        )
    return tiles


def _template() -> Template:
    environment = Environment(
        loader=FileSystemLoader(_TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["duration"] = duration_in_words
    # Style and scripts are not templates: their braces are their own.
    environment.globals["raw"] = lambda name: Markup((_TEMPLATES / name).read_text("utf-8"))
    environment.filters["as_script_data"] = Markup  # `pack` has escaped what would end a script
    return environment.get_template("page.html.j2")
