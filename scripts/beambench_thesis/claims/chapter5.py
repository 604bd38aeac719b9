"""The rules that decide by measurements whether the claims of the thesis's chapter 5 hold.

A rule returns one check for each cell of a table; `verdict.py` combines them into one verdict. Each
rule's docstring states its thresholds. Seconds include building the structure, and all structures
have the thesis's parameters: level 6, no objects in a leaf above the deepest level, 32 voxels per
axis, filled lazily, objects inserted into the hierarchy as given and as section 4.3 describes, Kay
and Kajiya's queue, no handover.
"""

from dataclasses import replace
from itertools import pairwise, product

from beambench_thesis.claims.comparisons import (
    SAMETS,
    any_of,
    beats,
    best_grid,
    best_ray,
    difference,
    formula,
    growing_share,
    grows_more,
    growth,
    is_linear,
    line_of,
    most,
    ratio_of,
    seconds_per_beam,
    slope,
)
from beambench_thesis.claims.verdict import Check, Claims, Question, aside, below, between
from beambench_thesis.paper.evidence import HIERARCHY, Evidence, Measured, smallest

CLAIMS = Claims()

_DIVISION = ("maceta", "delfines")
ON_OCTREES = ("escena1", "escena2", "casa-de-campo", "gato-bill", "misil", "stetra")
_CROWDED, _SPACIOUS = ("bola-espacial", "caracol"), ("tetera", "torre-eiffel")
_BY_COUNT = ("tetera", "bola-espacial", "flamenco", "ajedrez", "habitacion")
ALL_SCENES = tuple(
    "escena1 escena2 delfines maceta habitacion misil bola-espacial tetera stetra torre-eiffel "
    "ajedrez caracol casa-de-campo flamenco gato-bill".split()
)


# 5.3.1: how the octree is divided


@CLAIMS.claim(
    "C01",
    "5.3.1, table 5.2",
    "At level 6, more objects per leaf make the beams slower from 640x480.",
    Question.OCTREE,
)
def more_objects_are_slower(e: Evidence) -> list[Check]:
    """The time rises at each step from 0 to 10, 20 and 40 objects, at each resolution."""
    return [
        below(
            f"{scene} {resolution}, {fewer} to {more} objects",
            e.time(scene, "beam", resolution, objects=fewer),
            e.time(scene, "beam", resolution, objects=more),
        )
        for scene, resolution in product(_DIVISION, e.finer)
        for fewer, more in pairwise((0, 10, 20, 40))
    ]


@CLAIMS.claim(
    "C02",
    "5.3.1, table 5.2",
    "More objects per leaf leave fewer occupied leaves and far fewer pixels in exit beams.",
    Question.OCTREE,
    quantity="times as many",
)
def more_objects_leave_fewer_exits(e: Evidence) -> list[Check]:
    """Both numbers fall at each step; "far fewer": at 40 objects, at most a tenth of those at 0."""
    steps = [
        below(
            f"{scene} {what.replace('_', ' ')}, {fewer} to {more} objects",
            e.count(what, scene, objects=more),
            e.count(what, scene, objects=fewer),
        )
        for scene, what in product(_DIVISION, ("occupied_leaves", "exit_pixels"))
        for fewer, more in pairwise((0, 10, 20, 40))
    ]
    return steps + [
        below(
            f"{scene} exit pixels, a tenth at 40 objects",
            e.count("exit_pixels", scene, objects=40),
            e.count("exit_pixels", scene, objects=0),
            factor=10,
        )
        for scene in _DIVISION
    ]


@CLAIMS.claim(
    "C03",
    "5.3.1, table 5.3",
    "A deeper octree helps up to level 6 and hurts at level 7, from 640x480.",
    Question.OCTREE,
)
def level_six_is_best(e: Evidence) -> list[Check]:
    """Level 5 is faster than level 4, and level 6 is faster than levels 5 and 7."""
    return [
        below(
            f"{scene} {resolution}, level {quicker} before {slower}",
            e.time(scene, "beam", resolution, level=quicker),
            e.time(scene, "beam", resolution, level=slower),
        )
        for scene, resolution in product(_DIVISION, e.finer)
        for quicker, slower in ((5, 4), (6, 5), (6, 7))
    ]


