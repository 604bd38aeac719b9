"""Tile beams beside Embree's fastest mode, as the texts on them state it."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from beambench.analysis import Ratio, geometric_mean
from beambench_operations.publish.figures.formats import brief
from beambench_report.base.records import read_run
from beambench_report.embree_comparison.pairings import Pairing, pairings
from beambench_report.embree_comparison.report import outcome, outcomes
from beambench_report.embree_comparison.targets import Group, groups, part_of_targets


@dataclass(frozen=True)
class Against:
    """A ratio beside its target."""

    ratio: Ratio
    target: float | None
    outcome: str
    """`met`, `missed`, `open`; empty without a target."""

    @property
    def marked(self) -> str:
        """The ratio, bold where it is below its target, in italics where that is open."""
        mark = {"missed": "**", "open": "*"}.get(self.outcome, "")
        return f"{mark}{brief(self.ratio)}{mark}"


def read_pairings(folder: Path, names: Sequence[str]) -> list[Pairing]:
    """Of those runs of a folder that are there."""
    runs = [folder / name for name in names]
    return pairings(read_run(run) for run in runs if (run / "results.csv").is_file())


def figures_of(found: Sequence[Pairing]) -> dict[str, Any]:
    """The groups of scenes by title, with their ratios at each resolution, and the counts."""
    of_groups, of_groups_limited = (
        {group.title: own for group in groups() if (own := _of_group(group, found, isa))["rows"]}
        for isa in ("best", "avx2")
    )
    return {
        "groups": of_groups,
        "avx2": of_groups_limited,
        "targets": _counts(found, "best"),
        "targets_avx2": _counts(found, "avx2"),
    }


def _of_group(group: Group, found: Sequence[Pairing], isa: str) -> dict[str, Any]:
    part = part_of_targets(isa)
    at = {
        (one.scene, one.resolution): one
        for one in found
        if group.holds(one) and one.isa == isa and one.samples == 1
    }
    sizes = [size for size in group.targets if any(size == there for _, there in at)]
    rows = {
        title: {
            size: _against(at[scene, size].ratio, part * group.targets[size])
            for size in sizes
            if (scene, size) in at
        }
        for scene, title in group.scenes.items()
        if any(scene == there for there, _ in at)
    }
    means = {
        size: [at[scene, size] for scene in group.scenes if (scene, size) in at] for size in sizes
    }
    mean_targets = {  # none where scenes are missing
        size: part * target
        for size, target in group.mean_targets.items()
        if len(means.get(size, ())) == len(group.scenes)
    }
    return {
        "sizes": sizes,
        "rows": rows,
        "targets": {size: part * group.targets[size] for size in sizes},
        "mean": {
            size: _against(geometric_mean([one.ratio for one in own]), mean_targets.get(size))
            for size, own in means.items()
        },
        "second": {
            size: geometric_mean([one.second_ratio for one in own if one.second_ratio])
            for size, own in means.items()
            if any(one.second_ratio for one in own)
        },
    }


def _against(ratio: Ratio, target: float | None) -> Against:
    return Against(ratio, target, "" if target is None else outcome(ratio, target))


def _counts(found: Sequence[Pairing], isa: str) -> dict[str, int]:
    """How many targets of single scenes are met, open and missed."""
    single = [one for one in found if one.isa == isa and one.samples == 1]
    counts = outcomes(single, part_of_targets(isa))
    return {"all": counts.total()} | {name: counts[name] for name in ("met", "open", "missed")}
