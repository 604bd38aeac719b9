"""Who traces an image how much faster: tile beams or the fastest of Embree's modes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import pandas as pd

from beambench_report.base.cell_files import CellFile, Identity, identity, read_cell_files
from beambench_report.base.files import Problem
from beambench_report.base.ratio import Median, Ratio, median_of, paired_ratio, unpaired_ratio
from beambench_report.base.records import Run

_STRUCTURES = ("tile-beam", "embree")
_BEST = "best"

Row = dict[str, object]


@dataclass(frozen=True)
class Trace:
    """A contender's times for one image, in ms, and who it is."""

    contender: str
    first: Median
    """The first trace after a build."""
    second: float | None
    """The median of a second trace of the same structure."""
    build: float
    """The median of building."""
    isa: str
    """The instruction set that it ran on, as it names it."""

    @property
    def median(self) -> float:
        """Of the first traces."""
        return self.first.value


@dataclass(frozen=True)
class Duel:
    """Both at the same image."""

    scene: str
    camera: str
    primitives: int
    resolution: str
    rays: int
    samples: int
    isa: str
    """What both are held to: `best`, or the parameter isa."""
    tile: Trace
    embree: Trace
    """The fastest of Embree's modes whose hits were right, by its first traces."""
    ratio: Ratio
    """Embree's time over that of tile beams, of first traces, without the builds."""
    second_ratio: Ratio | None
    """The same of second traces."""
    run_id: str
    machine: str
    origin: str
    """Run, commit and machine."""

    @property
    def image(self) -> tuple[str, str, str, int, str]:
        """What was asked, whatever the run."""
        return (self.scene, self.camera, self.resolution, self.samples, self.isa)


def duels(runs: Iterable[Run]) -> list[Duel]:
    """Every image that tile beams and Embree both traced rightly, once, in the order of the rows.

    Of an image that several runs measured the newest one counts. Raises Problem where the runs are
    of several machines, whose ratios one table must not mix.
    """
    found: dict[tuple, Duel] = {}
    for run in runs:
        for duel in _duels_of(run):
            earlier = found.get(duel.image)
            if earlier is None or duel.run_id > earlier.run_id:
                found[duel.image] = duel
    machines = dict.fromkeys(duel.machine for duel in found.values())
    if len(machines) > 1:
        raise Problem(
            f"the runs are of {len(machines)} machines ({', '.join(machines)}), whose ratios must "
            "not be mixed in one table; give the runs of one"
        )
    return list(found.values())


def _duels_of(run: Run) -> list[Duel]:
    images: dict[tuple, dict[str, list[Row]]] = {}
    right = run.rows[(run.rows["verdict"] == "ok") & (run.rows["ray_kind"] == "primary")]
    for row in right.to_dict("records"):
        if row["structure"] in _STRUCTURES and row["trace_ms_median"] > 0:
            both = images.setdefault(_image(row), {name: [] for name in _STRUCTURES})
            both[row["structure"]].append(row)
    whole = {image: both for image, both in images.items() if all(both.values())}
    files = read_cell_files(run.directory) if whole else {}
    return [_duel(image, *both.values(), files) for image, both in whole.items()]


def _image(row: Row) -> tuple:
    """What both must have in common."""
    names = ("scene", "camera", "width", "height", "samples", "machine_id", "run_id")
    return (*(row[name] for name in names), _parameters(row).get("isa", _BEST))


def _duel(
    image: tuple, tiles: Sequence[Row], modes: Sequence[Row], files: Mapping[Identity, CellFile]
) -> Duel:
    tile_row = min(tiles, key=lambda row: row["trace_ms_median"])
    fastest = min(modes, key=lambda row: row["trace_ms_median"])
    tile, embree = _trace(tile_row, "tile-beam"), _trace(fastest, _mode_name(fastest))
    ratio, second = None, None
    tile_file, embree_file = files.get(identity(tile_row)), files.get(identity(fastest))
    if tile_file and embree_file:
        ratio = paired_ratio(embree_file.trace_ms, tile_file.trace_ms)
        second = paired_ratio(embree_file.warm_ms, tile_file.warm_ms)
    if second is None and embree.second and tile.second:
        second = Ratio(embree.second / tile.second)
    return Duel(
        str(tile_row["scene"]),
        str(tile_row["camera"]),
        int(tile_row["primitives"]),
        f"{tile_row['width']:.0f}x{tile_row['height']:.0f}",
        int(tile_row["rays"]),
        int(tile_row["samples"]),
        str(image[-1]),
        tile,
        embree,
        ratio or unpaired_ratio(embree.first, tile.first),
        second,
        str(tile_row["run_id"]),
        str(tile_row["machine_id"]),
        f"run {tile_row['run_id']}, commit {tile_row['commit'][:12]}"
        f"{' (modified)' if tile_row['dirty'] == 'true' else ''}, "
        f"machine {tile_row['machine_id'][:8]}",
    )


def _mode_name(row: Row) -> str:
    own = _parameters(row)
    mode = own.get("mode", "single")
    robust = ", robust" if own.get("robust") == "true" else ""
    apart = ", not coherent" if mode != "single" and own.get("coherent") == "false" else ""
    return f"{mode}{robust}{apart}"


def _trace(row: Row, contender: str) -> Trace:
    second = row.get("trace_warm_ms_median")
    return Trace(
        contender,
        median_of(row, "trace"),
        None if pd.isna(second) else float(second),
        float(row["build_ms_median"]),
        str(row.get("structure_isa") or ""),
    )


def _parameters(row: Row) -> dict[str, str]:
    return dict(item.split("=", 1) for item in str(row["parameters"]).split(",") if "=" in item)
