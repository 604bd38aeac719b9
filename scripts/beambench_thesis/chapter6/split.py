"""Simulates divided scenes (`--split`): time, traffic and memory by the number of parts.

The scene is really traced during the simulation, so the times of one run depend on the state of
this machine. Of several runs, the one with the median time is stored. Machines of 1999 are as in
the other simulations (`machines.py`).
"""

import sys
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import NamedTuple

import pandas as pd

from beambench_report.base.figure import PAGE_WIDTH, Plot, new_figure
from beambench_report.base.files import Problem, read_table
from beambench_report.base.quantities import markdown_table
from beambench_thesis.chapter6.machines import NONE, TRACED, Slowness, options
from beambench_thesis.chapter6.page import rendered
from beambench_thesis.chapter6.plots import HIGHER, IDEAL, LOWER, line_look, log_axis, name_panel
from beambench_thesis.chapter6.record import read_recorded
from beambench_thesis.chapter6.results import write_rows
from beambench_thesis.chapter6.simulate import (
    CLUSTERS,
    MACHINES_OF,
    OLD,
    TODAY,
    ResultCache,
    slowness_of,
)

SPLIT = "split.csv"
CELLS_LEVEL = 4
PARTS = (1, 2, 4, 8, 16, 32, 64)


class Divided(NamedTuple):
    """A scene and an octree that suits it."""

    scene: str
    structure: str


SCENES = (
    Divided(TRACED, "beam:max_level=6"),
    Divided("tetra:n=7", "beam:max_level=7"),
    Divided("bumpy:triangles=200000", "beam:max_level=7"),
)


def _sum(quantity: str) -> Callable[[dict], float]:
    return lambda run: sum(process[quantity] for process in run["processes"])


def _largest(quantity: str) -> Callable[[dict], float]:
    return lambda run: max(process[quantity] for process in run["processes"])


# Columns of the tables, from the run with the median time. Processor seconds are this machine's,
# summed over all processes.
_OF_RUN: dict[str, Callable[[dict], object]] = {
    "processes": lambda run: len(run["processes"]),
    # Simulated: from when the last process is ready until the picture is complete.
    "traced_seconds": lambda run: run["traced_seconds"],
    # Mean tracing time of the processes, relative to the busiest one.
    "balance": lambda run: _sum("busy")(run) / len(run["processes"]) / _largest("busy")(run),
    # Time to divide the scene and build a part: the median over processes.
    "build_seconds": lambda run: median(process["build_seconds"] for process in run["processes"]),
    "walk_cpu_seconds": _sum("walk_seconds"),
    "test_cpu_seconds": _sum("test_seconds"),
    "take_cpu_seconds": _sum("take_seconds"),
    "messages": lambda run: int(_sum("messages_out")(run)),
    "bytes": lambda run: int(_sum("bytes_out")(run)),
    "beams_handed": lambda run: int(_sum("beams_out")(run)),
    "rays_handed": lambda run: int(_sum("rays_out")(run)),
    "primitives": lambda run: run["primitives"],
    "largest_primitives": _largest("primitives"),
    "largest_bytes": _largest("bytes"),  # scene and octree of the largest part
    "result_hash": lambda run: run["result_hash"],
}
# Speedups are of tracing alone: each process builds only once, so the longest of many builds is a
# matter of chance.
_SETTING = ("era", "scene", "structure", "resolution", "processes", "traced_seconds")
COLUMNS = tuple(dict.fromkeys((*_SETTING, "speed_up", "efficiency", *_OF_RUN)))


