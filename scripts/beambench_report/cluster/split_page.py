"""What the page tells of a divided scene: one figure and two tables."""

from __future__ import annotations

import pandas as pd

from beambench_report.cluster.plan import OLD
from beambench_report.cluster.plots import IDEAL, line_look, name_panel
from beambench_report.cluster.split import CELLS_LEVEL
from beambench_report.figure import PAGE_WIDTH, Plot, new_figure

STEM = "divided-scenes"
_SUMMARY = "divided scenes: speed-up, memory of the largest part, traffic"


def split_plot(rows: pd.DataFrame) -> Plot:
    """Speed-up on both clusters, the largest part's memory, and what crossed borders."""
    figure, panels = new_figure(PAGE_WIDTH * 0.85, rows=2, columns=2)
    memory, crossed = panels[2], panels[3]
    eras = list(dict.fromkeys(rows["era"]))
    for panel, era in zip(panels, eras, strict=False):
        of_era = rows[rows["era"].eq(era)]
        for index, (scene, group) in enumerate(of_era.groupby("scene", sort=False)):
            panel.plot(group["processes"], group["speed_up"], label=scene, **line_look(index))
        panel.plot(of_era["processes"], of_era["processes"], **IDEAL)
        panel.set_yscale("log", base=2)
        panel.yaxis.set_major_formatter("{x:.0f}")
        name_panel(panel, f"Speed-up, {_machines(era)}", "parts", "times")
    last = rows[rows["era"].eq(eras[-1])]
    for index, (_, group) in enumerate(last.groupby("scene", sort=False)):
        look = line_look(index)
        memory.plot(group["processes"], 100 * _share_of_memory(group), **look)
        crossed.plot(group["processes"], 1e-6 * group["bytes"], **look)
    name_panel(memory, "Scene and octree of the largest part", "parts", "% of the whole")
    memory.plot(last["processes"], 100 / last["processes"], **IDEAL)
    memory.set_yscale("log")
    memory.yaxis.set_major_formatter("{x:.0f}")
    name_panel(crossed, "Handed over at borders", "parts", "MB")
    for panel in panels:
        panel.set_xscale("log", base=2)
        panel.xaxis.set_major_formatter("{x:.0f}")
    panels[0].legend(fontsize=7.5, frameon=False)
    return Plot(STEM, figure, _SUMMARY)


def split_section(rows: pd.DataFrame) -> str:
    """What stands on the page, its figure among it."""
    resolution = rows["resolution"].iloc[0]
    return "\n".join(
        [
            "## A divided scene\n",
            f"`--split {CELLS_LEVEL}`: each machine has the primitives in its share of the "
            f"octree's {8 ** (CELLS_LEVEL - 1)} cells of that level; {resolution}, one sample a "
            "pixel. The scene is really traced while it is simulated, and every run gave the hits "
            "of one process, bit for bit. Times are from when all parts are "
            "built to the picture: tracing, and gathering what was found.\n",
            f"![{_SUMMARY}]({STEM}.png)\n",
            _speed_ups(rows),
            _costs(rows),
            "Assumed: machines and messages of 1999, as above. Left out: to read the scene, the "
            "same for all and only from the whole can parts be cut; two buffers of the image's "
            "hits, 16 bytes a sample, which each process has beside its part; caches: here all "
            "processes share one core's.\n",
        ]
    )


def _machines(era: str) -> str:
    return "1999, 100 Mbit/s" if era == OLD else f"{era}, 10 Gbit/s"


def _share_of_memory(group: pd.DataFrame) -> pd.Series:
    """Of what one process has."""
    return group["largest_bytes"] / group["largest_bytes"].iloc[0]


def _speed_ups(rows: pd.DataFrame) -> str:
    parts = sorted(set(rows["processes"]))
    lines = [
        "Seconds of one part, and speed-up (in brackets: efficiency):\n",
        f"| machines | scene | 1 part | {' | '.join(f'{n} parts' for n in parts[1:])} |",
        "|---|---|" + "---|" * len(parts),
    ]
    for (era, scene), group in rows.groupby(["era", "scene"], sort=False):
        first, *others = group.itertuples()
        cells = [f"{each.speed_up:.1f} ({each.efficiency:.2f})" for each in others]
        cells.insert(0, f"{first.traced_seconds:.3g} s")
        lines.append(f"| {_machines(era)} | {scene} | {' | '.join(cells)} |")
    return "\n".join([*lines, ""])


def _costs(rows: pd.DataFrame) -> str:
    """Where the time goes, and what else it costs."""
    last = rows[rows["era"].eq(rows["era"].iloc[-1])]
    lines = [
        f"What it costs ({_machines(last['era'].iloc[0])}). Work: processor time of tracing, of "
        "what one part takes. Balance: how busy a machine is on average, of what the busiest "
        "is.\n",
        "| scene | parts | work | balance | messages | MB | beams | rays | "
        "primitives of the largest part | its memory |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for scene, group in last.groupby("scene", sort=False):
        work = group["walk_cpu_seconds"] + group["test_cpu_seconds"] + group["take_cpu_seconds"]
        memory = _share_of_memory(group)
        for i, each in enumerate(group.itertuples()):
            lines.append(
                f"| {scene} | {each.processes} | {work.iloc[i] / work.iloc[0]:.2f} "
                f"| {each.balance:.2f} | {each.messages:,} | {1e-6 * each.bytes:.1f} "
                f"| {each.beams_handed:,} | {each.rays_handed:,} "
                f"| {each.largest_primitives / each.primitives:.0%} "
                f"| {1e-6 * each.largest_bytes:.2f} MB, {memory.iloc[i]:.0%} |"
            )
    return "\n".join([*lines, ""])
