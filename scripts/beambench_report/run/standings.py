"""Who is fastest: in each view, by how much, and over all views of one kind of rays.

Fastest is the contender with correct hits whose first trace after a build has the least median
time. Its ratio to each of the others is paired, round by round, where the repetitions are at hand
(`base.ratio`); one whose interval holds 1 is tied with it. The build is what that trace costs
beforehand: the break-even ray count is the number of rays from which the fastest, build included,
is ahead of every contender that is not tied with it.

`null` finds nothing and `exhaustive` tests everything: they are references, not contenders.
`harness/measure/standings.cpp` prints the same at the end of a run; a test compares the two.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite

import pandas as pd

from beambench_report.base.cell_files import CellFile, Identity, identity, ratio_of
from beambench_report.base.ratio import Ratio, geometric_mean
from beambench_report.base.records import REFERENCES, Run, size_of
from beambench_report.run.break_even import AT_ONCE, break_even_rays

EMBREE = "embree"
_UNRECORDED = "not in the record"


@dataclass(frozen=True)
class Standing:
    """One contender in one view."""

    contender: str
    structure: str
    ns_per_ray: float
    build_ms: float
    ratio: Ratio
    """Its trace time over that of the fastest."""

    @property
    def mrays_per_s(self) -> float:
        """Millions of rays per second."""
        return 1e3 / self.ns_per_ray

    @property
    def is_tied(self) -> bool:
        """Is it the fastest, or does the interval of its ratio to the fastest hold 1?"""
        return self.ratio.low is not None and self.ratio.low <= 1


@dataclass(frozen=True)
class Standings:
    """The contenders of one view at its highest resolution."""

    view: str
    subject: str
    """The view, whichever machine measured it."""
    ray_kind: str
    size: str
    rays: int
    ranked: tuple[Standing, ...]
    """The fastest first; empty where no contender's hits were correct."""
    references: tuple[Standing, ...]
    left_out: tuple[tuple[str, str], ...]
    """Contenders of the run without a time here, each with the reason."""

    @property
    def unrecorded(self) -> int:
        """How many contenders have no row here, and no condition of the sweep leaves them out."""
        return sum(reason == _UNRECORDED for _, reason in self.left_out)

    @property
    def fastest(self) -> Standing | None:
        """That of the least median; `tied` has those that may be as fast."""
        return self.ranked[0] if self.ranked else None

    @property
    def tied(self) -> tuple[Standing, ...]:
        """Those whose interval does not rule out that they are as fast."""
        return tuple(one for one in self.ranked[1:] if one.is_tied)

    @property
    def behind(self) -> Standing | None:
        """The first that is not tied with the fastest."""
        return next((one for one in self.ranked if not one.is_tied), None)

    @property
    def embree(self) -> Standing | None:
        """Embree's fastest mode."""
        return next((one for one in self.ranked if one.structure == EMBREE), None)

    @property
    def break_even_rays(self) -> float | None:
        """From how many rays on the fastest is ahead of all that are not tied, build included.

        0: from the first; infinite: never, by the medians; None: there is nobody to compare with.
        """
        last = self.last_overtaken
        return None if last is None else _break_even(self.ranked[0], last)

    @property
    def last_overtaken(self) -> Standing | None:
        """The contender over which `break_even_rays` is."""
        others = [one for one in self.ranked if not one.is_tied]
        return max(others, key=lambda other: _break_even(self.ranked[0], other), default=None)

    def trace_ms(self, one: Standing) -> float:
        """The median time of one trace."""
        return 1e-6 * one.ns_per_ray * self.rays


@dataclass(frozen=True)
class Mean:
    """A contender over all views of one kind of rays."""

    contender: str
    structure: str
    ratio: Ratio
    """Geometric mean of its ratios to the fastest of each view."""
    views: int
    wins: int
    """Views in which it is the fastest or tied with it."""


@dataclass(frozen=True)
class Overall:
    """All contenders over all views of one kind of rays."""

    ray_kind: str
    views: int
    means: tuple[Mean, ...]
    """Those with times in every view, the fastest first; then the others."""
    references: tuple[Mean, ...]


def standings(
    run: Run, files: Mapping[Identity, CellFile], exclusions: Sequence[Mapping[str, object]] = ()
) -> list[Standings]:
    """Of each view, in the order of the file; `exclusions` are those of the sweep."""
    return [_of_view(run, view, files, exclusions) for view in run.views]


def overall(every: Sequence[Standings]) -> list[Overall]:
    """Of each kind of rays, in the order of the views."""
    found = counted(every)
    kinds = dict.fromkeys(one.ray_kind for one in found)
    return [_of_kind(kind, [one for one in found if one.ray_kind == kind]) for kind in kinds]


def counted(every: Sequence[Standings]) -> list[Standings]:
    """Those that means are over: those with times.

    Of a view that several machines measured, one at each resolution, the highest.
    """
    most: dict[str, int] = {}
    for one in every:
        if one.ranked:
            most[one.subject] = max(one.rays, most.get(one.subject, 0))
    return [one for one in every if one.ranked and one.rays == most[one.subject]]


def without_times(every: Sequence[Standings]) -> list[str]:
    """The contenders and references that no view has a time of, in the order of the record."""
    timed = {one.contender for view in every for one in (*view.ranked, *view.references)}
    names = dict.fromkeys(name for view in every for name, _ in view.left_out)
    return [name for name in names if name not in timed]


