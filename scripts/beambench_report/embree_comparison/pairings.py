"""The times of tile beams and of the fastest Embree mode with correct hits, on the same rays."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import pandas as pd

from beambench.analysis import Median, Ratio, unpaired_ratio
from beambench_report.base.cell_files import (
    CellFile,
    Identity,
    identity,
    median_of,
    read_cell_files,
)
from beambench_report.base.files import Problem
from beambench_report.base.names import parameter_items
from beambench_report.base.records import OK, Run, size_of

_STRUCTURES = ("tile-beam", "embree")
PRIMARY, SHADOW, MIRROR, PICTURE = "primary", "shadow", "mirror", "whitted"
_KINDS = (PRIMARY, SHADOW, MIRROR, PICTURE)
Row = dict[str, object]


@dataclass(frozen=True)
class Trace:
    """A contender's times for one set of rays, in ms, and its instruction set."""

    contender: str
    first: Median
    """The first trace after a build."""
    second: float | None
    """The median of a second trace of the same structure."""
    build: float
    isa: str


@dataclass(frozen=True)
class Pairing:
    """Both contenders on the same rays, each with the faster order if the rays are a list.

    Ratios are Embree's time over that of tile beams, without builds. Times of whole pictures
    exclude shading.
    """

    kind: str
    """The kind of rays."""
    scene: str
    camera: str
    primitives: int
    resolution: str
    rays: int
    samples: int
    isa: str
    """The instruction set that both are limited to: `best`, or the parameter isa."""
    is_culled: bool
    """Whether tile beams skipped the backs of solids; Embree cannot tell closed surfaces."""
    modes: tuple[str, ...]
    """Embree's modes with correct hits, of which the fastest counts."""
    tile: Trace
    embree: Trace
    ratio: Ratio
    second_ratio: Ratio | None
    run_id: str
    commit: str
    machine: str
    origin: str
    """Run, commit and machine."""

    @property
    def image(self) -> tuple:
        """Returns the key: the rays that were traced, and the instruction set."""
        return (self.kind, self.scene, self.camera, self.resolution, self.samples, self.isa)


def pairings(runs: Iterable[Run]) -> list[Pairing]:
    """Returns a pairing for all rays that both traced with correct hits, in the order of the rows.

    Traces with and without the backs of solids form two pairings. If several runs measured one of
    them, the newest counts. Raises Problem for runs of several machines, whose ratios must not be
    mixed in one table.
    """
    found: dict[tuple, Pairing] = {}
    for run in runs:
        for one in _pairings_of(run):
            key = (one.image, one.is_culled)
            if key not in found or one.run_id > found[key].run_id:
                found[key] = one
    machines = dict.fromkeys(one.machine for one in found.values())
    if len(machines) > 1:
        raise Problem(
            f"the runs are from {len(machines)} machines ({', '.join(machines)}), whose ratios "
            "must not be mixed in one table; give the runs of one machine"
        )
    return list(found.values())


def headlines(found: Iterable[Pairing]) -> list[Pairing]:
    """Returns one pairing for each image: with the backs of solids drawn, if that was measured."""
    every = list(found)
    drawn = {one.image for one in every if not one.is_culled}
    return [one for one in every if not one.is_culled or one.image not in drawn]


def in_one_way(found: Iterable[Pairing], size: Callable[[Pairing], int]) -> list[Pairing]:
    """Returns the pairings with or without the backs of solids, whichever have more sizes."""
    drawn, culled = ([one for one in found if one.is_culled is way] for way in (False, True))
    return culled if len(set(map(size, culled))) > len(set(map(size, drawn))) else drawn


