"""The figures of chapter 5, from our cells and from what the thesis's tables and text print."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from beambench_report.ledger.comparisons import rays
from beambench_report.ledger.evidence import COARSEST, FINEST, RESOLUTIONS
from beambench_report.ledger.measured import Measured
from beambench_report.quantities import number
from beambench_report.thesis.cells import Cells, Setting, setting
from beambench_report.thesis.drawing import FigureData, Panel, Points, Side
from beambench_report.thesis.figures_of_best import figure_5_14, figure_5_17, figure_5_18
from beambench_report.thesis.lines import ACROSS, TICKS, measured, over, seconds_told
from beambench_report.thesis.printed import PrintedPart, parts_of, scene_title

_LOST = "the thesis's points are lost"
_TIME = "time (1: first contender, 320x200)"


def make_figures(numbers: Iterable[str], cells: Cells) -> list[FigureData]:
    """The figures that can be drawn; 5.9 is made of pictures (`pictures`)."""
    made = [_FIGURES[number](cells) for number in numbers if number in _FIGURES]
    return [figure for figure in made if not figure.is_empty]


def _of_table(figure: str, title: str, table: str, *, is_log: bool = False) -> Callable:
    """A figure that draws the rows of a table over the number of rays."""

    def make(cells: Cells) -> FigureData:
        parts = parts_of(table)
        return FigureData(
            figure,
            title,
            tuple(_table_panel(part, cells) for part in parts),
            ACROSS,
            f"{_caption_of(parts)} Each part is drawn as a multiple of its first row's time at "
            "320x200, the thesis's left and ours right; build included; bars are intervals"
            f"{'; the vertical axis is logarithmic' if is_log else ''}.",
            TICKS,
            is_log,
        )

    return make


def _table_panel(part: PrintedPart, cells: Cells) -> Panel:
    first = cells.at(part.rows[0].setting(part.scene, COARSEST))
    base = first.time if first else None
    thesis, ours, seen = [], [], {}
    for row in part.rows:
        variant = seen[row.structure] = seen.get(row.structure, -1) + 1
        told = [(rays(at) / 1e4, Measured.exact(s / part.base)) for at, s in row.seconds.items()]
        thesis.append(Points(row.label, row.structure, variant, told))
        own = measured(cells, (row.setting(part.scene, at) for at in RESOLUTIONS))
        if base and own:
            ours.append(Points(row.label, row.structure, variant, over(own, base.value)))
    unit = f"ours (1 = {number(1e3 * base.value)} ms)" if base else "ours"
    return Panel(
        part.title,
        _TIME,
        Side(tuple(thesis), f"thesis (1 = {part.base:g} s)"),
        Side(tuple(ours), unit),
    )


def _caption_of(parts: Sequence[PrintedPart]) -> str:
    """What the thesis's table says from the coarsest to the finest resolution."""
    told = []
    for part in parts:
        rows = (
            f"{row.label} {row.seconds[COARSEST]:g} to {row.seconds[FINEST]:g} s"
            for row in part.rows
        )
        told.append(f"{part.title} {', '.join(rows)}")
    return f"Thesis, 320x200 to 1280x1024: {'; '.join(told)}."


def _of_scenes(figure: str, title: str, scenes: tuple[str, ...]) -> Callable[[Cells], FigureData]:
    """A figure of the beams' time (a) and of its increase over 320x200 (b), a line a scene."""

    def make(cells: Cells) -> FigureData:
        thesis = {scene: _told_beams(scene) for scene in scenes}
        ours = {scene: _measured_beams(cells, scene, 1) for scene in scenes}
        first = next((scene for scene in scenes if thesis[scene] and ours[scene]), scenes[0])
        panels = (
            _absolute(thesis, ours, first),
            Panel(
                "(b) increase",
                "increase over 320x200 (%)",
                Side(_lines(_increases(thesis)), "thesis", _LOST),
                Side(_lines(_increases(ours)), "ours"),
            ),
        )
        return FigureData(figure, title, panels, ACROSS, _told_of_scenes(thesis), TICKS)

    return make


def _absolute(thesis: dict, ours: dict, first: str) -> Panel:
    """Seconds as multiples of one scene's at 320x200: seconds of 1999 compare to none of today."""
    sides = []
    for whose, lines, unit, factor in (("thesis", thesis, "s", 1), ("ours", ours, "ms", 1e3)):
        base = lines[first][0][1].value if lines[first] else None
        scaled = {scene: over(points, base) for scene, points in lines.items() if base is not None}
        words = f"{whose} (1 = {number(base * factor)} {unit})" if base else whose
        sides.append(Side(_lines(scaled), words, _LOST if whose == "thesis" else ""))
    return Panel("(a) time", f"time (1: {scene_title(first)}, 320x200)", *sides)


