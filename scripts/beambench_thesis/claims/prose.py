"""Rules for claims that the thesis makes in prose only, without a table or a figure.

Such sentences have few figures, if any. Each rule states what it takes words such as "few" or
"nearly all" to mean. Octrees have level 6, as everywhere that the thesis does not vary it.
"""

from collections.abc import Iterable
from dataclasses import replace
from itertools import combinations, product
from math import inf

from beambench_report.base.published import rays
from beambench_thesis.claims.chapter5 import ALL_SCENES, ON_OCTREES
from beambench_thesis.claims.comparisons import SAMETS, beats, difference, most, ratio_of
from beambench_thesis.claims.verdict import Check, Claims, Outcome, Question, below, between
from beambench_thesis.paper.evidence import (
    HIERARCHY,
    PICTURE,
    PLAIN_HIERARCHY,
    Evidence,
    Measured,
    largest,
    share,
    smallest,
    total,
)

PROSE_CLAIMS = Claims()

_SAMPLED = ("bola-espacial", "caracol", "tetera", "torre-eiffel")
_BESIDE_HIERARCHIES = ("escena1", "escena2", "tetera", "bola-espacial")


def _left_over(e: Evidence, cells: Iterable[tuple[str, str]], bound: float) -> list[Check]:
    """Checks the samples of beams that end at an occupied leaf, in each scene and resolution.

    At most the share `bound` of these samples may hit nothing there and continue as rays.
    """
    return [
        between(
            f"{scene} {resolution}, part of the samples that continues as rays",
            ratio_of(
                e.worked("rays_after_leaf", scene, resolution),
                e.worked("samples_in_leaves", scene, resolution),
            ),
            0,
            bound,
        )
        for scene, resolution in cells
    ]


@PROSE_CLAIMS.claim(
    "C25",
    "5.4.2",
    "In bola-espacial nearly all rays hit an object in the occupied leaf where their beam ends.",
    Question.WORK,
    quantity="of these samples",
)
def rays_hit_where_their_beam_ends(e: Evidence) -> list[Check]:
    """Nearly all means 90% or more, at each resolution."""
    return _left_over(e, product(("bola-espacial",), e.resolutions), 0.1)


@PROSE_CLAIMS.claim(
    "C26",
    "3.6.2",
    "The rays of a beam that hit nothing in its occupied leaf and have to be traced on are few.",
    Question.WORK,
    quantity="of these samples",
)
def few_rays_are_left_over(e: Evidence) -> list[Check]:
    """Few means less than half of the samples, in each scene at 1280x1024."""
    return _left_over(e, product(ALL_SCENES, (e.finest,)), 0.5)


@PROSE_CLAIMS.claim(
    "C27",
    "6.2.1",
    "With a fitting octree, taking beams through it is no more than 10% of the whole time.",
    Question.WORK,
    quantity="of the time",
)
def walking_takes_little(e: Evidence) -> list[Check]:
    """Holds in each scene at 1280x1024: the section is about high resolutions."""
    return [
        between(
            f"{scene} {e.finest}, share of non-terminal beams",
            e.share_of_time("nonterminal", scene, e.finest),
            0,
            0.1,
        )
        for scene in ALL_SCENES
    ]


@PROSE_CLAIMS.claim(
    "C28",
    "5.3.3",
    "Beams that leave the scene are never the critical task.",
    Question.WORK,
    quantity="times as long",
)
def leaving_is_never_critical(e: Evidence) -> list[Check]:
    """Another task takes longer in each scene, at the lowest and at the highest resolution."""

    def critical(scene: str, resolution: str) -> Check:
        leaving, *others = (
            e.worked(f"seconds_{task}", scene, resolution)
            for task in ("leaving", "nonterminal", "occupied")
        )
        known = [seconds for seconds in others if seconds is not None]
        longest = largest(known) if len(known) == len(others) else None
        return below(f"{scene} {resolution}, leaving below the longest task", leaving, longest)

    return [
        critical(scene, resolution)
        for scene, resolution in product(ALL_SCENES, (e.coarsest, e.finest))
    ]


