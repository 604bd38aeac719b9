"""Beams through a hierarchy of grids, the thesis's future work, from the sweep grid-beams."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from beambench_report.base.quantities import number
from beambench_thesis.paper.cells import Cell
from beambench_thesis.paper.printed import milliseconds, scene_title
from beambench_thesis.paper.section import Section, section_table

_WORDS = (
    "The thesis proposes beams through structures other than the octree, such as hierarchies of "
    "grids (section 7.3). This is implemented by `grid-beam`: a beam passes through the empty "
    "voxels of the scene's grid and, where a voxel has many primitives, of the grid inside it "
    "(Jevans and Wyvill 1989). Beams with few samples become single rays. The hits are those of "
    "single rays, bit for bit. The table has the trace times of single rays and of beams through "
    "the same grids, and the total times, building included, of beams through the fastest measured "
    "octree and through the grids."
)


@dataclass(frozen=True)
class GridBeamRow:
    """The times of a scene at one resolution."""

    beams: Cell
    rays: Cell
    """Single rays through the same grids."""
    octree: Cell | None
    """The fastest beams through octrees."""

    @property
    def ratio(self) -> float:
        """Returns the trace time of single rays over that of beams."""
        return self.rays.trace / self.beams.trace

    @property
    def octree_ratio(self) -> float | None:
        """Returns the total time with the octree over the total time with the grids."""
        if self.octree is None:
            return None
        return _whole(self.octree) / _whole(self.beams)


def grid_beam_rows(cells: Iterable[Cell]) -> list[GridBeamRow]:
    """Returns rows, in the order of the cells, where beams and single rays have the same grids."""
    timed = [cell for cell in cells if cell.time is not None]
    rays = {
        _grid(cell): cell
        for cell in timed
        if cell.structure == "hierarchical-grid" and cell.parameters.get("inner") == "powers"
    }
    rows = []
    for cell in timed:
        is_beam = cell.structure == "grid-beam" and cell.parameters.get("handover") != "0"
        if not is_beam or _grid(cell) not in rays:
            continue
        octrees = (one for one in timed if one.structure == "beam" and _view(one) == _view(cell))
        octree = min(octrees, key=_whole, default=None)
        rows.append(GridBeamRow(cell, rays[_grid(cell)], octree))
    return rows


def grid_beams_section(cells: Iterable[Cell]) -> Section | None:
    """Returns the section, scene by scene; None if nothing was measured."""
    rows = grid_beam_rows(cells)
    if not rows:
        return None
    ordered = sorted(rows, key=lambda row: (row.beams.scene, row.beams.rays))
    table = section_table(
        "Beams through a hierarchy of grids",
        ("scene", "resolution"),
        (
            "single rays, ms",
            "beams, ms",
            "rays over beams",
            "grids with building, ms",
            "octree with building, ms",
            "octree's level",
            "octree over grids",
        ),
        [_fields(row) for row in ordered],
    )
    return Section(
        "grid-beams", "Beams through a hierarchy of grids", (_WORDS,), (table,), (), _findings(rows)
    )


def _findings(rows: Sequence[GridBeamRow]) -> tuple[str, ...]:
    ratios = sorted(row.ratio for row in rows)
    never = sum(ratio >= 1 for ratio in ratios)
    found = [
        f"Beams take no more time than single rays through the same grids in {never} of "
        f"{len(rows)} rows ({number(ratios[0])} to {number(ratios[-1])} times as fast, without "
        "intervals)."
    ]
    octrees = [ratio for row in rows if (ratio := row.octree_ratio) is not None]
    if octrees:
        faster = sum(ratio > 1 for ratio in octrees)
        found.append(
            f"Building included, beams through grids take less time than beams through the fastest "
            f"measured octree in {faster} of {len(octrees)} rows ({number(min(octrees))} to "
            f"{number(max(octrees))} times as fast, without intervals)."
        )
    return tuple(found)


def _fields(row: GridBeamRow) -> tuple[str, ...]:
    octree = row.octree
    ratio = row.octree_ratio
    return (
        scene_title(row.beams.scene),
        row.beams.resolution,
        milliseconds(row.rays.trace),
        milliseconds(row.beams.trace),
        number(row.ratio),
        milliseconds(_whole(row.beams)),
        "" if octree is None else milliseconds(_whole(octree)),
        "" if octree is None else octree.parameters.get("max_level", ""),
        "" if ratio is None else number(ratio),
    )


def _grid(cell: Cell) -> tuple[object, ...]:
    """Returns everything that determines the grids and the rays."""
    names = "resolution density inner_density shape max_objects max_level divide assign"
    grids = tuple(cell.parameters.get(name) for name in names.split())
    return *_view(cell), grids


def _view(cell: Cell) -> tuple[object, ...]:
    return cell.scene, cell.resolution, cell.samples


def _whole(cell: Cell) -> float:
    assert cell.time is not None  # only such cells are compared
    return cell.time.value
