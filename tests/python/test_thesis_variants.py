"""Variants of the scenes, and the other reading of the thesis's levels."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from beambench_report.base.files import Problem
from beambench_report.base.published import COARSEST
from beambench_thesis.__main__ import main
from beambench_thesis.claims.register import (
    SWEPT_CLAIMS,
    TESTED,
    Finding,
    judge_claims,
    variants_that_agree,
)
from beambench_thesis.claims.variants_file import with_variants, write_variants
from beambench_thesis.claims.verdict import Verdict
from beambench_thesis.paper.evidence import (
    NOTHING,
    OCTREES,
    SETTING,
    TIMES,
    Blocks,
    one_level_less,
    setting,
)
from beambench_thesis.report.plan import (
    LOW_RESOLUTIONS,
    add_variants,
    keep_plan,
    make_plan,
    read_plan,
)
from beambench_thesis.report.report import gather
from synthetic_thesis import Row, texts_of, write_runs


def test_a_variant_measures_what_claims_are_about_at_two_resolutions() -> None:
    plan = make_plan(["5.2"], [], False, variants=2)
    assert len(plan.variants) == 2
    names = [sweep.name for sweep in plan.variants[1]]
    assert names[0] == "variant-2-synthetic"
    for sweep in plan.variants[1]:
        for cell in sweep.cells():
            assert cell.scene.endswith(":perturb=2")
            assert cell.resolution in LOW_RESOLUTIONS
            assert cell.structure not in ("sah-bvh", "embree")
            assert dict(cell.parameters).get("leaf", "exact") == "exact"


def test_by_the_other_reading_every_octree_is_one_level_deeper() -> None:
    plan = make_plan(["5.2"], [], False, variants=1)
    (division,) = (sweep for sweep in plan.deeper if sweep.name == "deeper-division")
    levels = {int(dict(cell.parameters)["max_level"]) for cell in division.cells()}
    assert levels == {5, 6, 7, 8}
    (octree,) = (sweep for sweep in plan.deeper if sweep.name == "deeper-octree")
    assert {dict(cell.parameters)["max_level"] for cell in octree.cells()} == {"7"}
    assert not any("perturb" in cell.scene for cell in division.cells())


def test_variants_are_added_to_a_plan_once(tmp_path: Path) -> None:
    plan = make_plan(["5.2"], [], False)
    assert plan.variants == plan.deeper == ()
    assert add_variants(plan, 0) == plan
    three = add_variants(add_variants(plan, 2), 3)
    assert three == add_variants(plan, 3)
    assert add_variants(three, 2) == three
    keep_plan(three, tmp_path)
    assert read_plan(tmp_path) == three
    assert [s.name for s in three.every_sweep][: len(plan.sweeps)] == [s.name for s in plan.sweeps]


def test_levels_are_counted_from_one_less() -> None:
    at = dict(zip(SETTING, setting("escena1", "beam", COARSEST, level=7), strict=True))
    times = pd.DataFrame([{"table": "", "seconds": 1.0, "low": 0.9, "high": 1.1} | at])
    octrees = pd.DataFrame(
        [{"scene": "maceta", "level": 7, "objects": 0, "occupied_leaves": 9, "exit_pixels": 5}]
    )
    blocks = {setting("escena1", "beam", COARSEST, level=7): Blocks({0: 1.0})}
    deeper = replace(
        NOTHING, times=times[list(TIMES)], octrees=octrees[list(OCTREES)], blocks=blocks
    )
    shallow = one_level_less(deeper)
    found = shallow.time("escena1", "beam", COARSEST, level=6)
    assert found is not None
    assert found.blocks.ms == {0: 1.0}
    assert shallow.time("escena1", "beam", COARSEST, level=7) is None
    assert shallow.count("occupied_leaves", "maceta", level=6) is not None


def test_a_claim_is_judged_over_every_finished_variant(tmp_path: Path) -> None:
    """The beams are slower with fewer objects in the second variant; the third is not done."""
    plan = make_plan(["5.2"], [], False, variants=3)

    def spoil(row: Row) -> Row:
        odd = "perturb=2" in str(row["scene"]) and "max_objects=0" in str(row["parameters"])
        figures = [name for name in row if name.startswith("total_")]
        return row | {name: 9 * float(str(row[name])) for name in figures} if odd else row

    run = write_runs(
        tmp_path / "run", plan, spoil, only=lambda sweep: sweep.name != "variant-3-octree"
    )
    report = gather(run, plan)
    (objects,) = (one for one in report.claims if one.claim.name == "C01")
    assert [found.verdict for found in objects.variants] == [Verdict.SUPPORTED, Verdict.MIXED]
    assert variants_that_agree(objects) == "1 of 2 (1 mixed)"
    assert objects.deeper is not None
    assert objects.ours.verdict is Verdict.SUPPORTED
    assert all(not cell.run.startswith(("variant", "deeper")) for cell in report.cells.cells)


@pytest.mark.parametrize("number", ["0", "-1", "x", "100"])
def test_a_number_of_variants_that_cannot_be_is_refused(
    number: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as exit_:
        main(["run", "--perturb", number, "--dry-run"])
    assert exit_.value.code == 2
    assert "give a number from 1 to 99" in capsys.readouterr().err


def test_the_report_names_the_variants(tmp_path: Path) -> None:
    plan = make_plan(["5.2"], [], False, variants=1)
    run = write_runs(tmp_path / "run", plan)
    assert main(["run", "--resume", str(run), "--report-only"]) == 0
    lines = texts_of(run).splitlines()
    (line,) = (line for line in lines if "(C01) |" in line)
    head = next(line for line in lines if "variants that agree" in line)
    fields = dict(zip(head.split(" | "), line.split(" | "), strict=True))
    assert fields["variants that agree"] == "1 of 1"
    assert fields["levels read otherwise"] == "supported"


def test_a_table_of_verdicts_stands_for_runs_that_are_not_kept(tmp_path: Path) -> None:
    claims = judge_claims([], SWEPT_CLAIMS[:3])
    first, second, third = (Finding(one, []) for one in Verdict if one in TESTED[:3])
    judged = [replace(claims[0], variants=(first, second), deeper=third), *claims[1:]]
    path = write_variants(judged, tmp_path / "variants.csv")
    assert with_variants(claims, path) == judged
    path.write_text("claim,variant,verdict\nC01,1,holds in part\n")
    with pytest.raises(Problem, match=r"variants.csv: 'holds in part' is not a valid Verdict"):
        with_variants(claims, path)
