"""The sweeps for the tables and figures that a user requests."""

import json
import re
from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any

from beambench_report.base.files import ROOT, Problem, load_json, read_json, write_text
from beambench_report.base.published import rays


@dataclass(frozen=True)
class Table:
    """A table of the thesis; its `best` sweeps look for each contender's best parameters."""

    number: str
    title: str
    first: tuple[str, ...]
    best: tuple[str, ...]


@dataclass(frozen=True)
class Figure:
    """A figure of the thesis and the sweeps whose cells it draws."""

    number: str
    sweeps: tuple[str, ...]


TABLES = (
    Table("5.2", "Results as more objects may lie in a leaf", ("division",), ("best-division",)),
    Table("5.3", "Results as the octree becomes deeper", ("division",), ("best-division",)),
    Table(
        "5.4",
        "Total time: beams and single rays on the same octree, synthetic scenes",
        ("synthetic",),
        ("best-synthetic",),
    ),
    Table(
        "5.5",
        "Total time: beams and single rays on the same octree, real scenes",
        ("octree",),
        ("best-octree", "shallow"),
    ),
    Table(
        "5.6",
        "Total time: beams, voxel grid and bounding boxes, synthetic scenes",
        ("synthetic",),
        ("best-synthetic",),
    ),
    Table(
        "5.7",
        "Total time: beams, voxel grid and bounding boxes, a thousand polygons",
        ("others-small",),
        ("best-others-small",),
    ),
    Table(
        "5.8",
        "Total time: beams, voxel grid and bounding boxes, ten thousand polygons and more",
        ("others-large",),
        ("best-others-large", "best-grids"),
    ),
)

FIGURES = (
    Figure("5.4", ("division",)),
    Figure("5.5", ("division",)),
    Figure("5.6", ("division",)),
    Figure("5.7", ("division",)),
    Figure("5.8", ("synthetic",)),
    Figure("5.9", ("others-small", "quality")),
    Figure("5.10", ("others-small", "quality")),
    Figure("5.11", ("others-small", "quality", "samples")),
    Figure("5.12", ("synthetic",)),
    Figure("5.13", ("octree",)),
    Figure("5.14", ("octree", "best-octree", "shallow")),
    Figure("5.15", ("synthetic",)),
    Figure("5.16", ("others-small",)),
    Figure("5.17", ("others-large", "best-others-large", "best-grids")),
    Figure("5.18", ("others-large", "best-others-large", "best-grids", "grids")),
)

# In the order in which they are run: the thesis's own sweeps first, those needed by the fewest
# claims last.
SWEEPS = tuple(
    "synthetic division octree others-small others-large quality samples best-octree shallow "
    "best-others-large best-grids grids best-synthetic best-division best-others-small".split()
)

FOLDER = ROOT / "harness/measure/sweeps/thesis"

LEVELS = "levels"
"""The sweep that tests max_level=auto; its file is in the folder above FOLDER."""

LOW_RESOLUTIONS = ("320x200", "640x480")
"""The resolutions of quick runs and variants: the fewest for claims about changes with the
resolution.
"""

_QUICK_REPETITIONS = {"minimum": 1, "maximum": 3}
_QUICK_SECONDS_PER_CELL = 0.25


@dataclass(frozen=True)
class PlannedCell:
    """A cell as a sweep names it: parameters that are not named keep their defaults."""

    scene: str
    structure: str
    parameters: tuple[tuple[str, str], ...]
    resolution: str
    samples: int


@dataclass(frozen=True)
class Sweep:
    """A sweep file; the file and the folder of its run have the same `name`."""

    name: str
    source: dict[str, Any]

    @property
    def description(self) -> str:
        """The description in the sweep file."""
        return self.source.get("description", "")

    @property
    def budget_seconds(self) -> float:
        """The time budget; cells below their minimum number of repetitions may exceed it."""
        return self.source["budget_seconds"]

    def cells(self) -> list[PlannedCell]:
        """Returns every cell, in no particular order."""
        contenders = list(dict.fromkeys(self._contenders()))
        views = product(
            self.source["scenes"], self.source["resolutions"], self.source.get("samples", [1])
        )
        return [
            PlannedCell(scene, *contender, resolution, samples)
            for scene, resolution, samples in views
            for contender in contenders
            if not self._is_excluded(scene, contender[0], resolution, samples)
        ]

    def _is_excluded(self, scene: str, structure: str, resolution: str, samples: int) -> bool:
        """Returns whether the sweep excludes a cell; `primitives_above` is not evaluated."""
        own = {"scene": scene, "structure": structure}
        return any(
            all(entry.get(name, value) == value for name, value in own.items())
            and rays(resolution) * samples > entry.get("rays_above", -1)
            for entry in self.source.get("exclude", [])
        )

    def _contenders(self) -> Iterator[tuple[str, tuple[tuple[str, str], ...]]]:
        for entry in self.source["structures"]:
            if isinstance(entry, str):
                name, _, text = entry.partition(":")
                pairs = [part.partition("=") for part in text.split(",") if part]
                yield name, tuple((key, value) for key, _, value in pairs)
                continue
            given = entry.get("parameters", {})
            lists = [value if isinstance(value, list) else [value] for value in given.values()]
            for values in product(*lists):
                texts = (str(value) for value in values)
                yield entry["structure"], tuple(zip(given, texts, strict=True))


