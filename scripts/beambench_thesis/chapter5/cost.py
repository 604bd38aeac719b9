"""Fits the cost formulas of section 5.3.3 to counts and times, and likewise the sums by which
`max_level=auto` compares levels (accel/octree/choose_octree.cpp, accel/beam/beam_cost.cpp).
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain

import numpy as np
from scipy.optimize import nnls

from beambench_report.base.figure import Plot, new_figure, variant_look
from beambench_report.base.quantities import DASH, number
from beambench_report.run.panels import scale_axis
from beambench_thesis.paper.cells import Cell
from beambench_thesis.paper.evidence import Measured
from beambench_thesis.paper.section import Section, SectionFigure, SectionTable, section_table

MIN_CELLS = 10
_MIN_NANOSECONDS = 1e5  # below this, cold caches and the clock dominate, which no count explains
_MIN_SCENES = 3  # the fewest scenes for resampling, or for leaving one out
_DRAWS = 1000
_SEED = 1999


@dataclass(frozen=True)
class Observation:
    """One cell: the count of each term, and the time in nanoseconds."""

    cell: Cell
    counts: tuple[float, ...]
    time: float


@dataclass(frozen=True)
class Term:
    """A count, and the thesis's name for its cost, if it has one."""

    words: str
    symbol: str = ""


@dataclass(frozen=True)
class Formula:
    """A time as a sum of counts, each multiplied by a cost."""

    title: str
    time: str
    """The predicted time, as the words after `time`: `of building, samet and beam`."""
    terms: tuple[Term, ...]
    observe: Callable[[Iterable[Cell]], list[Observation]]
    unit: str = "ms"
    """The unit of the axes of its figure."""


@dataclass(frozen=True)
class Fit:
    """A formula fitted to cells. Coefficients and predictions are nanoseconds."""

    formula: Formula
    observations: tuple[Observation, ...]
    coefficients: tuple[Measured, ...]
    """The costs, with 95% intervals; their ends are NaN with too few scenes."""
    predicted: tuple[float, ...]
    r_squared: float
    errors: tuple[float, ...]
    """|predicted - measured| / measured."""
    cross_validation_errors: tuple[float, ...]
    """The errors if each scene is predicted by a fit to the others; empty with too few scenes."""

    @property
    def scenes(self) -> int:
        """Returns the number of scenes of the cells."""
        return len({observation.cell.scene for observation in self.observations})


def thesis_formulas() -> tuple[Formula, Formula]:
    """Returns the formulas for beams that pass empty leaves and beams at occupied leaves."""
    nonterminal = {
        "beams_nonterminal": Term("a beam: directions of exit", "C_d"),
        "beam_edges": Term("an edge met with a plane", "I_r-p"),
        "beam_clips": Term("a polygon clipped to a square", "R_pol-cuad"),
        "neighbor_searches": Term("a search for neighbors", "B_v"),
    }
    occupied = {
        "beams_occupied": Term("a beam: its pixels are found", "B_pixel"),
        "samples_in_leaves": Term("a sample in an occupied leaf"),
        "primitive_tests": Term("a ray tested against a primitive", "I_rayo-objeto"),
        "rays_after_leaf": Term("a ray that continues alone", "T_indiv"),
        "traversal_steps": Term("a leaf on the path of such a ray", "T_indiv"),
    }
    return (
        Formula(
            "Non-terminal beams",
            "of all non-terminal beams of an image",
            tuple(nonterminal.values()),
            partial(_tasks, "beams_nonterminal_ns", tuple(nonterminal)),
        ),
        Formula(
            "Beams at occupied leaves",
            "of all beams at occupied leaves of an image, including rays that continue behind them",
            tuple(occupied.values()),
            partial(_tasks, "beams_occupied_ns", tuple(occupied)),
        ),
    )


def sums_of_auto() -> tuple[Formula, Formula, Formula]:
    """Returns the sums for building an octree, for tracing single rays, and for tracing beams."""
    return (
        Formula(
            "Building the octree",
            "of building, samet and beam",
            (Term("a node"), Term("a reference")),
            _builds,
        ),
        Formula(
            "Tracing rays",
            "of tracing, per ray, samet",
            (Term("a ray"), Term("a leaf on its path"), Term("a test against a primitive")),
            _rays,
            "ns per ray",
        ),
        Formula(
            "Tracing beams",
            "of tracing an image; leaves and tests are those that samet counts in the same octree, "
            "for the rays that hit",
            (
                Term("a non-terminal beam"),
                Term("a beam at an occupied leaf"),
                Term("a leaf on the path of a ray that hits"),
                Term("a test of a ray that hits"),
            ),
            _beams,
        ),
    )


