"""The referee's table: independent exact arithmetic, rows by family, and the whole command."""

from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest

from beambench_operations.referee.__main__ import main
from beambench_operations.referee.exact_ray import closest, vector
from beambench_operations.referee.findings import (
    COLUMNS,
    counterexample,
    place_of,
    read_rows,
    rows_of,
)
from beambench_operations.referee.libraries import LIBRARIES, precision
from beambench_operations.referee.page import family_cell, known_faults, page, share
from beambench_operations.referee.speed import contender, named_parameters, speed_rows
from program import BINARY, output_of

REPOSITORY = Path(__file__).resolve().parents[2]
PUBLISHED = REPOSITORY / "results/published/referee"

TRIANGLE = (vector((0, 0, 1)), vector((1, 0, 1)), vector((0, 1, 1)))


@pytest.mark.parametrize(
    ("origin", "expected"),
    [
        ((0.25, 0.25, 0), Fraction(1, 2)),  # inside
        ((0, 0, 0), Fraction(1, 2)),  # a corner
        ((0.5, 0.5, 0), Fraction(1, 2)),  # an edge
        ((0.5, 0.5 + 2**-53, 0), None),  # the next float beside it
        ((0.25, 0.25, 2), None),  # behind the origin
    ],
)
def test_the_exact_hit_of_a_triangle(
    origin: tuple[float, float, float], expected: Fraction | None
) -> None:
    assert closest([TRIANGLE], origin, (0, 0, 2)) == expected


def test_the_exact_hit_respects_the_closed_interval_and_parallel_rays() -> None:
    ray = ((0.25, 0.25, 0), (0, 0, 1))
    assert closest([TRIANGLE], *ray, t_max=1.0) == 1
    assert closest([TRIANGLE], *ray, t_min=1.0) == 1
    assert closest([TRIANGLE], *ray, t_max=0.9999999) is None
    assert closest([TRIANGLE], *ray, t_min=1.0000001) is None
    assert closest([TRIANGLE], (0, 0, 1), (1, 0, 0)) is None


def test_cases_are_added_up_by_family_and_query() -> None:
    counts = {"rays": 10, "agree": 8, "tie": 0, "graze": 1, "structure_error": 1,
              "embree_error": 0, "leaks": 1}  # fmt: skip
    case = {"family": "needles", "query": "any", "verdict": "mismatch", **counts}
    none = {**case, "verdict": "unsupported", **dict.fromkeys(counts, 0)}
    (row,) = rows_of("mine", "mine 1", [case, case, none])
    assert (row["cases"], row["unsupported"], row["rays"], row["leaks"]) == (3, 1, 20, 2)
    assert share([row], "any") == "80.0000%"
    assert share([row], "closest") == "unsupported"


@pytest.mark.parametrize(("wrong", "text"), [(0, "100%"), (1, "99.9999%")])
def test_only_all_is_written_as_all(wrong: int, text: str) -> None:
    assert share([{"query": "any", "rays": 10**9, "structure_error": wrong, "leaks": 0}],
                 "any") == text  # fmt: skip


def test_a_counterexample_that_is_none_is_not_confirmed(tmp_path: Path) -> None:
    """The library is right in the last case, and the judge is wrong."""
    (tmp_path / "scene.obj").write_text("v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n")
    ray = {"origin": [0.25, 0.25, 0], "direction": [0, 0, 1], "t_min": 0, "t_max": None}
    for claimed, judged, confirmed in [(None, 1, True), (1, 1, False), (1, None, False)]:
        wrong = {
            "class": "structure_error",
            "ray": ray,
            "reported": claimed and {"t": claimed},
            "exact": judged and {"t": judged},
        }
        (tmp_path / "case.json").write_text(json.dumps({"wrong": wrong}))
        assert counterexample(tmp_path).confirmed == confirmed