def read_sweep(name: str, folder: Path = FOLDER) -> Sweep:
    """Reads FOLDER/NAME.json. Raises Problem if it is missing."""
    path = folder / f"{name}.json"
    source = read_json(path)
    if source is None:
        raise Problem(f"{path}: there is no such file; restore it with git")
    return Sweep(name, source)


def quick(sweep: Sweep) -> Sweep | None:
    """Returns the sweep at its low resolutions, with a short budget; None without them."""
    resolutions = [size for size in sweep.source["resolutions"] if size in LOW_RESOLUTIONS]
    if not resolutions:
        return None
    changes = {
        "name": f"{sweep.source['name']}-quick",
        "resolutions": resolutions,
        "repetitions": _QUICK_REPETITIONS,
        "warm_up_seconds": 0.2,
    }
    return _changed(sweep, sweep.name, changes, _QUICK_SECONDS_PER_CELL)


def _changed(sweep: Sweep, name: str, changes: dict[str, Any], seconds_per_cell: float) -> Sweep:
    """Returns the sweep with changes, and with the budget for its changed cells."""
    made = Sweep(name, sweep.source | changes)
    budget = round(max(1.0, seconds_per_cell * len(made.cells())), 1)
    return replace(made, source=made.source | {"budget_seconds": budget})


_VARIED = ("synthetic", "division", "octree", "others-small", "others-large", "quality", "samples")
_UNCLAIMED = (  # contenders that no claim concerns
    "sah-bvh",
    "embree",
    "goldsmith-salmon:order=given,queue=heap,insert=everywhere",
)
# Four blocks: an interval from fewer is too wide to decide anything.
_VARIANT_REPETITIONS = {"minimum": 12, "maximum": 24, "second_traces": 0}
_VARIANT_SECONDS_PER_CELL = 2.0


def variant_sweeps(number: int) -> tuple[Sweep, ...]:
    """Returns the sweeps of one variant of all scenes (`perturb=NUMBER`), at low resolutions."""
    return tuple(_varied(read_sweep(name), number) for name in _VARIED)


def deeper_sweeps() -> tuple[Sweep, ...]:
    """Returns the sweeps by the other reading of the thesis's levels, at low resolutions.

    In section 5.4 a level-5 octree has 2^5 cells along an axis, but elsewhere 2^4 (claims.md). In
    these sweeps, each `max_level` is larger by one.
    """
    return tuple(_deeper(read_sweep(name)) for name in _VARIED)


def _deeper(sweep: Sweep) -> Sweep:
    one_deeper = [_one_level_deeper(one) for one in _claimed(sweep)]
    return _at_low_resolutions(sweep, f"deeper-{sweep.name}", structures=one_deeper)


def _varied(sweep: Sweep, number: int) -> Sweep:
    scenes = [
        f"{scene}{',' if ':' in scene else ':'}perturb={number}" for scene in sweep.source["scenes"]
    ]
    return _at_low_resolutions(sweep, f"variant-{number}-{sweep.name}", scenes=scenes)


def _claimed(sweep: Sweep) -> list[str | dict[str, Any]]:
    """Returns the contenders that the claims concern."""
    return [_with_exact_leaves(one) for one in sweep.source["structures"] if one not in _UNCLAIMED]


def _at_low_resolutions(sweep: Sweep, name: str, **more: object) -> Sweep:
    changes = {
        "name": f"thesis-{name}",
        "structures": _claimed(sweep),
        "resolutions": list(LOW_RESOLUTIONS),
        "repetitions": _VARIANT_REPETITIONS,
    }
    return _changed(sweep, name, changes | more, _VARIANT_SECONDS_PER_CELL)


def _with_exact_leaves(structure: str | dict[str, Any]) -> str | dict[str, Any]:
    """Returns a contender without the SIMD leaf tests that are measured beside the thesis's."""
    if isinstance(structure, str) or "leaf" not in structure["parameters"]:
        return structure
    return structure | {"parameters": structure["parameters"] | {"leaf": "exact"}}


def _one_level_deeper(structure: str | dict[str, Any]) -> str | dict[str, Any]:
    """Returns the contender with each of its levels increased by one."""
    if isinstance(structure, str):
        return re.sub(r"(?<=max_level=)\d+", lambda level: str(int(level[0]) + 1), structure)
    levels = structure["parameters"].get("max_level")
    if levels is None:
        return structure
    deeper = [level + 1 for level in levels] if isinstance(levels, list) else levels + 1
    return structure | {"parameters": structure["parameters"] | {"max_level": deeper}}


_PLAN = "thesis.json"


