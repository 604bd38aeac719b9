"""Writing files whole: beside their place first, then renamed, so that none is ever half there."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path


def write_whole(path: Path, write: Callable[[Path], object]) -> Path:
    """Lets `write` fill a file beside `path` and puts it there; returns `path`."""
    pending = path.with_name(f".pending-{path.name}")
    try:
        write(pending)
        pending.replace(path)
    finally:
        pending.unlink(missing_ok=True)
    return path


def write_text(path: Path, text: str) -> Path:
    """Writes a text whole; returns `path`."""
    return write_whole(path, lambda pending: pending.write_text(text, "utf-8"))