def test_the_folder_of_a_counterexample_states_the_version() -> None:
    assert place_of("tinybvh:layout=bvh8,exact_t=false", "tinybvh 1.6.7 (4735685)") == (
        "tinybvh-layout-bvh8-exact_t-false-1.6.7"
    )
    assert place_of("madmann91-bvh", "madmann91/bvh 2 (ac41ab8)") != place_of("madmann91-bvh", "x")


def test_a_cell_of_the_families_states_both_queries_only_if_they_differ() -> None:
    def row(query: str, wrong: int, **other: int) -> dict[str, object]:
        numbers = {**dict.fromkeys(COLUMNS[4:], 0), "cases": 1, "rays": 1000, **other}
        return {"family": "random", "query": query, **numbers, "structure_error": wrong}

    both = [row("closest", 0), row("any", 0)]
    assert family_cell(both, "random") == "100"
    assert family_cell([row("closest", 100), row("any", 0)], "random") == "90.0 / 100"
    assert family_cell([row("closest", 0, leaks=1), row("any", 0)], "random") == "99.9 / 100"
    assert family_cell([row(q, 0, rays=0, errors=1) for q in ("closest", "any")], "random") == (
        "fails"
    )
    assert family_cell([row(q, 0, rays=0) for q in ("closest", "any")], "random") == "-"


def test_faults_from_public_reports_are_read_from_the_rows() -> None:
    def rows(library: str, version: str, leaks: int) -> list[dict[str, object]]:
        numbers = {**dict.fromkeys(COLUMNS[4:], 0), "cases": 1, "rays": 10, "leaks": leaks}
        name = {"library": library, "version": version}
        return [{**name, "family": "odd directions", "query": "closest", **numbers}]

    found = known_faults(
        [
            rows("tinybvh:layout=bvh2,exact_t=false", "tinybvh 1.5.0 (abf17f5)", 3),
            rows("tinybvh:layout=bvh8,exact_t=false", "tinybvh 1.4.9 (e3e73cd)", 1),
            rows("tinybvh:layout=double,exact_t=false", "tinybvh 1.6.7 (4735685)", 2),
        ]
    )
    assert found["watertight"] == "1.5.0 3"
    assert (found["parallel"], found["zeros"]) == ("2", "1.4.9 1")
    assert known_faults([rows("vtk", "vtk 9", 0)]) == {}


SWEEP = {
    "structures": [
        "sah-bvh:lists=single",
        "sah-bvh",
        "vtk",
        {"structure": "tinybvh", "parameters": {"layout": ["bvh2", "bvh8"], "exact_t": False}},
    ]
}


def test_a_contender_is_named_by_the_parameters_of_the_sweep() -> None:
    named = named_parameters(SWEEP)
    assert named == {"sah-bvh": ["lists"], "vtk": [], "tinybvh": ["layout", "exact_t"]}
    assert contender("sah-bvh", "builder=binned,lists=streams", named["sah-bvh"]) == (
        "sah-bvh:lists=streams"
    )
    assert contender("vtk", "timeout=60", []) == "vtk"
    assert contender("tinybvh", "layout=bvh8,optimize=0,exact_t=false", named["tinybvh"]) == (
        "tinybvh:layout=bvh8,exact_t=false"
    )


def test_speeds_have_an_interval_and_only_right_hits_have_a_speed(tmp_path: Path) -> None:
    columns = "structure,parameters,library_version,ray_kind,scene,rays,verdict,blocks,"
    columns += "trace_ms,trace_ms_ci_low,trace_ms_ci_high"
    right = "sah-bvh,lists=single,,diffuse,bumpy,20000,ok,6,10,8,16"
    wrong = "vtk,timeout=60,vtk 9,diffuse,bumpy,20000,mismatch,6,,,"
    (tmp_path / "results.csv").write_text(f"{columns}\n{right}\n{wrong}\n")
    (tmp_path / "config.json").write_text(json.dumps(SWEEP))
    manifest = {"program": {"commit": "0123456789"}, "machine": {"cpu": "EPYC"},
                "measurement": {"other_work": 2.04}, "time_utc": "2026"}  # fmt: skip
    (tmp_path / "manifest.json").write_text(json.dumps(manifest))
    first, second = speed_rows(tmp_path)
    assert (first["mrays"], first["mrays_low"], first["mrays_high"]) == ("2", "1.25", "2.5")
    assert (second["mrays"], second["verdict"]) == ("", "mismatch")
    assert (first["commit"], first["other_work"]) == ("01234567", "2.04")


