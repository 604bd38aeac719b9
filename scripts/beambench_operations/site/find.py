"""The folders of runs below given ones, however deep."""

import os
from collections.abc import Iterable
from pathlib import Path

from beambench_report.base.files import Problem

_RUN_FILES = {"results.csv", "manifest.json"}
HISTORY = "history.sqlite"


def find_runs(folders: Iterable[Path]) -> tuple[list[Path], list[Path]]:
    """Returns folders of runs, each once, and the histories of nightly runs.

    Abandoned runs and hidden folders are left out. Raises Problem where a folder does not exist, or
    where no run is found.
    """
    runs: dict[Path, Path] = {}
    histories: dict[Path, Path] = {}
    for folder in (wanted := list(folders)):
        if not folder.is_dir():
            raise Problem(f"{folder}: is not a folder; give folders of runs, or that hold runs")
        for place, names, files in os.walk(folder):
            here = Path(place)
            if _RUN_FILES & set(files):
                runs.setdefault(here.resolve(), here)
                names.clear()
            if HISTORY in files:
                histories.setdefault(here.resolve(), here / HISTORY)
            names[:] = sorted(name for name in names if not name.startswith((".", "abandoned-")))
    if not runs:
        raise Problem(f"{', '.join(map(str, wanted))}: holds no run; `beambench run` writes runs")
    return list(runs.values()), list(histories.values())
