"""Progress messages of scripts/meshes."""

from __future__ import annotations


def say(text: str) -> None:
    """Prints a line at once, in the order of what other programs print."""
    print(f"== {text}", flush=True)
