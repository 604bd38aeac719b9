"""Runs the program as a user does."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

from beambench_report.run.html import environment

BINARY = Path(
    os.environ.get(
        "BEAMBENCH_BINARY",
        Path(__file__).resolve().parents[2] / "build/release/bin/beambench",
    )
)


def beambench(*arguments: str | Path, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [BINARY, *map(str, arguments)],
        cwd=cwd,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def can_explain() -> bool:
    """Returns whether the program contains three.js, which scripts/setup fetches if npm exists."""
    words = ["explain", "tetra:n=1", "--accel", "samet", "--resolution", "1x1", "-o", "/dev/null"]
    return "no three.js" not in beambench(*words).stderr


def sorts_tables() -> bool:
    """Returns whether pages contain DataTables, which scripts/setup fetches if npm exists."""
    return bool(environment().globals["library_scripts"])


def shell(line: str, cwd: Path, timeout: float = 300) -> subprocess.CompletedProcess[str]:
    """Runs a line pasted into a shell that finds the program on its PATH."""
    path = f"{BINARY.resolve().parent}:{os.environ['PATH']}"
    return subprocess.run(
        ["bash", "-c", line],
        cwd=cwd,
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
    )


def output_of(*arguments: str | Path) -> str:
    """Returns the standard output of a command that must succeed."""
    done = beambench(*arguments)
    assert done.returncode == 0, done.stderr
    return done.stdout


def refused(done: subprocess.CompletedProcess[str], words: list[str]) -> None:
    """Expects exit code 2, nothing on stdout, and a sentence on stderr with the words."""
    assert done.returncode == 2, (done.returncode, done.stdout, done.stderr)
    assert done.stdout == ""
    lines = done.stderr.splitlines()
    assert len(lines) == 1, done.stderr
    assert lines[0].startswith("beambench: ")
    assert "terminate called" not in done.stderr
    assert "internal error" not in done.stderr
    for word in words:
        assert word in lines[0]
