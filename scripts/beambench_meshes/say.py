"""Progress messages of scripts/meshes."""

from __future__ import annotations


def say(text: str) -> None:
    """Prints a line at once, so that it is in order with the output of other programs."""
    print(f"== {text}", flush=True)
