"""Which counts make up which time: the two formulas of section 5.3.3, and the sums that
`max_level=auto` weighs levels by (accel/octree/choose_octree.cpp, accel/beam/beam_cost.cpp).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from beambench_report.thesis.cells import Cell

_SHORTEST = 1e5
"""Nanoseconds: of a shorter time, cold caches and the clock are a part that no count tells."""


@dataclass(frozen=True)
class Observation:
    """One cell: how often each term was counted, and nanoseconds."""

    cell: Cell
    counts: tuple[float, ...]
    time: float


@dataclass(frozen=True)
class Term:
    """A count and the thesis's name of what one of them costs, if it has one."""

    words: str
    symbol: str = ""


@dataclass(frozen=True)
class Formula:
    """A time as a sum of counts, each times a cost of its own."""

    title: str
    time: str
    """What is told by it."""
    terms: tuple[Term, ...]
    observe: Callable[[Iterable[Cell]], list[Observation]]
    unit: str = "ms"
    """Of its figure."""


def thesis_formulas() -> tuple[Formula, Formula]:
    """Of beams that pass empty leaves, and of beams that end at occupied ones."""
    return (
        Formula(
            "Non-terminal beams",
            "of all non-terminal beams of an image",
            (
                Term("a beam: directions of exit", "C_d"),
                Term("an edge met with a plane", "I_r-p"),
                Term("a polygon clipped to a square", "R_pol-cuad"),
                Term("a search for neighbours", "B_v"),
            ),
            lambda cells: _tasks(
                cells,
                "beams_nonterminal_ns",
                ("beams_nonterminal", "beam_edges", "beam_clips", "neighbour_searches"),
            ),
        ),
        Formula(
            "Beams at occupied leaves",
            "of all beams at occupied leaves of an image, with the rays that go on behind them",
            (
                Term("a beam: its pixels are found", "B_pixel"),
                Term("a sample in an occupied leaf"),
                Term("a ray tested against a primitive", "I_rayo-objeto"),
                Term("a ray that goes on alone", "T_indiv"),
                Term("a leaf on the way of such a ray", "T_indiv"),
            ),
            lambda cells: _tasks(
                cells,
                "beams_occupied_ns",
                (
                    "beams_occupied",
                    "samples_in_leaves",
                    "primitive_tests",
                    "rays_after_leaf",
                    "traversal_steps",
                ),
            ),
        ),
    )


def sums_of_auto() -> tuple[Formula, Formula, Formula]:
    """What building an octree, tracing single rays and tracing beams are taken to cost."""
    return (
        Formula(
            "Building the octree",
            "of building, samet and beam",
            (Term("a node"), Term("a reference")),
            _builds,
        ),
        Formula(
            "Tracing rays",
            "of tracing a ray, samet",
            (Term("a ray"), Term("a leaf on its way"), Term("a test against a primitive")),
            _rays,
            "ns a ray",
        ),
        Formula(
            "Tracing beams",
            "of tracing an image; leaves and tests are those that samet counts in the same octree, "
            "for the rays that hit",
            (
                Term("a non-terminal beam"),
                Term("a beam at an occupied leaf"),
                Term("a leaf on the way of a ray that hits"),
                Term("a test of a ray that hits"),
            ),
            _beams,
        ),
    )


def _usable(cells: Iterable[Cell], structures: tuple[str, ...]) -> Iterable[Cell]:
    """Right, and with the thesis's parameters but for level and objects."""
    for cell in cells:
        if cell.structure in structures and cell.setting is not None and cell.time is not None:
            yield cell


def _tasks(cells: Iterable[Cell], task: str, counts: tuple[str, ...]) -> list[Observation]:
    """The time of a task in the counting pass over the counts of the same pass, of an image."""
    return [
        Observation(
            cell,
            tuple(cell.counters[name] * cell.rays for name in counts),
            cell.counters[task] * cell.rays,
        )
        for cell in _usable(cells, ("beam",))
        if cell.counters.keys() >= {task, *counts} and cell.counters[task] * cell.rays >= _SHORTEST
    ]


def _builds(cells: Iterable[Cell]) -> list[Observation]:
    return [
        Observation(cell, (cell.nodes, cell.references), 1e9 * cell.build)
        for cell in _usable(cells, ("samet", "beam"))
        if cell.nodes + cell.references > 0 and 1e9 * cell.build >= _SHORTEST
    ]


def _rays(cells: Iterable[Cell]) -> list[Observation]:
    return [
        Observation(cell, (1.0, *_walk(cell)), 1e9 * cell.trace / cell.rays)
        for cell in _usable(cells, ("samet",))
        if cell.counters.keys() >= {"traversal_steps", "primitive_tests"}
    ]


def _beams(cells: Iterable[Cell]) -> list[Observation]:
    cells = list(cells)
    walks: dict[tuple[object, ...], tuple[float, float]] = {}
    for cell in _usable(cells, ("samet",)):
        if cell.counters.keys() >= {"traversal_steps", "primitive_tests"}:
            # A ray's work hardly depends on how many there are: another resolution's will do.
            walks[_octree(cell)] = walks[*_octree(cell), cell.rays] = _walk(cell)
    found = []
    for cell in _usable(cells, ("beam",)):
        walk = walks.get((*_octree(cell), cell.rays), walks.get(_octree(cell)))
        counted = cell.counters.keys() >= {"beams_nonterminal", "beams_occupied"}
        if walk is None or not counted or not cell.hit_share >= 0:
            continue
        hitting = cell.rays * cell.hit_share
        counts = (
            cell.counters["beams_nonterminal"] * cell.rays,
            cell.counters["beams_occupied"] * cell.rays,
            hitting * walk[0],
            hitting * walk[1],
        )
        found.append(Observation(cell, counts, 1e9 * cell.trace))
    return found


def _walk(cell: Cell) -> tuple[float, float]:
    return cell.counters["traversal_steps"], cell.counters["primitive_tests"]


def _octree(cell: Cell) -> tuple[object, ...]:
    """Scene and octree; root, assignment and padding are the thesis's in all usable cells."""
    given = cell.parameters
    return cell.scene, given.get("max_level"), given.get("max_objects"), given.get("pad")
