"""The aims beside what was measured, as Markdown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from beambench_report.base.quantities import number
from beambench_report.base.ratio import Ratio, geometric_mean
from beambench_report.embree_comparison.pairings import Duel
from beambench_report.embree_comparison.targets import HELD_TO_LESS, Group, groups

_WORDS = (
    "`tile-beam` is a frustum rasterizer: it draws the image of one eye, and is compared with "
    "Embree, a general ray tracer, on the one thing that both do. A ratio is the time in which "
    "Embree's fastest mode traces an image over the time of `tile-beam`, both in one run, on one "
    "thread, both writing t and id of every sample into the same kind of buffer, by the same rays. "
    "Embree's fastest mode is that of the least median among those whose hits were judged right.",
    "**Which trace.** The ratios in the tables, and the aims, are of the first trace after a "
    "build. Those of a second trace of the same structure are in the last table, and their "
    "geometric mean is below each of the others. Building is in neither; its times are in the last "
    "table.",
    "**Intervals.** In brackets: the 95% interval of the ratio. ",
    "An aim is `met` or `missed` when the whole interval lies on one side of it, otherwise `open`; "
    "without an interval, which takes six repetitions of both, it is `open`. A geometric mean has "
    "an interval, and is judged, where each of its scenes has one.",
)
_PAIRED = (
    "Both took turns, and the ratio is the median over rounds of the ratio of the two times in "
    "one round (paired). "
)
_NOT_PAIRED = (
    "The single repetitions of these runs are not here, so the intervals are made of those of both "
    "medians (not paired), as a rule wider than paired ones. "
)
_SOME_PAIRED = (
    "Where a run has its single repetitions, the ratio is the median over rounds of the ratio of "
    "the two times in one round; else it is of the medians, marked `not paired`. "
)


def as_markdown(found: Sequence[Duel], plots: Sequence[str] = ()) -> str:
    """The report; `plots` are the files of its figures."""
    lines = ["# Tile beams against Embree: a frustum rasterizer beside a general ray tracer", ""]
    paragraph, which, intervals, judging = _WORDS
    for text in (paragraph, which, intervals + _how_paired(found) + judging):
        lines += [text, ""]
    for plot in plots:
        lines += [f"![{plot}]({plot})", ""]
    lines += [*(f"- {origin}" for origin in dict.fromkeys(duel.origin for duel in found)), ""]
    single = [duel for duel in found if duel.samples == 1]
    for isa in dict.fromkeys(duel.isa for duel in single):
        lines += [*_of_isa(isa, [duel for duel in single if duel.isa == isa]), ""]
    lines += [*_every(found), ""]
    return "\n".join(lines)


def judgement(ratio: Ratio, aim: float) -> str:
    """`met`, `missed`, or `open` where the interval holds the aim or there is none."""
    if ratio.interval is None:
        return "open"
    low, high = ratio.interval
    if low >= aim:
        return "met"
    return "open" if high >= aim else "missed"


def part_of_aims(isa: str) -> float:
    """How much of the aims holds on an instruction set that both were held to."""
    return 1.0 if isa == "best" else HELD_TO_LESS


def _how_paired(found: Sequence[Duel]) -> str:
    paired = [duel.ratio.paired for duel in found]
    return _PAIRED if all(paired) else _SOME_PAIRED if any(paired) else _NOT_PAIRED


def _of_isa(isa: str, found: Sequence[Duel]) -> Iterable[str]:
    part = part_of_aims(isa)
    held = "" if isa == "best" else f" (both held to {isa}: {part:g} of the aims)"
    sets = dict.fromkeys(
        f"{duel.tile.isa or '?'} against {duel.embree.isa or '?'}" for duel in found
    )
    yield f"## On {', '.join(sets)}{held}"
    yield ""
    yield _summary(found, part)
    for group in groups():
        table = _group_table(group, found, part)
        if table:
            note = [group.note, ""] if group.note else []
            yield from ("", f"### {group.title}", "", *note, *table)


def _summary(found: Sequence[Duel], part: float) -> str:
    """Each image counts once: a scene is in one group, and `duels` has an image once."""
    judged = Counter(
        judgement(duel.ratio, part * group.aims[duel.resolution])
        for group in groups()
        for duel in found
        if duel.scene in group.scenes and duel.resolution in group.aims
    )
    return (
        f"Of {judged.total()} aims for single scenes, {judged['met']} are met, "
        f"{judged['open']} open, {judged['missed']} missed, by first traces."
    )


def _group_table(group: Group, found: Sequence[Duel], part: float) -> list[str]:
    at = {(duel.scene, duel.resolution): duel for duel in found if duel.scene in group.scenes}
    columns = [size for size in group.aims if any(size == resolution for _, resolution in at)]
    if not columns:
        return []
    lines = [_row(["scene", *columns]), _row(["---", *("---:" for _ in columns)])]
    for scene, title in group.scenes.items():
        if any((scene, size) in at for size in columns):
            texts = [_cell(at.get((scene, size)), part * group.aims[size]) for size in columns]
            lines.append(_row([title, *texts]))
    lines.append(_row(["*aim*", *(f"*at least {part * group.aims[s]:g}*" for s in columns)]))
    if len(group.scenes) == 1:
        return lines
    aims = {size: part * aim for size, aim in group.mean_aims.items()}
    means = [_mean(group, _ratios(at, size), aims.get(size)) for size in columns]
    lines.append(_row(["**geometric mean, first traces**", *means]))
    if aims:
        lines.append(_row(["*aim of the mean*", *(f"*at least {aims[s]:g}*" for s in columns)]))
    means = [_mean(group, _second_ratios(at, size), None) for size in columns]
    lines.append(_row(["geometric mean, second traces", *means]))
    return lines


def _ratios(at: Mapping[tuple[str, str], Duel], size: str) -> list[Ratio]:
    return [duel.ratio for (_, resolution), duel in at.items() if resolution == size]


def _second_ratios(at: Mapping[tuple[str, str], Duel], size: str) -> list[Ratio]:
    seconds = [duel.second_ratio for (_, resolution), duel in at.items() if resolution == size]
    return [ratio for ratio in seconds if ratio is not None]


def _cell(duel: Duel | None, aim: float) -> str:
    return "" if duel is None else f"{_text(duel.ratio, aim)} {judgement(duel.ratio, aim)}"


def _mean(group: Group, ratios: Sequence[Ratio], aim: float | None) -> str:
    """Of some scenes only, it is not judged."""
    if not ratios:
        return ""
    mean = geometric_mean(ratios)
    if len(ratios) < len(group.scenes):
        return f"{_text(mean)} of {len(ratios)} scenes"
    return _text(mean) if aim is None else f"{_text(mean, aim)} {judgement(mean, aim)}"


def _every(found: Sequence[Duel]) -> Iterable[str]:
    yield "## Every image"
    yield ""
    heads = (
        "scene, resolution, samples, primitives, held to, fastest mode, Embree ms, tile-beam ms, "
        "ratio, ratio of second traces, Embree's build ms, tile-beam's build ms"
    ).split(", ")
    yield _row(heads)
    yield _row(["---", "---", "---:", "---:", "---", "---", *(["---:"] * 6)])
    for duel in found:
        second = duel.second_ratio
        yield _row(
            [
                f"`{duel.scene}`",
                duel.resolution,
                f"{duel.samples}",
                f"{duel.primitives:,}",
                duel.isa,
                duel.embree.contender,
                number(duel.embree.median),
                number(duel.tile.median),
                _text(duel.ratio),
                "" if second is None else _text(second),
                number(duel.embree.build),
                number(duel.tile.build),
            ]
        )


def _text(ratio: Ratio, aim: float | None = None) -> str:
    if ratio.interval is None:
        return _beside(ratio.value, aim)
    low, high = (_beside(end, aim) for end in ratio.interval)
    return f"{_beside(ratio.value, aim)} ({low} to {high})"


def _beside(value: float, aim: float | None) -> str:
    """Three digits, or as many as show on which side of the aim it is: 2.504 for 2.5, not 2.50."""
    text = number(value)
    digits = 3
    while aim is not None and digits < 9 and float(text.replace(",", "")) == aim != value:
        digits += 1
        text = f"{value:.{digits}g}"
    return text


def _row(texts: Iterable[str]) -> str:
    return f"| {' | '.join(texts)} |"
