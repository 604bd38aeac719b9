"""Reports problems, runs programs, and reads and writes files.

Files are written under a temporary name and renamed, so they are never incomplete. Symbolic links
stay links: their targets are replaced. Devices and pipes are written directly.
"""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import IO, Any

import pandas as pd

from beambench_report.base.csv_texts import unguarded
from beambench_report.base.printable import printable

ROOT = Path(__file__).resolve().parents[3]
"""The top of the repository."""


class Problem(Exception):  # noqa: N818 (invalid arguments are not programming errors)
    """One sentence for the user: what is wrong with which file, and what to do."""


def say(text: str) -> None:
    """Reports progress or a warning on standard error; if that fails, the work continues."""
    try:
        print(printable(text), file=sys.stderr, flush=True)
    except OSError:
        # Discard unwritten text: flushing it at exit would fail from Python 3.13 on.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stderr.fileno())


def write_whole(path: Path, write: Callable[[Path], object]) -> Path:
    """Calls `write` for a temporary file beside `path` and renames it; returns `path`."""
    if path.exists() and not path.is_file() and not path.is_dir():
        write(path)
        return path
    target = path.resolve()
    pending = target.with_name(f".pending-{target.name}")
    try:
        write(pending)
        pending.replace(target)
    finally:
        pending.unlink(missing_ok=True)
    return path


def write_text(path: Path, text: str) -> Path:
    """Writes text atomically; returns `path`."""
    return write_whole(path, lambda pending: pending.write_text(text, "utf-8"))


def read_table(
    path: Path, columns: Collection[str], remedy: str, types: dict[str, type] | None = None
) -> pd.DataFrame:
    """Reads a CSV file. Raises Problem if it is missing, is not CSV, or lacks a column."""
    try:
        rows = pd.read_csv(path, dtype=types)
    except FileNotFoundError:
        raise Problem(f"{path}: there is no such file; {remedy}") from None
    except (pd.errors.ParserError, pd.errors.EmptyDataError, UnicodeDecodeError) as error:
        raise Problem(f"{path}: it is not a CSV file ({error})") from None
    missing = [column for column in columns if column not in rows]
    if missing:
        raise Problem(f"{path}: it has no column '{missing[0]}'; {remedy}")
    return unguarded(rows)


def load_json(path: Path) -> Any:  # noqa: ANN401 (like json.loads)
    """Returns the contents of a JSON file; a byte order mark is skipped.

    Raises ValueError if the file is not JSON or is nested too deeply, OSError if it cannot be read.
    """
    try:
        return json.loads(path.read_text("utf-8-sig"))
    except RecursionError:
        raise ValueError("its lists and objects are nested too deeply") from None


def read_json(path: Path) -> object:
    """Returns the contents of a JSON file; None if there is no file.

    Raises Problem if it is not JSON.
    """
    try:
        return load_json(path)
    except FileNotFoundError:
        return None
    except ValueError as error:
        raise Problem(f"{path}: cannot be read as JSON: {error}") from None


INTERRUPTED = (130, 143, -2, -15)  # as shells report SIGINT and SIGTERM, and as Python does


def run_in_foreground(
    command: Sequence[str],
    pass_fds: Collection[int] = (),
    output: int | IO[bytes] = subprocess.DEVNULL,
) -> int:
    """Runs a program and returns its exit code; by default, its standard output is discarded.

    SIGTERM is passed on to the program, and a keyboard interrupt reaches it directly. After either,
    the program is waited for, so that it can end cleanly. Raises Problem if it cannot be run.
    """
    try:
        child = subprocess.Popen(command, stdout=output, pass_fds=pass_fds)
    except OSError as error:
        raise Problem(f"{command[0]} cannot be run: {error.strerror}; build it first") from None
    before = signal.signal(signal.SIGTERM, lambda *_: child.terminate())
    try:
        return child.wait()
    except KeyboardInterrupt:
        child.wait()
        return INTERRUPTED[0]
    finally:
        signal.signal(signal.SIGTERM, before)


def output_of(
    command: Sequence[str],
    *,
    remedy: str = "build it first",
    success: Collection[int] = (0,),
    env: dict[str, str] | None = None,
) -> str:
    """Returns the standard output of a program.

    Raises Problem, with the last line of its standard error, if it cannot be run or fails.
    """
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False, env=env)
    except OSError as error:
        raise Problem(f"{command[0]} cannot be run: {error.strerror}; {remedy}") from None
    if done.returncode not in success:
        lines = done.stderr.strip().splitlines()
        raise Problem(lines[-1] if lines else f"{command[0]}: exit code {done.returncode}")
    return done.stdout
