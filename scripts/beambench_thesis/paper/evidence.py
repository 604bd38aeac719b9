"""Evidence for the rules, in one form for the thesis's figures and for figures of runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from math import hypot, nan

import numpy as np
import pandas as pd

from beambench.analysis import Median, Ratio, block_ratio, unpaired_ratio
from beambench_report.base.published import RESOLUTIONS, read_published


@dataclass(frozen=True)
class Blocks:
    """The time of a cell in each block, building included.

    A block is a process that measured the contenders of one view; its number is unique over all
    views and runs.
    """

    ms: Mapping[int, float]

    def over(self, other: Blocks, factor: float = 1) -> Ratio | None:
        """Returns the paired ratio to another time multiplied by a factor, with a confidence
        interval.

        None if they have fewer than two blocks in common.
        """
        under = {block: factor * ms for block, ms in other.ms.items()}
        ratio = block_ratio(self.ms, under)
        return ratio if ratio and ratio.interval else None


NO_BLOCKS = Blocks({})


@dataclass(frozen=True)
class Measured:
    """A positive figure and its 95% prediction interval, which is the figure itself if it is exact.

    Without an interval, both ends are NaN. Figures of the same `blocks` are paired. Other figures
    were measured independently, so their errors are combined as the root of the sum of their
    squares (propagation of uncertainty, JCGM 100:2008, section 5.1.2), separately for each
    side of the interval.
    """

    value: float
    low: float
    high: float
    blocks: Blocks = field(default=NO_BLOCKS, compare=False, repr=False)

    @classmethod
    def exact(cls, value: float) -> Measured:
        """Returns a figure without an interval."""
        return cls(value, value, value)

    def __truediv__(self, other: Measured) -> Measured:
        """Returns the ratio, paired if possible.

        If a figure may be zero, which has no logarithm, the interval extends from the smallest to
        the largest possible ratio.
        """
        if paired := self.blocks.over(other.blocks):
            return Measured(paired.value, paired.predicted_low, paired.predicted_high)
        if min(self.low, other.low) <= 0:
            value = self.value / other.value
            return Measured(value, self.low / other.high, self.high / other.low)
        ratio = unpaired_ratio(*(Median(one.value, one.low, one.high) for one in (self, other)))
        return Measured(ratio.value, *(ratio.interval or (nan, nan)))

    def __sub__(self, other: Measured) -> Measured:
        """Returns the difference; absolute errors are combined."""
        below = hypot(self.value - self.low, other.high - other.value)
        above = hypot(self.high - self.value, other.value - other.low)
        gap = self.value - other.value
        return Measured(gap, gap - below, gap + above)

    def times(self, factor: float) -> Measured:
        """Returns the figure in another unit, the factor being positive."""
        return Measured(self.value * factor, self.low * factor, self.high * factor)


def share(part: Measured, rest: Measured) -> Measured:
    """Returns the share of `part` in the sum of `part` and `rest`."""
    if min(part.value, rest.value) <= 0:
        return Measured(
            part.value / (part.value + rest.value),
            part.low / (part.low + rest.high),
            part.high / (part.high + rest.low),
        )
    odds = part / rest
    return Measured(*(end / (1 + end) for end in (odds.value, odds.low, odds.high)))


def smallest(figures: Sequence[Measured]) -> Measured:
    """Returns the least figure: its true value is at most the least upper end.

    If all were measured together, it is paired like the figure with the least value.
    """
    least = min(figures, key=lambda one: one.value)
    together = all(one.blocks.over(least.blocks) for one in figures)
    return Measured(*_ends(figures).min(axis=0).tolist(), least.blocks if together else NO_BLOCKS)


def largest(figures: Sequence[Measured]) -> Measured:
    """Returns the greatest figure: its true value is at least the greatest lower end."""
    return Measured(*_ends(figures).max(axis=0).tolist())


def _ends(figures: Sequence[Measured]) -> np.ndarray:
    return np.array([(one.value, one.low, one.high) for one in figures])


def total(figures: Sequence[Measured]) -> Measured:
    """Returns the sum; absolute errors are combined."""
    value = sum(figure.value for figure in figures)
    below = hypot(*(figure.value - figure.low for figure in figures))
    above = hypot(*(figure.high - figure.value for figure in figures))
    return Measured(value, value - below, value + above)


def rows_with(rows: pd.DataFrame, **values: object) -> pd.DataFrame:
    """Returns the rows that have these values, or one value of a collection, in their columns."""
    for name, value in values.items():
        rows = rows[rows[name].isin([value] if isinstance(value, str | int) else value)]
    return rows


def _figures_by(
    rows: pd.DataFrame, keys: Sequence[str], figure: str = "value"
) -> dict[tuple, Measured]:
    """Returns the figures with their intervals, by the values of several columns."""
    figures = map(Measured, rows[figure], rows["low"], rows["high"])
    return dict(zip(zip(*(rows[key] for key in keys), strict=True), figures, strict=True))


FIGURES = ("scene", "network", "quantity", "value", "low", "high")


@dataclass(frozen=True)
class ClusterEvidence:
    """One table: a row for each figure of a scene on a network.

    best_processors, best_efficiency, mean_efficiency, last_efficiency: of 2 to 15 processors,
        including the producer's; the interval of best_processors contains all numbers of processors
        that are as good within 1%.
    beams: the number of beams at occupied leaves, which are sent.
    fewest_beams, most_beams: the numbers of beams of two of 14 consumers.
    first_end, last_end: when the first and the last of 14 consumers end, in seconds.
    producer_busy: the share of the time during which the producer works, with 14 consumers.
    consumers_that_saturate: the fewest consumers with which this share is 90%.
    slowdown, capacity: of 14 unequal consumers, the time with equal consumers over their time, and
        their speed over that of equal consumers. In quantities that end in `_slow`, every other
        consumer is half as fast; in `_used`, five are used by others half of the time.
    """

    figures: pd.DataFrame

    @property
    def networks(self) -> list[str]:
        """Returns the networks with figures."""
        return list(dict.fromkeys(self.figures["network"]))

    def figure(self, quantity: str, scene: str, network: str) -> Measured | None:
        """Returns one figure, if it is known."""
        return self._figures.get((scene, network, quantity))

    @cached_property
    def _figures(self) -> dict[tuple[str, str, str], Measured]:
        return _figures_by(self.figures, ("scene", "network", "quantity"))


NO_CLUSTER = ClusterEvidence(pd.DataFrame(columns=list(FIGURES)))


# The subject of every row. `level` and `objects` are the octree's max_level and max_objects,
# `cells` the grid's voxels along an axis; 0 if a structure lacks the parameter.
SETTING = ("scene", "contender", "level", "objects", "cells", "resolution", "samples")
TIMES = ("table", *SETTING, "seconds", "low", "high")
WORK = (*SETTING, "quantity", "value", "low", "high")
OCTREES = ("scene", "level", "objects", "occupied_leaves", "exit_pixels")

# The hierarchy of the thesis descends by least growth to a terminal node, and only there weighs
# adding the object against a new volume (section 4.3): `insert=terminal`. Goldsmith and Salmon's
# own insertion weighs at every level.
HIERARCHY = "goldsmith-salmon"
PAPER_HIERARCHY = "goldsmith-salmon, insert=everywhere"
# Traversed in the order of the children (graphic 4.2), instead of Kay and Kajiya's (4.1).
PLAIN_HIERARCHY = "goldsmith-salmon, queue=stack"

# Whole pictures, whose rays a census counts by kind.
PICTURE = "picture"

ON_OCTREES = ("beam", "samet", "samet-net")

# The thesis's parameters wherever it does not vary them.
LEVEL, OBJECTS, CELLS = 6, 0, 32

Setting = tuple[str | int, ...]
"""Values in the order of SETTING."""


def setting(
    scene: str,
    contender: str,
    resolution: str,
    *,
    level: int = LEVEL,
    objects: int = OBJECTS,
    cells: int = CELLS,
    samples: int = 1,
) -> Setting:
    """Returns a setting as a key: 0 if the contender lacks the parameter."""
    level, objects = (level, objects) if contender in ON_OCTREES else (0, 0)
    cells = cells if contender == "voxel-grid" else 0
    return (scene, contender, level, objects, cells, resolution, samples)


@dataclass(frozen=True)
class Evidence:
    """The figures of the thesis, or of a run.

    times: table, setting, seconds with the building of the structure, and their interval.
    work: setting, the name of a quantity, its value and interval; a row for each quantity.
    octrees: counts of occupied leaves and of pixels of exit beams at 1280x1024.
    cluster: the figures of chapter 6.
    blocks: the times in each block, for runs in blocks.
    """

    times: pd.DataFrame
    work: pd.DataFrame
    octrees: pd.DataFrame
    cluster: ClusterEvidence = NO_CLUSTER
    blocks: Mapping[Setting, Blocks] = field(default_factory=dict)
    resolutions: tuple[str, ...] = RESOLUTIONS

    @property
    def coarsest(self) -> str:
        """Returns the lowest resolution: 320x200 if the thesis's are complete."""
        return self.resolutions[0]

    @property
    def finest(self) -> str:
        """Returns the highest resolution: 1280x1024 if the thesis's are complete."""
        return self.resolutions[-1]

    @property
    def finer(self) -> tuple[str, ...]:
        """Returns all resolutions except the lowest."""
        return self.resolutions[1:]

    def time(
        self,
        scene: str,
        contender: str,
        resolution: str = "",
        *,
        level: int = LEVEL,
        objects: int = OBJECTS,
        samples: int = 1,
    ) -> Measured | None:
        """Returns the seconds of one cell; parameters that are not given are the thesis's."""
        at = {"level": level, "objects": objects, "samples": samples}
        return self.at(setting(scene, contender, resolution or self.finest, **at))

    def at(self, setting: Setting) -> Measured | None:
        """Returns the seconds of one cell by its setting, in the order of SETTING."""
        return self._times.get(setting)

    def times_by(
        self, setting: str, scene: str, contender: str, resolution: str = ""
    ) -> dict[int, Measured]:
        """Returns the seconds of one contender by one of its settings, `level` or `cells`."""
        view = {"scene": scene, "contender": contender, "resolution": resolution or self.finest}
        rows = rows_with(self.times, **view, objects=OBJECTS, samples=1).sort_values(setting)
        settings = zip(*(rows[name] for name in SETTING), strict=True)
        return {at[SETTING.index(setting)]: self._times[at] for at in settings}

    def count(
        self, quantity: str, scene: str, *, level: int = LEVEL, objects: int = OBJECTS
    ) -> Measured | None:
        """Returns a count of the octree: `occupied_leaves` or `exit_pixels`."""
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
        """Returns a quantity of work: of beams with the thesis's parameters, or of `contender`."""
        level = level if contender == "beam" else 0
        return self._work.get((quantity, scene, contender, level, resolution))

    def share_of_time(
        self, task: str, scene: str, resolution: str, *, level: int = LEVEL
    ) -> Measured | None:
        """Returns a task's share of the beams' total time, building included."""
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
        """Returns scene, level and resolution of every cell whose beams were counted."""
        keys = [key[1:] for key in self._work if key[2] == "beam"]
        return list(dict.fromkeys((key[0], key[2], key[3]) for key in keys))

    @cached_property
    def _times(self) -> dict[Setting, Measured]:
        """Returns the times by setting; tables that print the same cell agree."""
        times = _figures_by(self.times.drop_duplicates(list(SETTING)), SETTING, "seconds")
        return {
            at: replace(time, blocks=self.blocks.get(at, NO_BLOCKS)) for at, time in times.items()
        }

    @cached_property
    def _work(self) -> dict[tuple[str, str, str, int, str], Measured]:
        rows = rows_with(self.work, samples=1, objects=OBJECTS)
        return _figures_by(rows, ("quantity", "scene", "contender", "level", "resolution"))

    @cached_property
    def _octrees(self) -> dict[tuple[str, str, int, int], Measured]:
        return {
            (quantity, row.scene, row.level, row.objects): Measured.exact(getattr(row, quantity))
            for row in self.octrees.itertuples()
            for quantity in ("occupied_leaves", "exit_pixels")
            if pd.notna(getattr(row, quantity))
        }


