"""Who traces an image how much faster: tile beams or the fastest of Embree's modes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import prod

import pandas as pd

_STRUCTURES = ("tile-beam", "embree")
_BEST = "best"

Row = dict[str, object]


@dataclass(frozen=True)
class Trace:
    """A contender's time for one image, in ms, and who it is."""

    contender: str
    median: float
    low: float | None
    """Of the median's 95% interval; none below six repetitions."""
    high: float | None
    warm: float | None
    """A second trace of the same structure."""
    isa: str
    """The instruction set that it ran on, as it names it."""


@dataclass(frozen=True)
class Ratio:
    """How many times as fast tile beams are; its interval where both medians have one."""

    value: float
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True)
class Duel:
    """Both at the same image."""

    scene: str
    primitives: int
    resolution: str
    rays: int
    samples: int
    isa: str
    """What both are held to: `best`, or the parameter isa."""
    tile: Trace
    embree: Trace
    """The fastest of Embree's modes whose hits were right."""
    origin: str
    """Run, commit and machine."""

    @property
    def ratio(self) -> Ratio:
        """Of the traces, without the builds.

        Its ends are those of both medians at the worst ends of their 95% intervals, so that it
        holds with 90% at the very least.
        """
        value = self.embree.median / self.tile.median
        ends = (self.embree.low, self.embree.high, self.tile.low, self.tile.high)
        if any(end is None for end in ends):
            return Ratio(value)
        return Ratio(value, self.embree.low / self.tile.high, self.embree.high / self.tile.low)

    @property
    def warm_ratio(self) -> float | None:
        """Of the second traces."""
        if self.tile.warm is None or self.embree.warm is None:
            return None
        return self.embree.warm / self.tile.warm


def duels(tables: Iterable[pd.DataFrame]) -> list[Duel]:
    """Every image that tile beams and Embree both traced rightly, in the order of the rows."""
    images: dict[tuple, dict[str, list[Row]]] = {}
    for table in tables:
        right = table[(table["verdict"] == "ok") & (table["ray_kind"] == "primary")]
        for row in right.to_dict("records"):
            if row["structure"] in _STRUCTURES and row["trace_ms_median"] > 0:
                found = images.setdefault(_image(row), {name: [] for name in _STRUCTURES})
                found[row["structure"]].append(row)
    return [_duel(image, *found.values()) for image, found in images.items() if all(found.values())]


def geometric_mean(ratios: Sequence[Ratio]) -> Ratio:
    """Of at least one; its ends are the means of the ends."""

    def mean(values: Sequence[float | None]) -> float | None:
        known = [value for value in values if value is not None]
        return prod(known) ** (1 / len(known)) if len(known) == len(values) else None

    value = mean([ratio.value for ratio in ratios])
    assert value is not None
    return Ratio(value, mean([r.low for r in ratios]), mean([r.high for r in ratios]))


def _image(row: Row) -> tuple:
    """What both must have in common."""
    names = ("scene", "camera", "width", "height", "samples", "machine_id", "run_id")
    return (*(row[name] for name in names), _parameters(row).get("isa", _BEST))


def _duel(image: tuple, tiles: Sequence[Row], modes: Sequence[Row]) -> Duel:
    tile = min(tiles, key=lambda row: row["trace_ms_median"])
    fastest = min(modes, key=lambda row: row["trace_ms_median"])
    return Duel(
        str(tile["scene"]),
        int(tile["primitives"]),
        f"{tile['width']:.0f}x{tile['height']:.0f}",
        int(tile["rays"]),
        int(tile["samples"]),
        str(image[-1]),
        _trace(tile, "tile-beam"),
        _trace(fastest, _mode_name(fastest)),
        f"run {tile['run_id']}, commit {tile['commit'][:12]}"
        f"{' (modified)' if tile['dirty'] == 'true' else ''}, machine {tile['machine_id'][:8]}",
    )


def _mode_name(row: Row) -> str:
    own = _parameters(row)
    return f"{own.get('mode', 'single')}{', robust' if own.get('robust') == 'true' else ''}"


def _trace(row: Row, contender: str) -> Trace:
    low, high, warm = (
        None if pd.isna(row.get(name)) else float(row[name])
        for name in ("trace_ms_ci_low", "trace_ms_ci_high", "trace_warm_ms_median")
    )
    isa = row.get("structure_isa")
    return Trace(contender, float(row["trace_ms_median"]), low, high, warm, str(isa or ""))


def _parameters(row: Row) -> dict[str, str]:
    return dict(item.split("=", 1) for item in str(row["parameters"]).split(",") if "=" in item)
