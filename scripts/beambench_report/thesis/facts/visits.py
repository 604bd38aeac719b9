"""How often rays and beams come to the nodes of an octree, by level: the thesis's reason for 6."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from beambench_report.quantities import number
from beambench_report.thesis.printed import scene_title
from beambench_report.thesis.section import Column, Field, Section, SectionTable
from beambench_report.thesis.texts import DASH

SCENES = ("maceta", "delfines")
ACCEL = "beam:max_level=8,max_objects=0"
_SIX = 6

_WORDS = (
    "Section 5.3.1 takes level 6 from McNeill et al. (1992): from the sixth level on, a ray is "
    "very unlikely to visit a given node, so that beams would have few rays. Counted here over "
    "octrees of level 8: nodes that rays pass through up to their first hit, each ray by itself, "
    "and leaves that beams come to. Deeper leaves exist only around the surfaces."
)


@dataclass(frozen=True)
class Level:
    """One level of an octree and who came to it."""

    level: int
    nodes: int
    leaves: int
    occupied_leaves: int
    node_visits: int
    leaf_visits: int
    beams: int

    @property
    def rays_a_node(self) -> float:
        """Rays that visit a node, on average."""
        return self.node_visits / self.nodes


def visits_file(directory: Path, scene: str) -> Path:
    """What `beambench stats --levels --json` printed."""
    return directory / "visits" / f"{scene}.json"


def visits_section(directory: Path) -> Section | None:
    """A table a scene; None where no visits were counted."""
    read = {scene: _read(visits_file(directory, scene)) for scene in SCENES}
    known = {scene: found for scene, found in read.items() if found is not None}
    if not known:
        return None
    return Section(
        "visits",
        "Visits by level",
        (_WORDS,),
        tuple(_table(scene, *found) for scene, found in known.items()),
        findings=tuple(
            sentence
            for scene, found in known.items()
            for sentence in (_finding(scene, *found),)
            if sentence
        ),
    )


def _read(path: Path) -> tuple[int, list[Level]] | None:
    """The number of rays, and the levels that have nodes."""
    try:
        source = json.loads(path.read_text("utf-8"))
        (structure,) = source["structures"]
        return int(source["rays"]), [Level(**level) for level in structure["levels"]]
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _table(scene: str, rays: int, levels: list[Level]) -> SectionTable:
    heads = (
        "level",
        "nodes",
        "rays that visit a node",
        "of all rays",
        "leaves",
        "occupied",
        "visits of leaves by rays",
        "by beams",
    )
    rows = tuple(
        tuple(
            Field(text)
            for text in (
                f"{level.level}",
                f"{level.nodes:,}",
                number(level.rays_a_node),
                f"{level.rays_a_node / rays:.3%}",
                *(
                    f"{count:,}" if count else DASH
                    for count in (
                        level.leaves,
                        level.occupied_leaves,
                        level.leaf_visits,
                        level.beams,
                    )
                ),
            )
        )
        for level in levels
    )
    title = f"{scene_title(scene)}, {ACCEL}, {rays:,} rays"
    return SectionTable(title, tuple(Column(head) for head in heads), rows)


def _finding(scene: str, rays: int, levels: list[Level]) -> str:
    """How visits fall around level 6."""
    by_level = {level.level: level for level in levels}
    wanted = [by_level[level] for level in (_SIX - 1, _SIX, _SIX + 1) if level in by_level]
    if len(wanted) < 3:
        return ""
    before, six, after = (level.rays_a_node for level in wanted)
    title = scene_title(scene)
    return (
        f"{title}: a node of level {_SIX} is visited by {number(six)} of {rays:,} rays on average "
        f"({six / rays:.2%}), one of level {_SIX - 1} by {number(before / six)} times as many, one "
        f"of level {_SIX + 1} by {number(six / after)} times fewer."
    )
