"""The targets and what was measured, as Markdown with plots."""

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from beambench.analysis import Ratio, geometric_mean
from beambench_report.base.figure import house_style, write_plot
from beambench_report.base.files import Problem, write_text
from beambench_report.base.quantities import markdown_table, number
from beambench_report.base.records import read_run
from beambench_report.embree_comparison.pairings import Pairing, pairings
from beambench_report.embree_comparison.plots import plots
from beambench_report.embree_comparison.targets import Group, groups, part_of_targets

_COMPARED = (
    "`tile-beam` is a frustum rasterizer: it draws what one point sees, and is compared with "
    "Embree, a general ray tracer, on the one thing that both do. A ratio is the time in which "
    "the fastest Embree mode with correct hits traces some rays over the time of `tile-beam`, both "
    "in one run, on one thread, both writing their answers into the same kind of buffer, by the "
    "same rays. Shadow rays and rays from mirrors are lists in which those of a light or a mirror "
    "are marked as a pencil; both get the same list. The fastest mode is the one of the smallest "
    "median."
)
_CLOSED = (
    "**Closedness.** While it builds, `tile-beam` proves of which triangles solids are made, and "
    "leaves out their backs, which no eye outside can see. This uses that they are closed, which "
    "Embree is not given. Ratios without it (`backface_culling=false`), of the same run, stand "
    "below each geometric mean and in the last table; the targets hold for the default."
)
_TRACES = (
    "**Which trace.** The ratios in the tables, and the targets, are of the first trace after a "
    "build. Those of a second trace of the same structure are in the last table, and their "
    "geometric mean is below each of the others. Building is in neither; its times are in the last "
    "table."
)
_PAIRED = (
    "The contenders take turns, and the ratio is the median over rounds of the ratio of the two "
    "times in one round (paired). "
)
_NOT_PAIRED = (
    "The single repetitions of these runs are not here, so the intervals are made of those of both "
    "medians (not paired), as a rule wider than paired ones. "
)
_SOME_PAIRED = (
    "Where a run has its single repetitions, the ratio is the median over rounds of the ratio of "
    "the two times in one round; otherwise it is of the medians, marked `not paired`. "
)
_DECIDED = (
    "A target is `met` or `missed` when the whole interval lies on one side of it, otherwise "
    "`open`; without an interval, which takes six repetitions of both, it is `open`. A geometric "
    "mean has an interval, and is compared with its target, where each of its scenes has one."
)