def one_level_less(e: Evidence) -> Evidence:
    """Returns the evidence with the levels of all octrees reduced by one."""

    def shifted(rows: pd.DataFrame) -> pd.DataFrame:
        return rows.assign(level=rows["level"] - (rows["level"] > 0))

    at = SETTING.index("level")
    blocks = {
        (*key[:at], max(int(key[at]) - 1, 0), *key[at + 1 :]): own for key, own in e.blocks.items()
    }
    return replace(
        e, times=shifted(e.times), work=shifted(e.work), octrees=shifted(e.octrees), blocks=blocks
    )


NOTHING = Evidence(
    pd.DataFrame(columns=list(TIMES)),
    pd.DataFrame(columns=list(WORK)),
    pd.DataFrame(columns=list(OCTREES)),
)


# The thesis counts the beams that its constructor made, and as non-terminal those of them that were
# cut: a beam that lies wholly inside the next leaf is only placed there (section 4.4.2,
# `PasaPor`; graphic 3.4).
_MADE_BY_CUTTING = {"beams": "beams_made", "beams_nonterminal": "beams_divided"}


@cache
def published_evidence() -> Evidence:
    """Returns tables 5.2 to 5.8 and the figures in the text.

    The thesis has no intervals: its figures count as exact.
    """
    times = read_published("times.csv")
    grids = times["algorithm"].eq("voxel-grid") * CELLS
    # Tables 5.4 to 5.8 do not repeat that a leaf with any object is split.
    objects = times["max_objects"].fillna(0).astype(int)
    times = _with_setting(times, "algorithm", "seconds").assign(objects=objects, cells=grids)
    text = read_published("figures_in_text.csv")
    parallel = text["section"].astype(str).str.startswith("6")
    return Evidence(
        times[list(TIMES)],
        _work(_with_setting(text[~parallel], "structure", "value")[list(WORK)], times),
        _octrees(read_published("octree_counts.csv")),
        _cluster(text[parallel]),
    )


