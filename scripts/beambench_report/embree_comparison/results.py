"""The ratios and geometric means of each group of scenes, with their targets."""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from beambench.analysis import Ratio, geometric_mean
from beambench_report.embree_comparison.pairings import Pairing, headlines
from beambench_report.embree_comparison.targets import Group, groups, part_of_targets


@dataclass(frozen=True)
class Result:
    """A ratio, or the geometric mean of several, with its target."""

    ratio: Ratio
    target: float | None = None
    """The target; None if no target is set, or if a scene is missing from the mean."""
    is_culled: bool = False
    """Whether `tile-beam` was only measured without the backs of solids."""
    scenes: int = 1

    @property
    def outcome(self) -> str:
        """Returns `met`, `missed` or `open`; empty without a target.

        A ratio that relies on closed solids can miss a target, but not meet it.
        """
        if self.target is None:
            return ""
        found = outcome(self.ratio, self.target)
        return "open" if found == "met" and self.is_culled else found


@dataclass(frozen=True)
class GroupResults:
    """The results of one group by resolution, for single scenes and as means."""

    group: Group
    sizes: tuple[str, ...]
    scenes: Mapping[str, Mapping[str, Result]]
    """The results by scene title and resolution."""
    means: Mapping[str, Result]
    """The means of the first traces over the scenes."""
    second: Mapping[str, Result]
    """The means of the second traces."""
    culled: Mapping[str, Result]
    """The means of first traces without the backs of solids, if `means` includes the backs."""


def outcome(ratio: Ratio, target: float) -> str:
    """Returns `met`, `missed`, or `open` if the interval contains the target or is missing."""
    if ratio.interval is None:
        return "open"
    low, high = ratio.interval
    if low >= target:
        return "met"
    return "open" if high >= target else "missed"


def outcomes_in_words(every: Sequence[GroupResults]) -> str:
    """Counts the targets of single scenes and of means that are met, open and missed."""
    parts = []
    for what, shown in (
        (
            "single scenes",
            [one for own in every for row in own.scenes.values() for one in row.values()],
        ),
        ("geometric means", [one for own in every for one in own.means.values()]),
    ):
        counts = Counter(one.outcome for one in shown if one.target is not None)
        if counts:
            parts.append(
                f"for {what}, {counts['met']} of {counts.total()} are met, {counts['open']} open "
                f"and {counts['missed']} missed"
            )
    return "; ".join(parts)


def results(found: Iterable[Pairing], isa: str) -> list[GroupResults]:
    """Returns the groups of which some scene was measured with that instruction set."""
    own = [one for one in found if one.isa == isa and one.samples == 1]
    every = (_of_group(group, own, part_of_targets(isa)) for group in groups())
    return [one for one in every if one.scenes]


def _of_group(group: Group, found: Sequence[Pairing], part: float) -> GroupResults:
    held = [one for one in found if group.holds(one)]
    shown = headlines(held)
    sizes = tuple(size for size in group.targets if any(one.resolution == size for one in shown))
    scenes = {
        title: {
            one.resolution: Result(one.ratio, part * group.targets[one.resolution], one.is_culled)
            for one in shown
            if one.scene == scene
        }
        for scene, title in group.scenes.items()
    }
    targets = {size: part * target for size, target in group.mean_targets.items()}
    drawn = {one.resolution for one in shown if not one.is_culled}
    culled = [one for one in held if one.is_culled and one.resolution in drawn]
    return GroupResults(
        group,
        sizes,
        {title: own for title, own in scenes.items() if own},
        _means(group, shown, lambda one: one.ratio, targets),
        _means(group, shown, lambda one: one.second_ratio),
        {
            size: replace(mean, is_culled=False)
            for size, mean in _means(group, culled, lambda one: one.ratio).items()
        },
    )


def _means(
    group: Group,
    found: Sequence[Pairing],
    ratio_of: Callable[[Pairing], Ratio | None],
    targets: Mapping[str, float] | None = None,
) -> dict[str, Result]:
    """Returns the geometric mean at each resolution, with the backs of solids if that was measured.

    A mean over only some of the scenes has no target.
    """
    means = {}
    for size in group.targets if len(group.scenes) > 1 else ():
        every = [one for one in found if one.resolution == size]
        own = [one for one in every if not one.is_culled] or every
        ratios = [ratio for one in own if (ratio := ratio_of(one))]
        if ratios:
            whole = len(ratios) == len(group.scenes)
            target = (targets or {}).get(size) if whole else None
            is_culled = any(one.is_culled for one in own)
            means[size] = Result(geometric_mean(ratios), target, is_culled, len(ratios))
    return means