@PROSE_CLAIMS.claim(
    "C29",
    "5.4.1",
    "The gain of Samet-Net over Samet, and of the beams over both, grows with the resolution.",
    Question.BEAMS_OR_RAYS,
    quantity=None,
)
def gains_grow_with_the_resolution(e: Evidence) -> list[Check]:
    """Compares 320x200 with 1280x1024. The gain of Samet-Net is the seconds saved, since the reason
    given is that more rays use the links; scenes in which it is not faster at 1280x1024 disagree.
    The gain of the beams is a ratio of times.
    """

    def saves_more(scene: str) -> Check:
        cell = f"{scene}, seconds that samet-net saves"
        check = below(cell, saved(scene, e.coarsest), saved(scene, e.finest))
        gain = beats(e, scene, "samet-net", "samet")
        no_gain = gain.outcome is Outcome.NO
        return replace(gain, cell=f"{cell}, if any at {e.finest}") if no_gain else check

    def saved(scene: str, resolution: str) -> Measured | None:
        return difference(
            e.time(scene, "samet", resolution), e.time(scene, "samet-net", resolution)
        )

    def ratio(scene: str, other: str, resolution: str) -> Measured | None:
        return ratio_of(e.time(scene, other, resolution), e.time(scene, "beam", resolution))

    return [
        *(saves_more(scene) for scene in ON_OCTREES),
        *(
            below(
                f"{scene}, {other} over beam",
                ratio(scene, other, e.coarsest),
                ratio(scene, other, e.finest),
            )
            for scene, other in product(ON_OCTREES, ("samet", "samet-net"))
        ),
    ]


@PROSE_CLAIMS.claim(
    "C30",
    "3.1",
    "Primary rays are generally more than secondary (reflected, refracted) ones.",
    Question.WORK,
    quantity="times as many",
    untestable="The thesis's materials are lost; the stand-ins have materials of beambench's own, "
    "which determine the secondary rays.",
)
def secondary_rays_are_fewer(e: Evidence) -> list[Check]:
    """Generally means in more than half of the fifteen scenes, and in all of them together."""
    counts = {
        scene: tuple(
            e.worked(kind, scene, contender=PICTURE) for kind in ("eye_rays", "secondary_rays")
        )
        for scene in ALL_SCENES
    }
    known = {scene: pair for scene, pair in counts.items() if None not in pair}
    shares = {scene: share(*pair) for scene, pair in known.items()}
    everything = [total(kind) for kind in zip(*known.values(), strict=True)]
    complete = len(known) == len(ALL_SCENES)
    primary, secondary = everything if complete else (None, None)
    return [
        most("scenes whose primary rays are more than half", shares, 0.5, len(ALL_SCENES)),
        below("secondary rays below primary rays, all scenes together", secondary, primary),
    ]


@PROSE_CLAIMS.claim(
    "C31",
    "6.2.2",
    "The shadow cache succeeds more often where pixels are grouped in beams.",
    Question.PARALLEL,
    quantity="times as often",
)
def shadow_cache_gains_from_beams(e: Evidence) -> list[Check]:
    """In each scene, the cache finds more hidden shadow rays if pixels are shaded beam by beam
    than if they are shaded along the rows.
    """
    checks = []
    for scene in ALL_SCENES:
        hidden = e.worked("shadow_hidden", scene, contender=PICTURE)
        if hidden is not None and hidden.value == 0:
            continue
        known = (
            ratio_of(e.worked(f"shadow_cached_{order}", scene, contender=PICTURE), hidden)
            for order in ("scan", "beams")
        )
        checks.append(below(f"{scene}, cached part of hidden shadow rays, rows to beams", *known))
    return checks or [Check("scenes with hidden shadow rays", Outcome.MISSING)]


def _gain(e: Evidence, scene: str, resolution: str = "", samples: int = 1) -> Measured | None:
    """Returns Samet's time over the beams' time."""
    return ratio_of(
        e.time(scene, "samet", resolution, samples=samples),
        e.time(scene, "beam", resolution, samples=samples),
    )


def _leaving(e: Evidence, scene: str) -> Measured | None:
    """Returns the share of the pixels that belong to exit beams at the highest resolution."""
    pixels = e.count("exit_pixels", scene)
    return pixels.times(1 / rays(e.finest)) if pixels is not None else None


@PROSE_CLAIMS.claim(
    "C32",
    "7.2.3",
    "Basically, the gain of beams comes from those that leave the scene without meeting an "
    "occupied leaf.",
    Question.BEAMS_OR_RAYS,
    quantity="of what is saved",
)
def gains_come_from_exit_beams(e: Evidence) -> list[Check]:
    """In each of the six scenes, exit beams account for at least half of the time that is saved.

    The saving is that of beams over Samet's rays; a pixel of an exit beam saves a ray of mean cost.
    """

    def share_of_gain(scene: str) -> Measured | None:
        rays_take, beams_take = e.time(scene, "samet"), e.time(scene, "beam")
        leaving = _leaving(e, scene)
        if rays_take is None or beams_take is None or leaving is None:
            return None
        saved = rays_take - beams_take
        part = rays_take.times(leaving.value)
        return part / saved if saved.low > 0 else Measured(0.0, 0.0, inf)

    return [
        between(f"{scene}, exit beams' part of what is saved", share_of_gain(scene), 0.5, inf)
        for scene in ON_OCTREES
    ]


