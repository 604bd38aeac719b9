"""Each rule of the ledger can reach each verdict, with figures invented for it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from random import Random

import pytest

from beambench_thesis.claims.chapter5 import CLAIMS, ON_OCTREES
from beambench_thesis.claims.prose import PROSE_CLAIMS
from beambench_thesis.claims.register import SWEPT_CLAIMS, judge, judge_ours
from beambench_thesis.claims.verdict import Claim, Outcome, Verdict
from beambench_thesis.paper.evidence import HIERARCHY, NOTHING, PICTURE, PLAIN_HIERARCHY
from synthetic_evidence import RAYS, SCENES, Row, holding, without

Only = Callable[[Row], bool]


def scaled(row: Row, factor: float) -> Row:
    """Returns the row with all its figures multiplied by a factor."""
    figures = [name for name in ("seconds", "value", "low", "high") if name in row]
    return row | {name: float(str(row[name])) * factor for name in figures}


def set_to(row: Row, figure: float) -> Row:
    """Returns the row with another figure, known exactly."""
    name = "seconds" if "seconds" in row else "value"
    return row | {name: figure, "low": figure, "high": figure}


def times(contender: str, factor: float) -> Callable[[Row], Row]:
    """Multiplies one contender's times by a factor."""
    return lambda row: (
        scaled(row, factor) if "seconds" in row and row["contender"] == contender else row
    )


def counted_backwards(row: Row) -> Row:
    """Reverses the counts of octrees: large ones become small."""
    names = [name for name in ("occupied_leaves", "exit_pixels") if name in row]
    return row | {name: 1e6 - float(str(row[name])) for name in names}


def quick_with_many_objects(row: Row) -> Row:
    return scaled(row, (1 + float(str(row["objects"])) / 10) ** -2) if "seconds" in row else row


def slow_by_level(row: Row) -> Row:
    """Makes times steeper with each level, except that 7 is faster than 6."""
    if "seconds" not in row or row["contender"] != "beam":
        return row
    return set_to(row, {4: 20, 5: 40, 6: 60, 7: 50}[int(str(row["level"]))])


def steep_by_level(row: Row) -> Row:
    if "seconds" not in row or row["contender"] != "beam":
        return row
    return set_to(row, RAYS[str(row["resolution"])] * float(str(row["level"])))


def crooked(row: Row) -> Row:
    """Replaces the line by ups and downs, growing more for escena2."""
    if "seconds" not in row or row["scene"] not in ("escena1", "escena2"):
        return row
    heights = {"escena1": (10, 1, 9, 1, 8), "escena2": (1, 100, 3, 100, 50)}[str(row["scene"])]
    return set_to(row, heights[list(RAYS).index(str(row["resolution"]))])


def flat(row: Row, samples: int) -> Row:
    """Makes crowded scenes take as long for many pixels as for few."""
    crowded = row["scene"] in ("bola-espacial", "caracol")
    return set_to(row, 5) if "seconds" in row and crowded and row["samples"] == samples else row


def work(quantity: str, factor: float | None) -> Callable[[Row], Row]:
    """Multiplies a quantity of the beams' work by a factor, or by the number of rays if None."""

    def change(row: Row) -> Row:
        if row.get("quantity") != quantity or row["contender"] not in ("beam", PICTURE):
            return row
        return scaled(row, RAYS.get(str(row["resolution"]), 1) if factor is None else factor)

    return change


def both(*changes: Callable[[Row], Row]) -> Callable[[Row], Row]:
    def change(row: Row) -> Row:
        for each in changes:
            row = each(row)
        return row

    return change


def erratic() -> Callable[[Row], Row]:
    """Makes times of tasks that no count explains."""
    random = Random(7)

    def change(row: Row) -> Row:
        if not str(row.get("quantity")).startswith("seconds_"):
            return row
        return set_to(row, 10 ** random.uniform(-3, 3))

    return change


def gains_that_shrink(row: Row) -> Row:
    """Makes Samet's time independent of the rays, and that of Samet-Net approach it."""
    if "seconds" not in row or row["contender"] not in ("samet", "samet-net"):
        return row
    growing = 90 + 9 * RAYS[str(row["resolution"])] / RAYS["1280x1024"]
    return set_to(row, 100 if row["contender"] == "samet" else growing)


def reversed_hierarchies(row: Row) -> Row:
    hierarchy = "seconds" in row and row["contender"] == HIERARCHY
    return set_to(row, 1e5 / float(str(row["seconds"]))) if hierarchy else row


def best_coarsest(row: Row) -> Row:
    grid = "seconds" in row and row["contender"] == "voxel-grid"
    return set_to(row, float(str(row["cells"])) / 10) if grid else row


def reversed_sizes(row: Row) -> Row:
    size = row.get("quantity") in ("boxes", "cost")
    return set_to(row, 1e3 / float(str(row["value"]))) if size else row


def few_exits(row: Row) -> Row:
    return row | {"exit_pixels": 1000} if "exit_pixels" in row else row


def scene(*names: str) -> Only:
    return lambda row: row["scene"] in names


