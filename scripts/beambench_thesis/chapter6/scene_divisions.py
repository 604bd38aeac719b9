"""The ways to divide a scene (`--division`), compared on simulated machines of today."""

from pathlib import Path

import pandas as pd

from beambench_report.base.figure import PAGE_WIDTH, Plot, new_figure
from beambench_report.base.quantities import markdown_table
from beambench_thesis.chapter6.page import rendered
from beambench_thesis.chapter6.plots import HIGHER, LOWER, line_look, log_axis, name_panel
from beambench_thesis.chapter6.simulate import MACHINES_OF, TODAY
from beambench_thesis.chapter6.split import (
    CELLS_LEVEL,
    COLUMNS,
    Divided,
    Runs,
    read_divided,
    share_of_memory,
    work_of,
)

DIVISIONS_TABLE = "scene-divisions.csv"
DIVISIONS = ("primitives", "cost", "interleaved", "bisection", "scattered")
PARTS = (4, 16, 64)
SCENES = (
    Divided("torre-eiffel", "beam:max_level=6"),
    Divided("habitacion", "beam:max_level=6"),
    Divided("tetra:n=8", "beam:max_level=7"),
)
_COLUMNS = ("division", *COLUMNS, "busy_share")


def simulate_scene_divisions(
    folder: Path, program: Path, resolution: str, repeats: int, most: int
) -> list[Path]:
    """Writes FOLDER/scene-divisions.csv, with speedups relative to one part of the same scene.

    Earlier results are reused. Raises Problem if parts produce a different picture than the whole.
    """
    runs = Runs(folder / "scene-divisions-answers.jsonl", program, resolution, repeats)
    for divided in SCENES:
        runs.add(TODAY, divided, 1, division=DIVISIONS[0])
        for division in DIVISIONS:
            for parts in (parts for parts in PARTS if parts <= most):
                runs.add(TODAY, divided, parts, division=division)
    return runs.write(folder / DIVISIONS_TABLE, _COLUMNS)


def read_scene_divisions(folder: Path) -> pd.DataFrame | None:
    """Returns the table of `simulate_scene_divisions`, if it was written."""
    return read_divided(folder / DIVISIONS_TABLE, _COLUMNS)


STEM = "scene-divisions"
_SUMMARY = "ways to divide a scene: efficiency, and memory of the largest part"


def scene_divisions_plot(rows: pd.DataFrame) -> Plot:
    """Draws efficiency and memory of each division, a column for each scene."""
    scenes = list(dict.fromkeys(rows["scene"]))
    figure, panels = new_figure(PAGE_WIDTH, rows=2, columns=len(scenes))
    for column, scene in enumerate(scenes):
        of_scene = rows[rows["scene"].eq(scene)]
        efficiency, memory = panels[column], panels[len(scenes) + column]
        alone = of_scene.iloc[:1]
        for index, division in enumerate(dict.fromkeys(of_scene["division"])):
            own = of_scene[of_scene["division"].eq(division) & (of_scene["processes"] > 1)]
            group = pd.concat([alone, own])
            look = line_look(index)
            efficiency.plot(group["processes"], group["efficiency"], label=division, **look)
            memory.plot(group["processes"], 100 * share_of_memory(group), **look)
        name_panel(efficiency, f"Efficiency, {scene}", "parts", HIGHER)
        efficiency.set_ylim(0, None)
        name_panel(memory, f"Largest part, {scene}", "parts", f"% of the whole {LOWER}")
        memory.set_yscale("log")
        memory.yaxis.set_major_formatter("{x:.0f}")
    for panel in panels:
        log_axis(panel)
    panels[0].legend(fontsize=7, frameon=False)
    return Plot(STEM, figure, _SUMMARY)


def scene_divisions_section(rows: pd.DataFrame) -> str:
    """Returns the section of the page, with the figure."""
    lines = (
        (
            scene,
            each.division,
            f"{each.processes}",
            f"{1e3 * each.traced_seconds:.1f}",
            f"{each.speed_up:.1f}",
            f"{each.efficiency:.2f}",
            f"{each.balance:.2f}",
            f"{each.busy_share:.2f}",
            f"{each.work:.2f}",
            f"{each.rays_handed:,}",
            f"{1e-6 * each.largest_bytes:.2f}",
            f"{1e3 * each.build_seconds:.1f}",
        )
        for scene, group in rows.groupby("scene", sort=False)
        for each in group.assign(work=work_of).itertuples()
    )
    heads = (
        "scene, division, parts, traced ms, speedup, efficiency, balance, busy, work, "
        "rays handed over, MB of the largest part, build ms"
    )
    return rendered(
        "scene-divisions",
        level=CELLS_LEVEL,
        machines=MACHINES_OF[TODAY],
        resolution=rows["resolution"].iloc[0],
        summary=_SUMMARY,
        stem=STEM,
        rows=markdown_table(heads.split(", "), lines),
    )
