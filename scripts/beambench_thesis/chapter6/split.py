"""A divided scene (`--split`) on simulated clusters: growth of time, traffic and memory with parts.

The scene is really traced during the simulation, so the times of one run depend on the state of
this machine: medians of several runs are kept. Machines of 1999 are as in the other simulations
(`machines.py`).
"""

import sys
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import pandas as pd

from beambench_report.base.figure import PAGE_WIDTH, Plot, new_figure
from beambench_report.base.files import Problem, read_table
from beambench_report.base.quantities import markdown_table
from beambench_thesis.chapter6.machines import (
    MESSAGES_OF_1999,
    MESSAGES_OF_TODAY,
    MODERN,
    NONE,
    SWITCHED,
    TRACED,
    Slowness,
)
from beambench_thesis.chapter6.page import rendered
from beambench_thesis.chapter6.plots import HIGHER, IDEAL, LOWER, line_look, name_panel
from beambench_thesis.chapter6.record import read_recorded
from beambench_thesis.chapter6.results import write_rows
from beambench_thesis.chapter6.simulate import OLD, TODAY, ResultCache, slowness_of

SPLIT = "split.csv"
CELLS_LEVEL = 4
PARTS = (1, 2, 4, 8, 16, 32, 64)


@dataclass(frozen=True)
class Divided:
    """A scene and the octree that suits it."""

    scene: str
    structure: str


SCENES = (
    Divided(TRACED, "beam:max_level=6"),
    Divided("tetra:n=7", "beam:max_level=7"),
    Divided("bumpy:triangles=200000", "beam:max_level=7"),
)
CLUSTERS = {OLD: (SWITCHED, MESSAGES_OF_1999), TODAY: (MODERN, MESSAGES_OF_TODAY)}


# The table: a row for each simulated run, the median of several. Seconds of the processor are this
# machine's, sums over all processes.
COLUMNS = (
    "era",
    "scene",
    "structure",
    "resolution",
    "processes",
    "traced_seconds",  # simulated: since the last process was ready, to the picture
    # Of tracing. Building is short and measured once a process: of many, the longest is chance.
    "speed_up",
    "efficiency",
    "balance",  # what a process is busy tracing on average, of what the busiest is
    "build_seconds",  # to divide the scene and build a part: the processes' median
    "walk_cpu_seconds",
    "test_cpu_seconds",
    "take_cpu_seconds",
    "messages",
    "bytes",
    "beams_handed",
    "rays_handed",
    "primitives",
    "largest_primitives",
    "largest_bytes",  # scene and octree of the largest part
    "result_hash",
)


def simulate_split(
    folder: Path, program: Path, resolution: str, repeats: int, most: int
) -> list[Path]:
    """Writes FOLDER/split.csv; machines of 1999 follow from the recordings there.

    Earlier results are reused: FOLDER/split-answers.jsonl has them. Raises Problem where parts give
    another picture than the whole.
    """
    cache = ResultCache(folder / "split-answers.jsonl")
    slow_by_era = {OLD: slowness_of(read_recorded(folder)), TODAY: NONE}
    rows: list[dict[str, object]] = []
    for era, slow in slow_by_era.items():
        for divided in SCENES:
            results = []
            for parts in (parts for parts in PARTS if parts <= most):
                what = f"\r{era}: {divided.scene} in {parts} parts   "
                print(what, end="", file=sys.stderr, flush=True)
                arguments = arguments_of(era, divided, parts, slow, resolution)
                results.append(median_run(cache, program, arguments, repeats))
            rows += [row_of(era, divided, resolution, result, results[0]) for result in results]
    print(file=sys.stderr)
    require_one_picture(rows)
    table = pd.DataFrame(rows, columns=list(COLUMNS))
    return [write_rows(folder / SPLIT, table)]


