"""The scripts as a user calls them."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pandas as pd
import pytest


def call(*command: str | Path, directory: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(part) for part in command], cwd=directory, capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize("script", ["run", "test", "meshes"])
def test_help_is_given(script: str, repository: Path) -> None:
    result = call(repository / "scripts" / script, "--help", directory=repository)
    assert result.returncode == 0
    assert result.stdout.startswith(f"usage: scripts/{script}")


@pytest.mark.parametrize(
    ("script", "arguments", "message"),
    [
        ("run", ["--swep", "x"], "unknown argument '--swep'"),
        ("run", ["--sweep"], "--sweep needs a file"),
        ("run", ["--sweep", "no/such.json"], "no/such.json is not a file that can be read"),
        ("test", ["--quick"], "takes no argument"),
        ("meshes", ["--all"], "unknown argument '--all'"),
        ("meshes", ["--beambench", "no/such"], "no/such is not a program"),
    ],
)
def test_a_wrong_request_is_one_sentence_and_exit_code_2(
    script: str, arguments: list[str], message: str, repository: Path
) -> None:
    result = call(repository / "scripts" / script, *arguments, directory=repository)
    assert result.returncode == 2
    assert result.stdout == ""
    assert result.stderr.startswith("error: ")
    assert message in result.stderr
    assert result.stderr.count("\n") == 1


def test_setup_does_not_clear_what_a_linked_environment_points_to(
    repository: Path, tmp_path: Path
) -> None:
    tree, others = tmp_path / "tree", tmp_path / "others"
    (tree / "scripts").mkdir(parents=True)
    shutil.copy(repository / "scripts/setup", tree / "scripts")
    for name in ("packages.txt", "packages-test.txt", "requirements.txt"):
        (tree / "scripts" / name).touch()  # nothing to install
    others.mkdir()
    (others / "precious").touch()
    (tree / ".venv").symlink_to(others)
    result = call(tree / "scripts/setup", directory=tmp_path)
    assert (others / "precious").exists()
    assert result.returncode == 2
    assert result.stderr.startswith("error: .venv is a symbolic link")
    assert str(others) in result.stderr
    assert result.stderr.count("\n") == 1


def test_the_lists_of_packages_name_each_once(repository: Path) -> None:
    lists = [repository / "scripts" / name for name in ("packages.txt", "packages-test.txt")]
    lines = [line for path in lists for line in path.read_text().splitlines()]
    packages = [line.split("#")[0].strip() for line in lines]
    packages = [package for package in packages if package]
    assert len(packages) == len(set(packages)) > 10


def test_a_small_sweep_leaves_records_pictures_plots_and_a_page(
    repository: Path, tmp_path: Path
) -> None:
    if not (repository / "build/release/bin/beambench").exists():
        pytest.skip("beambench is not built; run scripts/setup")
    sweep = tmp_path / "small.json"
    sweep.write_text(
        json.dumps(
            {
                "name": "small",
                "description": "One scene, for a test of scripts/run.",
                "scenes": ["stetra"],
                "structures": ["exhaustive", "samet", "null"],
                "resolutions": ["32x20", "64x40"],
                "samples": [1],
                "rays": ["primary"],
                "precision": 0.5,
                "repetitions": {"minimum": 2, "maximum": 3},
                "budget_seconds": 5,
            }
        )
    )
    run = tmp_path / "run"
    # Relative names are the caller's, whatever folder the script works in.
    result = call(
        repository / "scripts/run", "--sweep", "small.json", "--output", "run", directory=tmp_path
    )
    assert result.returncode == 0, result.stderr
    rows = pd.read_csv(run / "results.csv", keep_default_na=False)
    assert len(rows) == 6
    assert set(rows["verdict"]) == {"ok", "baseline"}
    assert (run / "plots" / "time-stetra.png").exists()
    assert (run / "pictures" / "stetra.png").exists()
    assert (run / "pictures" / "stetra-samet-traversal_steps.png").exists()
    assert f"Look at {run}/report.html\n" in result.stdout
    assert "All 6 cells were right" in (run / "report.html").read_text()
