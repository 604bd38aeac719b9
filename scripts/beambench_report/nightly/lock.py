"""Keeps two nightly runs apart."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

from beambench_report.problem import Problem


@contextmanager
def only_one(path: Path) -> Iterator[int]:
    """Holds the lock file while the block runs; the system frees it, however the process ends.

    Gives the file's descriptor: a child that inherits it holds the lock, too, and goes on doing so
    where its parent is killed. Raises Problem, and waits for nothing, where another process has it.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a+", encoding="utf-8") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            file.seek(0)
            holder = file.read().strip() or "another process"
            raise Problem(
                f"{path}: a nightly run is going on ({holder}); wait until it has ended"
            ) from None
        file.truncate(0)
        file.write(f"process {os.getpid()} since {datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ}\n")
        file.flush()
        yield file.fileno()
        file.truncate(0)