def comparison(runs: Sequence[Path], file: Path | None = None) -> list[Path] | str:
    """The report on some runs: its text, or the files written, FILE.md and plots beside it.

    Raises Problem where a run cannot be read, or none has both contenders.
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
    """The report; `plots` are the files of its figures."""
    paired = [one.ratio.paired for one in found]
    how = _PAIRED if all(paired) else _SOME_PAIRED if any(paired) else _NOT_PAIRED
    intervals = f"**Intervals.** In brackets: the 95% interval of the ratio. {how}{_DECIDED}"
    lines = ["# Tile beams against Embree: a frustum rasterizer beside a general ray tracer", ""]
    closed = [_CLOSED] if any(one.unculled_ratio for one in found) else []
    for text in (_COMPARED, *closed, _TRACES, intervals, *(f"![{plot}]({plot})" for plot in plots)):
        lines += [text, ""]
    lines += [*(f"- {origin}" for origin in dict.fromkeys(one.origin for one in found)), ""]
    single = [one for one in found if one.samples == 1]
    for isa in dict.fromkeys(one.isa for one in single):
        lines += [*_of_isa(isa, [one for one in single if one.isa == isa]), ""]
    return "\n".join([*lines, *_every(found), "", ""])


def outcome(ratio: Ratio, target: float) -> str:
    """`met`, `missed`, or `open` where the interval holds the target or there is none."""
    if ratio.interval is None:
        return "open"
    low, high = ratio.interval
    if low >= target:
        return "met"
    return "open" if high >= target else "missed"


def _of_isa(isa: str, found: Sequence[Pairing]) -> Iterable[str]:
    part = part_of_targets(isa)
    limited = "" if isa == "best" else f" (isa={isa}: {part:g} of the targets)"
    sets = dict.fromkeys(_instruction_sets(one.tile.isa, one.embree.isa) for one in found)
    yield from (f"## {', '.join(sets)}{limited}", "", _summary(found, part))
    for group in groups():
        if table := _group_table(group, found, part):
            note = [group.note, ""] if group.note else []
            yield from ("", f"### {group.title}", "", *note, *table)


def _instruction_sets(tile: str, embree: str) -> str:
    """Highway calls AVX-512 AVX3, Embree AVX512."""
    ours, theirs = (
        "AVX-512" if name.startswith(("AVX3", "AVX512")) else name or "?" for name in (tile, embree)
    )
    return f"Both on {ours}" if ours == theirs else f"tile-beam on {ours}, Embree on {theirs}"


def outcomes(found: Sequence[Pairing], part: float) -> Counter[str]:
    """Counts the outcomes of the targets of single scenes; `part` of each target holds."""
    return Counter(
        outcome(one.ratio, part * group.targets[one.resolution])
        for group in groups()
        for one in found
        if group.holds(one)
    )


def _summary(found: Sequence[Pairing], part: float) -> str:
    counts = outcomes(found, part)
    return (
        f"Of {counts.total()} targets for single scenes, {counts['met']} are met, "
        f"{counts['open']} open, {counts['missed']} missed, by first traces."
    )


def _group_table(group: Group, found: Sequence[Pairing], part: float) -> list[str]:
    at = {(one.scene, one.resolution): one for one in found if group.holds(one)}
    sizes = [size for size in group.targets if any(size == there for _, there in at)]
    if not sizes:
        return []
    lines = [
        [title, *(_cell(at.get((scene, size)), part * group.targets[size]) for size in sizes)]
        for scene, title in group.scenes.items()
        if any((scene, size) in at for size in sizes)
    ]
    lines.append(["*target*", *(f"*at least {part * group.targets[size]:g}*" for size in sizes)])
    if len(group.scenes) > 1:
        targets = {size: part * target for size, target in group.mean_targets.items()}
        first = {size: [one.ratio for key, one in at.items() if key[1] == size] for size in sizes}
        means = (_mean(group, first[size], targets.get(size)) for size in sizes)
        lines.append(["**geometric mean, first traces**", *means])
        if targets:
            lines.append(
                ["*target of the mean*", *(f"*at least {targets[size]:g}*" for size in sizes)]
            )
        of_others = {
            "geometric mean, second traces": [one.second_ratio for one in at.values()],
            "geometric mean, backs of solids drawn": [one.unculled_ratio for one in at.values()],
        }
        for title, ratios in of_others.items():
            if any(ratios):
                of_size = (
                    [ratio for (_, there), ratio in zip(at, ratios, strict=True) if there == size]
                    for size in sizes
                )
                means = (_mean(group, [one for one in own if one], None) for own in of_size)
                lines.append([title, *means])
    return markdown_table(["scene", *sizes], lines, range(1, len(sizes) + 1))


def _cell(one: Pairing | None, target: float) -> str:
    return "" if one is None else f"{_text(one.ratio, target)} {outcome(one.ratio, target)}"


def _mean(group: Group, ratios: Sequence[Ratio], target: float | None) -> str:
    """A mean of some scenes only is not compared with the target."""
    if not ratios:
        return ""
    mean = geometric_mean(ratios)
    if len(ratios) < len(group.scenes):
        return f"{_text(mean)} of {len(ratios)} scenes"
    return _text(mean) if target is None else f"{_text(mean, target)} {outcome(mean, target)}"


def _every(found: Sequence[Pairing]) -> list[str]:
    heads = (
        "rays, scene, resolution, samples, primitives, limited to, fastest mode, Embree ms, "
        "tile-beam ms, ratio, ratio of second traces, ratio with the backs of solids, "
        "Embree's build ms, tile-beam's build ms"
    ).split(", ")
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
            _text(one.ratio),
            "" if one.second_ratio is None else _text(one.second_ratio),
            "" if one.unculled_ratio is None else _text(one.unculled_ratio),
            number(one.embree.build),
            number(one.tile.build),
        )
        for one in found
    )
    return ["## All rays", "", *markdown_table(heads, rows, (3, 4, *range(7, 14)))]


def _text(ratio: Ratio, target: float | None = None) -> str:
    if ratio.interval is None:
        return _beside(ratio.value, target)
    low, high = (_beside(end, target) for end in ratio.interval)
    return f"{_beside(ratio.value, target)} ({low} to {high})"


def _beside(value: float, target: float | None) -> str:
    """Three digits, or enough to show on which side of the target: 2.504 for 2.5, not 2.50."""
    text = number(value)
    digits = 3
    while target is not None and digits < 9 and float(text.replace(",", "")) == target != value:
        digits += 1
        text = f"{value:.{digits}g}"
    return text
