"""The conclusions from a run: which contenders are fastest, and how far times can be trusted.

harness/analysis draws them. They are read from analysis.json; if the run was cut off before that
file was written, the log is analyzed instead.
"""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import Any, TypeVar

from beambench import InputError
from beambench.analysis import Ratio, analyze
from beambench_report.base.files import Problem, read_json
from beambench_report.base.records import Run, in_blocks
from beambench_report.base.run_log import has_log

ANALYSIS = "analysis.json"
_EMBREE = "embree"
_Json = Mapping[str, Any]
_Kind = TypeVar("_Kind")


@dataclass(frozen=True)
class Standing:
    """One contender in one view."""

    contender: str
    structure: str
    build_ms: float
    ns_per_ray: float
    ratio: Ratio
    """The contender's trace time over that of the fastest."""
    rank: str
    """"tied" with the fastest, clearly "behind" it, "undecided", or "unranked"."""
    variant: str = ""
    """For a tuned contender, the parameters that represent it: `embree:mode=stream`."""
    isa: str = ""
    """The instruction set of the contender's SIMD code; empty without such code."""

    @property
    def name(self) -> str:
        """The contender's name; with its parameters if it is tuned."""
        note = self.contender.removeprefix(self.structure)
        return f"{self.variant}{note}" if self.variant else self.contender

    @property
    def is_tied(self) -> bool:
        """Whether the contender is the fastest, or equivalent to the fastest."""
        return self.rank == "tied"

    @property
    def mrays_per_s(self) -> float:
        """Returns millions of rays per second."""
        return 1e3 / self.ns_per_ray


@dataclass(frozen=True)
class BreakEven:
    """The ray count from which the fastest beats all not tied with it, build included."""

    rays: float
    """The ray count: 0 if from the first ray, infinite if never, according to the medians."""
    over: str
    """The last contender that the fastest overtakes."""
    in_words: str


@dataclass(frozen=True)
class Standings:
    """The contenders of one view at its highest resolution."""

    view: str
    subject: str
    """The view without the machine that measured it."""
    ray_kind: str
    size: str
    rays: int
    ranked: tuple[Standing, ...]
    """The contenders, the fastest first; empty if none had correct hits."""
    references: tuple[Standing, ...]
    left_out: tuple[tuple[str, str], ...]
    """The contenders of the run that have no time in this view, each with the reason."""
    unrecorded: int
    """The number of contenders that are in the sweep for this view but have no row."""
    in_means: bool
    """Whether the means include this view."""
    clock: str
    """The clock of the compared times: "wall", or "cpu" if too many traces were disturbed."""
    break_even: BreakEven | None
    """The break-even point; None if there is no other contender."""

    @property
    def fastest(self) -> Standing | None:
        """Returns the contender with the least time; the contenders in `tied` may be as fast."""
        return self.ranked[0] if self.ranked else None

    @property
    def tied(self) -> tuple[Standing, ...]:
        """Returns the other contenders that may be as fast as the fastest."""
        return tuple(one for one in self.ranked[1:] if one.is_tied)

    @property
    def undecided(self) -> tuple[Standing, ...]:
        """Returns the contenders that may be as fast as the fastest, or slower."""
        return tuple(one for one in self.ranked[1:] if one.rank == "undecided")

    @property
    def behind(self) -> Standing | None:
        """Returns the first contender that is clearly slower than the fastest."""
        return next((one for one in self.ranked if one.rank == "behind"), None)

    @property
    def embree(self) -> Standing | None:
        """Returns Embree's fastest mode."""
        return next((one for one in self.ranked if one.structure == _EMBREE), None)

    def trace_ms(self, one: Standing) -> float:
        """Returns the median time of one trace."""
        return 1e-6 * one.ns_per_ray * self.rays


@dataclass(frozen=True)
class Mean:
    """The mean of a contender over all views with one kind of rays."""

    contender: str
    structure: str
    ratio: Ratio
    """The geometric mean of the contender's ratios to the fastest of each view."""
    views: int
    wins: int
    """The number of views in which the contender is the fastest or tied with the fastest."""
    scatter_low: float | None = None
    scatter_high: float | None = None
    """The 95% confidence interval of the mean, from the scatter between the views."""


