"""The sweeps of the thesis: valid, complete, and no cell measured twice."""

from __future__ import annotations

import csv
import json
from collections import Counter
from pathlib import Path

import jsonschema
import pytest

from beambench_report.base.files import Problem
from beambench_thesis.report.plan import (
    FIGURES,
    FOLDER,
    SWEEPS,
    TABLES,
    PlannedCell,
    make_plan,
    quick,
    read_sweep,
)
from program import BINARY, beambench

REPOSITORY = Path(__file__).resolve().parents[2]
DEFAULTS = {
    "max_level": "6",
    "max_objects": "0",
    "handover": "0",
    "insert": "everywhere",
    "leaf": "simd",
}
THESIS = {
    "voxel-grid": {"resolution": "32", "fill": "lazy"},
    "goldsmith-salmon": {"order": "given", "queue": "heap", "insert": "terminal"},
}


def printed_rows() -> list[dict[str, str]]:
    with (REPOSITORY / "results/thesis/times.csv").open() as file:
        return list(csv.DictReader(file))


def cells_of(*names: str) -> list[PlannedCell]:
    return [cell for name in names for cell in read_sweep(name).cells()]


def parameters(cell: PlannedCell) -> dict[str, str]:
    return DEFAULTS | dict(cell.parameters)


def is_wanted(cell: PlannedCell, row: dict[str, str]) -> bool:
    given = parameters(cell)
    octree = {"max_level": row["max_level"], "max_objects": row["max_objects"] or "0"}
    if row["algorithm"] == "beam":
        octree["leaf"] = "exact"
    wanted = THESIS.get(row["algorithm"], octree | {"handover": "0"})
    return (
        cell.scene == row["scene"]
        and cell.structure == row["algorithm"]
        and cell.resolution == f"{row['width']}x{row['height']}"
        and cell.samples == 1
        and all(given.get(name) == value for name, value in wanted.items())
    )


@pytest.mark.parametrize("name", SWEEPS)
def test_a_sweep_is_valid_and_says_what_it_is_for(name: str) -> None:
    schema = json.loads((REPOSITORY / "harness/measure/sweep.schema.json").read_text())
    sweep = read_sweep(name)
    jsonschema.Draft202012Validator(schema).validate(sweep.source)
    assert sweep.source["name"] == f"thesis-{name}"
    assert sweep.description
    assert sweep.source["repetitions"]["minimum"] >= 3
    known = {"scene", "structure", "rays_above"}  # to `cells`
    assert all(entry.keys() <= known for entry in sweep.source.get("exclude", []))


def test_every_file_is_a_sweep_that_something_shows() -> None:
    assert {path.stem for path in FOLDER.glob("*.json")} == set(SWEEPS)
    shown = {name for table in TABLES for name in (*table.first, *table.best)}
    assert shown | {name for figure in FIGURES for name in figure.sweeps} == set(SWEEPS)


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.number)
def test_every_row_of_a_table_has_its_cell_in_the_tables_own_sweeps(table) -> None:  # noqa: ANN001
    rows = [row for row in printed_rows() if row["table"] == table.number]
    cells = cells_of(*table.first)
    assert len(rows) >= 20
    for row in rows:
        assert sum(is_wanted(cell, row) for cell in cells) == 1, row


def test_where_the_thesiss_hierarchy_is_goldsmith_and_salmons_own_stands_beside_it() -> None:
    cells = [cell for cell in cells_of(*SWEEPS) if cell.structure == "goldsmith-salmon"]
    views = {(cell.scene, cell.resolution) for cell in cells}
    assert len(views) == 7 * 5
    for insertion in ("terminal", "everywhere"):
        wanted = THESIS["goldsmith-salmon"] | {"insert": insertion}
        there = {
            (cell.scene, cell.resolution)
            for cell in cells
            if all(parameters(cell).get(name) == value for name, value in wanted.items())
        }
        assert there == views, insertion


def test_no_cell_is_measured_twice() -> None:
    keys = [
        (cell.scene, cell.structure, tuple(sorted(named.items())), cell.resolution, cell.samples)
        for cell in cells_of(*SWEEPS)
        for named in [parameters(cell)]
    ]
    twice = [key for key, count in Counter(keys).items() if count > 1]
    assert not twice


def test_the_best_levels_of_figure_5_14_and_the_grids_of_5_17_are_swept() -> None:
    # Level 4 takes a minute per picture of gato-bill at 1280x1024.
    wanted = (("casa-de-campo", "1280x1024", "45678"), ("gato-bill", "320x200", "45678"))
    for scene, resolution, least in (*wanted, ("gato-bill", "1280x1024", "5678")):
        for structure in ("beam", "samet", "samet-net"):
            levels = {
                parameters(cell)["max_level"]
                for cell in cells_of("octree", "best-octree", "shallow")
                if (cell.scene, cell.structure, cell.resolution) == (scene, structure, resolution)
            }
            assert levels >= set(least)
            assert "4" in levels or least == "5678"
    for scene, best in (("flamenco", "13"), ("ajedrez", "15")):
        grids = {
            dict(cell.parameters)["resolution"]
            for cell in cells_of("others-large", "best-others-large", "best-grids")
            if (cell.scene, cell.structure) == (scene, "voxel-grid")
        }
        assert grids >= {best, "8", "32", "48"}


def test_the_whole_fits_into_the_hour_and_a_table_needs_a_part_of_it() -> None:
    everything, one = make_plan([], [], False), make_plan(["5.4"], [], False)
    assert everything.is_everything
    assert sum(sweep.budget_seconds for sweep in everything.sweeps) < 50 * 60
    assert [sweep.name for sweep in one.sweeps] == ["synthetic", "best-synthetic"]
    assert one.tables == ("5.4",)
    assert "5.12" in one.figures  # drawn from the same cells
    assert "5.13" not in one.figures


def test_quick_is_low_and_short() -> None:
    plan = make_plan([], [], True)
    sizes = {cell.resolution for sweep in plan.sweeps for cell in sweep.cells()}
    assert sizes == {"320x200", "640x480"}
    assert sum(sweep.budget_seconds for sweep in plan.sweeps) < 5 * 60
    assert quick(read_sweep("best-synthetic")).source["resolutions"] == ["320x200"]


@pytest.mark.parametrize("kind", ["table", "figure"])
def test_what_the_thesis_does_not_have_is_refused(kind: str) -> None:
    given = {"table": (["5.9"], []), "figure": ([], ["5.3"])}[kind]
    with pytest.raises(Problem, match=rf"there is no {kind} '5\.\d'; there are 5\.\d"):
        make_plan(*given, False)


@pytest.mark.parametrize("name", ["synthetic", "best-synthetic", "samples", "shallow"])
def test_cells_are_counted_as_the_program_counts_them(name: str) -> None:
    if not BINARY.exists():
        pytest.skip("beambench is not built; run scripts/setup")
    listed = beambench("run", "--dry-run", FOLDER / f"{name}.json")
    assert listed.returncode == 0, listed.stderr
    assert len(listed.stdout.splitlines()) == len(read_sweep(name).cells())
