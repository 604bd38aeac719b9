"""The ways to divide a scene (`--division`), compared on simulated machines of today."""

import sys
from pathlib import Path

import pandas as pd

from beambench_report.base.figure import PAGE_WIDTH, Plot, new_figure
from beambench_report.base.files import read_table
from beambench_report.base.quantities import markdown_table
from beambench_thesis.chapter6.machines import NONE
from beambench_thesis.chapter6.page import rendered
from beambench_thesis.chapter6.plots import HIGHER, LOWER, line_look, name_panel
from beambench_thesis.chapter6.results import write_rows
from beambench_thesis.chapter6.simulate import TODAY, ResultCache
from beambench_thesis.chapter6.split import (
    CELLS_LEVEL,
    COLUMNS,
    Divided,
    arguments_of,
    median_run,
    name_of_machines,
    require_one_picture,
    row_of,
    share_of_memory,
    total,
)

DIVISIONS_TABLE = "scene-divisions.csv"
DIVISIONS = ("primitives", "cost", "interleaved", "bisection", "scattered")
PARTS = (4, 16, 64)
SCENES = (
    Divided("torre-eiffel", "beam:max_level=6"),
    Divided("habitacion", "beam:max_level=6"),
    Divided("tetra:n=8", "beam:max_level=7"),
)

# Those of split.csv; `busy_share` is what a process is busy on average, of the traced seconds.
_COLUMNS = ("division", *COLUMNS, "busy_share")


def simulate_scene_divisions(
    folder: Path, program: Path, resolution: str, repeats: int, most: int
) -> list[Path]:
    """Writes FOLDER/scene-divisions.csv. The speedup is relative to one part of the same scene.

    Earlier results are reused. Raises Problem where parts give another picture than the whole.
    """
    cache = ResultCache(folder / "scene-divisions-answers.jsonl")
    rows: list[dict[str, object]] = []
    for divided in SCENES:

        def result(division: str, parts: int, divided: Divided = divided) -> dict:
            what = f"\r{divided.scene}, {division}, {parts} parts        "
            print(what, end="", file=sys.stderr, flush=True)
            arguments = arguments_of(TODAY, divided, parts, NONE, resolution)
            arguments += ["--division", division]
            return median_run(cache, program, arguments, repeats)

        alone = result(DIVISIONS[0], 1)
        rows.append(_row(DIVISIONS[0], divided, resolution, alone, alone))
        for division in DIVISIONS:
            for parts in (parts for parts in PARTS if parts <= most):
                rows.append(_row(division, divided, resolution, result(division, parts), alone))
    print(file=sys.stderr)
    require_one_picture(rows)
    return [write_rows(folder / DIVISIONS_TABLE, pd.DataFrame(rows, columns=list(_COLUMNS)))]


def read_scene_divisions(folder: Path) -> pd.DataFrame | None:
    """Returns the table; None where there is none. Raises Problem where it lacks a column."""
    path = folder / DIVISIONS_TABLE
    if not path.is_file():
        return None
    remedy = "write it with: python -m beambench_thesis cluster split DIR"
    return read_table(path, _COLUMNS, remedy, {"era": str, "result_hash": str})


def _row(
    division: str, divided: Divided, resolution: str, result: dict, alone: dict
) -> dict[str, object]:
    busy = total(result, "busy") / len(result["processes"])
    return {
        "division": division,
        **row_of(TODAY, divided, resolution, result, alone),
        "busy_share": busy / result["traced_seconds"],
    }


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
        panel.set_xscale("log", base=2)
        panel.xaxis.set_major_formatter("{x:.0f}")
    panels[0].legend(fontsize=7, frameon=False)
    return Plot(STEM, figure, _SUMMARY)


def scene_divisions_section(rows: pd.DataFrame) -> str:
    """Returns the section of the page, with the figure."""
    lines = []
    for scene, of_scene in rows.groupby("scene", sort=False):
        alone = of_scene.iloc[0]
        work_alone = _work(alone)
        for _, each in of_scene.iterrows():
            lines.append(
                (
                    scene,
                    each["division"],
                    f"{each['processes']}",
                    f"{1e3 * each['traced_seconds']:.1f}",
                    f"{each['speed_up']:.1f}",
                    f"{each['efficiency']:.2f}",
                    f"{each['balance']:.2f}",
                    f"{each['busy_share']:.2f}",
                    f"{_work(each) / work_alone:.2f}",
                    f"{each['rays_handed']:,}",
                    f"{1e-6 * each['largest_bytes']:.2f}",
                    f"{1e3 * each['build_seconds']:.1f}",
                )
            )
    heads = (
        "scene, division, parts, traced ms, speed-up, efficiency, balance, busy, work, "
        "rays handed over, MB of the largest part, build ms"
    )
    return rendered(
        "scene-divisions",
        level=CELLS_LEVEL,
        machines=name_of_machines(TODAY),
        resolution=rows["resolution"].iloc[0],
        summary=_SUMMARY,
        stem=STEM,
        rows=markdown_table(heads.split(", "), lines),
    )


def _work(row: pd.Series) -> float:
    return row["walk_cpu_seconds"] + row["test_cpu_seconds"] + row["take_cpu_seconds"]