def fit_costs(
    counts: np.ndarray, times: np.ndarray, weights: np.ndarray | None = None
) -> np.ndarray:
    """Returns nonnegative costs with the least squared relative error; cells are weighted."""
    shares = counts / times[:, None]
    lengths = np.sqrt((shares**2).sum(axis=0))  # counts differ by orders of magnitude
    scale = np.where(lengths > 0, lengths, 1.0)
    roots = np.sqrt(np.ones_like(times) if weights is None else weights)
    return nnls(shares / scale * roots[:, None], roots)[0] / scale


def r_squared(measured: np.ndarray, predicted: np.ndarray) -> float:
    """Returns the share of the variance that the prediction explains."""
    spread = float(np.sum((measured - measured.mean()) ** 2))
    return 1.0 - float(np.sum((measured - predicted) ** 2)) / spread if spread > 0 else 1.0


def fit(formula: Formula, observations: Sequence[Observation]) -> Fit | None:
    """Fits a formula to cells; None if there are too few."""
    if len(observations) < MIN_CELLS:
        return None
    counts = np.array([observation.counts for observation in observations], dtype=float)
    times = np.array([observation.time for observation in observations])
    groups = np.unique([one.cell.scene for one in observations], return_inverse=True)[1]
    values = fit_costs(counts, times)
    predicted = counts @ values
    low = high = np.full(len(values), np.nan)
    left_out: tuple[float, ...] = ()
    scenes = int(groups.max()) + 1
    if scenes >= _MIN_SCENES:
        drawn = np.random.default_rng(_SEED).multinomial(scenes, [1 / scenes] * scenes, _DRAWS)
        again = [fit_costs(counts, times, weights[groups]) for weights in drawn]
        low, high = np.percentile(again, [2.5, 97.5], axis=0)
        others = np.array([fit_costs(counts, times, groups != scene) for scene in range(scenes)])
        left_out = _errors(np.sum(counts * others[groups], axis=1), times)
    return Fit(
        formula,
        tuple(observations),
        tuple(Measured(*map(float, figures)) for figures in zip(values, low, high, strict=True)),
        tuple(map(float, predicted)),
        r_squared(times, predicted),
        _errors(predicted, times),
        left_out,
    )


def _errors(predicted: np.ndarray, times: np.ndarray) -> tuple[float, ...]:
    return tuple(map(float, np.abs(predicted - times) / times))


# Observations for the formulas, from the cells


def _usable(cells: Iterable[Cell], *structures: str) -> Iterable[Cell]:
    """Yields verified cells with the thesis's parameters, whatever their level and objects."""
    for cell in cells:
        if cell.structure in structures and cell.setting is not None and cell.time is not None:
            yield cell


def _tasks(task: str, counts: tuple[str, ...], cells: Iterable[Cell]) -> list[Observation]:
    """Returns time and counts of one task of an image, both from the counting pass."""
    return [
        Observation(cell, tuple(cell.counters[name] * cell.rays for name in counts), time)
        for cell in _usable(cells, "beam")
        if cell.counters.keys() >= {task, *counts}
        and (time := cell.counters[task] * cell.rays) >= _MIN_NANOSECONDS
    ]


def _builds(cells: Iterable[Cell]) -> list[Observation]:
    return [
        Observation(cell, (cell.nodes, cell.references), 1e9 * cell.build)
        for cell in _usable(cells, "samet", "beam")
        if cell.nodes + cell.references > 0 and 1e9 * cell.build >= _MIN_NANOSECONDS
    ]


def _rays(cells: Iterable[Cell]) -> list[Observation]:
    return [
        Observation(cell, (1.0, *walk), 1e9 * cell.trace / cell.rays)
        for cell in _usable(cells, "samet")
        if (walk := _walk(cell))
    ]


def _beams(cells: Iterable[Cell]) -> list[Observation]:
    cells = list(cells)
    walks: dict[tuple[object, ...], tuple[float, float]] = {}
    for cell in _usable(cells, "samet"):
        if walk := _walk(cell):
            # A ray's work hardly depends on the number of rays, so another resolution's count is
            # used.
            walks[_octree(cell)] = walks[*_octree(cell), cell.rays] = walk
    found = []
    for cell in _usable(cells, "beam"):
        walk = walks.get((*_octree(cell), cell.rays), walks.get(_octree(cell)))
        counted = cell.counters.keys() >= {"beams_nonterminal", "beams_occupied"}
        if walk is None or not counted or not cell.hit_share >= 0:
            continue
        hitting = cell.rays * cell.hit_share
        beams = (
            cell.counters[name] * cell.rays for name in ("beams_nonterminal", "beams_occupied")
        )
        counts = (*beams, hitting * walk[0], hitting * walk[1])
        found.append(Observation(cell, counts, 1e9 * cell.trace))
    return found


def _walk(cell: Cell) -> tuple[float, float] | None:
    steps, tests = (cell.counters.get(name) for name in ("traversal_steps", "primitive_tests"))
    return None if steps is None or tests is None else (steps, tests)