@CLAIMS.claim(
    "C04",
    "5.3.1, figure 5.7",
    "The slope of time over rays falls with every level, level 7 included.",
    Question.OCTREE,
)
def slopes_fall_with_the_level(e: Evidence) -> list[Check]:
    """Slopes are least squares over the five resolutions, in seconds for each 10,000 rays."""
    return [
        below(
            f"{scene}, level {deeper} flatter than {deeper - 1}",
            slope(line_of(e, scene, level=deeper)),
            slope(line_of(e, scene, level=deeper - 1)),
        )
        for scene, deeper in product(_DIVISION, (5, 6, 7))
    ]


@CLAIMS.claim(
    "C05",
    "5.3.1, table 5.3",
    "Pixels in exit beams grow with the level, and are more for delfines than for maceta.",
    Question.OCTREE,
    quantity="times as many",
)
def exits_grow_with_the_level(e: Evidence) -> list[Check]:
    """Numbers rise at each step from level 4 to 7, and are larger for delfines at each level."""
    steps = [
        below(
            f"{scene} exit pixels, level {level} to {level + 1}",
            e.count("exit_pixels", scene, level=level),
            e.count("exit_pixels", scene, level=level + 1),
        )
        for scene, level in product(_DIVISION, (4, 5, 6))
    ]
    return steps + [
        below(
            f"level {level}, maceta below delfines",
            e.count("exit_pixels", "maceta", level=level),
            e.count("exit_pixels", "delfines", level=level),
        )
        for level in (4, 5, 6, 7)
    ]


# 5.3.2: more pixels, more samples


@CLAIMS.claim(
    "C06",
    "5.3.2, figure 5.8",
    "The beams' time is linear in the rays; relative growth is larger for escena1 than escena2.",
    Question.GROWTH,
    quantity="times the growth",
)
def time_is_linear(e: Evidence) -> list[Check]:
    """Linear means R2 of 0.99 or more. Growth is relative to the time at 320x200."""
    scenes = ("escena1", "escena2")
    return [
        *(is_linear(scene, line_of(e, scene)) for scene in scenes if len(e.resolutions) > 2),
        *grows_more(e, ("escena1",), ("escena2",)),
    ]


@CLAIMS.claim(
    "C07",
    "5.3.2, figure 5.10",
    "Relative growth is larger for bola-espacial and caracol than for tetera and torre-eiffel.",
    Question.GROWTH,
    quantity="times the growth",
)
def crowded_scenes_grow_more(e: Evidence) -> list[Check]:
    """Each crowded scene grows more than each spacious scene, at each resolution."""
    return grows_more(e, _CROWDED, _SPACIOUS)


@CLAIMS.claim(
    "C08",
    "5.3.2, figure 5.11",
    "With 5 samples per pixel the gap between crowded and spacious scenes widens.",
    Question.GROWTH,
    quantity="times the gap",
)
def samples_widen_the_gap(e: Evidence) -> list[Check]:
    """The difference between the growths of C07 is larger with 5 samples than with 1.

    With 5 samples, growth is relative to the time at 320x200 with 5 samples.
    """
    return [
        below(
            f"{crowded} and {spacious}, {resolution}",
            difference(*(growth(e, scene, resolution, 1) for scene in (crowded, spacious))),
            difference(*(growth(e, scene, resolution, 5) for scene in (crowded, spacious))),
        )
        for crowded, spacious, resolution in product(_CROWDED, _SPACIOUS, e.finer)
    ]


# 5.3.3: where the time goes


