"""Figures 5.14, 5.17 and 5.18: what suits a contender best, and beams beside the best grid."""

from __future__ import annotations

from collections.abc import Iterable

from beambench_report.ledger.comparisons import rays
from beambench_report.ledger.evidence import CELLS, COARSEST, FINEST, RESOLUTIONS, SETTING
from beambench_report.ledger.measured import Measured
from beambench_report.ledger.published import published_evidence
from beambench_report.quantities import number
from beambench_report.thesis.cells import Cell, Cells, setting
from beambench_report.thesis.drawing import FigureData, Panel, Points, Side
from beambench_report.thesis.lines import ACROSS, TICKS, Line, measured, over, seconds_told
from beambench_report.thesis.printed import contender_title, scene_title

_ON_OCTREES = ("beam", "samet", "samet-net")
_BEST_GRIDS = {"ajedrez": 15, "flamenco": 13}
_LEVEL, _CELLS = SETTING.index("level"), SETTING.index("cells")


def figure_5_14(cells: Cells) -> FigureData:
    """Time over the level; the thesis prints no number of this figure."""
    panels = tuple(
        Panel(
            f"({letter}) {scene_title(scene)}",
            "time (ms)",
            *(
                Side(_over(cells, scene, _ON_OCTREES, resolution, _LEVEL), f"ours, {resolution}")
                for resolution in (COARSEST, FINEST)
            ),
        )
        for letter, scene in (("a", "casa-de-campo"), ("b", "gato-bill"))
    )
    return FigureData(
        "5.14",
        "Time by the level that each contender has",
        panels,
        "greatest level of the octree, the root being level 1",
        "All of it is ours, build included; the points of the thesis's figure are lost. It says "
        "that each contender's lowest point counts, and that the beams' is the lowest at high "
        "resolution. At level 6 and 1280x1024 the thesis has: "
        f"{'; '.join(_told_at_six(scene) for scene in ('casa-de-campo', 'gato-bill'))}. The "
        "vertical axis is logarithmic; bars are intervals.",
        (4, 5, 6, 7, 8, 9),
        is_log=True,
        is_all_ours=True,
    )


def figure_5_17(cells: Cells) -> FigureData:
    """Time of the lazy grid over its cells an axis."""
    at = _swept_at(cells)
    named = (("a", "ajedrez"), ("b", "flamenco"))
    sides = (
        _grids_of(cells, f"({letter}) {scene_title(scene)}", scene, at) for letter, scene in named
    )
    ours = "; ".join(
        f"{scene_title(scene)} {base}"
        for _, scene in named
        if (base := _own_grids(cells, scene, at)[1])
    )
    return FigureData(
        "5.17",
        "Time of the grid by its cells an axis",
        (Panel("", "time (1: 32 cells an axis)", *sides),),
        "voxels along each axis",
        f"{at}, filled lazily, build included; each line over its own time with 32 cells, ours "
        f"being {ours}. Of the thesis's figure only this is known: with 32 cells an axis "
        f"{_printed_grid('ajedrez', at):g} s (Ajedrez) and {_printed_grid('flamenco', at):g} s "
        "(Flamenco) by table 5.8, Flamenco's best with 13 cells, 93 s at a resolution that it does "
        "not state, Ajedrez's best with 15 (its seconds are lost). Both axes are logarithmic; bars "
        "are intervals.",
        (8, 13, 16, 20, 24, 32, 48),
        is_log=True,
        is_log_across=True,
        is_all_ours=True,
    )


def _grids_of(cells: Cells, title: str, scene: str, resolution: str) -> Side:
    """Our grids of a scene, and over them the thesis's points."""
    lines, _ = _own_grids(cells, scene, resolution)
    return Side((*_printed_grids(scene, resolution), *lines) if lines else (), title)


def _swept_at(cells: Cells) -> str:
    """1280x1024, or what a quick run has instead."""
    swept = [at for at in (FINEST, COARSEST) if len(_lazy(cells, "flamenco", at)) > 1]
    return swept[0] if swept else FINEST


