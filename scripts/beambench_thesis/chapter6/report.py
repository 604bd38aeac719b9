"""The page of the simulated cluster: Markdown and its figures."""

from collections.abc import Callable, Sequence
from pathlib import Path

import pandas as pd

from beambench_report.base.figure import Plot, house_style, write_plot
from beambench_report.base.files import write_text
from beambench_report.base.quantities import markdown_table, number
from beambench_thesis.chapter6.divisions import division_plots, divisions_sections
from beambench_thesis.chapter6.machines import thesis_seconds
from beambench_thesis.chapter6.page import rendered
from beambench_thesis.chapter6.plots import cluster_plots
from beambench_thesis.chapter6.record import measured_section, read_recorded
from beambench_thesis.chapter6.results import (
    EQUAL_MACHINES,
    THESIS_OPTIONS,
    pivot,
    read_processes,
    read_simulations,
    switched,
)
from beambench_thesis.chapter6.scene_divisions import (
    read_scene_divisions,
    scene_divisions_plot,
    scene_divisions_section,
)
from beambench_thesis.chapter6.simulate import DIVISIONS, OLD, OPTIONS, STATIONS, TODAY, slowness_of
from beambench_thesis.chapter6.split import read_split, split_plot, split_section
from beambench_thesis.paper.evidence import rows_with

_SHOWN = (1, 2, 4, 6, 8, 10, 12, 14)


def write_report(folder: Path) -> list[Path]:
    """Writes FOLDER/report.md and the figures that it shows."""
    with house_style():
        text, plots = report(folder)
        written = [path for plot in plots for path in write_plot(plot, folder)]
    return [*written, write_text(folder / "report.md", text)]


def report(folder: Path) -> tuple[str, list[Plot]]:
    """Returns the text of the report, and its figures, which must be saved within `house_style`."""
    simulations = read_simulations(folder)
    recorded = read_recorded(folder)
    split = read_split(folder)
    scene_divisions = read_scene_divisions(folder)
    more = (
        None if split is None else split_section(split),
        None if scene_divisions is None else scene_divisions_section(scene_divisions),
        measured_section(folder),
    )
    plots = cluster_plots(simulations, read_processes(folder))
    plots += division_plots(simulations)
    if split is not None:
        plots.append(split_plot(split))
    if scene_divisions is not None:
        plots.append(scene_divisions_plot(scene_divisions))
    shown = {plot.stem: f"![{plot.summary}]({plot.stem}.png)\n" for plot in plots}
    constant, per_ray = thesis_seconds()
    text = rendered(
        "report",
        recorded=_recorded(recorded),
        constant=constant,
        per_ray=per_ray,
        slowness=slowness_of(recorded),
        figure=lambda stem: shown.get(stem, ""),
        efficiencies=_efficiencies(simulations),
        options={era: _options(simulations, era) for era in (OLD, TODAY)},
        divisions=divisions_sections(simulations, recorded, shown),
        consumers=STATIONS - 1,
        machines=_machines(simulations),
        assumptions=_assumptions(simulations),
        more=[section for section in more if section is not None],
    )
    return text, plots


def _recorded(recorded: dict) -> list[str]:
    rows = (
        (
            *(scene, work),
            f"{each.build_seconds:.4f}",
            f"{each.walk_seconds:.4f}",
            f"{each.work_seconds:.3f}",
            f"{each.samples:,}",
        )
        for (scene, work), each in recorded.items()
    )
    heads = ("scene", "work", "build s", "walk s", "work s", "samples")
    return markdown_table(heads, rows)


def _efficiencies(simulations: pd.DataFrame) -> list[str]:
    return _by_consumers(
        rows_with(simulations, options=THESIS_OPTIONS, machines=EQUAL_MACHINES, era=OLD),
        "network",
        _SHOWN,
        lambda run: f"{run['efficiency']:.2f} / {run['efficiency_of_consumers']:.2f}",
    )


def _options(simulations: pd.DataFrame, era: str) -> list[str]:
    rows = switched(rows_with(simulations, era=era, options=OPTIONS, machines=EQUAL_MACHINES))
    counts = {STATIONS // 2, STATIONS - 1, 31, 63, 127, 255, 1023} & set(rows["consumers"])
    return _by_consumers(
        rows,
        "options",
        sorted(counts),
        lambda run: f"{run['speed_up']:.1f} ({run['producer_busy']:.0%})",
    )


def _by_consumers(
    rows: pd.DataFrame, by: str, counts: Sequence[int], cell: Callable[[pd.Series], str]
) -> list[str]:
    """Returns a table with a column for each number of consumers."""
    heads = {n: f"{n} consumers" for n in counts}
    shown = rows_with(rows, consumers=counts)
    return pivot(shown, ("scene", by), "consumers", heads, cell)


def _machines(simulations: pd.DataFrame) -> list[str]:
    rows = switched(rows_with(simulations, era=OLD, consumers=STATIONS - 1))
    unlike = set(rows.loc[rows["machines"].ne(EQUAL_MACHINES), "options"])
    return _by_options(rows_with(rows, options=unlike), "machines", "seconds")


def _assumptions(simulations: pd.DataFrame) -> list[str]:
    rows = rows_with(
        simulations, era=OLD, machines=EQUAL_MACHINES, consumers=(STATIONS // 2, STATIONS - 1)
    )
    others = (OPTIONS.keys() | DIVISIONS.keys()) - {THESIS_OPTIONS}
    rows = rows[~rows["options"].isin(others)]
    place = rows["network"] + ", " + rows["consumers"].astype(str) + " consumers"
    return _by_options(rows.assign(place=place), "place", "efficiency")


def _by_options(rows: pd.DataFrame, by: str, quantity: str) -> list[str]:
    heads = {options: options for options in rows["options"]}
    return pivot(rows, ("scene", by), "options", heads, lambda run: number(run[quantity]))