@CLAIMS.claim(
    "C09",
    "5.3.3",
    "Time spent on non-terminal beams does not depend on the resolution.",
    Question.WORK,
    quantity="times the least",
)
def nonterminal_time_is_constant(e: Evidence) -> list[Check]:
    """The maximum is less than 1.5 times the minimum while rays grow twentyfold."""
    checks = []
    for scene, level in dict.fromkeys((scene, level) for scene, level, _ in e.beam_cells):
        seconds = {
            resolution: e.worked("seconds_nonterminal", scene, resolution, level=level)
            for resolution in e.resolutions
        }
        known = [figure for figure in seconds.values() if figure is not None and figure.low > 0]
        # If the eye is in an occupied leaf, there are no such beams, and they take no time.
        if seconds[e.coarsest] not in known or seconds[e.finest] not in known:
            continue
        largest = max(known, key=lambda figure: figure.value)
        ratio = largest / smallest(known)
        where = f"{scene} level {level}, max/min over {len(known)} resolutions"
        checks.append(between(where, ratio, 1 / 1.5, 1.5))
    return checks


@CLAIMS.claim(
    "C10",
    "5.3.3",
    "maceta: 8,701 beams at level 6, 4,071 non-terminal; 37,718 and 17,751 at level 7. Their share "
    "of the time: 46% and 96% at 320x200, 60.8% at 1280x1024 and level 7.",
    Question.WORK,
    is_figures=True,
)
def beams_of_maceta(e: Evidence) -> list[Check]:
    """Counts the beams made by cutting, and how many of them were cut again.

    The thesis counts a beam when it is created by cutting another (section 4.4.2). A beam that lies
    wholly inside the next leaf is only placed there. A stand-in's counts should be within a factor
    of 2, its shares within 10 percentage points.
    """
    every, inner = "beams_made", "beams_divided"
    counts = {(every, 6): 8701, (inner, 6): 4071, (every, 7): 37718, (inner, 7): 17751}
    shares = {(6, "320x200"): 0.46, (7, "320x200"): 0.96, (7, "1280x1024"): 0.608}
    return [
        *(
            between(
                f"{what.replace('_', ' ')}, level {level}",
                e.worked(what, "maceta", level=level),
                count / 2,
                count * 2,
            )
            for (what, level), count in counts.items()
        ),
        *(
            between(
                f"share of non-terminal beams, level {level}, {resolution}",
                e.share_of_time("nonterminal", "maceta", resolution, level=level),
                share - 0.1,
                share + 0.1,
            )
            for (level, resolution), share in shares.items()
            if resolution in e.resolutions
        ),
    ]


@CLAIMS.claim(
    "C11",
    "5.3.3",
    "At 1280x1024 beams at occupied leaves take over 85% of the time in most scenes, 98% in "
    "bola-espacial, where 63% of all beams are of that kind.",
    Question.WORK,
    quantity=None,
)
def occupied_leaves_take_the_time(e: Evidence) -> list[Check]:
    """Most means more than half of the scenes.

    For bola-espacial, the share of the time is 95% or more, and the share of the beams 53% to 73%.
    All beams are those made by cutting.
    """
    beams = e.worked("share_of_beams_occupied", "bola-espacial")
    if beams is None:
        beams = ratio_of(
            e.worked("beams_occupied", "bola-espacial"), e.worked("beams_made", "bola-espacial")
        )
    shares = {scene: e.share_of_time("occupied", scene, e.finest) for scene in ALL_SCENES}
    growing = {scene: growing_share(e, scene) for scene in ALL_SCENES}
    return [
        most("scenes with over 85% at occupied leaves", shares, 0.85, len(ALL_SCENES)),
        between("bola-espacial, share of time", shares["bola-espacial"], 0.95, 1.0),
        between("bola-espacial, share of beams", beams, 0.53, 0.73),
        aside(
            most(
                "scenes with over 85% that grows with the rays (occupied leaves take no more)",
                growing,
                0.85,
                sum(share is not None for share in growing.values()),
            )
        ),
    ]


@CLAIMS.claim(
    "C12",
    "5.3.3",
    "Two cost formulas, of counts for each task, explain the time.",
    Question.WORK,
    quantity=None,
)
def formulas_explain_the_time(e: Evidence) -> list[Check]:
    """Fits to ten cells or more have an R2 of 0.9 or more and a median error below 25%."""
    return [
        *formula(e, "nonterminal", ("beams_nonterminal", "beam_clips", "neighbor_searches")),
        *formula(
            e,
            "occupied",
            ("beams_occupied", "samples_in_leaves", "primitive_tests", "traversal_steps"),
        ),
        aside(
            between(
                "maceta 320x200, seconds per non-terminal beam, level 7 over level 6 (one cost?)",
                ratio_of(seconds_per_beam(e, 7), seconds_per_beam(e, 6)),
                0.5,
                2.0,
            )
        ),
    ]


