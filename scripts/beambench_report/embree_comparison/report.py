"""Writes the targets and the measured ratios as Markdown with plots."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from beambench.analysis import Ratio
from beambench_report.base.figure import house_style, write_plot
from beambench_report.base.files import Problem, write_text
from beambench_report.base.quantities import markdown_table, number
from beambench_report.base.records import read_run
from beambench_report.embree_comparison.pairings import Pairing, headlines, pairings
from beambench_report.embree_comparison.plots import plots
from beambench_report.embree_comparison.results import (
    GroupResults,
    Result,
    outcomes_in_words,
    results,
)
from beambench_report.embree_comparison.targets import part_of_targets

_COMPARED = (
    "`tile-beam` is a frustum rasterizer: it draws what one point sees, and is compared with "
    "Embree, a general ray tracer, on their common task. A ratio is the time of the fastest Embree "
    "mode with correct hits divided by the time of `tile-beam` for the same rays, in one run, on "
    "one thread, with the hits written to the same kind of buffer. Shadow rays and rays from "
    "mirrors are lists in which the rays of a light or a mirror are marked as a pencil; both "
    "contenders trace the same list."
)
_CULLED = (
    "**Backs of solids.** `tile-beam` can find out during the build which triangles form solids, "
    "and skip their backs, which are invisible from outside. Embree has no information on closed "
    "surfaces, so the comparison uses `backface_culling=false` wherever that was measured. A ratio "
    "marked `backs left out` was measured with `backface_culling=true` only: it can miss a target, "
    "but not meet it. In the last table, a row whose first ratio is empty has only such figures."
)
_TRACES = (
    "**Which trace.** The ratios in the tables, and the targets, are for the first trace after a "
    "build. The last table also has the ratios for a second trace of the same structure, and the "
    "tables of groups have the geometric means of these ratios. No ratio includes the build; build "
    "times are in the last table."
)
_PAIRED = (
    "The contenders take turns, and ratios compare their times in the same block or, in records of "
    "one process, in the same round (paired). "
)
_NOT_PAIRED = (
    "The individual repetitions of these runs are missing, so each interval combines the intervals "
    "of both times (not paired); it is usually wider than a paired interval. "
)
_SOME_PAIRED = (
    "If a run has its individual repetitions, ratios compare the two times in the same block or "
    "round; otherwise they compare the medians. "
)
_DECIDED = (
    "Each ratio is followed by its target. The target is `met` or `missed` if the whole interval "
    "lies on one side of it; otherwise, or without an interval, it is `open`. A geometric mean has "
    "an interval if the ratio of each scene has one, and a target if each scene was measured."
)


def comparison(runs: Sequence[Path], file: Path | None = None) -> list[Path] | str:
    """Writes the report on some runs to FILE.md, with plots, and returns these files.

    Without `file`, it returns the text of the report. Raises Problem if a run cannot be read, or if
    no run has both contenders.
    """
    found = pairings(read_run(run) for run in runs)
    if not found:
        names = ", ".join(str(run) for run in runs)
        raise Problem(
            f"{names}: no rays have correct hits by both tile-beam and embree; measure "
            "harness/measure/sweeps/beat-embree.json"
        )
    if file is None:
        return as_markdown(found)
    with house_style():
        drawn = plots(found)
        figures = [path for plot in drawn for path in write_plot(plot, file.parent)]
    return [write_text(file, as_markdown(found, [f"{plot.stem}.png" for plot in drawn])), *figures]


def as_markdown(found: Sequence[Pairing], plots: Sequence[str] = ()) -> str:
    """Returns the report; `plots` are the files of its figures."""
    paired = [one.ratio.paired for one in found]
    how = _PAIRED if all(paired) else _SOME_PAIRED if any(paired) else _NOT_PAIRED
    intervals = (
        f"**Intervals.** In parentheses: the 95% confidence interval of the ratio. {how}{_DECIDED}"
    )
    lines = ["# Tile beams against Embree: a frustum rasterizer beside a general ray tracer", ""]
    culled = [_CULLED] if any(one.is_culled for one in found) else []
    shown = (f"![{plot}]({plot})" for plot in plots)
    for text in (_COMPARED, _advantages(found), *culled, _TRACES, intervals, *shown):
        lines += [text, ""]
    lines += [*(f"- {origin}" for origin in dict.fromkeys(one.origin for one in found)), ""]
    for isa in dict.fromkeys(one.isa for one in found if one.samples == 1):
        lines += [*_of_isa(isa, found), ""]
    return "\n".join([*lines, *_every(found), "", ""])


def _advantages(found: Sequence[Pairing]) -> str:
    """Returns which side has SIMD, tuned parameters and sorted rays, and omits backs of solids."""
    simd = {bool(trace.isa) for one in found for trace in (one.tile, one.embree)}
    modes = [mode for one in found for mode in one.modes]
    most = max(len(one.modes) for one in found)
    tuned = f"the fastest of up to {most} mode{'s' * (most > 1)} by the times below"
    if all("best of" in mode for mode in modes):
        tuned = "by its times from another camera"
    is_sorted = any("sorted rays" in mode for mode in modes)
    has_backs = all(not one.is_culled for one in headlines(found))
    return (
        f"**What each side has.** SIMD: {'both' if simd == {True} else 'see the sections'}. Tuned "
        f"parameters: Embree, {tuned}; `tile-beam` has its defaults. Sorted rays: "
        f"{'both, where sorting is faster' if is_sorted else 'neither'}. Omitted backs of solids: "
        f"{'neither' if has_backs else '`tile-beam`, where a table states it'}."
    )


def _of_isa(isa: str, found: Sequence[Pairing]) -> Iterable[str]:
    part = part_of_targets(isa)
    limited = "" if isa == "best" else f" (isa={isa}: {part:g} of the targets)"
    sets = dict.fromkeys(
        _instruction_sets(one.tile.isa, one.embree.isa)
        for one in found
        if one.isa == isa and one.samples == 1
    )
    every = results(found, isa)
    yield from (
        f"## {', '.join(sets)}{limited}",
        "",
        f"Targets by first traces: {outcomes_in_words(every)}.",
    )
    for one in every:
        note = [one.group.note, ""] if one.group.note else []
        yield from ("", f"### {one.group.title}", "", *note, *_table(one))


def _instruction_sets(tile: str, embree: str) -> str:
    """Returns both instruction sets by Embree's names: Highway calls AVX-512 AVX3."""
    ours, theirs = (
        "AVX-512" if name.startswith(("AVX3", "AVX512")) else name or "?" for name in (tile, embree)
    )
    return f"Both on {ours}" if ours == theirs else f"tile-beam on {ours}, Embree on {theirs}"


