"""Makes the lines of the figures: the thesis's seconds and ours, over the number of rays."""

from collections.abc import Callable, Iterable, Sequence
from functools import partial

from beambench_report.base.palette import SCENE_COLORS
from beambench_report.base.published import COARSEST, FINEST, RESOLUTIONS, rays
from beambench_report.base.quantities import number
from beambench_thesis.paper.cells import Cell, Cells
from beambench_thesis.paper.evidence import (
    CELLS,
    ON_OCTREES,
    SETTING,
    Measured,
    Setting,
    published_evidence,
    setting,
)
from beambench_thesis.paper.printed import PrintedPart, contender_title, parts_of, scene_title
from beambench_thesis.report.drawing import FigureData, Panel, Points, Side

ACROSS = "rays / 10,000"
TICKS = tuple(round(rays(resolution) / 1e4, 2) for resolution in RESOLUTIONS)

_BARS = "bars are 95% intervals; points without bars have too few repetitions"

_RESOLUTION = SETTING.index("resolution")

Line = list[tuple[float, Measured]]


def measured(cells: Cells, keys: Iterable[Setting]) -> Line:
    """Returns our seconds, if there are any."""
    found = ((key, cells.at(key)) for key in keys)
    return [(place(key), cell.time) for key, cell in found if cell and cell.time]


def seconds_printed(keys: Iterable[Setting]) -> Line:
    """Returns the thesis's seconds, if some table has them."""
    found = ((key, published_evidence().at(key)) for key in keys)
    return [(place(key), seconds) for key, seconds in found if seconds]


def place(key: Setting) -> float:
    """Returns tens of thousands of rays at one sample per pixel, as the thesis counts them."""
    return rays(str(key[_RESOLUTION])) / 1e4


def over(line: Sequence[tuple[float, Measured]], base: float) -> Line:
    """Returns the line as multiples of a figure."""
    return [(at, figure.times(1 / base)) for at, figure in line]


_BEST_GRIDS = {"ajedrez": 15, "flamenco": 13}
_LEVEL, _CELLS = SETTING.index("level"), SETTING.index("cells")


def figure_5_14(cells: Cells, figure: str) -> FigureData:
    """Returns time over the level; the thesis prints no numbers for this figure."""
    panels = tuple(
        Panel(
            f"({letter}) {scene_title(scene)}",
            "time (ms)",
            *(
                Side(_over(cells, scene, ON_OCTREES, resolution, _LEVEL), f"ours, {resolution}")
                for resolution in (COARSEST, FINEST)
            ),
        )
        for letter, scene in (("a", "casa-de-campo"), ("b", "gato-bill"))
    )
    return FigureData(
        figure,
        "Time by the level of each contender's octree",
        panels,
        "greatest level of the octree, the root being level 1",
        "All points are ours, build included; the thesis's are lost. The thesis says that each "
        "contender's lowest point counts, and that the beams have the lowest of all at high "
        "resolution. At level 6 and 1280x1024, the thesis's times are: "
        f"{'; '.join(_printed_at_six(scene) for scene in ('casa-de-campo', 'gato-bill'))}. The "
        f"vertical axis is logarithmic; {_BARS}.",
        (4, 5, 6, 7, 8, 9),
        is_log=True,
        is_all_ours=True,
    )


def figure_5_17(cells: Cells, figure: str) -> FigureData:
    """Returns the time of the lazy grid over its cells per axis."""
    at = _swept_at(cells)
    named = (("a", "ajedrez"), ("b", "flamenco"))
    own = {scene: _own_grids(cells, scene, at) for _, scene in named}
    sides = (
        Side(
            (*_printed_grids(scene, at), *own[scene][0]) if own[scene][0] else (),
            f"({letter}) {scene_title(scene)}",
        )
        for letter, scene in named
    )
    ours = "; ".join(f"{scene_title(scene)} {base}" for scene, (_, base) in own.items() if base)
    return FigureData(
        figure,
        "Time of the grid by its cells per axis",
        (Panel("", "time (1: 32 cells per axis;\nlower is better)", *sides),),
        "voxels along each axis",
        f"{at}, filled lazily, build included; each line is relative to its own time with 32 "
        f"cells, for ours {ours}. Of the thesis's figure, only three points are known: 32 cells "
        f"per axis take {_printed_grid('ajedrez', at):g} s (Ajedrez) and "
        f"{_printed_grid('flamenco', at):g} s (Flamenco) in table 5.8, and Flamenco's best grid, "
        "with 13 cells, takes 93 s at a resolution that is not stated. Ajedrez's best grid has 15 "
        "cells, but its seconds are lost. Both axes are logarithmic; "
        f"{_BARS}.",
        (8, 13, 16, 20, 24, 32, 48),
        is_log=True,
        is_log_across=True,
        is_all_ours=True,
    )


