"""The aims beside what was measured, as Markdown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from beambench_report.beat.aims import HELD_TO_LESS, Group, groups
from beambench_report.beat.duels import Duel, Ratio, geometric_mean
from beambench_report.quantities import number

_WORDS = (
    "The time in which Embree's fastest mode traces an image over the time of `tile-beam`, both in "
    "one run, on one thread, both writing t and id of every sample into the same kind of buffer, "
    "by the same rays. Embree's fastest mode is that of the least median among those whose hits "
    "were judged right. Building is left out. In brackets: the ratio if both medians stood at the "
    "worst ends of their 95% intervals. An aim is `met` or `missed` when the whole of that lies on "
    "one side of it, otherwise `open`."
)


def as_markdown(found: Sequence[Duel], plots: Sequence[str] = ()) -> str:
    """The report; `plots` are the files of its figures."""
    lines = ["# Tile beams against Embree", "", _WORDS, ""]
    for plot in plots:
        lines += [f"![{plot}]({plot})", ""]
    lines += [*(f"- {origin}" for origin in dict.fromkeys(duel.origin for duel in found)), ""]
    single = [duel for duel in found if duel.samples == 1]
    for isa in dict.fromkeys(duel.isa for duel in single):
        lines += [*_of_isa(isa, [duel for duel in single if duel.isa == isa]), ""]
    lines += [*_every(found), ""]
    return "\n".join(lines)


def judgement(ratio: Ratio, aim: float) -> str:
    """`met`, `open` or `missed`; without an interval by the median alone."""
    low = ratio.value if ratio.low is None else ratio.low
    high = ratio.value if ratio.high is None else ratio.high
    if low >= aim:
        return "met"
    return "open" if high >= aim else "missed"


def part_of_aims(isa: str) -> float:
    """How much of the aims holds on an instruction set that both were held to."""
    return 1.0 if isa == "best" else HELD_TO_LESS


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
            yield from ("", f"### {group.title}", "", *table)


def _summary(found: Sequence[Duel], part: float) -> str:
    judged = Counter(
        judgement(duel.ratio, part * group.aims[duel.resolution])
        for group in groups()
        for duel in found
        if duel.scene in group.scenes and duel.resolution in group.aims
    )
    return (
        f"Of {judged.total()} aims for single scenes {judged['met']} are met, "
        f"{judged['open']} open, {judged['missed']} missed."
    )


def _group_table(group: Group, found: Sequence[Duel], part: float) -> list[str]:
    at = {(duel.scene, duel.resolution): duel.ratio for duel in found if duel.scene in group.scenes}
    columns = [size for size in group.aims if any(size == resolution for _, resolution in at)]
    if not columns:
        return []
    lines = [_row(["scene", *columns]), _row(["---", *("---:" for _ in columns)])]
    for scene, title in group.scenes.items():
        if any((scene, size) in at for size in columns):
            texts = [_cell(at.get((scene, size)), part * group.aims[size]) for size in columns]
            lines.append(_row([title, *texts]))
    lines.append(_row(["*aim*", *(f"*at least {part * group.aims[s]:g}*" for s in columns)]))
    if group.mean_aims:
        means = [_mean(group, at, size, part * group.mean_aims[size]) for size in columns]
        lines.append(_row(["**geometric mean**", *means]))
        aims = (f"*at least {part * group.mean_aims[size]:g}*" for size in columns)
        lines.append(_row(["*aim of the mean*", *aims]))
    return lines


def _cell(ratio: Ratio | None, aim: float) -> str:
    return "" if ratio is None else f"{_text(ratio)} {judgement(ratio, aim)}"


def _mean(group: Group, at: dict[tuple[str, str], Ratio], size: str, aim: float) -> str:
    ratios = [at[scene, size] for scene in group.scenes if (scene, size) in at]
    if not ratios:
        return ""
    mean = geometric_mean(ratios)
    if len(ratios) < len(group.scenes):
        return f"{_text(mean)} of {len(ratios)} scenes"
    return f"{_text(mean)} {judgement(mean, aim)}"


def _every(found: Sequence[Duel]) -> Iterable[str]:
    yield "## Every image"
    yield ""
    heads = (
        "scene, resolution, samples, primitives, held to, fastest mode, Embree ms, tile-beam ms, "
        "ratio, of second traces"
    ).split(", ")
    yield _row(heads)
    yield _row(["---", "---", "---:", "---:", "---", "---", *(["---:"] * 4)])
    for duel in found:
        warm = duel.warm_ratio
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
                "" if warm is None else number(warm),
            ]
        )


def _text(ratio: Ratio) -> str:
    if ratio.low is None or ratio.high is None:
        return number(ratio.value)
    return f"{number(ratio.value)} ({number(ratio.low)} to {number(ratio.high)})"


def _row(texts: Iterable[str]) -> str:
    return f"| {' | '.join(texts)} |"