def ratios_are_paired(every: Sequence[Standings]) -> bool:
    """Was any ratio to the fastest made round by round?"""
    return any(other.ratio.paired for one in every for other in one.ranked[1:])


def ties_are_known(every: Sequence[Standings]) -> bool:
    """Has any ratio an interval, where there are ratios?"""
    ratios = [other.ratio for one in every for other in one.ranked[1:]]
    return not ratios or any(ratio.interval for ratio in ratios)


def _of_view(
    run: Run,
    view: str,
    files: Mapping[Identity, CellFile],
    exclusions: Sequence[Mapping[str, object]],
) -> Standings:
    rows = run.finest(view).drop_duplicates("contender", keep="last")
    timed = rows[rows["timed"] & (rows["trace_ms_median"] > 0)]
    timed = timed.sort_values("trace_ms_median", kind="stable")
    is_reference = timed["structure"].isin(REFERENCES)
    contenders = timed[~is_reference & (timed["verdict"] == "ok")]
    base = contenders.iloc[0] if len(contenders) else None
    first = rows.iloc[0]

    def stand(chosen: pd.DataFrame) -> tuple[Standing, ...]:
        return tuple(_standing(row, base, files) for _, row in chosen.iterrows())

    return Standings(
        view,
        first["subject"],
        first["ray_kind"],
        size_of(first),
        int(first["rays"]),
        stand(contenders),
        stand(timed[is_reference]) if base is not None else (),
        tuple(_left_out(run, rows, set(timed["contender"]), files, exclusions)),
    )


def _standing(row: pd.Series, base: pd.Series, files: Mapping[Identity, CellFile]) -> Standing:
    return Standing(
        row["contender"],
        row["structure"],
        1e6 * row["trace_ms_median"] / row["rays"],
        row["build_ms_median"],
        trace_ratio(row, base, files),
    )


def trace_ratio(row: pd.Series, base: pd.Series, files: Mapping[Identity, CellFile]) -> Ratio:
    """The trace time of a row over that of another; paired where the repetitions are at hand."""
    if row["contender"] == base["contender"]:
        return Ratio(1.0, 1.0, 1.0, paired=True)
    return ratio_of("trace", row, base, files)


def _break_even(mine: Standing, other: Standing) -> float:
    """In rays. Nobody traces faster than `mine`: once ahead, it stays ahead."""
    rays, words = break_even_rays(
        1e6 * mine.build_ms, mine.ns_per_ray, 1e6 * other.build_ms, other.ns_per_ray
    )
    if rays is None:
        return 0.0 if words == AT_ONCE else inf
    return rays


def _left_out(
    run: Run,
    rows: pd.DataFrame,
    timed: set[str],
    files: Mapping[Identity, CellFile],
    exclusions: Sequence[Mapping[str, object]],
) -> list[tuple[str, str]]:
    present = {row["contender"]: row for _, row in rows.iterrows()}
    first = rows.iloc[0]
    structures = dict(zip(run.rows["contender"], run.rows["structure"], strict=True))
    return [
        (
            contender,
            _why_untimed(present[contender], files)
            if contender in present
            else _why_absent(structure, first, exclusions),
        )
        for contender, structure in structures.items()
        if contender not in timed
    ]


def _why_untimed(row: pd.Series, files: Mapping[Identity, CellFile]) -> str:
    file = files.get(identity(row))
    verdict = row["verdict"] or "no verdict"
    return f"{verdict}: {file.message}" if file and file.message else verdict


def _why_absent(structure: str, row: pd.Series, exclusions: Sequence[Mapping[str, object]]) -> str:
    """The condition of the sweep that leaves it out; without one, the record only lacks it."""
    for entry in exclusions:
        if (
            entry.get("structure", structure) == structure
            and entry.get("scene", row["scene"]) == row["scene"]
            and row["primitives"] > entry.get("primitives_above", -inf)
            and row["rays"] > entry.get("rays_above", -inf)
        ):
            limits = [
                f"more than {entry[limit]:,} {limit.removesuffix('_above')}"
                for limit in ("primitives_above", "rays_above")
                if limit in entry
            ]
            return f"left out by the sweep ({' and '.join(limits) or 'this scene'})"
    return _UNRECORDED


def _of_kind(kind: str, every: Sequence[Standings]) -> Overall:
    def means(lists: Sequence[tuple[Standing, ...]]) -> tuple[Mean, ...]:
        ratios: dict[str, list[Standing]] = {}
        for one in (standing for ranked in lists for standing in ranked):
            ratios.setdefault(one.contender, []).append(one)
        found = [
            Mean(
                contender,
                own[0].structure,
                geometric_mean([one.ratio for one in own]),
                len(own),
                sum(one.is_tied for one in own),
            )
            for contender, own in ratios.items()
        ]
        return tuple(sorted(found, key=lambda mean: (-mean.views, mean.ratio.value)))

    return Overall(
        kind,
        len(every),
        means([one.ranked for one in every]),
        means([one.references for one in every]),
    )


def in_words(rays: float | None) -> str:
    """A break-even ray count as tables show it."""
    if rays is None:
        return ""
    if rays <= 0:
        return "the first ray"
    if not isfinite(rays):
        return "never"
    for limit, unit in ((1e3, ""), (1e6, " k"), (1e9, " M")):
        if rays < limit:
            return f"{rays * 1e3 / limit:.3g}{unit} rays"
    return f"{rays / 1e9:.3g} G rays"