def _swept_at(cells: Cells) -> str:
    """Returns 1280x1024 or, for a quick run, 320x200."""
    swept = [
        at for at in (FINEST, COARSEST) if len(_timed(cells, "flamenco", "voxel-grid", at)) > 1
    ]
    return swept[0] if swept else FINEST


def figure_5_18(cells: Cells, figure: str) -> FigureData:
    """Compares beams with grids: the thesis's 32 cells, its best, and our best."""
    panels = []
    for letter, scene in (("a", "ajedrez"), ("b", "flamenco")):
        beam = [setting(scene, "beam", at) for at in RESOLUTIONS]
        printed, own = seconds_printed(beam), measured(cells, beam)
        origin = printed[0][1].value
        first = cells.at(beam[0])
        base = first.time.value if first and first.time else None
        ours = []
        if base:
            ours = [Points(contender_title("beam"), "beam", 0, over(own, base))]
            ours += _grids_over_rays(cells, scene, base)
        thesis_grid = over(seconds_printed(_grid(scene, CELLS)), origin)
        left = (
            Points(contender_title("beam"), "beam", 0, over(printed, origin)),
            Points("grid, 32 cells per axis", "voxel-grid", 0, thesis_grid),
        )
        panels.append(
            Panel(
                f"({letter}) {scene_title(scene)}",
                "time (1: beams, 320x200)",
                Side(left, f"thesis (1 = {origin:g} s)"),
                Side(tuple(ours), f"ours (1 = {number(1e3 * base)} ms)" if base else "ours"),
            )
        )
    return FigureData(
        figure,
        "Beams and the grid at its best",
        tuple(panels),
        ACROSS,
        "The thesis's best grids are 15 cells per axis for Ajedrez and 13 for Flamenco; its points "
        "for these are lost, except Flamenco's 93 s, so its column shows the 32 cells of table "
        f"5.8. Build included; the vertical axis is logarithmic; {_BARS}.",
        TICKS,
        is_log=True,
    )


def _grids_over_rays(cells: Cells, scene: str, base: float) -> list[Points]:
    lines = []
    named = ((CELLS, ""), (_BEST_GRIDS[scene], " (thesis's best)"))
    for variant, (count, words) in enumerate(named):
        points = measured(cells, _grid(scene, count))
        label = "grid, the thesis's best (15, 13) cells" if words else "grid, 32 cells per axis"
        lines.append(Points(label, "voxel-grid", variant, over(points, base)))
    lazy = (_timed(cells, scene, "voxel-grid", at) for at in RESOLUTIONS)
    best = (min(found, key=lambda cell: cell.time.value) for found in lazy if found)
    points = [(rays(cell.resolution) / 1e4, cell.time) for cell in best]
    lines.append(Points("grid, our best lazy grid", "voxel-grid", 2, over(points, base)))
    return [line for line in lines if line.at]


def _grid(scene: str, count: int) -> list[tuple]:
    return [setting(scene, "voxel-grid", at, cells=count) for at in RESOLUTIONS]


def _timed(cells: Cells, scene: str, structure: str, resolution: str) -> list[Cell]:
    """Returns the timed cells with the thesis's parameters, such as lazily filled grids."""
    found = cells.of(scene, structure, resolution)
    return [cell for cell in found if cell.setting is not None and cell.time is not None]


def _over(
    cells: Cells, scene: str, structures: Iterable[str], resolution: str, of: int
) -> tuple[Points, ...]:
    lines = []
    for structure in structures:
        found: Line = [
            (float(cell.setting[of]), cell.time.times(1e3))
            for cell in _timed(cells, scene, structure, resolution)
        ]
        found.sort(key=lambda point: point[0])
        lines.append(Points(contender_title(structure), structure, 0, found))
    return tuple(line for line in lines if line.at)