def test_each_offered_library_is_described() -> None:
    script = (REPOSITORY / "scripts/outside").read_text()
    offered = next(line for line in script.splitlines() if line.startswith('names="'))
    installed = {each.install.split()[-1] for each in LIBRARIES.values()}
    assert installed == set(offered.removeprefix('names="').rstrip('"').split())
    assert precision("tinybvh:layout=double,exact_t=false") == "double"
    assert precision("tinybvh:layout=bvh2,exact_t=false") == "float"


def test_the_published_page_is_made_from_the_published_rows() -> None:
    text = (PUBLISHED / "README.md").read_text()
    assert text == page(PUBLISHED)
    assert len(text.splitlines()) <= 150
    for rows in read_rows(PUBLISHED / "referee.csv"):
        assert rows[0]["library"] in text
        assert sum(row["rays"] for row in rows) >= 800_000


def test_each_published_counterexample_is_confirmed_and_each_fault_has_one() -> None:
    for rows in read_rows(PUBLISHED / "referee.csv"):
        place = PUBLISHED / "minimal" / place_of(rows[0]["library"], rows[0]["version"])
        closest_wrong = sum(r["structure_error"] for r in rows if r["query"] == "closest")
        assert (place / "case.json").exists() == (
            closest_wrong + sum(row["leaks"] for row in rows) > 0
        ), place
        if (place / "case.json").exists():
            found = counterexample(place)
            assert found.confirmed, place
            assert found.leak == (closest_wrong == 0)


WRONG = f"""#!{sys.executable}
import sys
import numpy as np
for line in sys.stdin:
    verb, *words = line.split()
    if verb == "describe":
        print('{{"name": "vtk", "description": "blind", "version": "blind 1"}}', flush=True)
        continue
    if verb == "any":
        print("unsupported there is no such query", flush=True)
        continue
    if verb == "closest":
        n = int(words[1])
        memory = np.memmap(words[0], np.uint8, mode="r+")
        memory[32 * n : 36 * n] = np.full(n, np.inf, "<f4").view(np.uint8)
        memory[36 * n : 40 * n] = 255
    print("ok 0", flush=True)
"""


def test_the_command_writes_the_table_and_a_confirmed_counterexample(tmp_path: Path) -> None:
    program = tmp_path / "blind"
    program.write_text(WRONG)
    program.chmod(0o755)
    output_of("selftest", "--export", tmp_path / "kit", "--scenes", "1", "--rays", "20")
    code = main([f"vtk={program}", "--kit", str(tmp_path / "kit"), "--program", str(BINARY),
                 "--work", str(tmp_path / "work"), "--output", str(tmp_path / "out")])  # fmt: skip
    assert code == 0
    rows = list(csv.DictReader((tmp_path / "out/referee.csv").open()))
    assert {row["query"] for row in rows} == {"closest", "any"}
    assert all(row["version"] == "blind 1 (times are self-reported)" for row in rows)
    assert all(row["unsupported"] == row["cases"] for row in rows if row["query"] == "any")
    assert sum(int(row["structure_error"]) for row in rows) > 0
    assert all(row["oracle_error"] == "0" for row in rows)
    text = (tmp_path / "out/README.md").read_text()
    assert "| wrong hit | 1 | a miss | t = " in text
    place = "results/published/referee/minimal/vtk-1/scene.obj"
    assert f"| yes | `beambench --plugin $(scripts/outside vtk) verify {place} --accel vtk" in text
    assert "Not measured yet" in text


def test_the_module_runs_as_a_command() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "beambench_operations.referee", "--help"],
        env={**os.environ, "PYTHONPATH": "scripts"},
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        check=True,
    )
    assert "NAME=PLUGIN" in done.stdout
