"""Draws figures 6.3 and 6.4 of the thesis from our simulations, and further figures."""

from collections.abc import Sequence

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from beambench_report.base.figure import DASHES, LINE_COLORS, MARKERS, PAGE_WIDTH, Plot, new_figure
from beambench_report.run.panels import scale_axis
from beambench_thesis.chapter6.results import EQUAL_MACHINES, THESIS_OPTIONS
from beambench_thesis.chapter6.simulate import MACHINES_OF, OLD, OPTIONS, STATIONS, TODAY
from beambench_thesis.paper.evidence import published_evidence, rows_with

LOWER, HIGHER = "(lower is better)", "(higher is better)"
IDEAL = {"color": "#777777", "linewidth": 0.8, "linestyle": (0, (1, 2)), "zorder": 1}


def cluster_plots(simulations: pd.DataFrame, processes: pd.DataFrame) -> list[Plot]:
    """Returns all figures for which the tables have rows."""
    equal = rows_with(simulations, machines=EQUAL_MACHINES)
    thesis = rows_with(equal, options=THESIS_OPTIONS, era=OLD, consumers=range(STATIONS))
    plots = []
    if not thesis.empty:
        plots += [_times(thesis), _balance(thesis, processes)]
    many = rows_with(equal[equal["consumers"] >= STATIONS // 2], options=OPTIONS)
    plots += [_scaling(rows_with(many, era=era), era) for era in (OLD, TODAY)]
    return [plot for plot in plots if plot is not None]


def _times(rows: pd.DataFrame) -> Plot:
    """Draws figure 6.3: time, speedup and efficiency over the number of consumers."""
    figure, panels = new_figure(PAGE_WIDTH * 0.95, rows=2, columns=2)
    seconds, speed_up, counted, uncounted = panels
    for index, (key, line) in enumerate(rows.groupby(["scene", "network"], sort=False)):
        group = line.sort_values("consumers")
        look = line_look(index) | {"label": ", ".join(key)}
        processors = group["consumers"] + 1
        seconds.plot(processors, group["seconds"], **look)
        speed_up.plot(processors, group["speed_up"], **look)
        counted.plot(processors, group["efficiency"], **look)
        uncounted.plot(group["consumers"], group["efficiency_of_consumers"], **look)
    last = int(rows["consumers"].max()) + 1
    speed_up.plot([1, last], [1, last], **IDEAL)
    for panel in (counted, uncounted):
        panel.axhline(1, **IDEAL)
        panel.set_ylim(0, 1.1)
    _overlay_thesis(counted, list(dict.fromkeys(rows["scene"])))
    every, alone = (
        "processors, including the producer's",
        "d) Efficiency, the producer not counted",
    )
    name_panel(seconds, "a) Time", every, f"seconds {LOWER}")
    seconds.set_ylim(bottom=0)
    name_panel(speed_up, "b) Speedup", every, f"times {HIGHER}")
    name_panel(counted, "c) Efficiency", every, f"speedup / processors {HIGHER}")
    name_panel(uncounted, alone, "consumers", f"speedup / consumers {HIGHER}")
    seconds.legend(fontsize=7.5, frameon=False)
    return Plot("figure-6.3", figure, "time, speedup and efficiency of 1 to 14 consumers")


def _overlay_thesis(efficiency: Axes, scenes: Sequence[str]) -> None:
    """Marks the thesis's best efficiency; for torre-eiffel only the mean is known."""
    cluster = published_evidence().cluster
    marks = []
    for scene in scenes:
        figures = {
            name: cluster.figure(name, scene, network)
            for network in cluster.networks
            for name in ("best_processors", "best_efficiency", "mean_efficiency")
        }
        best, height = figures["best_processors"], figures["best_efficiency"]
        height, what = (height, "best") if height else (figures["mean_efficiency"], "mean, at best")
        if best is None or height is None:
            continue
        marks += efficiency.plot(
            best.value,
            height.value,
            "*",
            markersize=11,
            markerfacecolor="none",
            color="#000000" if what == "best" else "#777777",
            label=f"thesis, {scene}: {what}",
        )
    if marks:
        efficiency.legend(handles=marks, fontsize=7, frameon=False, loc="lower center")


def _balance(thesis: pd.DataFrame, processes: pd.DataFrame) -> Plot | None:
    """Draws figure 6.4: beams and busy time of each process, with all 15 machines."""
    rows = thesis[thesis["consumers"].eq(STATIONS - 1)]
    rows = rows[rows["network"].eq(rows["network"].iloc[-1])] if not rows.empty else rows
    if rows.empty:
        return None
    figure, panels = new_figure(PAGE_WIDTH * 0.8, rows=2, columns=len(rows))
    for column, row in enumerate(rows.itertuples()):
        members = processes[processes["simulation"].eq(row.simulation)]
        consumers = members[members["role"].eq("consumer")]
        beams, times = panels[column], panels[column + len(rows)]
        # The axis of beams begins at 0, so that a small difference looks small.
        beams.plot(consumers["process"], consumers["tasks"], "o", color=LINE_COLORS[0])
        times.plot(
            consumers["process"], consumers["busy_seconds"], "o", color=LINE_COLORS[0], label="busy"
        )
        times.plot(
            consumers["process"],
            consumers["last_seconds"],
            "_",
            color=LINE_COLORS[1],
            markersize=9,
            label="end of the last beam",
        )
        name_panel(beams, row.scene, "consumer", "beams")
        producer = f"{row.scene}, the producer busy {row.producer_busy:.0%}"
        name_panel(times, producer, "consumer", "seconds")
        times.set_ylim(0, 1.3 * times.get_ylim()[1])
        beams.set_ylim(0, 1.08 * consumers["tasks"].max())
        times.legend(fontsize=7.5, frameon=False, loc="upper right", ncols=2)
        for panel in (beams, times):
            panel.xaxis.set_major_locator(MaxNLocator(integer=True))
    network = rows["network"].iloc[0]
    return Plot("figure-6.4", figure, f"beams and busy time of each process on {network}")


def _scaling(rows: pd.DataFrame, era: str) -> Plot | None:
    """Draws the speedup of each option and the load of the producer, up to 1,024 processes."""
    if rows.empty:
        return None
    scenes = list(dict.fromkeys(rows["scene"]))
    usual = rows["network"].mode().iloc[0]
    figure, panels = new_figure(PAGE_WIDTH * 0.95, rows=2, columns=len(scenes))
    for column, scene in enumerate(scenes):
        speed_up, busy = panels[column], panels[column + len(scenes)]
        of_scene = rows[rows["scene"].eq(scene)]
        lines = _option_lines(of_scene, usual)
        for index, ((options, network), group) in enumerate(lines):
            named = "" if network == usual else f", {network}"
            look = line_look(index) | {"label": f"{options}{named}"}
            speed_up.plot(group["consumers"] + 1, group["speed_up"], **look)
            busy.plot(group["consumers"] + 1, 100 * group["producer_busy"], **look)
        ends = [of_scene["consumers"].min() + 1, of_scene["consumers"].max() + 1]
        speed_up.plot(ends, ends, **IDEAL)
        scale_axis(speed_up, "y", [*of_scene["speed_up"], *ends])
        for panel in (speed_up, busy):
            log_axis(panel)
        name_panel(speed_up, f"{scene}: speedup", "processes", f"times {HIGHER}")
        name_panel(busy, f"{scene}: the producer is busy", "processes", "% of the time")
        busy.set_ylim(0, 105)
    panels[0].legend(fontsize=7, frameon=False)
    summary = f"speedup and the producer's load (machines: {MACHINES_OF[era]})"
    return Plot(f"many-processes-{era}", figure, summary)


def _option_lines(rows: pd.DataFrame, usual: str) -> Sequence[tuple[tuple[str, str], pd.DataFrame]]:
    """Returns a line for each option, then lines for other networks than the usual one."""
    groups = dict(list(rows.groupby(["options", "network"], sort=False)))
    options = list(OPTIONS)
    order = sorted(groups, key=lambda key: (key[1] != usual, options.index(key[0])))
    return [(key, groups[key].sort_values("consumers")) for key in order]


def line_look(index: int) -> dict[str, object]:
    """Returns the look of a line by its number: color, marker and dashes."""
    return {
        "color": LINE_COLORS[index % len(LINE_COLORS)],
        "marker": MARKERS[index % 7],
        "linestyle": DASHES[index % len(DASHES)],
        "markersize": 3.5,
        "linewidth": 1.2,
    }


def name_panel(panel: Axes, title: str, across: str, up: str) -> None:
    """Sets the title and the axis labels of a panel."""
    panel.set_title(title, fontsize=9)
    panel.set_xlabel(across)
    panel.set_ylabel(up)
    panel.grid(alpha=0.3)


def log_axis(panel: Axes, which: str = "x") -> None:
    """Makes an axis of a panel logarithmic to base 2, with whole numbers beside it."""
    getattr(panel, f"set_{which}scale")("log", base=2)
    getattr(panel, f"{which}axis").set_major_formatter("{x:.0f}")
