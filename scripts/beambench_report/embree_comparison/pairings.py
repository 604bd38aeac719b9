"""The times of tile beams and of the fastest Embree mode with correct hits, for each image."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import pandas as pd

from beambench_report.base.cell_files import CellFile, Identity, identity, read_cell_files
from beambench_report.base.files import Problem
from beambench_report.base.names import parameter_items
from beambench_report.base.ratio import Median, Ratio, median_of, paired_ratio, unpaired_ratio
from beambench_report.base.records import OK, Run, size_of

_STRUCTURES = ("tile-beam", "embree")
Row = dict[str, object]


@dataclass(frozen=True)
class Trace:
    """A contender's times for one image, in ms, and what it ran on."""

    contender: str
    first: Median
    """The first trace after a build."""
    second: float | None
    """The median of a second trace of the same structure."""
    build: float
    isa: str


@dataclass(frozen=True)
class Pairing:
    """Both at the same image. Ratios are Embree's time over that of tile beams, without builds."""

    scene: str
    camera: str
    primitives: int
    resolution: str
    rays: int
    samples: int
    isa: str
    """What both are limited to: `best`, or the parameter isa."""
    tile: Trace
    embree: Trace
    ratio: Ratio
    second_ratio: Ratio | None
    run_id: str
    commit: str
    machine: str
    origin: str
    """Run, commit and machine."""


def pairings(runs: Iterable[Run]) -> list[Pairing]:
    """Every image that both traced with correct hits, once, in the order of the rows.

    Of an image that several runs measured the newest counts. Raises Problem for runs of several
    machines, whose ratios one table must not mix.
    """
    found: dict[tuple, Pairing] = {}
    for run in runs:
        for one in _pairings_of(run):
            image = (one.scene, one.camera, one.resolution, one.samples, one.isa)
            if image not in found or one.run_id > found[image].run_id:
                found[image] = one
    machines = dict.fromkeys(one.machine for one in found.values())
    if len(machines) > 1:
        raise Problem(
            f"the runs are of {len(machines)} machines ({', '.join(machines)}), whose ratios must "
            "not be mixed in one table; give the runs of one"
        )
    return list(found.values())


def _pairings_of(run: Run) -> list[Pairing]:
    images: dict[tuple, dict[str, list[Row]]] = {}
    right = run.rows[(run.rows["verdict"] == OK) & (run.rows["ray_kind"] == "primary")]
    for row in right.to_dict("records"):
        if row["structure"] in _STRUCTURES and row["trace_ms_median"] > 0:
            both = images.setdefault(_image(row), {name: [] for name in _STRUCTURES})
            both[row["structure"]].append(row)
    whole = {image: both for image, both in images.items() if all(both.values())}
    files = read_cell_files(run.directory) if whole else {}
    return [_pairing(image[-1], *both.values(), files) for image, both in whole.items()]


def _image(row: Row) -> tuple:
    """What both must have in common."""
    names = ("scene", "camera", "width", "height", "samples", "machine_id", "run_id")
    own = parameter_items(row["parameters"])
    return (*(row[name] for name in names), own.get("isa", "best"))


def _pairing(
    isa: str, tiles: Sequence[Row], modes: Sequence[Row], files: Mapping[Identity, CellFile]
) -> Pairing:
    row, mode = (min(rows, key=lambda row: row["trace_ms_median"]) for rows in (tiles, modes))
    tile, embree = _trace(row, "tile-beam"), _trace(mode, _mode_name(mode))
    ratio, second = None, None
    tile_file, embree_file = files.get(identity(row)), files.get(identity(mode))
    if tile_file and embree_file:
        ratio = paired_ratio(embree_file.trace_ms, tile_file.trace_ms)
        second = paired_ratio(embree_file.warm_ms, tile_file.warm_ms)
    if second is None and embree.second and tile.second:
        second = Ratio(embree.second / tile.second)
    commit = f"{row['commit'][:12]}{' (modified)' if row['dirty'] == 'true' else ''}"
    return Pairing(
        str(row["scene"]),
        str(row["camera"]),
        int(row["primitives"]),
        size_of(row),
        int(row["rays"]),
        int(row["samples"]),
        isa,
        tile,
        embree,
        ratio or unpaired_ratio(embree.first, tile.first),
        second,
        str(row["run_id"]),
        commit,
        str(row["machine_id"]),
        f"run {row['run_id']}, commit {commit}, machine {row['machine_id'][:8]}",
    )


def _mode_name(row: Row) -> str:
    own = parameter_items(row["parameters"])
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