def _table(one: GroupResults) -> list[str]:
    rows = [
        *one.scenes.items(),
        ("**geometric mean, first traces**", one.means),
        ("geometric mean, second traces", one.second),
        ("geometric mean, backs left out", one.culled),
    ]
    scenes = len(one.group.scenes)
    lines = [
        [title, *(_cell(own[size], scenes) if size in own else "" for size in one.sizes)]
        for title, own in rows
        if own
    ]
    return markdown_table(["scene", *one.sizes], lines, range(1, len(one.sizes) + 1))


def _cell(one: Result, scenes: int) -> str:
    parts = [_text(one.ratio, one.target)]
    if one.target is not None:
        parts.append(f"target {one.target:g}: {one.outcome}")
    if one.is_culled:
        parts.append("backs left out")
    if 1 < one.scenes < scenes:
        parts.append(f"of {one.scenes} scenes")
    return ", ".join(parts)


def _every(found: Sequence[Pairing]) -> list[str]:
    heads = (
        "rays, scene, resolution, samples, primitives, limited to, fastest mode, Embree ms, "
        "tile-beam ms, ratio, ratio of second traces, ratio with the backs left out, "
        "Embree's build ms, tile-beam's build ms"
    ).split(", ")
    culled = {one.image: one.ratio for one in found if one.is_culled}
    rows = (
        (
            one.kind,
            f"`{one.scene}`",
            one.resolution,
            f"{one.samples}",
            f"{one.primitives:,}",
            one.isa,
            one.embree.contender,
            number(one.embree.first.value),
            number(one.tile.first.value),
            "" if one.is_culled else _text(one.ratio),
            "" if one.second_ratio is None else _text(one.second_ratio),
            _text(culled[one.image]) if one.image in culled else "",
            number(one.embree.build),
            number(one.tile.build),
        )
        for one in headlines(found)
    )
    return ["## All rays", "", *markdown_table(heads, rows, (3, 4, *range(7, 14)))]


def _text(ratio: Ratio, target: float | None = None) -> str:
    if ratio.interval is None:
        return _beside(ratio.value, target)
    low, high = (_beside(end, target) for end in ratio.interval)
    return f"{_beside(ratio.value, target)} ({low} to {high})"


def _beside(value: float, target: float | None) -> str:
    """Formats with three digits, or with enough to show on which side of the target the value is.

    With a target of 2.5, 2.504 has four digits.
    """
    text = number(value)
    digits = 3
    while target is not None and digits < 9 and float(text.replace(",", "")) == target != value:
        digits += 1
        text = f"{value:.{digits}g}"
    return text