def _pairings_of(run: Run) -> list[Pairing]:
    images: dict[tuple, dict[str, list[Row]]] = {}
    right = run.rows[(run.rows["verdict"] == OK) & run.rows["kind"].isin(_KINDS)]
    for row in right.to_dict("records"):
        if row["structure"] in _STRUCTURES and row["trace_ms"] > 0:
            both = images.setdefault(_image(row), {name: [] for name in _STRUCTURES})
            both[row["structure"]].append(row)
    whole = {image: both for image, both in images.items() if all(both.values())}
    files = read_cell_files(run.directory) if whole else {}
    return [
        _pairing(image[-1], own, both["embree"], files)
        for image, both in whole.items()
        for way in (False, True)
        if (own := [row for row in both["tile-beam"] if _is_culled(row) is way])
    ]


def _image(row: Row) -> tuple:
    """Returns the facts that both contenders must share."""
    names = ("kind", "scene", "camera", "width", "height", "samples", "machine_id", "run_id")
    own = parameter_items(row["parameters"])
    return (*(row[name] for name in names), own.get("isa", "best"))


def _pairing(
    isa: str, tiles: Sequence[Row], modes: Sequence[Row], files: Mapping[Identity, CellFile]
) -> Pairing:
    mode, row = _fastest(modes), _fastest(tiles)
    tile, embree = _trace(row, "tile-beam"), _trace(mode, mode_name(mode))
    ratio, second = _ratios(mode, row, files)
    commit = f"{row['commit'][:12]}{' (modified)' if row['dirty'] == 'true' else ''}"
    return Pairing(
        str(row["kind"]),
        str(row["scene"]),
        str(row["camera"]),
        int(row["primitives"]),
        size_of(row),
        int(row["rays"]),
        int(row["samples"]),
        isa,
        _is_culled(row),
        tuple(sorted(map(mode_name, modes))),
        tile,
        embree,
        ratio,
        second,
        str(row["run_id"]),
        commit,
        str(row["machine_id"]),
        f"run {row['run_id']}, commit {commit}, machine {row['machine_id'][:8]}",
    )


def _fastest(rows: Iterable[Row]) -> Row:
    return min(rows, key=lambda row: row["trace_ms"])


def _is_culled(row: Row) -> bool:
    return parameter_items(row["parameters"]).get("backface_culling") == "true"


def _ratios(mode: Row, row: Row, files: Mapping[Identity, CellFile]) -> tuple[Ratio, Ratio | None]:
    """Returns the ratios of first and second traces, paired by rounds if possible."""
    ratio, second = None, None
    over, under = files.get(identity(mode)), files.get(identity(row))
    if over and under:
        shares = (_shading(mode), _shading(row))
        ratio, second = (over.ratio(times, under, shares) for times in ("trace_ms", "warm_ms"))
    embree, tile = _trace(mode, ""), _trace(row, "")
    if second is None and embree.second and tile.second:
        second = Ratio(embree.second / tile.second)
    return ratio or unpaired_ratio(embree.first, tile.first), second


def _shading(row: Row) -> float:
    """Returns the time in ms that all traces of a picture share, without any structure's work."""
    return float(row["harness_ms"]) if row["kind"] == PICTURE else 0.0


def mode_name(row: Row) -> str:
    """Returns Embree's mode and flags in a row, and whether its list was sorted."""
    own = parameter_items(row["parameters"])
    mode = own.get("mode", "single")
    robust = ", robust" if own.get("robust") == "true" else ""
    apart = ", not coherent" if mode != "single" and own.get("coherent") == "false" else ""
    sets = row.get("parameter_sets")
    tuned = f" (best of {sets:.0f})" if pd.notna(sets) and sets > 1 else ""
    is_sorted = row["kind"] != row["ray_kind"]
    return f"{mode}{robust}{apart}{tuned}{', sorted rays' if is_sorted else ''}"


def _trace(row: Row, contender: str) -> Trace:
    second = row.get("trace_warm_ms_median")
    share = _shading(row)
    first = median_of(row, "trace")
    ends = (None if end is None else end - share for end in (first.low, first.high))
    return Trace(
        contender,
        Median(first.value - share, *ends),
        None if pd.isna(second) else float(second) - share,
        float(row["build_ms_median"]),
        str(row.get("structure_isa") or ""),
    )
