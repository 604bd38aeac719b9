"""Static divisions of the image, and 1,024 processes on a large picture: figures and sections."""

from collections.abc import Mapping

import pandas as pd
from matplotlib.axes import Axes

from beambench_report.base.figure import PAGE_WIDTH, Plot, new_figure
from beambench_report.base.quantities import markdown_table
from beambench_thesis.chapter6.machines import Recorded
from beambench_thesis.chapter6.page import rendered
from beambench_thesis.chapter6.plots import HIGHER, line_look, log_axis, name_panel
from beambench_thesis.chapter6.record import LARGE
from beambench_thesis.chapter6.results import EQUAL_MACHINES, THESIS_OPTIONS, pivot, switched
from beambench_thesis.chapter6.simulate import DIVISIONS, ERAS, LARGE_OPTIONS, MACHINES_OF
from beambench_thesis.paper.evidence import rows_with

_COMPARED = (THESIS_OPTIONS, "image blocks", *DIVISIONS)
_CLUSTERS = {era: f"machines of {machines}" for era, machines in MACHINES_OF.items()}
_SHOWN = (8, 15, 32, 64, 128, 256, 512, 1024)


def _divided(simulations: pd.DataFrame) -> pd.DataFrame:
    """Returns runs of the thesis's scenes on switched networks: static divisions and their rivals.

    The table is empty if no division was simulated.
    """
    rows = switched(rows_with(simulations, options=_COMPARED, machines=EQUAL_MACHINES))
    rows = rows[rows["scene"].ne(LARGE) & (rows["consumers"] + 1).isin(_SHOWN)]
    rows = rows.drop_duplicates(["era", "scene", "options", "consumers"])
    return rows if rows["options"].isin(DIVISIONS).any() else rows.iloc[:0]


def _large(simulations: pd.DataFrame) -> pd.DataFrame:
    """Returns runs of the large picture, with the efficiency of tracing alone."""
    rows = simulations[simulations["scene"].eq(LARGE)]
    rows = rows.assign(processes=rows["consumers"] + 1)
    sequential = rows["sequential_seconds"] - rows["build_seconds"]
    return rows.assign(
        efficiency_of_tracing=sequential / (rows["processes"] * rows["traced_seconds"])
    )


def division_plots(simulations: pd.DataFrame) -> list[Plot]:
    """Plots efficiency over the number of processes, by division and for the large picture."""
    plots = []
    rows = _divided(simulations)
    if not rows.empty:
        scenes = list(dict.fromkeys(rows["scene"]))
        figure, panels = new_figure(PAGE_WIDTH * 0.95, rows=len(ERAS), columns=len(scenes))
        for number, (era, scene) in enumerate((era, scene) for era in ERAS for scene in scenes):
            of_panel = rows[rows["era"].eq(era) & rows["scene"].eq(scene)]
            _efficiency(panels[number], of_panel, _COMPARED, f"{scene}, {_CLUSTERS[era]}")
        panels[0].legend(fontsize=7, frameon=False)
        plots.append(Plot("divisions", figure, "efficiency of static divisions and of tiles"))
    rows = _large(simulations)
    if not rows.empty:
        figure, panels = new_figure(PAGE_WIDTH * 0.95, rows=1, columns=len(ERAS))
        for panel, era in zip(panels, ERAS, strict=True):
            _efficiency(panel, rows[rows["era"].eq(era)], tuple(LARGE_OPTIONS), _CLUSTERS[era])
            panel.axhline(0.5, color="#777777", linewidth=0.8, linestyle=(0, (1, 2)))
        panels[0].legend(fontsize=7, frameon=False)
        plots.append(Plot("large-picture", figure, f"efficiency on {LARGE}, a large picture"))
    return plots


def _efficiency(panel: Axes, rows: pd.DataFrame, options: tuple[str, ...], title: str) -> None:
    for index, name in enumerate(options):
        line = rows[rows["options"].eq(name)].sort_values("consumers")
        if line.empty:
            continue
        panel.plot(line["consumers"] + 1, line["efficiency"], **line_look(index), label=name)
    log_axis(panel)
    panel.set_ylim(0, 1.1)
    name_panel(panel, title, "processes", f"efficiency {HIGHER}")


def divisions_sections(
    simulations: pd.DataFrame,
    recorded: Mapping[tuple[str, str], Recorded],
    shown: Mapping[str, str],
) -> str:
    """Returns both sections of the page; empty if nothing was simulated for them."""
    divided, large = _divided(simulations), _large(simulations)
    values: dict[str, object] = {}
    if not large.empty:
        beams = recorded[LARGE, "beams"]
        values = {
            "beams": beams,
            "sequential": beams.build_seconds + beams.walk_seconds + beams.work_seconds,
            "processes": large["processes"].max(),
            "profile": _profile(large),
        }
    return rendered(
        "divisions",
        shown=shown,
        scene=LARGE,
        divided=None if divided.empty else _table(divided),
        large=None if large.empty else _table(large),
        **values,
    )


def _table(rows: pd.DataFrame) -> list[str]:
    shown = rows.assign(processes=rows["consumers"] + 1)
    counts = sorted(set(shown["processes"]) & set(_SHOWN))
    heads = {count: f"{count:,} processes" for count in counts}
    names = ("machines of", "scene", "work")
    by = ("era", "scene", "options")
    return pivot(shown, by, "processes", heads, lambda run: f"{run['efficiency']:.2f}", names)


def _profile(rows: pd.DataFrame) -> list[str]:
    """Returns a table of how the largest runs spend their time."""
    most = rows[rows["processes"].eq(rows["processes"].max())]
    lines = [
        (
            *(run["era"], run["options"], f"{run['seconds']:.4g}", f"{run['build_seconds']:.3g}"),
            *(f"{run['busy_mean']:.3g}" if "busy_mean" in run else "",),
            *(f"{run['busy_max']:.3g}" if "busy_max" in run else "",),
            *(f"{run['producer_busy']:.0%}", f"{run['messages_from_producer']:,}"),
            *(f"{run['efficiency']:.2f}", f"{run['efficiency_of_tracing']:.2f}"),
        )
        for _, run in most.iterrows()
    ]
    heads = (
        "machines of; work; seconds; seconds to build; consumers busy, mean; consumers busy, most; "
        "producer busy; messages out; efficiency; efficiency of tracing alone"
    )
    return markdown_table(heads.split("; "), lines)