def _octree(cell: Cell) -> tuple[object, ...]:
    """Returns scene and octree; all usable cells have the thesis's root and assignment."""
    given = cell.parameters
    return cell.scene, given.get("max_level"), given.get("max_objects"), given.get("pad")


# The figures and the section of the report

_HEIGHTS = {1: 3.0, 2: 3.4, 3: 2.5}  # inches, by the number of panels
_BAND = 0.25
_NANOSECONDS = {"ms": 1e-6, "ns per ray": 1.0}


def draw_fits(stem: str, fits: Sequence[Fit]) -> Plot:
    """Draws a panel for each formula and a point per cell; on the line, predictions are exact."""
    figure, panels = new_figure(_HEIGHTS[len(fits)], 1, len(fits))
    for panel, one in zip(panels, fits, strict=True):
        scale = _NANOSECONDS[one.formula.unit]
        measured = np.array([observation.time for observation in one.observations]) * scale
        predicted = np.array(one.predicted) * scale
        structures = np.array([observation.cell.structure for observation in one.observations])
        for structure in dict.fromkeys(structures):
            at = structures == structure
            look = variant_look(structure, 0 if structure == "beam" else 1)
            panel.scatter(
                measured[at],
                predicted[at],
                s=12,
                color=look.color,
                marker=look.marker,
                alpha=0.55,
                linewidths=0,
                label=structure,
            )
        both = [value for value in chain(measured, predicted) if value > 0]
        ends = np.array([min(both) / 1.5, max(both) * 1.5])
        band = (ends * (1 - _BAND), ends * (1 + _BAND))
        panel.plot(ends, ends, color="#333333", linewidth=0.8)
        panel.fill_between(ends, *band, color="#999999", alpha=0.25, linewidth=0)
        for axis in "xy":
            scale_axis(panel, axis, ends, ticks=6)
        panel.set(xlim=ends, ylim=ends, aspect="equal")
        panel.set_title(one.formula.title, fontsize=8.5)
        panel.set_ylabel(f"predicted / {one.formula.unit}", labelpad=1)
        panel.set_xlabel(f"measured / {one.formula.unit}")
        panel.tick_params(labelsize=8)
        panel.grid(which="major", color="#dddddd", linewidth=0.6)
        panel.legend(frameon=False, fontsize=8, loc="upper left")
    return Plot(stem, figure, "Times predicted by counts over measured times")


_WORDS = (
    "Section 5.3.3 expresses the time of the beams by two sums of counts, each multiplied by a "
    "cost. Both sums are fitted to all cells of beams with the thesis's parameters, over all "
    "scenes, levels, resolutions and samples, by least squares of the relative error and without "
    "negative costs. Counts and times are those of the counting pass, which times each beam "
    "separately. The 95% intervals come from a thousand samples of the scenes with replacement: "
    "they show how much a cost depends on the choice of scenes. A cost of 0 means that the other "
    "terms predict the times as well without it.",
    "The further sums are those by which max_level=auto compares the levels. Their costs are "
    "the constants of accel/octree/choose_octree.cpp and accel/beam/beam_cost.cpp; they are fitted "
    "to the timed passes.",
)
_CAPTION = (
    "Every point is a cell. The counts predict its time exactly on the line, and to within 25% in "
    "the gray band."
)


def cost_section(cells: Iterable[Cell]) -> Section | None:
    """Returns the fits and their figures; None if nothing can be fitted."""
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
    rows = (
        (
            one.formula.title,
            term.words,
            term.symbol or DASH,
            number(cost.value),
            DASH if math.isnan(cost.low) else f"{number(cost.low)} to {number(cost.high)}",
        )
        for one in fits
        for term, cost in zip(one.formula.terms, one.coefficients, strict=True)
    )
    words = ("formula", "what is counted", "in the thesis")
    return section_table("Costs, fitted", words, ("ns each", "interval"), rows)


def _quality(fits: Iterable[Fit]) -> SectionTable:
    heads = ("cells", "scenes", "R2", "median error", "90% below", "median error, scene left out")
    rows = (
        (
            f"{one.formula.title}: time {one.formula.time}",
            f"{len(one.observations):,}",
            f"{one.scenes}",
            f"{one.r_squared:.3f}",
            *(_percent(np.percentile(one.errors, part)) for part in (50, 90)),
            _percent(np.median(left_out)) if (left_out := one.cross_validation_errors) else DASH,
        )
        for one in fits
    )
    return section_table("How well the sums predict the times", ("formula",), heads, rows)


def _finding(one: Fit) -> str:
    middle, most = np.percentile(one.errors, (50, 90))
    return (
        f"{one.formula.title}: of {len(one.observations):,} times, the sum predicts 50% to within "
        f"{_percent(middle)} and 90% to within {_percent(most)}; R2 {one.r_squared:.3f}."
    )


def _percent(share: float) -> str:
    return f"{100 * share:.1f}%"
