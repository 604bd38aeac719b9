"""Comparisons for rules, and least-squares fits of straight lines and cost formulas."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from math import log

import numpy as np

from beambench_report.base.published import rays
from beambench_thesis.chapter5.cost import MIN_CELLS, r_squared
from beambench_thesis.claims.verdict import Check, Outcome, below, between
from beambench_thesis.paper.evidence import LEVEL, Evidence, Measured, smallest, total


@dataclass(frozen=True)
class Line:
    """A least-squares line through points whose heights have intervals."""

    slope: Measured
    """The slope, with the errors of the heights combined as independent errors."""
    intercept: float
    r_squared: float
    within_intervals: bool
    """Whether the line passes through every interval, so that the data are consistent with it."""


def fit_line(places: Sequence[float], heights: Sequence[Measured]) -> Line:
    """Fits `heights` over `places`, of which at least three differ."""
    x = np.asarray(places, dtype=float)
    weights = (x - x.mean()) / np.sum((x - x.mean()) ** 2)  # the slope is linear in the heights
    value = np.array([height.value for height in heights])
    low = np.array([height.low for height in heights])
    high = np.array([height.high for height in heights])
    rising = total([height.times(w) for height, w in zip(heights, weights, strict=True) if w > 0])
    falling = total([height.times(-w) for height, w in zip(heights, weights, strict=True) if w < 0])
    slope = rising - falling
    intercept = float(value.mean() - slope.value * x.mean())
    fitted = intercept + slope.value * x
    return Line(
        slope,
        intercept,
        r_squared(value, fitted),
        not np.any((low == high) | (fitted < low) | (fitted > high)),
    )


_WIDTH = 1.96  # half the width of a 95% interval, in standard deviations of a normal distribution
_DRAWS = 400
_SEED = 1999

SAMETS = ("samet", "samet-net")


def beats(
    e: Evidence, scene: str, winner: str, other: str, resolution: str = "", factor: float = 1
) -> Check:
    """Checks whether one structure is faster than another, by `factor` or more.

    The default is the finest resolution.
    """
    resolution = resolution or e.finest
    twice = f", by {factor:g}" if factor > 1 else ""
    return below(
        f"{scene} {resolution}, {winner} before {other}{twice}",
        e.time(scene, winner, resolution),
        e.time(scene, other, resolution),
        factor,
    )


def best_ray(e: Evidence, scene: str, resolution: str) -> Measured | None:
    """Returns the better time of Samet and Samet-Net, if both were timed."""
    known = [e.time(scene, contender, resolution) for contender in SAMETS]
    times = [time for time in known if time is not None]
    return smallest(times) if len(times) == len(SAMETS) else None


def line_of(e: Evidence, scene: str, level: int = LEVEL) -> Line | None:
    """Fits seconds over rays in tens of thousands, as in the thesis's figures."""
    times = [e.time(scene, "beam", resolution, level=level) for resolution in e.resolutions]
    known = [time for time in times if time is not None]
    return fit_line([rays(at) / 1e4 for at in e.resolutions], known) if known == times else None


def slope(line: Line | None) -> Measured | None:
    """Returns the slope of a line, if there is one."""
    return line.slope if line else None


def is_linear(scene: str, line: Line | None) -> Check:
    """Checks whether the line explains 99% of the variance.

    If it does not, but passes through all intervals, this is undecided.
    """
    if line is None:
        return Check(f"{scene}, linear", Outcome.MISSING)
    outcome = Outcome.UNDECIDED if line.within_intervals else Outcome.NO
    if line.r_squared >= 0.99:
        outcome = Outcome.YES
    return Check(f"{scene}, linear", outcome, f"R2 {line.r_squared:.4f} (at least 0.99)")


def growing_share(e: Evidence, scene: str) -> Measured | None:
    """Returns the share of the time at 1280x1024 that grows with the rays, by the fitted line."""
    line, whole = line_of(e, scene), e.time(scene, "beam")
    return line.slope.times(rays(e.finest) / 1e4) / whole if line and whole else None


def growth(e: Evidence, scene: str, resolution: str, samples: int = 1) -> Measured | None:
    """Returns the beams' time over that at 320x200."""
    return ratio_of(
        e.time(scene, "beam", resolution, samples=samples),
        e.time(scene, "beam", e.coarsest, samples=samples),
    )


def grows_more(e: Evidence, more: tuple[str, ...], less: tuple[str, ...]) -> list[Check]:
    """Checks whether each scene of `more` grows more than each of `less`, at each resolution."""
    return [
        below(
            f"{slow} below {quick}, {resolution} over {e.coarsest}",
            growth(e, slow, resolution),
            growth(e, quick, resolution),
        )
        for quick, slow, resolution in product(more, less, e.finer)
    ]


def ratio_of(over: Measured | None, under: Measured | None) -> Measured | None:
    """Returns the ratio of two figures, if both are known."""
    return None if over is None or under is None else over / under


def difference(more: Measured | None, less: Measured | None) -> Measured | None:
    """Returns the difference of two figures, if both are known."""
    return None if more is None or less is None else more - less


