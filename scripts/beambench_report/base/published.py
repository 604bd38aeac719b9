"""The thesis's figures, as results/thesis has them, and the resolutions at which it measured."""

from functools import cache
from pathlib import Path

import pandas as pd

from beambench_report.base.files import ROOT, read_table

FOLDER = ROOT / "results/thesis"
RESOLUTIONS = ("320x200", "640x480", "800x600", "1024x768", "1280x1024")
COARSEST, FINEST = RESOLUTIONS[0], RESOLUTIONS[-1]


def rays(resolution: str) -> int:
    """Rays of an image with one sample per pixel."""
    width, height = resolution.split("x")
    return int(width) * int(height)


def read_published(name: str, folder: Path = FOLDER) -> pd.DataFrame:
    """A table of results/thesis. Raises Problem where it is missing."""
    return read_table(folder / name, (), "restore it with git", {"table": str})


@cache
def primitives_by_scene() -> dict[str, int]:
    """Table 5.1: polygons and spheres of each scene."""
    scenes = read_published("scenes.csv")
    return dict(zip(scenes["scene"], scenes["polygons"] + scenes["spheres"], strict=True))
