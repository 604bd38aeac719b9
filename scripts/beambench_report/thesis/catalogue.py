"""The tables and figures of chapter 5, and the sweeps of harness/sweeps/thesis that serve each.

Every cell is measured by one sweep only: tables and figures that show the same cell share it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Table:
    """A table of the thesis; in the `best` sweeps its contenders look for their own best."""

    number: str
    title: str
    first: tuple[str, ...]
    best: tuple[str, ...]


@dataclass(frozen=True)
class Figure:
    """A figure of the thesis and the sweeps whose cells it draws."""

    number: str
    title: str
    sweeps: tuple[str, ...]


_OTHERS = ("others-small", "others-large")

TABLES = (
    Table(
        "5.2",
        "Results as more objects may lie in a leaf",
        ("division",),
        ("best-division",),
    ),
    Table(
        "5.3",
        "Results as the octree becomes deeper",
        ("division",),
        ("best-division",),
    ),
    Table(
        "5.4",
        "Total time: beams and single rays on the same octree, synthetic scenes",
        ("synthetic",),
        ("best-synthetic",),
    ),
    Table(
        "5.5",
        "Total time: beams and single rays on the same octree, real scenes",
        ("octree",),
        ("best-octree", "shallow"),
    ),
    Table(
        "5.6",
        "Total time: beams, voxel grid and bounding boxes, synthetic scenes",
        ("synthetic",),
        ("best-synthetic",),
    ),
    Table(
        "5.7",
        "Total time: beams, voxel grid and bounding boxes, a thousand polygons",
        ("others-small",),
        ("best-others-small",),
    ),
    Table(
        "5.8",
        "Total time: beams, voxel grid and bounding boxes, ten thousand polygons and more",
        ("others-large",),
        ("best-others-large",),
    ),
)

FIGURES = (
    Figure("5.4", "Octrees of Maceta by different criteria of division", ("division",)),
    Figure("5.5", "Octrees of Delfines by different criteria of division", ("division",)),
    Figure("5.6", "Total time by the objects that may lie in a leaf", ("division",)),
    Figure("5.7", "Total time by the level of the octree", ("division",)),
    Figure("5.8", "Time of the beams in Escena 1 and Escena 2", ("synthetic",)),
    Figure(
        "5.9",
        "The octrees of Bola espacial, Caracol, Tetera and Torre Eiffel",
        ("others-small", "quality"),
    ),
    Figure("5.10", "Time of the beams in four real scenes", ("others-small", "quality")),
    Figure(
        "5.11",
        "Increase of the time with five samples a pixel",
        ("others-small", "quality", "samples"),
    ),
    Figure("5.12", "Time in the scenes of table 5.4", ("synthetic",)),
    Figure("5.13", "Time in the scenes of table 5.5", ("octree",)),
    Figure(
        "5.14", "Time by the level that each contender has", ("octree", "best-octree", "shallow")
    ),
    Figure("5.15", "Time in the scenes of table 5.6", ("synthetic",)),
    Figure("5.16", "Time in the scenes of table 5.7", ("others-small",)),
    Figure("5.17", "Time of the grid by its cells an axis", ("others-large", "best-others-large")),
    Figure(
        "5.18",
        "Beams beside the grid at its best",
        ("others-large", "best-others-large", "grids"),
    ),
)

# In the order in which they are run: what the thesis did first.
SWEEPS = (
    "synthetic",
    "division",
    "octree",
    "others-small",
    "others-large",
    "quality",
    "samples",
    "best-synthetic",
    "best-division",
    "best-octree",
    "shallow",
    "best-others-small",
    "best-others-large",
    "grids",
)