def most(cell: str, shares: dict[str, Measured | None], bound: float, of: int) -> Check:
    """Checks whether more than half exceed the bound, whatever the undecided shares are."""
    known = {scene: share for scene, share in shares.items() if share is not None}
    figures = ", ".join(f"{scene} {share.value:.0%}" for scene, share in known.items())
    if len(known) < of or not known:
        return Check(cell, Outcome.MISSING, figures)
    surely = sum(share.low > bound for share in known.values())
    perhaps = sum(not share.high <= bound for share in known.values())
    outcome = Outcome.YES if 2 * surely > of else Outcome.NO if 2 * perhaps <= of else None
    return Check(cell, outcome or Outcome.UNDECIDED, f"{surely} of {of}: {figures}")


def any_of(cell: str, checks: Sequence[Check]) -> Check:
    """Checks whether at least one of several cells agrees."""
    outcomes = {check.outcome for check in checks}
    figures = ", ".join(f"{check.cell}: {check.figures}" for check in checks if check.figures)
    for outcome in (Outcome.MISSING, Outcome.YES, Outcome.UNDECIDED):
        if outcome in outcomes:
            return Check(cell, outcome, figures)
    return Check(cell, Outcome.NO, figures)


def seconds_per_beam(e: Evidence, level: int) -> Measured | None:
    """Returns the cost of a non-terminal beam of maceta at 320x200, counted as in the thesis."""
    seconds = e.worked("seconds_nonterminal", "maceta", e.coarsest, level=level)
    return ratio_of(seconds, e.worked("beams_divided", "maceta", level=level))


def formula(e: Evidence, task: str, quantities: tuple[str, ...]) -> list[Check]:
    """Checks whether a sum of counts, each multiplied by a cost, explains the time of a task.

    This takes ten cells or more.
    """
    seconds, counts = [], []
    for scene, level, resolution in e.beam_cells:
        time = e.worked(f"seconds_{task}", scene, resolution, level=level)
        figures = [e.worked(name, scene, resolution, level=level) for name in quantities]
        known = [figure.value for figure in figures if figure is not None]
        if time is not None and time.value > 0 and len(known) == len(quantities):
            seconds.append(time)
            counts.append(known)
    explained = error = None
    if len(seconds) >= MIN_CELLS:
        explained, error = _fit(seconds, np.array(counts))
    return [
        below(f"{task} beams, R2 above 0.9 ({len(seconds)} cells)", Measured.exact(0.9), explained),
        below(f"{task} beams, median error below 0.25", error, Measured.exact(0.25)),
    ]


def _fit(seconds: Sequence[Measured], counts: np.ndarray) -> tuple[Measured, Measured]:
    """Returns R2 and median error of a fit, with the intervals that follow from those of the times.

    The fit is repeated with times varied as their intervals allow (propagation of distributions,
    JCGM 101:2008). Such times contain their errors twice and fit worse, by as much as times without
    errors would fit better, so the interval is symmetric.
    """
    times = np.array([time.value for time in seconds])
    widths = np.array([log(time.high / time.value) / _WIDTH for time in seconds])
    # Plain least squares, as in the committed rule: a cost may be negative.
    scaled = counts / np.maximum(counts.max(axis=0), 1e-300)

    def quality(times: np.ndarray) -> tuple[float, float]:
        shares = scaled / times[:, None]
        predicted = scaled @ np.linalg.lstsq(shares, np.ones_like(times), rcond=None)[0]
        return r_squared(times, predicted), float(np.median(np.abs(predicted - times) / times))

    random = np.random.default_rng(_SEED)
    drawn = [quality(times * np.exp(random.normal(0.0, widths))) for _ in range(_DRAWS)]
    value = np.array(quality(times))
    reach = np.abs(np.quantile(drawn, (0.025, 0.975), axis=0) - value).max(axis=0)
    explained, error = map(Measured, value.tolist(), value - reach, value + reach)
    return explained, error


def best_grid(scene: str, sweep: dict[int, Measured], printed: int) -> list[Check]:
    """Checks whether the best grid of the sweep is inside it, near the printed number of cells.

    The grid must be faster than the coarsest and the finest grid, and within a factor of 1.5 of the
    printed number of cells. This needs five grids or more. The interval of the best grid contains
    all grids that may be as fast.
    """
    inside, place = f"{scene}, a best grid inside the sweep", f"{scene}, best cells per axis"
    if len(sweep) < 5:
        return [Check(inside, Outcome.MISSING), Check(place, Outcome.MISSING)]
    best, ends = min(sweep, key=lambda cells: sweep[cells].value), (min(sweep), max(sweep))
    checks = [below(f"{scene}, {best} cells before {end}", sweep[best], sweep[end]) for end in ends]
    if best in ends:
        checks = [Check(inside, Outcome.NO, f"best: {best} cells")]
    alike = [
        cells
        for cells, time in sweep.items()
        if below("", sweep[best], time).outcome is not Outcome.YES
    ]
    figure = Measured(best, min(alike), max(alike))
    return [*checks, between(place, figure, printed / 1.5, printed * 1.5)]