@dataclass(frozen=True)
class Overall:
    """The means of all contenders over all views with one kind of rays."""

    ray_kind: str
    views: int
    means: tuple[Mean, ...]
    """The contenders with times in every view, the fastest first; then the others."""
    references: tuple[Mean, ...]

    @property
    def largest_ratio(self) -> float:
        """Returns the largest mean ratio of all contenders and references, the end of the bars."""
        return max(mean.ratio.value for mean in (*self.means, *self.references))


@dataclass(frozen=True)
class Steadiness:
    """A comparison of the late blocks of a run with its early blocks."""

    shift: float
    """The difference of the logarithms of times: 0.03 if late blocks took 3% longer."""
    limit: float
    """The largest difference that chance explains."""

    @property
    def is_steady(self) -> bool:
        """Whether the machine was as fast late in the run as early in it."""
        return abs(self.shift) <= self.limit


@dataclass(frozen=True)
class Overhead:
    """The cell of one query path in which the harness has the largest share of the trace time."""

    query_path: str
    cell: str
    title: str
    """The cell, as plots and pages name it."""
    part: float


@dataclass(frozen=True)
class FrameCost:
    """The cost of a structure in one frame."""

    ready_ms: float
    """The time of the build or of the update."""
    trace_ms: float
    sah_cost: float | None

    @property
    def total_ms(self) -> float:
        """Returns the time of the whole frame."""
        return self.ready_ms + self.trace_ms


@dataclass(frozen=True)
class FrameComparison:
    """A structure in one frame, updated from the first frame and built anew."""

    frame: int
    updated: FrameCost
    built: FrameCost
    total_ratio: Ratio
    """The time of the updated structure over that of the new one, paired within blocks."""
    trace_ratio: Ratio


@dataclass(frozen=True)
class FrameSeries:
    """A structure with the same rays over the frames of a scene."""

    contender: str
    """The structure with its parameters except `update`: `embree:robust=false`."""
    subject: str
    """Scene, camera, resolution, samples and rays: `waving-sheet/default/320x240/1/primary`."""
    frames: tuple[FrameComparison, ...]
    """The frames in ascending order."""
    rebuild_after: int | None
    """The number of frames between builds with the least mean time; None: a second build never
    pays.
    """
    mean_ms: float
    """The mean frame time if the structure is rebuilt after that many frames."""


@dataclass(frozen=True)
class Analysis:
    """The conclusions from a run."""

    cells: int
    failed: int
    """The number of cells with wrong hits or with a structure that could not be built."""
    without_rays: int
    unsupported: int
    """The number of cells whose rays or primitives the structure does not support."""
    reasons_for_care: tuple[str, ...]
    """Reasons to distrust the times, as clauses; an unsteady machine comes first."""
    steadiness: Steadiness | None
    """The test of steadiness; None if there are too few blocks."""
    views: tuple[Standings, ...]
    means: tuple[Overall, ...]
    """The means for each kind of rays."""
    overheads: tuple[Overhead, ...]
    """The largest share of the harness for each query path, in descending order."""
    block_totals: Mapping[str, Mapping[int, float]]
    """The time of build and trace by cell name and block; empty in records of one process."""
    frame_series: tuple[FrameSeries, ...] = ()
    """The structures measured both updated and built anew, for each moving scene."""

    @property
    def right(self) -> int:
        """Counts the cells with correct hits."""
        return self.cells - self.failed - self.without_rays - self.unsupported

    @property
    def by_view(self) -> dict[str, Standings]:
        """The views by their titles."""
        return {one.view: one for one in self.views}

    @property
    def without_times(self) -> list[str]:
        """Returns contenders and references without a time in any view, in the order of the run."""
        timed = {one.contender for view in self.views for one in (*view.ranked, *view.references)}
        names = dict.fromkeys(name for view in self.views for name, _ in view.left_out)
        return [name for name in names if name not in timed]

    @property
    def ratios_are_paired(self) -> bool:
        """Whether any ratio to the fastest was paired round by round."""
        return any(ratio.paired for ratio in self._ratios)

    @property
    def is_unsteady(self) -> bool:
        """Whether late blocks were faster or slower than early blocks, beyond chance."""
        return self.steadiness is not None and not self.steadiness.is_steady

    @property
    def has_blocks(self) -> bool:
        """Whether ratios come from blocks; if so, contenders are ranked by equivalence."""
        return any(ratio.predicted_low is not None for ratio in self._ratios)

    @property
    def ties_are_known(self) -> bool:
        """Whether some ratio has an interval, or there are no ratios."""
        return not self._ratios or any(ratio.interval for ratio in self._ratios)

    @property
    def _ratios(self) -> list[Ratio]:
        return [other.ratio for one in self.views for other in one.ranked[1:]]


