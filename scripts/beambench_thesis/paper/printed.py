"""The tables as the thesis prints them: parts, rows in their order, seconds."""

from dataclasses import dataclass
from functools import cache
from math import isnan

import pandas as pd

from beambench_report.base.published import RESOLUTIONS, read_published
from beambench_report.base.quantities import DASH, number
from beambench_thesis.paper.cells import Cell
from beambench_thesis.paper.evidence import Measured, Setting, setting

REFERENCES = ("sah-bvh", "embree")
"""Contenders of today, which the thesis's tables do not have."""

_NAMES = {
    "beam": "beams (Tr. Haces)",
    "samet": "Samet",
    "samet-net": "Samet-Net",
    "voxel-grid": "voxel grid (Matriz Voxel)",
    "goldsmith-salmon": "hierarchy (Bounding Box)",
}
# All other scenes have their capitalized names.
_SCENES = {
    "escena1": "Escena 1",
    "escena2": "Escena 2",
    "habitacion": "Habitación",
    "bola-espacial": "Bola espacial",
    "torre-eiffel": "Torre Eiffel",
    "casa-de-campo": "Casa de Campo",
    "gato-bill": "Gato-Bill",
} | {
    name: name.capitalize()
    for name in "maceta delfines misil tetera stetra ajedrez caracol flamenco".split()
}


@dataclass(frozen=True)
class PrintedRow:
    """A row: the contender, and seconds by resolution."""

    label: str
    structure: str
    level: int
    objects: int
    seconds: dict[str, float]

    def setting(self, scene: str, resolution: str) -> Setting:
        """Returns the setting of one of its cells."""
        varied = {"level": self.level, "objects": self.objects}
        return setting(scene, self.structure, resolution, **varied)


@dataclass(frozen=True)
class PrintedPart:
    """Part (a), (b), ... of a table, for one scene."""

    table: str
    letter: str
    scene: str
    rows: tuple[PrintedRow, ...]

    @property
    def title(self) -> str:
        """Returns `(a) Maceta`."""
        return f"({self.letter}) {scene_title(self.scene)}"

    @property
    def structures(self) -> list[str]:
        """Returns the structures of its rows, each once."""
        return list(dict.fromkeys(row.structure for row in self.rows))

    @property
    def base(self) -> float | None:
        """Returns the seconds of the first row at 320x200, to which shapes are relative."""
        return self.rows[0].seconds.get(RESOLUTIONS[0])


def scene_title(scene: str) -> str:
    """Returns the thesis's name of a scene."""
    return _SCENES.get(scene, scene)


def title_of(name: str) -> str:
    """Returns the thesis's name of `escena1:seed=1999`; names of other scenes are unchanged."""
    plain = name.split(":")[0]
    return scene_title(plain) if plain in _SCENES else name


def contender_title(structure: str) -> str:
    """Returns the name of a contender in the thesis's tables, in English."""
    return _NAMES.get(structure, structure)


@cache
def printed_parts() -> tuple[PrintedPart, ...]:
    """Returns all parts of all tables, in the order of the thesis."""
    rows = read_published("times.csv")
    rows["resolution"] = rows["width"].astype(str) + "x" + rows["height"].astype(str)
    rows[["max_level", "max_objects"]] = rows[["max_level", "max_objects"]].fillna(0).astype(int)
    return tuple(
        PrintedPart(table, letter, group["scene"].iloc[0], _rows(table, group))
        for (table, letter), group in rows.groupby(["table", "part"], sort=False)
    )


def parts_of(table: str) -> list[PrintedPart]:
    """Returns the parts of one table."""
    return [part for part in printed_parts() if part.table == table]


def _rows(table: str, rows: pd.DataFrame) -> tuple[PrintedRow, ...]:
    keys = ["algorithm", "max_level", "max_objects"]
    return tuple(
        PrintedRow(
            _label(table, structure, level, objects),
            structure,
            level,
            objects,
            dict(zip(group["resolution"], group["seconds"], strict=True)),
        )
        for (structure, level, objects), group in rows.groupby(keys, sort=False)
    )


def _label(table: str, structure: str, level: int, objects: int) -> str:
    if table == "5.2":
        return f"level {level}, {objects} objects"
    return f"level {level}" if table == "5.3" else contender_title(structure)


# Figures as the report shows them, in Markdown and on the page


def milliseconds(seconds: float) -> str:
    """Returns `43.9 ms`; long times have the same unit."""
    return f"{number(1e3 * seconds)} ms"


def thesis_seconds(seconds: float | None) -> str:
    """Returns `2.21 s`, as printed."""
    return DASH if seconds is None else f"{seconds:,g} s"


def interval(figure: Measured, factor: float = 1e3, unit: str = " ms") -> str:
    """Returns `43.1 to 45.0 ms`, or a dash without an interval."""
    if isnan(figure.low):
        return DASH
    return f"{number(factor * figure.low)} to {number(factor * figure.high)}{unit}"


def origin(cell: Cell) -> str:
    """Returns the origin of a figure: row, file, cell, repetitions and verdict."""
    time = f"; {interval(cell.time)}" if cell.time else ""
    return (
        f"row {cell.number}: {cell.run}/results.csv, line {cell.line}; {cell.name}; "
        f"{cell.repetitions} repetitions{time}; verdict {cell.verdict}"
    )
