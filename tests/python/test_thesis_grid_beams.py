"""Beams through grids in the thesis report, from the run of a sweep."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import jsonschema

from beambench_report.base.published import primitives_by_scene
from beambench_thesis.chapter5.grid_beams import grid_beam_rows, grid_beams_section
from beambench_thesis.paper.cells import Cell, read_cells
from beambench_thesis.paper.section import section_as_markdown
from beambench_thesis.report.plan import read_sweep
from program import beambench

REPOSITORY = Path(__file__).parents[2]
SWEEP = REPOSITORY / "harness/measure/sweeps/grid-beams.json"


def measured(folder: Path) -> tuple[Cell, ...]:
    config = {
        "name": "grid-beams",
        "scenes": ["escena2"],
        "structures": [
            "grid-beam:handover=0",
            "grid-beam",
            "grid-beam:density=1",
            "hierarchical-grid:inner=powers",
            "hierarchical-grid",
            "beam:max_level=4",
            "beam:max_level=5",
        ],
        "resolutions": ["32x24"],
        "repetitions": {"minimum": 2, "maximum": 2},
        "budget_seconds": 1,
    }
    (folder / "sweep.json").write_text(json.dumps(config))
    run = folder / "grid-beams"
    beambench("run", str(folder / "sweep.json"), "-o", str(run))
    return read_cells(folder, [run.name]).cells


def test_beams_stand_beside_single_rays_through_the_same_grids(tmp_path: Path) -> None:
    cells = measured(tmp_path)
    (row,) = grid_beam_rows(cells)
    assert row.beams.parameters["handover"] != "0"
    assert row.rays.parameters["inner"] == "powers"
    assert row.beams.parameters["density"] == row.rays.parameters["density"]
    assert row.octree is not None
    slowed = replace(row, rays=replace(row.rays, trace=3.0 * row.beams.trace))
    assert abs(slowed.ratio - 3.0) < 1e-9
    section = grid_beams_section(cells)
    assert section is not None
    text = section_as_markdown(section)
    assert "32x24" in text
    assert "of 1 rows" in text
    assert grid_beams_section(cells[:1]) is None


def test_the_sweep_has_all_scenes(tmp_path: Path) -> None:
    source = json.loads(SWEEP.read_text())
    schema = json.loads((REPOSITORY / "harness/measure/sweep.schema.json").read_text())
    jsonschema.Draft202012Validator(schema).validate(source)
    sweep = read_sweep("grid-beams", SWEEP.parent)
    assert {cell.scene for cell in sweep.cells()} == set(primitives_by_scene())
