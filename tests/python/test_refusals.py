"""The program refuses what it would otherwise ignore, and makes suggestions."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from pathlib import Path

import pytest

from program import BINARY, beambench, output_of, refused


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["-v"], "did you mean '--version'?"),
        (["scene", "TETRA"], "did you mean 'tetra'?"),
        (["verify", "tetra:n=1", "--accel", "SAMET"], "did you mean 'samet'?"),
        (["verify", "tetra:n=1", "--rays", "primary", "shadow"], "--rays A,B"),
        (["run", "quick", "--benchmark_filter=["], "not a valid regular expression"),
        (
            [
                "render",
                "tetra",
                "--accel",
                "samet",
                "--heatmap",
                "leaves",
                "--shade",
                "id",
                "-o",
                "x.png",
            ],
            "--shade excludes --heatmap",
        ),
    ],
)
def test_messages_say_what_was_meant(words: list[str], said: str) -> None:
    refused(beambench(*words), [said])


def test_an_invalid_memory_limit_is_invalid_input() -> None:
    done = subprocess.run(
        [BINARY, "verify", "tetra:n=1", "--accel", "samet"],
        env={**os.environ, "BEAMBENCH_MEMORY": "12X"},
        capture_output=True,
        text=True,
        check=False,
    )
    refused(done, ["BEAMBENCH_MEMORY is '12X'"])


def test_a_run_is_not_written_among_other_files(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").touch()
    done = beambench("run", "quick", "-o", tmp_path)
    assert done.returncode == 2
    assert "is not empty: it contains 'mine.txt'" in done.stderr
    assert [path.name for path in tmp_path.iterdir() if not path.name.startswith(".")] == [
        "mine.txt"
    ]


def test_interrupting_a_command_that_verify_runs_ends_with_130(tmp_path: Path) -> None:
    output_of("rays", "tetra:n=1", "--resolution", "4x4", "-o", tmp_path / "a.rays")
    slow = "touch begun; sleep 30; echo {hits}"
    process = subprocess.Popen(
        [BINARY, "verify", "tetra:n=1", "--rays", "a.rays", "--command", slow],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,  # a separate group, as a shell creates
    )
    ends = time.monotonic() + 60
    while not (tmp_path / "begun").exists():
        assert time.monotonic() < ends
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    _, messages = process.communicate(timeout=60)
    assert process.returncode == 130, messages
    assert "interrupted" in messages
