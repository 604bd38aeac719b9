"""The tidy tables that rules judge: the same for the thesis's figures and for a run's."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import pandas as pd

from beambench_report.ledger.cluster_evidence import NO_CLUSTER, ClusterEvidence
from beambench_report.ledger.measured import Measured, share, total

RESOLUTIONS = ("320x200", "640x480", "800x600", "1024x768", "1280x1024")
COARSEST, FINEST = RESOLUTIONS[0], RESOLUTIONS[-1]

# What every row is about. `level` and `objects` are the octree's max_level and max_objects, `cells`
# the grid's voxels along an axis; 0 stands where a structure has no such thing.
SETTING = ("scene", "contender", "level", "objects", "cells", "resolution", "samples")
TIMES = ("table", *SETTING, "seconds", "low", "high")
WORK = (*SETTING, "quantity", "value", "low", "high")
OCTREES = ("scene", "level", "objects", "occupied_leaves", "exit_pixels")

# The hierarchy of the thesis descends by least growth to a terminal node, and only there weighs
# adding the object against a new volume (section 4.3): `insert=terminal`. Goldsmith and Salmon's
# own insertion weighs at every level.
HIERARCHY = "goldsmith-salmon"
PAPER_HIERARCHY = "goldsmith-salmon, insert=everywhere"

# Whole pictures, whose rays a census counts by kind.
PICTURE = "picture"

# The thesis's parameters wherever it does not vary them.
LEVEL, OBJECTS, CELLS = 6, 0, 32


@dataclass(frozen=True)
class Evidence:
    """What was measured, by the thesis or in a run.

    times: table, setting, seconds with the building of the structure, and their interval.
    work: setting, the name of a quantity, its value and interval; a row a quantity.
    octrees: counts of occupied leaves and of pixels of exit beams at 1280x1024.
    cluster: chapter 6.
    """

    times: pd.DataFrame
    work: pd.DataFrame
    octrees: pd.DataFrame
    cluster: ClusterEvidence = NO_CLUSTER

    def time(
        self,
        scene: str,
        contender: str,
        resolution: str = FINEST,
        *,
        level: int = LEVEL,
        objects: int = OBJECTS,
        cells: int = CELLS,
        samples: int = 1,
    ) -> Measured | None:
        """Seconds of one cell, by the thesis's parameters if not told otherwise."""
        octree, grid = contender in ("beam", "samet", "samet-net"), contender == "voxel-grid"
        setting = (
            scene,
            contender,
            level if octree else 0,
            objects if octree else 0,
            cells if grid else 0,
            resolution,
            samples,
        )
        return self._times.get(setting)

    def times_by(
        self, setting: str, scene: str, contender: str, resolution: str = FINEST
    ) -> dict[int, Measured]:
        """Seconds of one contender by the value of one of its settings, `level` or `cells`."""
        at = {name: place for place, name in enumerate(SETTING)}
        wanted = {"scene": scene, "contender": contender, "resolution": resolution}
        wanted |= {"objects": OBJECTS, "samples": 1}
        found = {
            key[at[setting]]: seconds
            for key, seconds in self._times.items()
            if all(key[at[name]] == value for name, value in wanted.items())
        }
        return dict(sorted(found.items()))

    def count(
        self, quantity: str, scene: str, *, level: int = LEVEL, objects: int = OBJECTS
    ) -> Measured | None:
        """A count of the octree: `occupied_leaves` or `exit_pixels`."""
        return self._octrees.get((quantity, scene, level, objects))

    def worked(
        self,
        quantity: str,
        scene: str,
        resolution: str = "",
        *,
        contender: str = "beam",
        level: int = LEVEL,
    ) -> Measured | None:
        """A quantity of the beams' work by the thesis's parameters, or of another structure."""
        level = level if contender == "beam" else 0
        return self._work.get((quantity, scene, contender, level, resolution))

    def share_of_time(
        self, task: str, scene: str, resolution: str, *, level: int = LEVEL
    ) -> Measured | None:
        """A task of the beams over the whole, building included; as printed, or made of times."""
        printed = self.worked(f"share_{task}", scene, resolution, level=level)
        if printed is not None:
            return printed
        seconds = {
            name: self.worked(f"seconds_{name}", scene, resolution, level=level)
            for name in ("nonterminal", "occupied", "leaving", "build")
        }
        part = seconds.pop(task)
        rest = [figure for figure in seconds.values() if figure is not None]
        return share(part, total(rest)) if part is not None and len(rest) == 3 else None

    @property
    def beam_cells(self) -> list[tuple[str, int, str]]:
        """Scene, level and resolution of every cell whose beams were counted."""
        keys = [key[1:] for key in self._work if key[2] == "beam"]
        return list(dict.fromkeys((key[0], key[2], key[3]) for key in keys))

    @cached_property
    def _times(self) -> dict[tuple[str | int, ...], Measured]:
        """Where two tables print the same cell the first one counts; they agree."""
        found: dict[tuple[str | int, ...], Measured] = {}
        for row in self.times.itertuples():
            key = tuple(getattr(row, name) for name in SETTING)
            found.setdefault(key, Measured(row.seconds, row.low, row.high))
        return found

    @cached_property
    def _work(self) -> dict[tuple[str, str, str, int, str], Measured]:
        rows = self.work[(self.work["samples"] == 1) & (self.work["objects"] == OBJECTS)]
        return {
            (row.quantity, row.scene, row.contender, row.level, row.resolution): Measured(
                row.value, row.low, row.high
            )
            for row in rows.itertuples()
        }

    @cached_property
    def _octrees(self) -> dict[tuple[str, str, int, int], Measured]:
        return {
            (quantity, row.scene, row.level, row.objects): Measured.exact(getattr(row, quantity))
            for row in self.octrees.itertuples()
            for quantity in ("occupied_leaves", "exit_pixels")
            if pd.notna(getattr(row, quantity))
        }


NOTHING = Evidence(
    pd.DataFrame(columns=list(TIMES)),
    pd.DataFrame(columns=list(WORK)),
    pd.DataFrame(columns=list(OCTREES)),
)
