"""The page of the simulated cluster: Markdown and its figures."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pandas as pd

from beambench_report.base.figure import house_style, write_plot
from beambench_report.base.files import write_text
from beambench_report.base.quantities import markdown_table, number
from beambench_thesis.chapter6.divisions import division_plots, divisions_sections
from beambench_thesis.chapter6.machines import Slowness, thesis_seconds
from beambench_thesis.chapter6.plots import cluster_plots
from beambench_thesis.chapter6.record import measured_section, read_recorded
from beambench_thesis.chapter6.results import (
    EQUAL_MACHINES,
    THESIS_OPTIONS,
    read_processes,
    read_simulations,
)
from beambench_thesis.chapter6.scene_divisions import (
    read_scene_divisions,
    scene_divisions_plot,
    scene_divisions_section,
)
from beambench_thesis.chapter6.simulate import (
    DIVISIONS,
    OLD,
    OPTIONS,
    STATIONS,
    TODAY,
    slowness_of,
)
from beambench_thesis.chapter6.split import read_split, split_plot, split_section

_SHOWN = (1, 2, 4, 6, 8, 10, 12, 14)


def write_report(folder: Path) -> list[Path]:
    """Writes FOLDER/report.md and the figures that it shows."""
    simulations = read_simulations(folder)
    recorded = read_recorded(folder)
    split = read_split(folder)
    scene_divisions = read_scene_divisions(folder)
    measured = measured_section(folder)
    written = []
    with house_style():
        plots = cluster_plots(simulations, read_processes(folder))
        plots += division_plots(simulations)
        if split is not None:
            plots.append(split_plot(split))
        if scene_divisions is not None:
            plots.append(scene_divisions_plot(scene_divisions))
        for plot in plots:
            written += write_plot(plot, folder)
    shown = {plot.stem: f"![{plot.summary}]({plot.stem}.png)\n" for plot in plots}
    sections = [
        "# The thesis's cluster, simulated\n",
        "The MPI program itself runs, its producer, consumers and messages; machines and "
        "network are SimGrid's, and what a beam costs was recorded.\n",
        _of_recording(recorded, slowness_of(recorded)),
        "## Figure 6.3: time, speed-up, efficiency\n",
        shown.get("figure-6.3", ""),
        _efficiencies(simulations),
        "## Figure 6.4: how the work was distributed\n",
        shown.get("figure-6.4", ""),
        "## More processes, and what each option changes\n",
        shown.get(f"many-processes-{OLD}", ""),
        _options(simulations, OLD),
        shown.get(f"many-processes-{TODAY}", ""),
        _options(simulations, TODAY),
        divisions_sections(simulations, recorded, shown),
        "## Machines that are not equal\n",
        f"{STATIONS - 1} consumers. `every other one half as fast`: seven machines of half "
        "the speed. `five used by others`: half of the time only half of their speed is "
        "left.\n",
        _machines(simulations),
        "## What was assumed\n",
        "What messages cost the processor in 1999, halved and doubled; results as our own "
        "program sends them, 8 bytes per sample, where the thesis sends pixels; and the "
        "thesis's seconds that do not grow with the rays taken for walking alone, or for "
        "building alone.\n",
        _assumptions(simulations),
        *([split_section(split)] if split is not None else []),
        *([scene_divisions_section(scene_divisions)] if scene_divisions is not None else []),
        *([measured] if measured is not None else []),
    ]
    text = "\n".join(section for section in sections if section)
    return [*written, write_text(folder / "report.md", text)]


def _of_recording(recorded: dict, slowness: Slowness) -> str:
    constant, per_ray = thesis_seconds()
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
    text = (
        f"Seconds of one core of this machine. The thesis's gato-bill takes {constant:.2f} s at no "
        f"rays and {1e6 * per_ray:.1f} us per ray on its cluster's machines. So there building and "
        f"walking take {number(slowness.walk)} times as long as here, the work in leaves "
        f"{number(slowness.work)} times.\n"
    )
    heads = ("scene", "work", "build s", "walk s", "work s", "samples")
    return "\n".join([*markdown_table(heads, rows), "", text])


def _efficiencies(simulations: pd.DataFrame) -> str:
    rows = simulations[
        simulations["options"].eq(THESIS_OPTIONS)
        & simulations["machines"].eq(EQUAL_MACHINES)
        & simulations["era"].eq(OLD)
        & simulations["consumers"].isin(_SHOWN)
    ]
    return _by_consumers(
        "Efficiency with the producer counted / not counted:",
        rows,
        "network",
        _SHOWN,
        lambda run: f"{run['efficiency']:.2f} / {run['efficiency_of_consumers']:.2f}",
    )


def _options(simulations: pd.DataFrame, era: str) -> str:
    rows = simulations[
        simulations["era"].eq(era)
        & simulations["options"].isin(OPTIONS)
        & simulations["machines"].eq(EQUAL_MACHINES)
        & (simulations["consumers"] >= STATIONS // 2)
        & ~simulations["network"].str.startswith("shared")
    ]
    counts = sorted(set(rows["consumers"]) & {STATIONS // 2, STATIONS - 1, 31, 63, 127, 255, 1023})
    return _by_consumers(
        f"Speed-up, {era} (in brackets: how busy the producer is):",
        rows,
        "options",
        counts,
        lambda run: f"{run['speed_up']:.1f} ({run['producer_busy']:.0%})",
    )


def _by_consumers(
    title: str,
    rows: pd.DataFrame,
    by: str,
    counts: Sequence[int],
    cell: Callable[[pd.Series], str],
) -> str:
    """Returns a table with a column for each number of consumers."""
    heads = {n: f"{n} consumers" for n in counts}
    return _pivot(title, rows, by, "consumers", heads, cell)


def _pivot(
    title: str,
    rows: pd.DataFrame,
    by: str,
    across: str,
    heads: Mapping[object, str],
    cell: Callable[[pd.Series], str],
) -> str:
    """Returns a row for each scene and value of `by`; `heads` are the values of `across`."""
    lines = []
    for (scene, which), group in rows.groupby(["scene", by], sort=False):
        runs = group.drop_duplicates(across).set_index(across)
        cells = (cell(runs.loc[value]) if value in runs.index else "" for value in heads)
        lines.append((scene, which, *cells))
    return "\n".join([f"{title}\n", *markdown_table(["scene", by, *heads.values()], lines), ""])


def _machines(simulations: pd.DataFrame) -> str:
    rows = simulations[
        simulations["era"].eq(OLD)
        & simulations["consumers"].eq(STATIONS - 1)
        & ~simulations["network"].str.startswith("shared")
    ]
    unlike = set(rows.loc[rows["machines"].ne(EQUAL_MACHINES), "options"])
    return _seconds(rows[rows["options"].isin(unlike)], "machines")


def _assumptions(simulations: pd.DataFrame) -> str:
    rows = simulations[
        simulations["era"].eq(OLD)
        & simulations["machines"].eq(EQUAL_MACHINES)
        & simulations["consumers"].isin((STATIONS // 2, STATIONS - 1))
        & ~simulations["options"].isin((OPTIONS.keys() | DIVISIONS.keys()) - {THESIS_OPTIONS})
    ]
    rows = rows.assign(place=rows["network"] + ", " + rows["consumers"].astype(str) + " consumers")
    return _seconds(rows, "place", "efficiency")


def _seconds(rows: pd.DataFrame, by: str, quantity: str = "seconds") -> str:
    heads = {options: options for options in rows["options"]}
    title = f"{quantity.capitalize()}:"
    return _pivot(title, rows, by, "options", heads, lambda run: number(run[quantity]))