def median_run(cache: ResultCache, program: Path, arguments: list[str], repeats: int) -> dict:
    """Returns the run with the median tracing time, out of `repeats`."""
    runs = [
        cache.result([str(repeat), *arguments], [str(program), "split", *arguments])
        for repeat in range(repeats)
    ]
    runs.sort(key=lambda run: run["traced_seconds"])
    return runs[len(runs) // 2]


def read_split(folder: Path) -> pd.DataFrame | None:
    """Returns the table; None where there is none. Raises Problem where it lacks a column."""
    path = folder / SPLIT
    if not path.is_file():
        return None
    remedy = "write it with: python -m beambench_thesis cluster split DIR"
    types = {"era": str, "result_hash": str}
    return read_table(path, COLUMNS, remedy, types)


def arguments_of(
    era: str, divided: Divided, parts: int, slow: Slowness, resolution: str
) -> list[str]:
    """Returns arguments of the simulator."""
    network, messages = CLUSTERS[era]
    return [
        divided.scene,
        *("--accel", divided.structure),
        *("--split", str(CELLS_LEVEL)),
        *("--processes", str(parts)),
        *("--resolution", resolution),
        *("--build-scale", str(slow.build)),
        *("--walk-scale", str(slow.walk)),
        *("--work-scale", str(slow.work)),
        *network.arguments(),
        *messages.arguments(),
    ]


def total(result: dict, quantity: str) -> float:
    """Returns the sum over all processes."""
    return sum(process[quantity] for process in result["processes"])


def row_of(
    era: str, divided: Divided, resolution: str, result: dict, alone: dict
) -> dict[str, object]:
    """Returns a row of the table; the speedup is relative to `alone`."""
    processes = result["processes"]
    speed_up = alone["traced_seconds"] / result["traced_seconds"]
    busiest = max(process["busy"] for process in processes)
    return {
        "era": era,
        "scene": divided.scene,
        "structure": divided.structure,
        "resolution": resolution,
        "processes": len(processes),
        "traced_seconds": result["traced_seconds"],
        "speed_up": speed_up,
        "efficiency": speed_up / len(processes),
        "balance": total(result, "busy") / len(processes) / busiest,
        "build_seconds": median(process["build_seconds"] for process in processes),
        "walk_cpu_seconds": total(result, "walk_seconds"),
        "test_cpu_seconds": total(result, "test_seconds"),
        "take_cpu_seconds": total(result, "take_seconds"),
        "messages": int(total(result, "messages_out")),
        "bytes": int(total(result, "bytes_out")),
        "beams_handed": int(total(result, "beams_out")),
        "rays_handed": int(total(result, "rays_out")),
        "primitives": result["primitives"],
        "largest_primitives": max(process["primitives"] for process in processes),
        "largest_bytes": max(process["bytes"] for process in processes),
        "result_hash": result["result_hash"],
    }


def require_one_picture(rows: list[dict[str, object]]) -> None:
    """Raises Problem where rows of a scene have different pictures."""
    pictures: dict[str, str] = {}
    for row in rows:
        if pictures.setdefault(row["scene"], row["result_hash"]) != row["result_hash"]:
            raise Problem(
                f"{row['scene']} in {row['processes']} parts is another picture than the whole; "
                "that is a fault of beambench"
            )


STEM = "divided-scenes"
_SUMMARY = "divided scenes: speed-up, memory of the largest part, traffic"


def split_plot(rows: pd.DataFrame) -> Plot:
    """Draws the speedup on both clusters, the largest part's memory, and traffic across borders."""
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
        name_panel(panel, f"Speed-up, {name_of_machines(era)}", "parts", f"times {HIGHER}")
    last = rows[rows["era"].eq(eras[-1])]
    for index, (_, group) in enumerate(last.groupby("scene", sort=False)):
        look = line_look(index)
        memory.plot(group["processes"], 100 * share_of_memory(group), **look)
        crossed.plot(group["processes"], 1e-6 * group["bytes"], **look)
    name_panel(memory, "Scene and octree of the largest part", "parts", f"% of the whole {LOWER}")
    memory.plot(last["processes"], 100 / last["processes"], **IDEAL)
    memory.set_yscale("log")
    memory.yaxis.set_major_formatter("{x:.0f}")
    name_panel(crossed, "Handed over at borders", "parts", f"MB {LOWER}")
    for panel in panels:
        panel.set_xscale("log", base=2)
        panel.xaxis.set_major_formatter("{x:.0f}")
    panels[0].legend(fontsize=7.5, frameon=False)
    return Plot(STEM, figure, _SUMMARY)


def split_section(rows: pd.DataFrame) -> str:
    """Returns the section of the page, with the figure."""
    return rendered(
        "split",
        level=CELLS_LEVEL,
        resolution=rows["resolution"].iloc[0],
        summary=_SUMMARY,
        stem=STEM,
        speed_ups=_speed_ups(rows),
        machines=name_of_machines(rows["era"].iloc[-1]),
        costs=_costs(rows),
    )


def name_of_machines(era: str) -> str:
    """Returns the machines of an era in words, with their network."""
    return "1999, 100 Mbit/s" if era == OLD else f"{era}, 10 Gbit/s"


def share_of_memory(group: pd.DataFrame) -> pd.Series:
    """Returns the memory of each part as a share of one process's memory."""
    return group["largest_bytes"] / group["largest_bytes"].iloc[0]


def _speed_ups(rows: pd.DataFrame) -> list[str]:
    parts = sorted(set(rows["processes"]))
    lines = []
    for (era, scene), group in rows.groupby(["era", "scene"], sort=False):
        first, *others = group.itertuples()
        speed_ups = (f"{each.speed_up:.1f} ({each.efficiency:.2f})" for each in others)
        lines.append((name_of_machines(era), scene, f"{first.traced_seconds:.3g} s", *speed_ups))
    heads = ["machines", "scene", "1 part", *(f"{n} parts" for n in parts[1:])]
    return markdown_table(heads, lines)


def _costs(rows: pd.DataFrame) -> list[str]:
    """Returns a table of time and other costs."""
    last = rows[rows["era"].eq(rows["era"].iloc[-1])]
    lines = []
    for scene, group in last.groupby("scene", sort=False):
        work = group["walk_cpu_seconds"] + group["test_cpu_seconds"] + group["take_cpu_seconds"]
        shares = zip(work / work.iloc[0], share_of_memory(group), strict=True)
        for each, (work_share, memory_share) in zip(group.itertuples(), shares, strict=True):
            lines.append(
                (
                    scene,
                    f"{each.processes}",
                    f"{work_share:.2f}",
                    f"{each.balance:.2f}",
                    f"{each.messages:,}",
                    f"{1e-6 * each.bytes:.1f}",
                    f"{each.beams_handed:,}",
                    f"{each.rays_handed:,}",
                    f"{each.largest_primitives / each.primitives:.0%}",
                    f"{1e-6 * each.largest_bytes:.2f} MB, {memory_share:.0%}",
                )
            )
    heads = "scene, parts, work, balance, messages, MB, beams, rays, "
    heads += "primitives of the largest part, its memory"
    return markdown_table(heads.split(", "), lines)