def has_analysis(directory: Path) -> bool:
    """Returns whether conclusions can be drawn from a run in this folder."""
    return (directory / ANALYSIS).is_file() or has_log(directory)


def block_totals(run: Run) -> Mapping[str, Mapping[int, float]]:
    """Reads the total build and trace time per cell name and block.

    Returns {} for a run without blocks or without an analysis.
    """
    known = in_blocks(run.rows) and has_analysis(run.directory)
    return read_analysis(run.directory).block_totals if known else {}


def read_analysis(directory: Path) -> Analysis:
    """Reads DIRECTORY/analysis.json; without one, analyzes the log of the run.

    Raises Problem if there is neither, or if it cannot be read.
    """
    path = directory / ANALYSIS
    source = read_json(path)
    if source is None:
        if not has_log(directory):
            raise Problem(
                f"{directory}: holds neither {ANALYSIS} nor the log of a run; give the folder that "
                "`beambench run` wrote"
            )
        try:
            source = analyze(directory)
        except InputError as error:
            raise Problem(str(error)) from None
    try:
        return _analysis(source)
    except (KeyError, TypeError, AttributeError) as error:
        raise Problem(
            f"{path}: not an analysis by this version ({type(error).__name__}: {error}); "
            f"write it again: beambench analyze --write {os.fspath(directory)}"
        ) from None


def _analysis(source: _Json) -> Analysis:
    counts = ("cells", "failed", "without_rays", "unsupported")
    return Analysis(
        *(source[name] for name in counts),
        tuple(source["reasons_for_care"]),
        Steadiness(**steadiness) if (steadiness := source.get("steadiness")) else None,
        tuple(_view(view) for view in source["views"]),
        tuple(
            Overall(
                *(one["ray_kind"], one["views"]),
                *(_with_ratios(Mean, one[name]) for name in ("means", "references")),
            )
            for one in source["means"]
        ),
        tuple(Overhead(**one) for one in source["harness_overheads"]),
        {
            one["cell"]: {int(block): ms for block, ms in one["total_ms"].items()}
            for one in source.get("block_totals", ())
        },
        tuple(_frame_series(one) for one in source.get("frame_series", ())),
    )


def _frame_series(source: _Json) -> FrameSeries:
    frames = tuple(
        FrameComparison(
            one["frame"],
            *(FrameCost(**one[name]) for name in ("updated", "built")),
            *(Ratio(**one[name]) for name in ("total_ratio", "trace_ratio")),
        )
        for one in source["frames"]
    )
    return FrameSeries(**{**source, "frames": frames})


def _view(source: _Json) -> Standings:
    break_even = source.get("break_even")
    return Standings(
        **{name: source[name] for name in ("view", "subject", "ray_kind", "size", "rays", "clock")},
        **{name: source[name] for name in ("unrecorded", "in_means")},
        ranked=_with_ratios(Standing, source["ranked"]),
        references=_with_ratios(Standing, source["references"]),
        left_out=tuple((one["contender"], one["reason"]) for one in source["left_out"]),
        break_even=break_even
        and BreakEven(
            inf if break_even["rays"] is None else break_even["rays"],
            break_even["over"],
            break_even["in_words"],
        ),
    )


def _with_ratios(kind: type[_Kind], source: Sequence[_Json]) -> tuple[_Kind, ...]:
    return tuple(kind(**{**one, "ratio": Ratio(**one["ratio"])}) for one in source)