# 5.4.1: beams against rays on octrees


@CLAIMS.claim(
    "C13",
    "5.4.1, tables 5.4, 5.5",
    "At 1280x1024 the beams beat Samet and Samet-Net on the same octree in all six scenes.",
    Question.BEAMS_OR_RAYS,
)
def beams_win_at_high_resolution(e: Evidence) -> list[Check]:
    """Compares six scenes with two opponents each."""
    return [beats(e, scene, "beam", other) for scene, other in product(ON_OCTREES, SAMETS)]


def _rays_before_beams(e: Evidence, scene: str, resolution: str = "") -> Check:
    """Checks whether the better of Samet and Samet-Net is faster than the beams.

    The default is the coarsest resolution.
    """
    resolution = resolution or e.coarsest
    return below(
        f"{scene} {resolution}", best_ray(e, scene, resolution), e.time(scene, "beam", resolution)
    )


@CLAIMS.claim(
    "C14",
    "5.4.1, tables 5.4, 5.5",
    "At 320x200 individual rays can win (escena1, escena2, gato-bill, stetra).",
    Question.BEAMS_OR_RAYS,
    quantity=None,
)
def rays_can_win_at_low_resolution(e: Evidence) -> list[Check]:
    """Rays win in at least one scene of table 5.4 and in at least one scene of table 5.5."""
    synthetic, real = ON_OCTREES[:2], ON_OCTREES[2:]
    said = replace(
        _rays_before_beams(e, "gato-bill", "640x480"),
        cell="gato-bill 640x480 (also named in the text)",
    )
    return [
        any_of("rays win in a synthetic scene", [_rays_before_beams(e, s) for s in synthetic]),
        any_of("rays win in a real scene", [_rays_before_beams(e, scene) for scene in real]),
        aside(said),
    ]


@CLAIMS.claim(
    "C15", "5.4.1", "Samet-Net beats Samet in every scene and resolution.", Question.BEAMS_OR_RAYS
)
def links_pay(e: Evidence) -> list[Check]:
    """Compares six scenes at five resolutions each."""
    return [
        beats(e, scene, "samet-net", "samet", resolution)
        for scene, resolution in product(ON_OCTREES, e.resolutions)
    ]


@CLAIMS.claim(
    "C16",
    "5.4.1, figure 5.14",
    "At high resolution the beams win when Samet and Samet-Net have their own best level.",
    Question.BEAMS_OR_RAYS,
)
def beams_win_at_best_levels(e: Evidence) -> list[Check]:
    """Compares the best levels at 1280x1024; opponents need three measured levels or more."""
    checks = []
    for scene, other in product(("casa-de-campo", "gato-bill"), SAMETS):
        beams = list(e.times_by("level", scene, "beam").values())
        rays = list(e.times_by("level", scene, other).values())
        checks.append(
            below(
                f"{scene} {e.finest}, beam before {other}",
                smallest(beams) if beams else None,
                smallest(rays) if len(rays) >= 3 else None,
            )
        )
    return checks


# 5.4.2: other structures


@CLAIMS.claim(
    "C17",
    "5.4.2, table 5.6",
    "In escena1 the grid beats the hierarchy by far; in escena2 the hierarchy beats the grid.",
    Question.OTHER_STRUCTURES,
)
def distribution_decides(e: Evidence) -> list[Check]:
    """Holds at every resolution; "by far" means twice as fast at 1280x1024."""
    return [
        *(beats(e, "escena1", "voxel-grid", HIERARCHY, at) for at in e.resolutions),
        beats(e, "escena1", "voxel-grid", HIERARCHY, factor=2),
        *(beats(e, "escena2", HIERARCHY, "voxel-grid", at) for at in e.resolutions),
    ]


