"""`beambench report` starts the Python package that draws."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from beambench_report.__main__ import main
from program import BINARY, beambench, refused


def report(python: str | Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "BEAMBENCH_REPORT_PYTHON": str(python)}
    return subprocess.run(
        [BINARY, "report", *arguments],
        capture_output=True,
        text=True,
        check=False,
        env=environment,
    )


@pytest.fixture
def bare_python(tmp_path: Path) -> Path:
    """A Python without any package."""
    python = tmp_path / "python"
    python.write_text(f'#!/bin/sh\nexec {sys.executable} -I -S "$@"\n')
    python.chmod(0o755)
    return python


def test_plots_pictures_and_the_page_are_made_and_the_page_is_named(tmp_path: Path) -> None:
    run = tmp_path / "-a run"
    sweep = ["run", "quick", "-o", run, "--benchmark_filter=tetra.*(samet|embree)"]
    assert beambench(*sweep).returncode == 0
    done = report(sys.executable, f"{run}")
    assert done.returncode == 0, done.stderr
    assert done.stdout == f"{run}/report.html\n"
    assert (run / "plots/overall.svg").is_file()
    assert list((run / "pictures").glob("tetra*.png"))
    page = (run / "report.html").read_text("utf-8")
    assert "beambench report" not in page  # the remedy for what a folder lacks


def test_the_reference_is_passed_on(tmp_path: Path) -> None:
    (tmp_path / "python").write_text('#!/bin/sh\nshift 2; echo "$@"\n')
    (tmp_path / "python").chmod(0o755)
    done = report(tmp_path / "python", "-r", "--reference", "samet max_level=6")
    assert done.returncode == 2
    done = report(tmp_path / "python", "run", "--reference", "samet max_level=6")
    words = ["report", "--beambench", str(BINARY.resolve()), "--reference=samet max_level=6"]
    assert done.stdout == f"{' '.join([*words, '--', 'run'])}\n"


def test_missing_packages_are_named_with_the_command_that_installs_them(bare_python: Path) -> None:
    refused(
        report(bare_python, "run"),
        ["has no module 'beambench_report'", "pipx install 'beambench[report]'"],
    )


def test_a_missing_python_is_named() -> None:
    refused(report("/no/python", "run"), ["/no/python", "pipx install 'beambench[report]'"])


def test_a_folder_without_a_run_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["report", str(tmp_path), "--beambench", "/bin/true"]) == 2
    assert "results.csv" in capsys.readouterr().err