@PROSE_CLAIMS.claim(
    "C33",
    "7.2.3",
    "The gain of beams grows with the free space of the scene, through which many beams pass "
    "without meeting an occupied leaf.",
    Question.BEAMS_OR_RAYS,
    quantity="times the gain",
)
def gains_grow_with_free_space(e: Evidence) -> list[Check]:
    """In each pair of the six scenes, the scene with more pixels in exit beams gains more."""
    shares = {scene: _leaving(e, scene) for scene in ON_OCTREES}
    known = {scene: share.value for scene, share in shares.items() if share is not None}
    if len(known) < len(shares):
        return [Check("pixels of exit beams in six scenes", Outcome.MISSING)]
    ordered = sorted(known, key=lambda scene: known[scene])
    return [
        below(
            f"gain of {less} ({known[less]:.0%} of pixels in exit beams) below that of {more} "
            f"({known[more]:.0%})",
            _gain(e, less),
            _gain(e, more),
        )
        for less, more in combinations(ordered, 2)
    ]


@PROSE_CLAIMS.claim(
    "C34",
    "7.2.4",
    "The gain of beams over single rays grows with the samples per pixel.",
    Question.BEAMS_OR_RAYS,
    quantity="times the gain",
)
def gains_grow_with_the_samples(e: Evidence) -> list[Check]:
    """Compares gains over Samet's rays at 640x480, 5 samples with 1, in figure 5.11's scenes."""
    at = "640x480"
    return [
        below(
            f"{scene} {at}, samet over beam, 1 sample per pixel below 5",
            _gain(e, scene, at, 1),
            _gain(e, scene, at, 5),
        )
        for scene in _SAMPLED
    ]


@PROSE_CLAIMS.claim(
    "C35",
    "7.2.4",
    "Beams are hurt less than single rays by an octree of an unsuitable level.",
    Question.OCTREE,
    quantity="times the loss",
)
def beams_mind_the_level_less(e: Evidence) -> list[Check]:
    """The beams' time grows less from the best to the worst of levels 5 to 7 at 1280x1024."""

    def spread(scene: str, contender: str) -> Measured | None:
        by_level = e.times_by("level", scene, contender)
        times = [by_level[level] for level in (5, 6, 7) if level in by_level]
        if len(times) < 3:
            return None
        return max(times, key=lambda time: time.value) / smallest(times)

    return [
        below(
            f"{scene}, worst over best level, beam below {other}",
            spread(scene, "beam"),
            spread(scene, other),
        )
        for scene, other in product(("casa-de-campo", "gato-bill"), SAMETS)
    ]


@PROSE_CLAIMS.claim(
    "C36",
    "4.3, graphics 4.1, 4.2",
    "For closest hits Kay and Kajiya's priority queue suits a hierarchy better than the plain "
    "order of children.",
    Question.OTHER_STRUCTURES,
)
def the_queue_pays(e: Evidence) -> list[Check]:
    """The queue is quicker in each of the four scenes of tables 5.6 and 5.7, at each resolution."""
    return [
        beats(e, scene, HIERARCHY, PLAIN_HIERARCHY, resolution)
        for scene, resolution in product(_BESIDE_HIERARCHIES, e.resolutions)
    ]


@PROSE_CLAIMS.claim(
    "C37",
    "5.4.2, table 5.8",
    "Filling the grid's voxels takes most of its time where objects are many, since all objects "
    "are tested against each voxel.",
    Question.OTHER_STRUCTURES,
)
def filling_dominates(e: Evidence) -> list[Check]:
    """Filled lazily, the grid takes more than half as long at 320x200 as at 1280x1024."""
    return [
        below(
            f"{scene}, half of {e.finest} below {e.coarsest}",
            half.times(0.5) if (half := e.time(scene, "voxel-grid")) else None,
            e.time(scene, "voxel-grid", e.coarsest),
        )
        for scene in ("ajedrez", "flamenco", "habitacion")
    ]
