"""The files that texts show."""

from pathlib import Path


def plot(folder: Path, stem: str) -> str:
    """Returns the name of a plot: the SVG if there is one, else the PNG of an earlier commit."""
    return next(
        (name for name in (f"{stem}.svg", f"{stem}.png") if (folder / name).is_file()),
        f"{stem}.svg",
    )