class Runs:
    """Runs the simulator on divided scenes; a file stores the results for later calls."""

    def __init__(self, file: Path, program: Path, resolution: str, repeats: int) -> None:
        """Reads the file."""
        self._cache = ResultCache(file)
        self._program, self._resolution, self._repeats = program, resolution, repeats
        self._rows: list[dict[str, object]] = []

    def add(
        self, era: str, divided: Divided, parts: int, slow: Slowness = NONE, division: str = ""
    ) -> None:
        """Adds the run with the median tracing time of `repeats`."""
        what = f"{era}: {divided.scene} in {parts} parts{f', {division}' * bool(division)}"
        print(f"\r{what:<60}", end="", file=sys.stderr, flush=True)
        arguments = arguments_of(era, divided, parts, slow, self._resolution)
        arguments += options(division=division) if division else []
        runs = [
            self._cache.result([str(repeat), *arguments], [str(self._program), "split", *arguments])
            for repeat in range(self._repeats)
        ]
        run = sorted(runs, key=lambda run: run["traced_seconds"])[len(runs) // 2]
        # Mean busy time of the processes, relative to the traced seconds.
        share = _sum("busy")(run) / len(run["processes"]) / run["traced_seconds"]
        setting = {"division": division, "era": era, "resolution": self._resolution}
        figures = {name: figure(run) for name, figure in _OF_RUN.items()}
        self._rows.append(setting | divided._asdict() | figures | {"busy_share": share})

    def write(self, path: Path, columns: tuple[str, ...]) -> list[Path]:
        """Writes a table; speedups are relative to the first run of the same era and scene.

        Raises Problem if runs of a scene have different pictures.
        """
        print(file=sys.stderr)
        rows = pd.DataFrame(self._rows, columns=list(columns))
        whole = rows.groupby("scene")["result_hash"].transform("first")
        for row in rows[rows["result_hash"] != whole].itertuples():
            raise Problem(
                f"{row.scene} in {row.processes} parts is a different picture than the whole; this "
                "is a bug in beambench"
            )
        alone = rows.groupby(["era", "scene"])["traced_seconds"].transform("first")
        rows["speed_up"] = alone / rows["traced_seconds"]
        rows["efficiency"] = rows["speed_up"] / rows["processes"]
        return [write_rows(path, rows)]


def simulate_split(
    folder: Path, program: Path, resolution: str, repeats: int, most: int
) -> list[Path]:
    """Writes FOLDER/split.csv; the slowness of machines of 1999 follows from the recordings there.

    Earlier results in FOLDER/split-answers.jsonl are reused. Raises Problem if parts produce a
    different picture than the whole.
    """
    slow_by_era = {OLD: slowness_of(read_recorded(folder)), TODAY: NONE}
    runs = Runs(folder / "split-answers.jsonl", program, resolution, repeats)
    for era, slow in slow_by_era.items():
        for divided in SCENES:
            for parts in (parts for parts in PARTS if parts <= most):
                runs.add(era, divided, parts, slow)
    return runs.write(folder / SPLIT, COLUMNS)


def read_divided(path: Path, columns: tuple[str, ...]) -> pd.DataFrame | None:
    """Returns the table; None if it is missing. Raises Problem if it lacks a column."""
    if not path.is_file():
        return None
    remedy = "write it with: python -m beambench_thesis cluster split DIR"
    return read_table(path, columns, remedy, {"era": str, "result_hash": str})


def read_split(folder: Path) -> pd.DataFrame | None:
    """Returns the table of `simulate_split`, if it was written."""
    return read_divided(folder / SPLIT, COLUMNS)


def arguments_of(
    era: str, divided: Divided, parts: int, slow: Slowness, resolution: str
) -> list[str]:
    """Returns arguments of the simulator."""
    network, messages = CLUSTERS[era]
    return [
        divided.scene,
        *options(accel=divided.structure, split=CELLS_LEVEL, processes=parts),
        *options(resolution=resolution, build_scale=slow.build),
        *options(walk_scale=slow.walk, work_scale=slow.work),
        *network.arguments(),
        *messages.arguments(),
    ]


STEM = "divided-scenes"
_SUMMARY = "divided scenes: speedup, memory of the largest part, traffic"


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
        log_axis(panel, "y")
        name_panel(panel, f"Speedup, {MACHINES_OF[era]}", "parts", f"times {HIGHER}")
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
        log_axis(panel)
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
        machines=MACHINES_OF[rows["era"].iloc[-1]],
        costs=_costs(rows),
    )


def share_of_memory(group: pd.DataFrame) -> pd.Series:
    """Returns the memory of the largest part as a share of that of the first row."""
    return group["largest_bytes"] / group["largest_bytes"].iloc[0]


def work_of(rows: pd.DataFrame) -> pd.Series:
    """Returns the processor time of tracing, relative to the first row."""
    work = rows["walk_cpu_seconds"] + rows["test_cpu_seconds"] + rows["take_cpu_seconds"]
    return work / work.iloc[0]


def _speed_ups(rows: pd.DataFrame) -> list[str]:
    parts = sorted(set(rows["processes"]))
    lines = []
    for (era, scene), group in rows.groupby(["era", "scene"], sort=False):
        first, *others = group.itertuples()
        speed_ups = (f"{each.speed_up:.1f} ({each.efficiency:.2f})" for each in others)
        lines.append((MACHINES_OF[era], scene, f"{first.traced_seconds:.3g} s", *speed_ups))
    heads = ["machines", "scene", "1 part", *(f"{n} parts" for n in parts[1:])]
    return markdown_table(heads, lines)


def _costs(rows: pd.DataFrame) -> list[str]:
    """Returns a table of time and other costs."""
    last = rows[rows["era"].eq(rows["era"].iloc[-1])]
    lines = (
        (
            scene,
            f"{each.processes}",
            f"{each.work:.2f}",
            f"{each.balance:.2f}",
            f"{each.messages:,}",
            f"{1e-6 * each.bytes:.1f}",
            f"{each.beams_handed:,}",
            f"{each.rays_handed:,}",
            f"{each.largest_primitives / each.primitives:.0%}",
            f"{1e-6 * each.largest_bytes:.2f} MB, {each.memory:.0%}",
        )
        for scene, group in last.groupby("scene", sort=False)
        for each in group.assign(work=work_of, memory=share_of_memory).itertuples()
    )
    heads = "scene, parts, work, balance, messages, MB, beams, rays, "
    heads += "primitives of the largest part, its memory"
    return markdown_table(heads.split(", "), lines)
