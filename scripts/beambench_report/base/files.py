"""What can go wrong, and writing files whole: beside their place first, then renamed.

Symbolic links stay links: what they lead to is replaced. Devices and pipes are written into.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
"""The top of the repository."""


class Problem(Exception):  # noqa: N818 (a wrong request is no programming error)
    """One sentence for the user: what is wrong with which file, and what to do."""


def write_whole(path: Path, write: Callable[[Path], object]) -> Path:
    """Lets `write` fill a file beside `path` and puts it there; returns `path`."""
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
    """Writes a text whole; returns `path`."""
    return write_whole(path, lambda pending: pending.write_text(text, "utf-8"))