def _own_grids(cells: Cells, scene: str, resolution: str) -> tuple[tuple[Points, ...], str]:
    """Returns the line of our grids, and its unit."""
    base = cells.at(setting(scene, "voxel-grid", resolution, cells=CELLS))
    found = _over(cells, scene, ("voxel-grid",), resolution, _CELLS)
    if base is None or base.time is None or not found:
        return (), ""
    scaled = over(found[0].at, 1e3 * base.time.value)
    line = Points("ours, grid filled lazily", "voxel-grid", 0, scaled)
    return (line,), f"{number(1e3 * base.time.value)} ms"


def _printed_grids(scene: str, resolution: str) -> tuple[Points, ...]:
    points = [(float(CELLS), Measured.exact(1.0))]
    best = published_evidence().worked("best_seconds", scene, contender="voxel-grid")
    if best:
        scaled = best.times(1 / _printed_grid(scene, resolution))
        points.insert(0, (float(_BEST_GRIDS[scene]), scaled))
    return (Points("thesis", "embree", 1, points, is_joined=False),)  # black squares


def _printed_grid(scene: str, resolution: str) -> float:
    printed = published_evidence().time(scene, "voxel-grid", resolution)
    return printed.value if printed else 1.0


def _printed_at_six(scene: str) -> str:
    times = ((name, published_evidence().time(scene, name)) for name in ON_OCTREES)
    seconds = (f"{contender_title(name)} {time.value:g} s" for name, time in times if time)
    return f"{scene_title(scene)} {', '.join(seconds)}"


_LOST = "the thesis's points are lost"
_REAL = ("bola-espacial", "tetera", "torre-eiffel", "caracol")
_TIME = "time (1: first contender, 320x200)"


def make_figures(numbers: Iterable[str], cells: Cells) -> list[FigureData]:
    """Returns the figures that can be drawn; 5.9 is made of pictures (`pictures`)."""
    made = [_FIGURES[number](cells, number) for number in numbers if number in _FIGURES]
    return [figure for figure in made if not figure.is_empty]


def _of_table(
    title: str, table: str, cells: Cells, figure: str, *, is_log: bool = False
) -> FigureData:
    """Returns the figure of a table's rows over the number of rays."""
    parts = parts_of(table)
    return FigureData(
        figure,
        title,
        tuple(_table_panel(part, cells) for part in parts),
        ACROSS,
        f"{_caption_of(parts)} Times, building included, are divided by the first curve's time at "
        f"320x200, the thesis's on the left and ours on the right; {_BARS}"
        f"{'; the vertical axis is logarithmic' if is_log else ''}.",
        TICKS,
        is_log,
    )


def _table_panel(part: PrintedPart, cells: Cells) -> Panel:
    first = cells.at(part.rows[0].setting(part.scene, COARSEST))
    base = first.time if first else None
    thesis, ours, seen = [], [], {}
    for row in part.rows:
        variant = seen[row.structure] = seen.get(row.structure, -1) + 1
        printed = [(rays(at) / 1e4, Measured.exact(s / part.base)) for at, s in row.seconds.items()]
        thesis.append(Points(row.label, row.structure, variant, printed))
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
    """Returns the thesis's figures at the coarsest and the finest resolution, in words."""
    texts = []
    for part in parts:
        rows = (
            f"{row.label} {row.seconds[COARSEST]:g} to {row.seconds[FINEST]:g} s"
            for row in part.rows
        )
        texts.append(f"{part.title} {', '.join(rows)}")
    return f"Thesis, 320x200 to 1280x1024: {'; '.join(texts)}."


def _of_scenes(title: str, scenes: Sequence[str], cells: Cells, figure: str) -> FigureData:
    """Returns the figure of the beams' time (a) and its increase over 320x200 (b), by scene."""
    thesis = {scene: _printed_beams(scene) for scene in scenes}
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
    return FigureData(figure, title, panels, ACROSS, _caption_of_scenes(thesis), TICKS)


