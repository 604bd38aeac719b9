"""The cells of a folder of runs, each with its row of results.csv."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import nan
from operator import attrgetter
from pathlib import Path

import pandas as pd

from beambench_report.base.columns import COUNTER_SUFFIX
from beambench_report.base.fastest import with_fastest
from beambench_report.base.files import Problem
from beambench_report.base.machine import require_one_machine
from beambench_report.base.names import parameter_items
from beambench_report.base.published import RESOLUTIONS, primitives_by_scene
from beambench_report.base.records import read_run, size_of
from beambench_thesis.paper.evidence import SETTING, Measured, Setting
from beambench_thesis.paper.measured import seconds_of, setting_of

_SIZES = ("nodes", "leaves", "empty_leaves", "references", "depth", "hit_share")


@dataclass(frozen=True)
class Cell:
    """One row of one run."""

    number: int
    """The position of the row in the report's list of rows."""
    run: str
    line: int
    """The line in the run's results.csv; the header is line 1."""
    name: str
    scene: str
    structure: str
    parameters: dict[str, str]
    resolution: str
    samples: int
    rays: int
    verdict: str
    repetitions: int
    setting: Setting | None
    """The setting in the thesis; None if the thesis has no such parameters."""
    time: Measured | None
    """Seconds, building included; None if the hits are not correct."""
    build: float
    """Seconds of building."""
    trace: float
    megacycles: float
    memory: float
    nodes: float
    leaves: float
    empty_leaves: float
    references: float
    depth: float
    hit_share: float
    counters: dict[str, float]
    """Work per ray, by the counter's name."""


@dataclass(frozen=True)
class Cells:
    """All cells of all runs of a folder."""

    directory: Path
    runs: tuple[Path, ...]
    cells: tuple[Cell, ...]
    unread: tuple[str, ...] = ()
    """Why runs could not be read, one sentence each."""

    @property
    def wrong(self) -> list[Cell]:
        """Returns the cells without times."""
        return [cell for cell in self.cells if cell.time is None]

    def at(self, setting: Setting) -> Cell | None:
        """Returns the cell of a setting of the thesis, if it was measured."""
        return self._by_setting.get(setting)

    def of(self, scene: str, structure: str, resolution: str) -> list[Cell]:
        """Returns all cells of a structure with one sample per pixel, whatever its parameters."""
        return self._by_view.get((scene, structure, resolution, 1), [])

    def without(self, run: str) -> Cells:
        """Returns the cells of all other runs."""
        runs = tuple(path for path in self.runs if path.name != run)
        return replace(self, runs=runs, cells=tuple(one for one in self.cells if one.run != run))

    @cached_property
    def _by_setting(self) -> dict[Setting, Cell]:
        """Returns the first cell of each setting."""
        return {cell.setting: cell for cell in reversed(self.cells) if cell.setting is not None}

    @cached_property
    def _by_view(self) -> dict[tuple[str, str, str, int], list[Cell]]:
        found = defaultdict(list)
        for cell in self.cells:
            found[cell.scene, cell.structure, cell.resolution, cell.samples].append(cell)
        return dict(found)


def read_cells(directory: Path, names: Iterable[str]) -> Cells:
    """Reads the runs DIRECTORY/NAME; folders without results.csv are skipped."""
    runs, cells, unread = [], [], []
    for name in names:
        folder = directory / name
        if not (folder / "results.csv").exists():
            continue
        try:
            (rows,) = with_fastest([read_run(folder)])
            require_one_machine(rows, folder)
        except Problem as problem:
            unread.append(str(problem))
            continue
        runs.append(folder)
        for line, row in enumerate(rows.to_dict("records"), 2):
            if row["ray_kind"] == "primary":
                cells.append(_cell(len(cells) + 1, name, line, row))
    return Cells(directory, tuple(runs), tuple(cells), tuple(unread))


def resolutions_of(cells: Iterable[Cell]) -> list[str]:
    """Returns the thesis's resolutions that any cell has, the coarsest first."""
    there = {cell.resolution for cell in cells}
    return [resolution for resolution in RESOLUTIONS if resolution in there]


def comparable(cells: Sequence[Cell]) -> Callable[[Cell], float]:
    """Returns the measure by which these cells are compared, building included.

    It is clock cycles if all cells have them, because two runs may have had two clock rates, and
    seconds otherwise.
    """
    if all(pd.notna(cell.megacycles) for cell in cells):
        return attrgetter("megacycles")
    return attrgetter("time.value")


def _cell(number: int, run: str, line: int, row: dict) -> Cell:
    known = setting_of(row)
    resolution = size_of(row)
    samples = int(row["samples"])
    view = f"{row['scene']}/{row['camera']}/{resolution}/{samples}/{row['ray_kind']}"
    structure = f"{row['structure']}:{row['parameters']}".rstrip(":")
    time = seconds_of(row) if row["timed"] else None
    return Cell(
        number,
        run,
        line,
        f"{view}/{structure}",
        _plain_scene(str(row["scene"]), row["primitives"]),
        str(row["structure"]),
        parameter_items(row["parameters"]),
        resolution,
        samples,
        int(row["rays"]),
        row["verdict"] or "no verdict",
        0 if pd.isna(row["repetitions"]) else int(row["repetitions"]),
        tuple(known[name] for name in SETTING) if known else None,
        Measured(time["seconds"], time["low"], time["high"]) if time else None,
        row["build_ms_median"] / 1e3,
        row["trace_ms_median"] / 1e3,
        row["fastest_mcycles"] if pd.notna(row["fastest_mcycles"]) else row["total_mcycles_median"],
        row["memory_bytes"],
        *(float(row.get(name, nan)) for name in _SIZES),
        {
            name.removesuffix(COUNTER_SUFFIX): value
            for name, value in row.items()
            if name.endswith(COUNTER_SUFFIX) and pd.notna(value)
        },
    )


def _plain_scene(scene: str, primitives: float) -> str:
    """Returns `escena1` for `escena1:seed=1999,spheres=430`, if its size is the thesis's."""
    plain = scene.split(":")[0]
    return plain if primitives_by_scene().get(plain) == primitives else scene
