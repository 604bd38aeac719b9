"""Each rule of the ledger comes to each verdict, by figures that were made up for it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from random import Random

import pytest

from beambench_report.ledger.book import judge
from beambench_report.ledger.claim import Claim
from beambench_report.ledger.evidence import NOTHING
from beambench_report.ledger.rules import CLAIMS
from beambench_report.ledger.verdict import Verdict
from made_up_evidence import RAYS, SCENES, Row, holding, without

Only = Callable[[Row], bool]


def scaled(row: Row, factor: float) -> Row:
    """The row with all its figures so many times as large."""
    figures = [name for name in ("seconds", "value", "low", "high") if name in row]
    return row | {name: float(str(row[name])) * factor for name in figures}


def set_to(row: Row, figure: float) -> Row:
    """The row with another figure, known exactly."""
    name = "seconds" if "seconds" in row else "value"
    return row | {name: figure, "low": figure, "high": figure}


def times(contender: str, factor: float) -> Callable[[Row], Row]:
    """One contender's times are so many times as long."""
    return lambda row: (
        scaled(row, factor) if "seconds" in row and row["contender"] == contender else row
    )


def counted_backwards(row: Row) -> Row:
    """What was many is few, in the counts of octrees."""
    names = [name for name in ("occupied_leaves", "exit_pixels") if name in row]
    return row | {name: 1e6 - float(str(row[name])) for name in names}


def quick_with_many_objects(row: Row) -> Row:
    return scaled(row, (1 + float(str(row["objects"])) / 10) ** -2) if "seconds" in row else row


def slow_by_level(row: Row) -> Row:
    """Steeper with each level, but 7 quicker than 6."""
    if "seconds" not in row or row["contender"] != "beam":
        return row
    return set_to(row, {4: 20, 5: 40, 6: 60, 7: 50}[int(str(row["level"]))])


def steep_by_level(row: Row) -> Row:
    if "seconds" not in row or row["contender"] != "beam":
        return row
    return set_to(row, RAYS[str(row["resolution"])] * float(str(row["level"])))


def crooked(row: Row) -> Row:
    """No line: up and down, escena2 growing more."""
    if "seconds" not in row or row["scene"] not in ("escena1", "escena2"):
        return row
    heights = {"escena1": (10, 1, 9, 1, 8), "escena2": (1, 100, 3, 100, 50)}[str(row["scene"])]
    return set_to(row, heights[list(RAYS).index(str(row["resolution"]))])


def flat(row: Row, samples: int) -> Row:
    """Crowded scenes take as long for many pixels as for few."""
    crowded = row["scene"] in ("bola-espacial", "caracol")
    return set_to(row, 5) if "seconds" in row and crowded and row["samples"] == samples else row


def work(quantity: str, factor: float | None) -> Callable[[Row], Row]:
    """A quantity of the beams' work so many times as large; by the resolution if not told."""

    def change(row: Row) -> Row:
        if row.get("quantity") != quantity or row["contender"] != "beam":
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
    """Times of tasks that no count explains."""
    random = Random(7)

    def change(row: Row) -> Row:
        if not str(row.get("quantity")).startswith("seconds_"):
            return row
        return set_to(row, 10 ** random.uniform(-3, 3))

    return change


def reversed_hierarchies(row: Row) -> Row:
    hierarchy = "seconds" in row and row["contender"] == "goldsmith-salmon"
    return set_to(row, 1e5 / float(str(row["seconds"]))) if hierarchy else row


def best_coarsest(row: Row) -> Row:
    grid = "seconds" in row and row["contender"] == "voxel-grid"
    return set_to(row, float(str(row["cells"])) / 10) if grid else row


def reversed_sizes(row: Row) -> Row:
    size = row.get("quantity") in ("boxes", "cost")
    return set_to(row, 1e3 / float(str(row["value"]))) if size else row


def scene(*names: str) -> Only:
    return lambda row: row["scene"] in names