@dataclass(frozen=True)
class Plan:
    """The tables and figures to show, and the sweeps to measure for them."""

    tables: tuple[str, ...]
    figures: tuple[str, ...]
    is_quick: bool
    sweeps: tuple[Sweep, ...]
    variants: tuple[tuple[Sweep, ...], ...] = ()
    """The sweeps of perturbed scenes, variant by variant."""
    deeper: tuple[Sweep, ...] = ()
    """The sweeps by the other reading of the thesis's levels."""

    @property
    def every_sweep(self) -> tuple[Sweep, ...]:
        """All sweeps in the order in which they are run."""
        varied = (sweep for variant in self.variants for sweep in variant)
        return (*self.sweeps, *self.deeper, *varied)

    @property
    def is_everything(self) -> bool:
        """Whether the plan covers all of chapter 5."""
        return len(self.tables) == len(TABLES) and len(self.figures) == len(FIGURES)


def make_plan(
    tables: Sequence[str],
    figures: Sequence[str],
    is_quick: bool,
    *,
    with_levels: bool = False,
    variants: int = 0,
) -> Plan:
    """Returns the plan for some tables and figures, or for all. Raises Problem for an unknown one.

    `with_levels` adds the sweep that tests max_level=auto, `variants` that number of perturbed
    scenes.
    """
    known_tables, known_figures = [t.number for t in TABLES], [f.number for f in FIGURES]
    for kind, given, known in (("table", tables, known_tables), ("figure", figures, known_figures)):
        for unknown in (number for number in given if number not in known):
            raise Problem(f"there is no {kind} '{unknown}'; there are {', '.join(known)}")
    if not tables and not figures:
        tables, figures = known_tables, known_figures
    chosen_tables = [table for table in TABLES if table.number in tables]
    wanted = {name for table in chosen_tables for name in (*table.first, *table.best)}
    wanted |= {name for figure in FIGURES if figure.number in figures for name in figure.sweeps}
    shown = _figures_of(wanted)
    read = [read_sweep(name, FOLDER) for name in SWEEPS if name in wanted]
    made = [quick(sweep) if is_quick else sweep for sweep in read]
    plan = Plan(
        tuple(table.number for table in chosen_tables),
        tuple(shown),
        is_quick,
        tuple(sweep for sweep in made if sweep is not None),
    )
    plan = add_variants(plan, variants)
    return add_levels(plan) if with_levels else plan


def add_levels(plan: Plan) -> Plan:
    """Returns the plan with the sweep that tests max_level=auto."""
    if any(sweep.name == LEVELS for sweep in plan.sweeps):
        return plan
    levels = read_sweep(LEVELS, FOLDER.parent)
    made = quick(levels) if plan.is_quick else levels
    return replace(plan, sweeps=(*plan.sweeps, made)) if made else plan


def add_variants(plan: Plan, number: int) -> Plan:
    """Returns the plan with variants of the scenes up to that number, and the deeper octrees."""
    if not number:
        return plan
    more = range(len(plan.variants) + 1, number + 1)
    variants = (*plan.variants, *map(variant_sweeps, more))
    return replace(plan, variants=variants, deeper=plan.deeper or deeper_sweeps())


def keep_plan(plan: Plan, directory: Path) -> None:
    """Writes DIRECTORY/thesis.json, from which an interrupted run is resumed."""
    document = {
        "tables": plan.tables,
        "figures": plan.figures,
        "quick": plan.is_quick,
        "sweeps": _kept(plan.sweeps),
        "variants": [_kept(variant) for variant in plan.variants],
        "deeper": _kept(plan.deeper),
    }
    write_text(directory / _PLAN, json.dumps(document, indent=2) + "\n")


def _kept(sweeps: Sequence[Sweep]) -> list[dict[str, Any]]:
    return [{"name": sweep.name, "sweep": sweep.source} for sweep in sweeps]


def _restored(kept: Sequence[dict[str, Any]]) -> tuple[Sweep, ...]:
    return tuple(Sweep(entry["name"], entry["sweep"]) for entry in kept)


def read_plan(directory: Path) -> Plan:
    """Reads the file written by `keep_plan`. Raises Problem if it cannot be read."""
    path = directory / _PLAN
    try:
        source = load_json(path)
        sweeps = _restored(source["sweeps"])
        shown = set(source["figures"]) | set(_figures_of({sweep.name for sweep in sweeps}))
        return Plan(
            tuple(source["tables"]),
            tuple(figure.number for figure in FIGURES if figure.number in shown),
            source["quick"],
            sweeps,
            tuple(map(_restored, source.get("variants", ()))),
            _restored(source.get("deeper", ())),
        )
    except FileNotFoundError:
        raise Problem(
            f"{path}: there is no such file; give the folder that an earlier scripts/thesis wrote"
        ) from None
    except (ValueError, KeyError, TypeError) as error:
        raise Problem(f"{path}: is not the plan of a run ({error}); begin anew with -o") from None


def _figures_of(sweeps: Set[str]) -> list[str]:
    """Returns the figures for which these sweeps suffice."""
    return [figure.number for figure in FIGURES if sweeps >= set(figure.sweeps)]
