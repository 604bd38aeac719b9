"""The table of structures verified over registered meshes from every camera."""

from __future__ import annotations

import csv
import os
import subprocess
import sys
from pathlib import Path

from beambench_meshes.every_camera import views

VIEWS = [(f"mesh:{mesh}", camera) for mesh, camera in views()]

_PROGRAM = """#!/usr/bin/env python3
import json, sys
arguments = sys.argv
scene = arguments[arguments.index("verify") + 1]
cell = {"scene": scene, "ray_kind": "ao:samples=2", "structure": "=1+1", "parameters": "a=1,b=2",
        "verdict": "ok", "rays": 9, "hits": 4, "agree": 9, "tie": 0, "graze": 0,
        "structure_error": 0, "embree_error": 0, "disputes": []}
with open(arguments[arguments.index("--json") + 1], "w") as file:
    json.dump({"cells": [cell, {**cell, "verdict": "error"}]}, file)
sys.exit(1)
"""


def run(repository: Path, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "beambench_meshes.every_camera", *map(str, arguments)],
        env={**os.environ, "PYTHONPATH": str(repository / "scripts")},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def test_each_camera_has_its_rows(repository: Path, tmp_path: Path) -> None:
    program = tmp_path / "program"
    program.write_text(_PROGRAM)
    program.chmod(0o755)
    done = run(repository, program, tmp_path / "all.csv")
    assert done.returncode == 0, done.stderr
    with (tmp_path / "all.csv").open(encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    assert [(row["scene"], row["camera"]) for row in rows[::2]] == VIEWS
    assert {("mesh:aneurysm", "tunnel"), ("mesh:cat", "top")} <= set(VIEWS)
    assert {row["verdict"] for row in rows} == {"ok", "error"}
    assert rows[0]["parameters"] == "a=1,b=2"
    assert {row["structure"] for row in rows} == {"'=1+1"}, "no cell is a formula"


def test_what_the_program_refuses_is_passed_on(repository: Path, tmp_path: Path) -> None:
    done = run(repository, "/bin/false", tmp_path / "all.csv")
    assert done.returncode == 1
    assert not (tmp_path / "all.csv").exists()
    assert run(repository).returncode == 2


def test_what_is_published_has_no_structure_error(repository: Path) -> None:
    file = repository / "results/published/real/cameras.csv"
    with file.open(encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    assert {(row["scene"], row["camera"]) for row in rows} == set(VIEWS)
    wrong = [row for row in rows if row["structure_error"] not in ("", "0")]
    assert not wrong
    said = (repository / "results/published/real/README.md").read_text("utf-8")
    verified = [row for row in rows if row["verdict"] != "baseline"]
    right = [row for row in verified if row["verdict"] == "ok"]
    assert f"Of {len(verified):,} cells" in said
    assert f"{len(right):,} are `ok`" in " ".join(said.split())
    assert {row["verdict"] for row in verified} <= {"ok", "grazes"}