@dataclass(frozen=True)
class Spoiling:
    """What makes a claim fail, and which rows are enough for it to hold in part only."""

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
            work("beams", 100),
            work("beams_nonterminal", 100),
        ),
        lambda row: row["level"] == 6,
    ),
    "C11": Spoiling(
        both(work("seconds_nonterminal", 1000), work("beams_occupied", 0.1)),
        scene("bola-espacial"),
    ),
    "C12": Spoiling(erratic(), lambda row: row.get("quantity") == "seconds_occupied"),
    "C13": Spoiling(times("beam", 10), scene("stetra")),
    "C14": Spoiling(times("beam", 0.1), scene("stetra")),
    "C15": Spoiling(times("samet", 0.5), scene("stetra")),
    "C16": Spoiling(times("beam", 10), scene("gato-bill")),
    "C17": Spoiling(
        lambda row: times("voxel-grid" if row["scene"] == "escena1" else "goldsmith-salmon", 100)(
            row
        ),
        scene("escena1"),
    ),
    "C18": Spoiling(times("beam", 1000), scene("tetera")),
    "C19": Spoiling(reversed_hierarchies, scene("flamenco")),
    "C20": Spoiling(best_coarsest, scene("ajedrez")),
    "C21": Spoiling(reversed_sizes, scene("tetera")),
}


def claims_but(*names: str) -> pytest.MarkDecorator:
    """Makes a test one of every claim, but for those named."""
    claims = [claim for claim in CLAIMS if claim.name not in names]
    return pytest.mark.parametrize("claim", claims, ids=lambda claim: claim.name)


every_claim = claims_but()


def test_there_is_a_rule_for_each_claim_of_chapter_five() -> None:
    assert [claim.name for claim in CLAIMS] == [f"C{number:02}" for number in range(1, 22)]


@every_claim
def test_a_claim_holds_where_every_cell_says_so(claim: Claim) -> None:
    assert judge(claim, holding()).verdict is Verdict.HOLDS


@every_claim
def test_a_claim_fails_where_no_cell_says_so(claim: Claim) -> None:
    found = judge(claim, holding(SPOILED[claim.name].fails))
    assert found.verdict is Verdict.FAILS, found.checks


@every_claim
def test_a_claim_holds_in_part_where_some_scene_says_otherwise(claim: Claim) -> None:
    found = judge(claim, holding(SPOILED[claim.name].fails, SPOILED[claim.name].part))
    assert found.verdict is Verdict.IN_PART, found.checks


def vague(row: Row) -> Row:
    """Intervals that say nothing; counts of octrees, which have none, all alike."""
    if "occupied_leaves" in row:
        return row | {"occupied_leaves": 500, "exit_pixels": 500}
    figure = float(str(row.get("seconds", row.get("value"))))
    return row | {"low": figure / 50, "high": figure * 50}


@claims_but("C12")  # whose fits have intervals of their own, see below
def test_a_claim_is_undecided_where_differences_are_within_the_intervals(claim: Claim) -> None:
    found = judge(claim, holding(vague))
    assert found.verdict is Verdict.UNDECIDED, found.checks


def test_a_fit_that_is_near_its_bound_is_undecided() -> None:
    def off_by_a_fifth(row: Row) -> Row:
        if row.get("quantity") != "seconds_occupied":
            return row
        return scaled(row, 1.19 if SCENES.index(str(row["scene"])) % 2 else 0.81)

    (formulas,) = (claim for claim in CLAIMS if claim.name == "C12")
    assert judge(formulas, holding(off_by_a_fifth)).verdict is Verdict.UNDECIDED


@every_claim
def test_a_claim_is_not_tested_without_any_figures(claim: Claim) -> None:
    assert judge(claim, NOTHING).verdict is Verdict.NOT_TESTED


@claims_but("C09")  # which asks whatever scenes were measured
def test_a_claim_is_not_tested_where_rows_are_missing(claim: Claim) -> None:
    part = SPOILED[claim.name].part
    assert judge(claim, without(part)).verdict is Verdict.NOT_TESTED


def test_a_scene_without_nonterminal_beams_tells_nothing_of_their_time() -> None:
    (constant,) = (claim for claim in CLAIMS if claim.name == "C09")

    def none_in_tetera(row: Row) -> Row:
        return set_to(row, 0) if SPOILED["C09"].part(row) and "quantity" in row else row

    found = judge(constant, holding(none_in_tetera))
    assert found.verdict is Verdict.HOLDS
    assert not any("tetera" in check.cell for check in found.checks)


def test_what_stands_beside_a_claim_does_not_count() -> None:
    (rays_win,) = (claim for claim in CLAIMS if claim.name == "C14")
    found = judge(rays_win, without(lambda row: row.get("resolution") == "640x480"))
    assert found.verdict is Verdict.HOLDS
