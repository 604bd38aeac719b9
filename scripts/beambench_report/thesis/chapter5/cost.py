"""The cost formulas of section 5.3.3, fitted to what was counted and how long it took."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain, combinations

import numpy as np

from beambench_report.base.figure import Plot, new_figure, variant_look
from beambench_report.base.quantities import number
from beambench_report.thesis.paper.cells import Cell
from beambench_report.thesis.paper.evidence import Measured
from beambench_report.thesis.paper.printed import DASH
from beambench_report.thesis.paper.section import (
    Column,
    Field,
    Section,
    SectionFigure,
    SectionTable,
)

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
                ("beams_nonterminal", "beam_edges", "beam_clips", "neighbor_searches"),
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


_SAME = 1e-10  # columns whose part of their own is less say the same


@dataclass(frozen=True)
class NormalEquations:
    """What fits need to know of groups of cells; the first axis is that of the groups."""

    products: np.ndarray
    """Of the columns with each other: groups x terms x terms."""
    aims: np.ndarray
    """Of the columns with what is to be told: groups x terms."""

    def sums(self, weights: np.ndarray) -> NormalEquations:
        """Of unions of the groups, each as often as the rows of `weights` say."""
        return NormalEquations(
            np.tensordot(weights, self.products, axes=1), np.tensordot(weights, self.aims, axes=1)
        )


def relative_equations(
    counts: np.ndarray, times: np.ndarray, groups: np.ndarray
) -> NormalEquations:
    """Every cell counts alike, however long it took: the error is (told - measured) / measured."""
    shares = counts / times[:, None]
    parts = [shares[groups == group] for group in np.unique(groups)]
    return NormalEquations(
        np.stack([part.T @ part for part in parts]), np.stack([part.sum(axis=0) for part in parts])
    )


def solve(equations: NormalEquations) -> np.ndarray:
    """For each group the coefficients, none negative, that make the sum of the squares least."""
    lengths = np.sqrt(np.einsum("gtt->gt", equations.products))
    scale = np.where(lengths > 0, lengths, 1.0)
    products = equations.products / (scale[:, :, None] * scale[:, None, :])
    aims = equations.aims / scale
    groups, terms = aims.shape
    best, gains = np.zeros_like(aims), np.zeros(groups)
    for count in range(1, terms + 1):
        for chosen in combinations(range(terms), count):
            of = list(chosen)
            inverses = np.linalg.pinv(products[:, of][:, :, of], rcond=_SAME, hermitian=True)
            found = np.einsum("gst,gt->gs", inverses, aims[:, of])
            gain = np.sum(found * aims[:, of], axis=1)
            better = (found >= 0).all(axis=1) & (gain > gains)
            gains = np.where(better, gain, gains)
            best[better] = 0.0
            best[np.ix_(better, of)] = found[better]
    return best / scale


LEAST_CELLS = 10
_LEAST_SCENES = 3  # from which on scenes can be drawn again, or one be left out
_DRAWS = 1000
_SEED = 1999


@dataclass(frozen=True)
class Fit:
    """One formula, the cells it was fitted to, and what it tells of them."""

    formula: Formula
    observations: tuple[Observation, ...]
    coefficients: tuple[Measured, ...]
    """Nanoseconds each; the interval is (nan, nan) with too few scenes."""
    told: tuple[float, ...]
    """Nanoseconds, by the fitted coefficients."""
    r_squared: float
    errors: tuple[float, ...]
    """|told - measured| / measured."""
    errors_of_strangers: tuple[float, ...]
    """The same, each scene told by what was fitted to all others; empty with too few."""

    @property
    def scenes(self) -> int:
        """How many scenes the cells are of."""
        return len({observation.cell.scene for observation in self.observations})


def fit(formula: Formula, observations: Sequence[Observation]) -> Fit | None:
    """Fits a formula to cells; None if there are too few."""
    if len(observations) < LEAST_CELLS:
        return None
    counts = np.array([observation.counts for observation in observations], dtype=float)
    times = np.array([observation.time for observation in observations])
    scenes_of = [observation.cell.scene for observation in observations]
    groups = np.unique(scenes_of, return_inverse=True)[1]
    equations = relative_equations(counts, times, groups)
    every = np.ones((1, len(equations.aims)))
    values = solve(equations.sums(every))[0]
    told = counts @ values
    low = high = np.full(len(values), np.nan)
    strangers: tuple[float, ...] = ()
    scenes = len(equations.aims)
    if scenes >= _LEAST_SCENES:
        drawn = np.random.default_rng(_SEED).multinomial(scenes, [1 / scenes] * scenes, _DRAWS)
        low, high = np.percentile(solve(equations.sums(drawn)), [2.5, 97.5], axis=0)
        others = solve(equations.sums(1 - np.eye(scenes)))[groups]
        strangers = _errors(np.sum(counts * others, axis=1), times)
    return Fit(
        formula,
        tuple(observations),
        tuple(Measured(*map(float, figures)) for figures in zip(values, low, high, strict=True)),
        tuple(map(float, told)),
        r_squared(times, told),
        _errors(told, times),
        strangers,
    )


def r_squared(measured: np.ndarray, told: np.ndarray) -> float:
    """The part of the spread of what was measured that what is told explains."""
    spread = float(np.sum((measured - measured.mean()) ** 2))
    return 1.0 - float(np.sum((measured - told) ** 2)) / spread if spread > 0 else 1.0


def _errors(told: np.ndarray, times: np.ndarray) -> tuple[float, ...]:
    return tuple(map(float, np.abs(told - times) / times))


_HEIGHTS = {1: 3.0, 2: 3.4, 3: 2.5}  # inches, by the number of panels
_BAND = 0.25
_NANOSECONDS = {"ms": 1e-6, "ns a ray": 1.0}


def draw_fits(stem: str, fits: Sequence[Fit]) -> Plot:
    """A panel a formula: every cell a point; on the line, the formula tells the time exactly."""
    figure, panels = new_figure(_HEIGHTS[len(fits)], 1, len(fits))
    for panel, fit in zip(panels, fits, strict=True):
        scale = _NANOSECONDS[fit.formula.unit]
        measured = np.array([one.time for one in fit.observations]) * scale
        told = np.array(fit.told) * scale
        structures = [one.cell.structure for one in fit.observations]
        for structure in dict.fromkeys(structures):
            at = [name == structure for name in structures]
            look = variant_look(structure, 0 if structure == "beam" else 1)
            panel.scatter(
                measured[at],
                told[at],
                s=12,
                color=look.colour,
                marker=look.marker,
                alpha=0.55,
                linewidths=0,
                label=structure,
            )
        both = [value for value in chain(measured, told) if value > 0]
        ends = np.array([min(both) / 1.5, max(both) * 1.5])
        panel.plot(ends, ends, color="#333333", linewidth=0.8)
        panel.fill_between(
            ends, ends * (1 - _BAND), ends * (1 + _BAND), color="#999999", alpha=0.25, linewidth=0
        )
        panel.set(xscale="log", yscale="log", xlim=ends, ylim=ends, aspect="equal")
        panel.set_title(fit.formula.title, fontsize=8.5)
        panel.set_ylabel(f"told / {fit.formula.unit}", labelpad=1)
        panel.set_xlabel(f"measured / {fit.formula.unit}")
        panel.tick_params(labelsize=8)
        panel.grid(which="major", color="#dddddd", linewidth=0.6)
        panel.legend(frameon=False, fontsize=8, loc="upper left")
    return Plot(stem, figure, "Times told by counts over measured times")


_WORDS = (
    "Section 5.3.3 gives the time of the beams as two sums of counts, each times a cost of its "
    "own. Both are fitted here to every cell of beams with the thesis's parameters, whatever its "
    "scene, level, resolution and samples, by least squares of the relative error and without "
    "negative costs; counts and times are of the counting pass, which takes the time of each beam "
    "by itself. Intervals are of 95%, by drawing the scenes again, with replacement, a thousand "
    "times: they tell how far a cost depends on which scenes were measured. A cost of 0 means that "
    "the other terms tell the times as well without it.",
    "The sums below them are those by which max_level=auto weighs the levels. Their costs are the "
    "constants of accel/octree/choose_octree.cpp and accel/beam/beam_cost.cpp; they are fitted to "
    "the timed passes.",
)
_CAPTION = (
    "Every point is a cell; on the line, the counts tell its time exactly, and in the grey band "
    "within a quarter."
)


def cost_section(cells: Iterable[Cell]) -> Section | None:
    """The fits and their figures; None where nothing can be fitted."""
    cells = list(cells)
    thesis, sums = _fits(thesis_formulas(), cells), _fits(sums_of_auto(), cells)
    fits = [*thesis, *sums]
    if not fits:
        return None
    figures = (
        SectionFigure(stem, title, _CAPTION, partial(draw_fits, stem, shown))
        for stem, title, shown in (
            ("cost-formulas", "The two formulas of section 5.3.3: time of an image", thesis),
            ("cost-sums", "The sums of max_level=auto: time of building and of tracing", sums),
        )
        if shown
    )
    return Section(
        "costs",
        "The cost formulas of section 5.3.3",
        _WORDS,
        (_costs(fits), _quality(fits)),
        tuple(figures),
        tuple(_finding(one) for one in thesis),
    )


def _fits(formulas: Iterable[Formula], cells: Sequence[Cell]) -> list[Fit]:
    found = (fit(formula, formula.observe(cells)) for formula in formulas)
    return [one for one in found if one is not None]


def _costs(fits: Iterable[Fit]) -> SectionTable:
    heads = ("formula", "what is counted", "in the thesis")
    columns = (*(Column(head, False) for head in heads), Column("ns each"), Column("interval"))
    rows = [
        tuple(
            Field(text)
            for text in (
                one.formula.title,
                term.words,
                term.symbol or DASH,
                number(cost.value),
                DASH if math.isnan(cost.low) else f"{number(cost.low)} to {number(cost.high)}",
            )
        )
        for one in fits
        for term, cost in zip(one.formula.terms, one.coefficients, strict=True)
    ]
    return SectionTable("Costs, fitted", columns, tuple(rows))


def _quality(fits: Iterable[Fit]) -> SectionTable:
    heads = ("cells", "scenes", "R2", "median error", "90% below", "median, scene left out")
    rows = []
    for one in fits:
        texts = (
            f"{one.formula.title}: time {one.formula.time}",
            f"{len(one.observations):,}",
            f"{one.scenes}",
            f"{one.r_squared:.3f}",
            *(_percent(np.percentile(one.errors, part)) for part in (50, 90)),
            _percent(np.median(one.errors_of_strangers)) if one.errors_of_strangers else DASH,
        )
        rows.append(tuple(Field(text) for text in texts))
    columns = (Column("formula", False), *(Column(head) for head in heads))
    return SectionTable("How well the sums tell the times", columns, tuple(rows))


def _finding(one: Fit) -> str:
    middle, most = np.percentile(one.errors, (50, 90))
    return (
        f"{one.formula.title}: the sum tells half of {len(one.observations):,} times to "
        f"{_percent(middle)}, nine of ten to {_percent(most)}; R2 {one.r_squared:.3f}."
    )


def _percent(share: float) -> str:
    return f"{100 * share:.1f}%"