def _samples(cells: Cells) -> FigureData:
    """Figure 5.11 beside 5.10 b: the thesis's points of both scenes that no table has are lost."""
    scenes = ("bola-espacial", "tetera", "torre-eiffel", "caracol")
    one = {scene: _measured_beams(cells, scene, 1) for scene in scenes}
    five = {scene: _measured_beams(cells, scene, 5) for scene in scenes}
    panel = Panel(
        "Increase",
        "increase over 320x200 (%)",
        Side(_lines(_increases(one)), "ours, 1 sample a pixel", "not measured"),
        Side(_lines(_increases(five)), "ours, 5 samples a pixel"),
    )
    return FigureData(
        "5.11",
        "Increase of the time with five samples a pixel",
        (panel,),
        ACROSS,
        "Four samples at a pixel's corners and one in its centre; none where a beam leaves the "
        "scene. The base of each line is its own time at 320x200 with as many samples. The "
        "thesis's points are lost; it says that the lines lie farther apart with five samples "
        "(right) than with one (left, figure 5.10 b). Bars are intervals.",
        TICKS,
        is_all_ours=True,
    )


def _told_beams(scene: str) -> list[tuple[float, Measured]]:
    """The beams' times at level 6 in the first table that has the scene."""
    return seconds_told(setting(scene, "beam", at, level=6) for at in RESOLUTIONS)


def _measured_beams(cells: Cells, scene: str, samples: int) -> list[tuple[float, Measured]]:
    keys: list[Setting] = [
        setting(scene, "beam", at, level=6, samples=samples) for at in RESOLUTIONS
    ]
    points = measured(cells, keys)
    return points if cells.at(keys[0]) and cells.at(keys[0]).time else []


def _increases(lines: dict) -> dict:
    """Percent over the first point, with the interval of that ratio."""
    return {
        scene: [
            (place, _percent(figure, points[0][1], is_base=index == 0))
            for index, (place, figure) in enumerate(points)
        ]
        for scene, points in lines.items()
    }


def _percent(figure: Measured, base: Measured, *, is_base: bool) -> Measured:
    if is_base:
        return Measured.exact(0.0)
    ratio = figure / base
    return Measured(*(100 * (end - 1) for end in (ratio.value, ratio.low, ratio.high)))


def _lines(lines: dict) -> tuple[Points, ...]:
    return tuple(
        Points(scene_title(scene), "beam", variant, points)
        for variant, (scene, points) in enumerate(lines.items())
        if points
    )


def _told_of_scenes(thesis: dict) -> str:
    told = []
    for scene, points in thesis.items():
        if points:
            low, high = points[0][1].value, points[-1][1].value
            more = f"+{100 * (high / low - 1):.0f}%"
            told.append(f"{scene_title(scene)} {low:g} to {high:g} s ({more})")
    lost = [scene_title(scene) for scene, points in thesis.items() if not points]
    without = f" Its points for {' and '.join(lost)} are lost." if lost else ""
    return (
        f"The beams at level 6. Thesis, 320x200 to 1280x1024: {'; '.join(told)}.{without} Both "
        "axes of (a) are multiples of one scene's time at 320x200; bars are intervals."
    )


_FIGURES: dict[str, Callable[[Cells], FigureData]] = {
    "5.6": _of_table("5.6", "Total time by the objects that may lie in a leaf", "5.2"),
    "5.7": _of_table("5.7", "Total time by the level of the octree", "5.3"),
    "5.8": _of_scenes("5.8", "Time of the beams, synthetic scenes", ("escena1", "escena2")),
    "5.10": _of_scenes(
        "5.10",
        "Time of the beams, four real scenes",
        ("bola-espacial", "tetera", "torre-eiffel", "caracol"),
    ),
    "5.11": _samples,
    "5.12": _of_table("5.12", "Beams and single rays on the same octree, synthetic scenes", "5.4"),
    "5.13": _of_table("5.13", "Beams and single rays on the same octree, real scenes", "5.5"),
    "5.14": figure_5_14,
    "5.15": _of_table("5.15", "Beams, grid and hierarchy, synthetic scenes", "5.6", is_log=True),
    "5.16": _of_table("5.16", "Beams, grid and hierarchy, real scenes", "5.7", is_log=True),
    "5.17": figure_5_17,
    "5.18": figure_5_18,
}