@dataclass(frozen=True)
class Spoiling:
    """A change that contradicts a claim; for the rows `part` alone, it makes the verdict mixed."""

    fails: Callable[[Row], Row]
    part: Only


SPOILED = {
    "C01": Spoiling(quick_with_many_objects, scene("delfines")),
    "C02": Spoiling(counted_backwards, scene("delfines")),
    "C03": Spoiling(slow_by_level, scene("delfines")),
    "C04": Spoiling(steep_by_level, scene("delfines")),
    "C05": Spoiling(counted_backwards, scene("delfines")),
    "C06": Spoiling(crooked, scene("escena1")),
    "C07": Spoiling(lambda row: flat(row, 1), scene("bola-espacial")),
    "C08": Spoiling(lambda row: flat(row, 5), scene("bola-espacial")),
    "C09": Spoiling(work("seconds_nonterminal", None), scene("tetera")),
    "C10": Spoiling(
        both(
            work("seconds_nonterminal", 0.001),
            work("beams_made", 100),
            work("beams_divided", 100),
        ),
        lambda row: row["level"] == 6,
    ),
    "C11": Spoiling(
        both(work("seconds_nonterminal", 1000), work("beams_occupied", 0.1)),
        scene("bola-espacial"),
    ),
    "C12": Spoiling(erratic(), lambda row: row.get("quantity") == "seconds_occupied"),
    "C13": Spoiling(times("beam", 10), scene("stetra")),
    "C14": Spoiling(times("beam", 0.1), scene(*ON_OCTREES[2:])),
    "C15": Spoiling(times("samet", 0.5), scene("stetra")),
    "C16": Spoiling(times("beam", 10), scene("gato-bill")),
    "C17": Spoiling(
        lambda row: times("voxel-grid" if row["scene"] == "escena1" else HIERARCHY, 100)(row),
        scene("escena1"),
    ),
    "C18": Spoiling(times("beam", 1000), scene("tetera")),
    "C19": Spoiling(reversed_hierarchies, scene("flamenco")),
    "C20": Spoiling(best_coarsest, scene("ajedrez")),
    "C21": Spoiling(reversed_sizes, scene("tetera")),
    "C25": Spoiling(work("rays_after_leaf", 10), lambda row: row.get("resolution") == "320x200"),
    "C26": Spoiling(work("rays_after_leaf", 15), scene("stetra")),
    "C27": Spoiling(work("seconds_nonterminal", 1000), scene("stetra")),
    "C28": Spoiling(work("seconds_leaving", 1e6), scene("stetra")),
    "C29": Spoiling(gains_that_shrink, scene("stetra")),
    "C30": Spoiling(work("secondary_rays", 100), scene("bola-espacial")),
    "C31": Spoiling(work("shadow_cached_beams", 0.1), scene("stetra")),
    "C32": Spoiling(few_exits, scene("stetra")),
    "C33": Spoiling(counted_backwards, scene("misil")),
    "C34": Spoiling(
        lambda row: times("samet", 0.1)(row) if row.get("samples") == 5 else row, scene("tetera")
    ),
    "C35": Spoiling(
        lambda row: times("beam", 100)(row) if row.get("level") == 5 else row, scene("gato-bill")
    ),
    "C36": Spoiling(times(PLAIN_HIERARCHY, 0.1), scene("tetera")),
    "C37": Spoiling(
        lambda row: times("voxel-grid", 0.01)(row) if row.get("resolution") == "320x200" else row,
        scene("ajedrez"),
    ),
}


def claims_but(*names: str) -> pytest.MarkDecorator:
    """Turns a test into one per claim, except those named."""
    claims = [claim for claim in SWEPT_CLAIMS if claim.name not in names]
    return pytest.mark.parametrize("claim", claims, ids=lambda claim: claim.name)


every_claim = claims_but()


def test_there_is_a_rule_for_each_claim_of_chapter_five() -> None:
    assert [claim.name for claim in CLAIMS] == [f"C{number:02}" for number in range(1, 22)]


def test_there_is_a_rule_for_each_claim_of_the_text_alone() -> None:
    assert [claim.name for claim in PROSE_CLAIMS] == [f"C{number}" for number in range(25, 38)]


@every_claim
def test_a_claim_is_supported_where_every_cell_says_so(claim: Claim) -> None:
    assert judge(claim, holding()).verdict is Verdict.SUPPORTED


@every_claim
def test_a_claim_is_contradicted_where_no_cell_says_so(claim: Claim) -> None:
    found = judge(claim, holding(SPOILED[claim.name].fails))
    assert found.verdict is Verdict.CONTRADICTED, found.checks


@every_claim
def test_a_verdict_follows_from_the_share_of_cells_that_say_the_opposite(claim: Claim) -> None:
    found = judge(claim, holding(SPOILED[claim.name].fails, SPOILED[claim.name].part))
    assert found.formerly == "holds in part"
    outcomes = [check.outcome for check in found.checks if not check.aside]
    most = 2 * outcomes.count(Outcome.NO) > len(outcomes)
    assert found.verdict is (Verdict.CONTRADICTED if most else Verdict.MIXED), found.checks