def figure_5_18(cells: Cells) -> FigureData:
    """The beams beside grids: the thesis's 32 cells, those it found best, and those we found."""
    panels = []
    for letter, scene in (("a", "ajedrez"), ("b", "flamenco")):
        beam = [setting(scene, "beam", at, level=6) for at in RESOLUTIONS]
        told, own = seconds_told(beam), measured(cells, beam)
        first = cells.at(beam[0])
        base = first.time.value if first and first.time else None
        ours = []
        if base:
            ours = [Points(contender_title("beam"), "beam", 0, over(own, base))]
            ours += _grids_over_rays(cells, scene, base)
        thesis_grid = over(seconds_told(_grid(scene, CELLS)), told[0][1].value)
        left = (
            Points(contender_title("beam"), "beam", 0, over(told, told[0][1].value)),
            Points("grid, 32 cells an axis", "voxel-grid", 0, thesis_grid),
        )
        panels.append(
            Panel(
                f"({letter}) {scene_title(scene)}",
                "time (1: beams, 320x200)",
                Side(left, f"thesis (1 = {told[0][1].value:g} s)"),
                Side(tuple(ours), f"ours (1 = {number(1e3 * base)} ms)" if base else "ours"),
            )
        )
    return FigureData(
        "5.18",
        "Beams beside the grid at its best",
        tuple(panels),
        ACROSS,
        "The thesis's best grids are 15 cells an axis for Ajedrez and 13 for Flamenco; its points "
        "for them are lost but for Flamenco's 93 s, so its column shows the 32 cells of table "
        "5.8. Build included; the vertical axis is logarithmic; bars are intervals.",
        TICKS,
        is_log=True,
    )


def _grids_over_rays(cells: Cells, scene: str, base: float) -> list[Points]:
    lines = []
    named = ((CELLS, ""), (_BEST_GRIDS[scene], " (thesis's best)"))
    for variant, (count, words) in enumerate(named):
        points = measured(cells, _grid(scene, count))
        label = "grid, the thesis's best (15, 13) cells" if words else "grid, 32 cells an axis"
        lines.append(Points(label, "voxel-grid", variant, over(points, base)))
    best = [min(found, key=_seconds) for at in RESOLUTIONS if (found := _lazy(cells, scene, at))]
    points = [(rays(cell.resolution) / 1e4, cell.time) for cell in best if cell.time]
    lines.append(Points("grid, our best lazy one", "voxel-grid", 2, over(points, base)))
    return [line for line in lines if line.at]


def _grid(scene: str, count: int) -> list[tuple]:
    return [setting(scene, "voxel-grid", at, cells=count) for at in RESOLUTIONS]


def _lazy(cells: Cells, scene: str, resolution: str) -> list[Cell]:
    found = cells.of(scene, "voxel-grid", resolution)
    return [cell for cell in found if cell.setting is not None and cell.time is not None]


def _seconds(cell: Cell) -> float:
    return cell.time.value if cell.time else float("inf")


def _over(
    cells: Cells, scene: str, structures: Iterable[str], resolution: str, of: int
) -> tuple[Points, ...]:
    lines = []
    for structure in structures:
        found: Line = [
            (float(cell.setting[of]), cell.time.times(1e3))
            for cell in cells.of(scene, structure, resolution)
            if cell.setting is not None and cell.time is not None
        ]
        if found:
            found.sort(key=lambda point: point[0])
            lines.append(Points(contender_title(structure), structure, 0, found))
    return tuple(lines)


def _own_grids(cells: Cells, scene: str, resolution: str) -> tuple[tuple[Points, ...], str]:
    """The line of our grids, and what it is a multiple of."""
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


def _told_at_six(scene: str) -> str:
    times = ((name, published_evidence().time(scene, name)) for name in _ON_OCTREES)
    told = ", ".join(f"{contender_title(name)} {time.value:g} s" for name, time in times if time)
    return f"{scene_title(scene)} {told}"
