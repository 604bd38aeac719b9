"""The Pareto front of a view by build and trace, and the ray counts where each member is best.

Build times and times per ray are from the run's analysis.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from beambench.analysis import break_even_rays
from beambench_report.base.analysis import Analysis, Standing, Standings


@dataclass(frozen=True)
class Choice:
    """A contender that is the best for some number of rays, its build included."""

    rays: float
    """The ray count from which the contender is best; 0 for the first choice."""
    standing: Standing


@dataclass(frozen=True)
class Front:
    """The contenders of a view that no other contender beats in both build and trace."""

    view: Standings
    members: tuple[Standing, ...]
    """The members by build time, the shortest first."""
    choices: tuple[Choice, ...]
    """The members that are best for some number of rays, in the order of that number."""

    @property
    def scene(self) -> str:
        """Returns the subject of the view without the kind of rays."""
        return self.view.subject.removesuffix(f", {self.view.ray_kind} rays")

    @property
    def others(self) -> tuple[Standing, ...]:
        """Returns the contenders that are not on the front."""
        return tuple(one for one in self.view.ranked if one not in self.members)

    @property
    def never(self) -> tuple[Standing, ...]:
        """Returns the members that are not the best choice for any number of rays."""
        chosen = [choice.standing for choice in self.choices]
        return tuple(one for one in self.members if one not in chosen)


def fronts(analysis: Analysis) -> list[Front]:
    """Returns the front of each view with contenders, in the order of the run."""
    found = []
    for view in analysis.views:
        if view.ranked:
            members = front_of(view.ranked)
            found.append(Front(view, members, choices_of(members)))
    return found


def pareto_front(points: Sequence[tuple[float, float]]) -> list[int]:
    """Returns the indices of undominated points, ordered by the first coordinate.

    Of points in the same place, the first is returned.
    """
    front: list[int] = []
    for index in sorted(range(len(points)), key=lambda i: points[i]):
        if not front or points[index][1] < points[front[-1]][1]:
            front.append(index)
    return front


def front_of(standings: Sequence[Standing]) -> tuple[Standing, ...]:
    """Returns the Pareto front of build and trace, the shortest build first."""
    places = pareto_front([(one.build_ms, one.ns_per_ray) for one in standings])
    return tuple(standings[place] for place in places)


def choices_of(front: Sequence[Standing]) -> tuple[Choice, ...]:
    """Returns the contenders that are best for some number of rays, in the order of that number.

    Each is followed by the first contender that overtakes it; if several do so at the same number,
    by the fastest of them.
    """
    choices = [Choice(0.0, front[0])]
    while later := front[front.index(choices[-1].standing) + 1 :]:
        since = [_break_even(one, choices[-1].standing) for one in later]
        first = min(range(len(later)), key=lambda place: (since[place], -place))
        choices.append(Choice(since[first], later[first]))
    return tuple(choices)


def _break_even(one: Standing, other: Standing) -> float:
    return break_even_rays(one.build_ms, one.ns_per_ray, other.build_ms, other.ns_per_ray)