def vague(row: Row) -> Row:
    """Makes intervals too wide to decide anything."""
    if "occupied_leaves" in row:
        return row
    figure = float(str(row.get("seconds", row.get("value"))))
    return row | {"low": figure / 1e6, "high": figure * 1e6}


# C02 and C05 concern counts of octrees, which are exact.
@claims_but("C02", "C05")
def test_a_claim_is_undecided_where_differences_are_within_the_intervals(claim: Claim) -> None:
    found = judge(claim, holding(vague))
    assert found.verdict is Verdict.UNDECIDED, found.checks


def test_a_fit_that_is_near_its_bound_is_undecided() -> None:
    def off_by_a_fifth(error: float) -> Callable[[Row], Row]:
        def change(row: Row) -> Row:
            if row.get("quantity") != "seconds_occupied":
                return row
            row = scaled(row, 1.19 if SCENES.index(str(row["scene"])) % 2 else 0.81)
            value = float(str(row["value"]))
            return row | {"low": value / (1 + error), "high": value * (1 + error)}

        return change

    (formulas,) = (claim for claim in CLAIMS if claim.name == "C12")
    assert judge(formulas, holding(off_by_a_fifth(0.1))).verdict is Verdict.UNDECIDED
    assert judge(formulas, holding(off_by_a_fifth(0.001))).verdict is Verdict.MIXED


@every_claim
def test_a_claim_is_not_tested_without_any_figures(claim: Claim) -> None:
    assert judge(claim, NOTHING).verdict is Verdict.NOT_TESTED


def test_what_rests_on_lost_materials_is_not_testable() -> None:
    for claim in SWEPT_CLAIMS:
        expected = Verdict.NOT_TESTABLE if claim.name == "C30" else Verdict.SUPPORTED
        assert judge_ours(claim, holding()).verdict is expected


@pytest.mark.parametrize("name", ["C17", "C18", "C19", "C21"])
def test_only_the_hierarchy_of_section_4_3_is_judged_as_the_thesis_s(name: str) -> None:
    (claim,) = (claim for claim in CLAIMS if claim.name == name)
    evidence = without(lambda row: row.get("contender") == HIERARCHY)
    assert judge(claim, evidence).verdict is Verdict.NOT_TESTED


@pytest.mark.parametrize("name", ["C10", "C11"])
def test_beams_are_counted_where_cutting_makes_them(name: str) -> None:
    (claim,) = (claim for claim in CLAIMS if claim.name == name)
    counted_anew_in_each_leaf = holding(both(work("beams", 8), work("beams_nonterminal", 8)))
    assert judge(claim, counted_anew_in_each_leaf).verdict is Verdict.SUPPORTED


def test_a_gain_that_is_none_has_not_grown() -> None:
    (claim,) = (claim for claim in PROSE_CLAIMS if claim.name == "C29")

    def one_time(row: Row) -> Row:
        times = "seconds" in row and row["contender"] in ("samet", "samet-net")
        return row | {"seconds": 100, "low": 99, "high": 101} if times else row

    evidence = holding(one_time, scene("stetra"))
    found = [check for check in judge(claim, evidence).checks if "samet-net saves" in check.cell]
    assert [check.outcome.value for check in found].count("no") == 1


def test_rays_can_win_where_one_scene_of_each_table_shows_it() -> None:
    (claim,) = (claim for claim in CLAIMS if claim.name == "C14")
    lost = ("escena2", "casa-de-campo", "gato-bill", "misil")
    found = judge(claim, holding(times("beam", 0.1), scene(*lost)))
    assert found.verdict is Verdict.SUPPORTED, found.checks


def test_a_scene_without_hidden_shadow_rays_says_nothing_of_the_cache() -> None:
    (claim,) = (claim for claim in PROSE_CLAIMS if claim.name == "C31")
    found = judge(claim, holding(work("shadow_hidden", 0), scene("stetra")))
    assert found.verdict is Verdict.SUPPORTED
    assert not any("stetra" in check.cell for check in found.checks)


@claims_but("C09")  # which applies to any set of scenes
def test_a_claim_is_not_tested_where_rows_are_missing(claim: Claim) -> None:
    part = SPOILED[claim.name].part
    assert judge(claim, without(part)).verdict is Verdict.NOT_TESTED


def test_a_scene_without_nonterminal_beams_tells_nothing_of_their_time() -> None:
    (constant,) = (claim for claim in CLAIMS if claim.name == "C09")

    def none_in_tetera(row: Row) -> Row:
        return set_to(row, 0) if SPOILED["C09"].part(row) and "quantity" in row else row

    found = judge(constant, holding(none_in_tetera))
    assert found.verdict is Verdict.SUPPORTED
    assert not any("tetera" in check.cell for check in found.checks)


def test_what_stands_beside_a_claim_does_not_count() -> None:
    (rays_win,) = (claim for claim in CLAIMS if claim.name == "C14")
    found = judge(rays_win, without(lambda row: row.get("resolution") == "640x480"))
    assert found.verdict is Verdict.SUPPORTED