@CLAIMS.claim(
    "C18",
    "5.4.2, tables 5.6, 5.7",
    "At 1280x1024 the beams beat grid and hierarchy in escena1, escena2, tetera, bola-espacial.",
    Question.OTHER_STRUCTURES,
)
def beams_win_against_other_structures(e: Evidence) -> list[Check]:
    """Compares four scenes with two opponents each."""
    scenes = ("escena1", "escena2", "tetera", "bola-espacial")
    others = ("voxel-grid", HIERARCHY)
    return [beats(e, scene, "beam", other) for scene, other in product(scenes, others)]


@CLAIMS.claim(
    "C19",
    "5.4.2, tables 5.7, 5.8",
    "The hierarchy falls behind as objects grow.",
    Question.OTHER_STRUCTURES,
)
def hierarchy_falls_behind(e: Evidence) -> list[Check]:
    """Time and ratio grow from each scene to the next larger scene (1,004 to 34,110 objects)."""
    seconds = {scene: e.time(scene, HIERARCHY) for scene in _BY_COUNT}
    ratios = {scene: ratio_of(seconds[scene], e.time(scene, "beam")) for scene in _BY_COUNT}
    return [
        below(f"{smaller} to {larger}, {what}", figures[smaller], figures[larger])
        for what, figures in (("seconds", seconds), ("ratio to the beams", ratios))
        for smaller, larger in pairwise(_BY_COUNT)
    ]


@CLAIMS.claim(
    "C20",
    "5.4.2, figures 5.17, 5.18",
    "The grid has a best resolution (13 cells per axis for flamenco, 15 for ajedrez); the beams "
    "beat the grid at its best.",
    Question.OTHER_STRUCTURES,
    quantity=None,
)
def beams_win_against_the_best_grid(e: Evidence) -> list[Check]:
    """At 1280x1024, the best of five or more grids is neither the coarsest nor the finest.

    It is within a factor of 1.5 of 13 or 15 cells.
    """
    checks = []
    for scene, best in (("flamenco", 13), ("ajedrez", 15)):
        sweep = e.times_by("cells", scene, "voxel-grid")
        quickest = smallest(list(sweep.values())) if len(sweep) >= 5 else None
        checks += [
            *best_grid(scene, sweep, best),
            below(f"{scene}, beam before the best grid", e.time(scene, "beam"), quickest),
        ]
    printed = below(
        "flamenco, beam before the only time that the thesis states",
        e.time("flamenco", "beam"),
        e.worked("best_seconds", "flamenco", contender="voxel-grid"),
    )
    return [*checks, aside(printed)]


@CLAIMS.claim(
    "C21",
    "5.4.2",
    "Hierarchies: bola-espacial 1,154 boxes, cost 372; tetera 731 and 130; escena1 cost 4.64.",
    Question.OTHER_STRUCTURES,
    is_figures=True,
)
def sizes_of_hierarchies(e: Evidence) -> list[Check]:
    """A stand-in's number of boxes is within a factor of 1.5, its cost within a factor of 2.

    The costs are in the thesis's order.
    """
    printed = (
        ("bola-espacial", "boxes", 1154, 1.5),
        ("tetera", "boxes", 731, 1.5),
        ("bola-espacial", "cost", 372, 2),
        ("tetera", "cost", 130, 2),
        ("escena1", "cost", 4.64, 2),
    )

    def size(what: str, scene: str) -> Measured | None:
        return e.worked(what, scene, contender=HIERARCHY)

    cost = {scene: size("cost", scene) for scene in ("escena1", "tetera", "bola-espacial")}
    quicker = below(
        "escena1, of least cost, is traced before tetera",
        e.time("escena1", HIERARCHY),
        e.time("tetera", HIERARCHY),
    )
    return [
        *(
            between(f"{scene}, {what}", size(what, scene), figure / factor, figure * factor)
            for scene, what, figure, factor in printed
        ),
        below("cost of escena1 below tetera's", cost["escena1"], cost["tetera"]),
        below("cost of tetera below bola-espacial's", cost["tetera"], cost["bola-espacial"]),
        aside(quicker),
    ]
