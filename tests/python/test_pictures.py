"""Rendering the scenes of a run, with a stand-in for beambench that records its calls."""

from __future__ import annotations

from pathlib import Path

import pytest

from beambench_report.__main__ import main
from synthetic_run import synthetic_rows, write_run


@pytest.fixture
def painter(tmp_path: Path) -> Path:
    """A program that appends its arguments to calls.txt and writes the file after -o."""
    program = tmp_path / "beambench"
    program.write_text(
        f'#!/bin/sh\necho "$@" >> {tmp_path}/calls.txt\n'
        'while [ "$1" != -o ]; do shift; done\necho picture > "$2"\n'
    )
    program.chmod(0o755)
    return program


def test_each_scene_is_rendered_and_has_a_heat_map(run_folder: Path, painter: Path) -> None:
    assert main(["pictures", str(run_folder), "--beambench", str(painter)]) == 0
    assert {path.name for path in (run_folder / "pictures").iterdir()} == {
        "escena1.png",
        "escena1-samet-traversal_steps.png",
        "tetra-n-5.png",
        "tetra-n-5-samet-traversal_steps.png",
    }
    calls = (painter.parent / "calls.txt").read_text().splitlines()
    pictures = run_folder / "pictures"
    assert calls[:2] == [
        f"render escena1 --accel embree -o {pictures}/escena1.png --exposure auto",
        "render escena1 --accel samet:max_level=5,max_objects=0 "
        f"-o {pictures}/escena1-samet-traversal_steps.png --heatmap traversal_steps",
    ]


def test_a_structure_that_was_wrong_has_no_heat_map(tmp_path: Path, painter: Path) -> None:
    rows = [{**row, "verdict": "mismatch"} for row in synthetic_rows()]
    folder = write_run(tmp_path, rows)
    assert main(["pictures", str(folder), "--beambench", str(painter)]) == 0
    assert len(list((folder / "pictures").iterdir())) == 2


def test_a_failure_of_beambench_is_passed_on(
    run_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["pictures", str(run_folder), "--beambench", "/bin/false"]) == 2
    assert "scene 'escena1' cannot be rendered: /bin/false" in capsys.readouterr().err


def test_a_missing_beambench_is_named(run_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pictures", str(run_folder), "--beambench", "/nowhere/beambench"]) == 2
    assert "/nowhere/beambench cannot be run" in capsys.readouterr().err
