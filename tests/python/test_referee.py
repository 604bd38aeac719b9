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
from beambench_operations.referee.findings import counterexample, rows_of
from beambench_operations.referee.page import share
from program import BINARY, output_of

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
            "ray": ray,
            "reported": claimed and {"t": claimed},
            "exact": judged and {"t": judged},
        }
        (tmp_path / "case.json").write_text(json.dumps({"wrong": wrong}))
        assert counterexample(tmp_path).confirmed == confirmed


WRONG = f"""#!{sys.executable}
import sys
import numpy as np
for line in sys.stdin:
    verb, *words = line.split()
    if verb == "describe":
        print('{{"name": "blind", "description": "blind", "version": "blind 1"}}', flush=True)
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
    code = main([f"blind={program}", "--kit", str(tmp_path / "kit"), "--program", str(BINARY),
                 "--work", str(tmp_path / "work"), "--output", str(tmp_path / "out")])  # fmt: skip
    assert code == 0
    rows = list(csv.DictReader((tmp_path / "out/referee.csv").open()))
    assert {row["query"] for row in rows} == {"closest", "any"}
    assert all(row["version"] == "blind 1 (times are self-reported)" for row in rows)
    assert all(row["unsupported"] == row["cases"] for row in rows if row["query"] == "any")
    assert sum(int(row["structure_error"]) for row in rows) > 0
    assert all(row["oracle_error"] == "0" for row in rows)
    page = (tmp_path / "out/README.md").read_text()
    assert "| 1 | a miss | t = " in page
    assert "| yes | `beambench --plugin PLUGIN verify minimal/blind/scene.obj" in page


def test_the_module_runs_as_a_command() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "beambench_operations.referee", "--help"],
        env={**os.environ, "PYTHONPATH": "scripts"},
        cwd=Path(__file__).resolve().parents[2],
        capture_output=True,
        text=True,
        check=True,
    )
    assert "NAME=PLUGIN" in done.stdout