def _with_setting(rows: pd.DataFrame, contender: str, figure: str) -> pd.DataFrame:
    """Returns the rows with the columns of SETTING and exact figures."""
    return rows.assign(
        contender=rows[contender],
        level=rows["max_level"].fillna(0).astype(int),
        objects=0,
        cells=0,
        resolution=_resolution(rows),
        samples=1,
        low=rows[figure],
        high=rows[figure],
    )


def _work(rows: pd.DataFrame, times: pd.DataFrame) -> pd.DataFrame:
    cut = rows_with(rows, quantity=_MADE_BY_CUTTING)
    cut = cut.assign(quantity=cut["quantity"].map(_MADE_BY_CUTTING))
    return pd.concat([rows, cut, _seconds_of_shares(rows, times)], ignore_index=True)


def _seconds_of_shares(work: pd.DataFrame, times: pd.DataFrame) -> pd.DataFrame:
    """Converts the printed shares of the total time into seconds; C09 compares seconds."""
    setting = ["scene", "contender", "level", "objects", "resolution"]
    known = times.drop_duplicates(setting)[[*setting, "seconds"]]
    shares = work[work["quantity"].eq("share_nonterminal")].merge(known, on=setting)
    seconds = shares["value"] * shares["seconds"]
    shares = shares.assign(quantity="seconds_nonterminal", value=seconds, low=seconds, high=seconds)
    return shares[list(WORK)]


def _octrees(rows: pd.DataFrame) -> pd.DataFrame:
    names = {
        "max_level": "level",
        "max_objects": "objects",
        "exit_beam_pixels_1280x1024": "exit_pixels",
    }
    return rows.rename(columns=names)[list(OCTREES)].drop_duplicates()


def _cluster(text: pd.DataFrame) -> ClusterEvidence:
    """Returns the figures of the cluster; the thesis only says that its network is an Ethernet."""
    rows = text.assign(network="Ethernet", low=text["value"], high=text["value"])
    return ClusterEvidence(rows[list(FIGURES)])


def _resolution(rows: pd.DataFrame) -> pd.Series:
    """Returns `320x200`, or an empty string if a figure has no resolution."""
    width, height = (rows[side].astype("Int64").astype(str) for side in ("width", "height"))
    return (width + "x" + height).where(rows["width"].notna(), "")
