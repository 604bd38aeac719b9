"""The thesis's figures from results/thesis, and the resolutions at which it measured."""

from functools import cache

import pandas as pd

from beambench_report.base.files import ROOT, read_table

FOLDER = ROOT / "results/thesis"
RESOLUTIONS = ("320x200", "640x480", "800x600", "1024x768", "1280x1024")
COARSEST, FINEST = RESOLUTIONS[0], RESOLUTIONS[-1]


def rays(resolution: str) -> int:
    """Returns the number of rays of an image with one sample per pixel."""
    width, height = resolution.split("x")
    return int(width) * int(height)


def read_published(name: str) -> pd.DataFrame:
    """Reads a table of results/thesis. Raises Problem if it is missing."""
    return read_table(FOLDER / name, (), "restore it with git", {"table": str})


@cache
def primitives_by_scene() -> dict[str, int]:
    """Reads table 5.1: polygons and spheres of each scene."""
    scenes = read_published("scenes.csv")
    return dict(zip(scenes["scene"], scenes["polygons"] + scenes["spheres"], strict=True))
