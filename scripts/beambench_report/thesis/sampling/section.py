"""The ways of sampling as a part of the report, and as files of their own."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path
from statistics import median

from beambench_report.figure import house_style, write_plot
from beambench_report.files import write_text
from beambench_report.names import file_stems
from beambench_report.problem import Problem
from beambench_report.quantities import number
from beambench_report.thesis.printed import scene_title
from beambench_report.thesis.sampling.plot import draw_comparison
from beambench_report.thesis.sampling.read import UNIFORM, Comparison, read_comparison
from beambench_report.thesis.section import (
    Column,
    Field,
    Section,
    SectionFigure,
    SectionTable,
    section_as_markdown,
)
from beambench_report.thesis.texts import DASH, milliseconds

_WORDS = (
    "The thesis takes five samples in every pixel of a beam that ends at an occupied leaf, and "
    "leaves it to future work to let the leaf choose how many. Here it does: 1, 5 or 25 by the "
    "primitives of the leaf over its width in pixels (object-space). Beside it stand the same "
    "number in every such pixel (uniform) and more where a pixel differs from its neighbours "
    "(image-space). An error is the root mean square difference, of 255, to the picture of 64 "
    "samples a pixel in preview shading; a time is that of tracing and of choosing. Two numbers as "
    "a setting are the values from which on a pixel gets 5 and 25 samples.",
)
_CAPTION = (
    "Every point is a setting; the ends of each line are labeled, the table has all. Further left "
    "is quicker, further down is better; ringed is what the thesis did."
)


def sampling_section(comparisons: Sequence[Comparison]) -> Section | None:
    """Scene by scene; None where there is nothing."""
    if not comparisons:
        return None
    stems = file_stems(f"sampling {_title(comparison)}" for comparison in comparisons)
    figures = []
    for comparison, stem in zip(comparisons, stems.values(), strict=True):
        title = _title(comparison)
        draw = partial(draw_comparison, comparison, stem, title)
        figures.append(SectionFigure(stem, f"{title}: error over time", _CAPTION, draw))
    return Section(
        "sampling",
        "Samples chosen in object space",
        _WORDS,
        (_against_thesis(comparisons), *map(_ways, comparisons)),
        tuple(figures),
        tuple(_findings(comparisons)),
    )


def read_comparisons(files: Iterable[Path]) -> list[Comparison]:
    """One file a view. Raises Problem where a file cannot be read, or is of a view again."""
    found, unread = readable_comparisons(files)
    if unread:
        raise Problem(unread[0])
    return found


def readable_comparisons(files: Iterable[Path]) -> tuple[list[Comparison], list[str]]:
    """What can be shown, and a sentence for each file that cannot."""
    found: dict[str, Comparison] = {}
    unread = []
    for path in files:
        try:
            comparison = read_comparison(path)
        except Problem as problem:
            unread.append(str(problem))
            continue
        title = _title(comparison)
        if title in found:
            first = found[title].path
            unread.append(f"{path} and {first} are both of {title}; give one of them")
            continue
        found[title] = comparison
    return list(found.values()), unread


def write_sampling(files: Iterable[Path], directory: Path) -> list[Path]:
    """Writes DIRECTORY/sampling.md and a plot a file. Raises Problem where one cannot be read."""
    section = sampling_section(read_comparisons(files))
    if section is None:
        raise Problem("there is no file; write one with `beambench sampling SCENE --json`")
    directory.mkdir(parents=True, exist_ok=True)
    text = section_as_markdown(section, level=1, folder="")
    paths = [write_text(directory / "sampling.md", text)]
    with house_style():
        for figure in section.figures:
            paths += write_plot(figure.draw(), directory)
    return paths


def _title(comparison: Comparison) -> str:
    plain = comparison.scene.split(":")[0]
    name = scene_title(plain)
    own = "" if comparison.structure == "beam" else f", {comparison.structure}"
    return f"{comparison.scene if name == plain else name}, {comparison.resolution}{own}"


def _against_thesis(comparisons: Sequence[Comparison]) -> SectionTable:
    heads = ("time", "error", "same error in", "of its time", "error in its time")
    columns = (Column("scene", False), Column("method", False), *(Column(head) for head in heads))
    rows = []
    for comparison in comparisons:
        thesis = comparison.thesis
        if thesis is None:
            continue
        own = (_milliseconds(thesis.milliseconds), number(thesis.error), DASH, DASH, DASH)
        rows.append((_title(comparison), "uniform, 5 samples (thesis)", *own))
        for method in comparison.methods:
            if method == UNIFORM:
                continue
            reached = comparison.reached(method, thesis.error)
            error = comparison.error_at_time(method, thesis.milliseconds)
            texts = (
                DASH if reached is None else f"{_at_most(reached)}{_milliseconds(reached[0])}",
                DASH
                if reached is None
                else f"{_at_most(reached)}{reached[0] / thesis.milliseconds:.0%}",
                DASH if error is None else number(error),
            )
            rows.append(("", method, DASH, DASH, *texts))
    fields = tuple(tuple(Field(text) for text in row) for row in rows)
    title = (
        f"Against the thesis's five samples ({DASH}: outside of the settings that were tried; at "
        "most: the quickest setting has a smaller error)"
    )
    return SectionTable(title, columns, fields)


def _ways(comparison: Comparison) -> SectionTable:
    heads = ("rays a pixel", "trace", "error")
    columns = (Column("method", False), Column("setting", False), *(Column(h) for h in heads))
    rows = tuple(
        tuple(
            Field(text)
            for text in (
                way.method,
                way.setting.replace(" ", ", "),
                f"{way.rays:.3f}",
                _milliseconds(way.milliseconds),
                f"{way.error:.3f}",
            )
        )
        for way in comparison.ways
    )
    title = f"{_title(comparison)} ({comparison.path.name}, {comparison.repetitions} repetitions)"
    return SectionTable(title, columns, rows, is_long=True)


def _at_most(reached: tuple[float, bool]) -> str:
    return "" if reached[1] else "at most "


def _findings(comparisons: Sequence[Comparison]) -> Iterable[str]:
    """Of each other method: in how many scenes it is quicker to the thesis's error, or a smaller
    one.
    """
    compared = [comparison for comparison in comparisons if comparison.thesis]
    for method in dict.fromkeys(name for one in compared for name in one.methods):
        if method == UNIFORM:
            continue
        tried = [one for one in compared if method in one.methods]
        found = [one.reached(method, one.thesis.error) for one in tried]
        shares = [
            reached[0] / one.thesis.milliseconds
            for one, reached in zip(tried, found, strict=True)
            if reached is not None
        ]
        if not shares:
            yield f"{method}: every setting that was tried has a larger error than five samples."
            continue
        quicker = sum(share < 1 for share in shares)
        beyond = len(tried) - len(shares)
        at_most = "" if all(reached is None or reached[1] for reached in found) else "at most "
        larger = f"; in {beyond} every setting has a larger error" if beyond else ""
        yield (
            f"{method} reaches the error of the thesis's five samples, or a smaller one, in less "
            f"time in {quicker} of the {len(tried)} scenes that were tried, by the median of "
            f"{len(shares)} in {at_most}{median(shares):.0%} of it{larger}."
        )


def _milliseconds(value: float) -> str:
    return milliseconds(value / 1e3)
