"""Storage of nightly runs: a folder with the history, and a folder for each run."""

import fcntl
import os
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

from beambench_operations.history.store import recorded_folders
from beambench_report.base.files import ROOT, Problem, read_json
from beambench_report.base.records import FAULTLESS_VERDICTS
from beambench_report.base.run_log import LOG, logged_cells


@contextmanager
def only_one(path: Path) -> Iterator[int]:
    """Holds the lock file during the block; the system frees it however the process ends.

    Yields the file's descriptor: a child that inherits it also holds the lock, even after its
    parent is killed. Raises Problem at once if another process has the lock.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a+", encoding="utf-8") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            file.seek(0)
            holder = file.read().strip() or "another process"
            raise Problem(
                f"{path}: a nightly run is in progress ({holder}); wait until it has ended"
            ) from None
        file.truncate(0)
        file.write(f"process {os.getpid()} since {datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ}\n")
        file.flush()
        yield file.fileno()
        file.truncate(0)


HOME = ROOT / "results/runs/nightly"

KEEP_SAMPLES = 30
"""The number of runs that keep their raw samples.

CSVs, manifests, sweeps and mismatch pictures always stay.
"""


class Home:
    """The files of a history."""

    def __init__(self, folder: Path) -> None:
        """Names the files, which need not exist yet."""
        self.folder = folder
        self.history = folder / "history.sqlite"
        self.lock = folder / "nightly.lock"  # held while a run is in progress
        self.site = folder / "site"  # over all nights
        self.page = self.site / "index.html"

    def finished(self) -> list[Path]:
        """Returns the folders of finished runs, the oldest first."""
        return [path for path in recorded_folders(self.folder) if is_finished(path)]

    def unfinished(self) -> list[Path]:
        """Returns the folders of interrupted runs, the oldest first."""
        begun = sorted(path for path in self.folder.glob("[0-9]*") if path.is_dir())
        return [path for path in begun if not is_finished(path)]


def adopt(home: Home, run: Path, run_id: str) -> Path:
    """Copies a run below the home, unless it is there, so that a rebuild finds it."""
    if run.resolve().parent == home.folder.resolve():
        return run
    target = home.folder / re.sub(r"[^A-Za-z0-9._-]", "-", run_id)
    if not target.name[:1].isdigit():
        raise Problem(f"{run}: its run_id '{run_id}' does not begin with a time, as it must")
    if not target.exists():
        home.folder.mkdir(parents=True, exist_ok=True)
        pending = target.with_name(f".pending-{target.name}")
        shutil.copytree(run, pending, dirs_exist_ok=True)
        pending.rename(target)
    return target


def is_finished(run: Path) -> bool:
    """Returns whether the run is finished."""
    manifest = read_json(run / "manifest.json")
    ended = isinstance(manifest, dict) and bool(manifest.get("finished_utc"))
    return ended and (run / "results.csv").exists()


def abandon(run: Path) -> Path:
    """Renames an interrupted run, so that it never enters the history."""
    target = run.with_name(f"abandoned-{run.name}")
    if target.exists():
        shutil.rmtree(target)
    return run.rename(target)


def prune(home: Home, keep: int = KEEP_SAMPLES) -> list[Path]:
    """Deletes the raw samples of all but the newest `keep` runs, and older abandoned runs.

    A run with wrong cells keeps its log, which contains the examples.
    """
    runs = home.finished()
    old, kept = (runs[:-keep], runs[-keep:]) if keep > 0 else (runs, [])
    deleted = []
    for run in old:
        files = ["google-benchmark.json"]
        if all(cell.verdict in FAULTLESS_VERDICTS for cell in logged_cells(run)):
            files.append(LOG)
        deleted += [run / name for name in files if (run / name).exists()]
    for path in deleted:
        path.unlink()
    oldest = kept[0].name if kept else ""
    for path in home.folder.glob("abandoned-*"):
        if path.name.removeprefix("abandoned-") < oldest:
            shutil.rmtree(path)
            deleted.append(path)
    return deleted
