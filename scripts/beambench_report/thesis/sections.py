"""The parts of the report beyond the thesis's tables and figures: those that were measured."""

from __future__ import annotations

import json
from pathlib import Path

from beambench_report.thesis.cells import Cells
from beambench_report.thesis.cost.section import cost_section
from beambench_report.thesis.facts.camera import camera_section
from beambench_report.thesis.facts.scenes import scenes_section
from beambench_report.thesis.facts.visits import visits_section
from beambench_report.thesis.levels.section import levels_section
from beambench_report.thesis.plan import Plan
from beambench_report.thesis.sampling.section import readable_comparisons, sampling_section
from beambench_report.thesis.section import Section
from beambench_report.thesis.sweeps import LEVELS, Sweep

SAMPLING = "sampling"
"""The folder of what `beambench sampling SCENE --json` printed."""


def extra_sweeps(directory: Path, plan: Plan) -> list[Sweep]:
    """The sweep of levels, where it was run into DIRECTORY/levels without being planned."""
    if any(sweep.name == LEVELS for sweep in plan.sweeps):
        return []
    try:
        source = json.loads((directory / LEVELS / "config.json").read_text("utf-8"))
    except (OSError, ValueError):
        return []
    return [Sweep(LEVELS, source)]


def sections_of(directory: Path, cells: Cells) -> tuple[list[Section], list[str]]:
    """All that were measured, and a sentence for each file that could not be read."""
    comparisons, unread = readable_comparisons(sorted((directory / SAMPLING).glob("*.json")))
    sections = (
        scenes_section(directory),
        visits_section(directory),
        camera_section(directory),
        cost_section(cells.cells),
        levels_section(cells.cells),
        sampling_section(comparisons),
    )
    return [section for section in sections if section is not None], unread