def _absolute(thesis: dict, ours: dict, first: str) -> Panel:
    """Returns times relative to one scene at 320x200, to compare 1999 with today."""
    sides = []
    for whose, lines, unit, factor in (("thesis", thesis, "s", 1), ("ours", ours, "ms", 1e3)):
        base = lines[first][0][1].value if lines[first] else None
        scaled = {scene: over(points, base) for scene, points in lines.items() if base is not None}
        words = f"{whose} (1 = {number(base * factor)} {unit})" if base else whose
        sides.append(Side(_lines(scaled), words, _LOST if whose == "thesis" else ""))
    return Panel("(a) time", f"time (1: {scene_title(first)}, 320x200)", *sides)


def _samples(cells: Cells, figure: str) -> FigureData:
    """Returns figure 5.11 with 5.10 b; the thesis's points that are in no table are lost."""
    one, five = (
        {scene: _measured_beams(cells, scene, samples) for scene in _REAL} for samples in (1, 5)
    )
    panel = Panel(
        "Increase",
        "increase over 320x200 (%)",
        Side(_lines(_increases(one)), "ours, 1 sample per pixel", "not measured"),
        Side(_lines(_increases(five)), "ours, 5 samples per pixel"),
    )
    return FigureData(
        figure,
        "Increase of the time with five samples per pixel",
        (panel,),
        ACROSS,
        "Four samples at a pixel's corners and one in its center; none where a beam leaves the "
        "scene. Each line is relative to its own time at 320x200 with as many samples. The "
        "thesis's points are lost; it says that the lines lie farther apart with five samples "
        f"(right) than with one (left, figure 5.10 b). {_BARS[0].upper()}{_BARS[1:]}.",
        TICKS,
        is_all_ours=True,
    )


def _printed_beams(scene: str) -> list[tuple[float, Measured]]:
    """Returns the beams' times at level 6 in the first table that has the scene."""
    return seconds_printed(setting(scene, "beam", at) for at in RESOLUTIONS)


def _measured_beams(cells: Cells, scene: str, samples: int) -> list[tuple[float, Measured]]:
    keys = [setting(scene, "beam", at, samples=samples) for at in RESOLUTIONS]
    points = measured(cells, keys)
    return points if cells.at(keys[0]) and cells.at(keys[0]).time else []


def _increases(lines: dict) -> dict:
    """Returns percent over the first point, with the interval of that ratio."""
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
        Points(scene_title(scene), "beam", variant, points, color=color)
        for variant, ((scene, points), color) in enumerate(
            zip(lines.items(), SCENE_COLORS, strict=False)
        )
        if points
    )


def _caption_of_scenes(thesis: dict) -> str:
    texts = []
    for scene, points in thesis.items():
        if points:
            low, high = points[0][1].value, points[-1][1].value
            more = f"+{100 * (high / low - 1):.0f}%"
            texts.append(f"{scene_title(scene)} {low:g} to {high:g} s ({more})")
    lost = [scene_title(scene) for scene, points in thesis.items() if not points]
    without = f" Its points for {' and '.join(lost)} are lost." if lost else ""
    return (
        f"The beams at level 6. Thesis, 320x200 to 1280x1024: {'; '.join(texts)}.{without} Both "
        f"sides of (a) show multiples of one scene's time at 320x200; {_BARS}."
    )


_FIGURES: dict[str, Callable[[Cells, str], FigureData]] = {
    "5.6": partial(_of_table, "Total time by the objects that may lie in a leaf", "5.2"),
    "5.7": partial(_of_table, "Total time by the level of the octree", "5.3"),
    "5.8": partial(_of_scenes, "Time of the beams, synthetic scenes", ("escena1", "escena2")),
    "5.10": partial(_of_scenes, "Time of the beams, four real scenes", _REAL),
    "5.11": _samples,
    "5.12": partial(_of_table, "Beams and single rays on the same octree, synthetic scenes", "5.4"),
    "5.13": partial(_of_table, "Beams and single rays on the same octree, real scenes", "5.5"),
    "5.14": figure_5_14,
    "5.15": partial(_of_table, "Beams, grid and hierarchy, synthetic scenes", "5.6", is_log=True),
    "5.16": partial(_of_table, "Beams, grid and hierarchy, real scenes", "5.7", is_log=True),
    "5.17": figure_5_17,
    "5.18": figure_5_18,
}
