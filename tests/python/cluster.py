"""Starts beambench-cluster with mpirun."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from beambench_thesis.chapter6.record import ENVIRONMENT as OPEN_MPI
from program import BINARY

CLUSTER = BINARY.resolve().with_name("beambench-cluster")

needs_mpi = pytest.mark.skipif(
    shutil.which("mpirun") is None or not CLUSTER.exists(),
    reason="no mpirun, or built without MPI; scripts/setup installs both",
)


def skip_where_mpirun_starts_one_program_only() -> None:
    """Skips a test if mpirun crashes on starting two programs: Open MPI 5.0.7 of Debian 13 does."""
    if mpirun("-n", 1, "true", ":", "-n", 1, "true").returncode != 0:
        pytest.skip("mpirun cannot start two programs")


# mpirun waits for the processes of a failed run to end; without this wait, tests of failures take
# a third of the time.
ENVIRONMENT = {**os.environ, **OPEN_MPI, "OMPI_MCA_odls_base_sigkill_timeout": "0"}


def start(*arguments: str | Path, cwd: Path | None = None) -> subprocess.Popen[str]:
    """Starts mpirun with the given arguments."""
    return subprocess.Popen(
        ["mpirun", *map(str, arguments)],
        cwd=cwd,
        env=ENVIRONMENT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def finish(run: subprocess.Popen[str], timeout: int = 300) -> subprocess.CompletedProcess[str]:
    output, errors = run.communicate(timeout=timeout)
    return subprocess.CompletedProcess(run.args, run.returncode, output, errors)


def mpirun(*arguments: str | Path, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    return finish(start(*arguments, cwd=cwd))


def processes_of(run: subprocess.Popen[str]) -> dict[int, int]:
    """Returns the pids of the run's processes that have started, by rank."""
    children = Path(f"/proc/{run.pid}/task/{run.pid}/children").read_text().split()
    found = {}
    for child in map(int, children):
        try:
            environment = Path(f"/proc/{child}/environ").read_bytes()
        except OSError:
            continue
        for entry in environment.split(b"\0"):
            if entry.startswith(b"OMPI_COMM_WORLD_RANK="):
                found[int(entry.split(b"=")[1])] = child
    return found
