"""The ledger of claims: its verdicts, the thesis's own figures, the rows of a run, its page."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import replace
from math import exp, hypot, isnan, log, sqrt
from pathlib import Path
from random import Random
from statistics import median

import numpy as np
import pytest

from beambench_report.base.fastest import with_fastest
from beambench_report.base.files import Problem
from beambench_report.base.published import COARSEST, FINEST
from beambench_report.base.quantities import DASH
from beambench_report.base.records import read_run
from beambench_thesis.__main__ import main
from beambench_thesis.chapter5.cost import fit_costs, r_squared
from beambench_thesis.claims.comparisons import fit_line
from beambench_thesis.claims.register import (
    ALL_CLAIMS,
    SWEPT_CLAIMS,
    Finding,
    JudgedClaim,
    agreeing,
    effect,
    judge,
    judge_claims,
    named,
    variants_that_agree,
)
from beambench_thesis.claims.verdict import (
    Check,
    Claim,
    Outcome,
    Question,
    Verdict,
    aside,
    below,
    between,
    verdict_of,
)
from beambench_thesis.paper.evidence import (
    HIERARCHY,
    PAPER_HIERARCHY,
    Measured,
    published_evidence,
    share,
    smallest,
    total,
)
from beambench_thesis.paper.measured import (
    BETWEEN_RUNS,
    census_work,
    measured_evidence,
    seconds_of,
)
from synthetic_run import synthetic_rows, without_times, write_repeated_cell, write_run

YES, NO, UNDECIDED, MISSING = Outcome


def measured(value: float, half: float = 0.1) -> Measured:
    return Measured(value, value - half, value + half)


# Cells and verdicts


def judged(*checks: Check) -> JudgedClaim:
    finding = Finding(verdict_of(checks), list(checks))
    return JudgedClaim(ALL_CLAIMS[0], finding, finding)


@pytest.mark.parametrize(
    ("smaller", "larger", "factor", "outcome"),
    [
        (measured(1), measured(2), 1, YES),
        (measured(2), measured(1), 1, NO),
        (measured(1), measured(1.15), 1, YES),  # both errors at once are unlikely
        (measured(1), measured(1.13), 1, UNDECIDED),
        (measured(10), measured(10.1), 1, NO),  # certainly equal
        (measured(10, 0.3), measured(10.4, 0.3), 1, UNDECIDED),
        (measured(10), measured(20.2), 2, UNDECIDED),
        (Measured.exact(10), measured(10.1, 0.2), 1, UNDECIDED),  # a bound is met or not met
        (measured(1), measured(2.5), 2, YES),
        (measured(1), measured(2.1), 2, UNDECIDED),
        (measured(1), measured(1.5), 2, NO),
        (Measured.exact(1), Measured.exact(1.001), 1, YES),
        (Measured.exact(1), Measured.exact(1), 1, NO),
        (Measured.exact(1), Measured.exact(2), 2, YES),
        (None, measured(1), 1, MISSING),
        (measured(1), None, 1, MISSING),
    ],
)
def test_a_difference_counts_where_its_interval_says_so(
    smaller: Measured | None, larger: Measured | None, factor: float, outcome: Outcome
) -> None:
    assert below("cell", smaller, larger, factor).outcome is outcome


@pytest.mark.parametrize(
    ("figure", "outcome"),
    [
        (measured(1.5), YES),
        (measured(2.05), UNDECIDED),
        (measured(0.95), UNDECIDED),
        (measured(2.5), NO),
        (None, MISSING),
    ],
)
def test_a_figure_lies_between_bounds_with_all_of_its_interval(
    figure: Measured | None, outcome: Outcome
) -> None:
    assert between("cell", figure, 1, 2).outcome is outcome


@pytest.mark.parametrize(
    ("outcomes", "verdict"),
    [
        ([YES, YES], Verdict.SUPPORTED),
        ([NO, NO], Verdict.CONTRADICTED),
        ([YES, NO], Verdict.MIXED),
        ([YES, UNDECIDED], Verdict.UNDECIDED),
        ([NO, UNDECIDED], Verdict.UNDECIDED),
        ([YES, NO, UNDECIDED], Verdict.UNDECIDED),  # contradicted, if the third says no
        ([YES, YES, NO, UNDECIDED], Verdict.MIXED),  # whatever the fourth turns out to be
        ([YES, NO, NO], Verdict.CONTRADICTED),
        ([YES, NO, NO, NO, UNDECIDED], Verdict.CONTRADICTED),
        ([YES, MISSING], Verdict.NOT_TESTED),
        ([], Verdict.NOT_TESTED),
    ],
)
def test_a_verdict_stands_whichever_way_undecided_cells_fall(
    outcomes: list[Outcome], verdict: Verdict
) -> None:
    assert verdict_of([Check("cell", outcome) for outcome in outcomes]) is verdict


def test_no_verdict_depends_on_what_stands_beside() -> None:
    assert verdict_of([Check("a", YES), aside(Check("b", NO))]) is Verdict.SUPPORTED
    assert verdict_of([aside(Check("b", NO))]) is Verdict.NOT_TESTED


# Figures


def test_errors_of_ratios_differences_sums_and_shares_are_combined_as_independent_ones() -> None:
    four, two = Measured(4, 3, 5), Measured(2, 1, 2.5)
    ratio, gap, sum_of_both = four / two, four - two, total([four, two])
    assert ratio.value == 2
    assert ratio.low == pytest.approx(2 * exp(-hypot(log(4 / 3), log(2.5 / 2))))
    assert ratio.high == pytest.approx(2 * exp(hypot(log(5 / 4), log(2))))
    assert (gap.low, gap.value, gap.high) == (2 - hypot(1, 0.5), 2, 2 + hypot(1, 1))
    assert (sum_of_both.low, sum_of_both.high) == (6 - hypot(1, 1), 6 + hypot(1, 0.5))
    odds = two / four
    part = share(two, four)
    assert (part.low, part.value) == (
        pytest.approx(odds.low / (1 + odds.low)),
        pytest.approx(2 / 6),
    )
    assert smallest([four, two]) == Measured(2, 1, 2.5)


def test_a_ratio_of_figures_that_may_be_zero_holds_every_possible_value() -> None:
    assert Measured(1, 0, 2) / Measured(2, 1, 4) == Measured(0.5, 0, 2)
    assert share(Measured.exact(0), Measured(2, 1, 4)) == Measured.exact(0)


def test_an_interval_of_independent_errors_covers_what_it_says() -> None:
    random = Random(7)
    covered = 0
    for _ in range(2000):
        ten, five = (random.gauss(value, 0.1) for value in (10, 5))
        figures = (measured(figure, 1.96 * 0.1) for figure in (ten, five))
        ratio = next(figures) / next(figures)
        covered += ratio.low <= 2 <= ratio.high
    assert 0.94 < covered / 2000 < 0.96


def test_a_line_is_found_with_the_slopes_that_its_intervals_allow() -> None:
    line = fit_line([0, 1, 2], [Measured(1, 0.9, 1.1), Measured(3, 2.9, 3.1), Measured(5, 4.5, 6)])
    assert line.slope.value == pytest.approx(2)
    assert line.slope.low == pytest.approx(2 - hypot(0.5, 0.1) / 2)
    assert line.slope.high == pytest.approx(2 + hypot(1, 0.1) / 2)
    assert line.intercept == pytest.approx(1)
    assert line.r_squared == pytest.approx(1)
    assert line.within_intervals
    assert not fit_line(
        [0, 1, 2], [Measured.exact(height) for height in (1, 5, 1)]
    ).within_intervals


def test_costs_that_make_the_times_are_found() -> None:
    counts = [[1, 10], [2, 5], [3, 40], [10, 1]]
    seconds = np.array([0.5 * first + 0.02 * second for first, second in counts])
    costs = fit_costs(np.array(counts), seconds)
    assert costs == pytest.approx([0.5, 0.02])
    assert r_squared(seconds, counts @ costs) == pytest.approx(1)


# The thesis's own figures

THESIS = {
    "C19": Verdict.MIXED,  # flamenco to ajedrez: neither the time grows nor the ratio
    # The evidence for these is in lost plots, or was not printed for every scene.
    **dict.fromkeys(("C07", "C08", "C11", "C12", "C16", "C20"), Verdict.NOT_TESTED),
    # The text states these without figures.
    **dict.fromkeys(
        ("C25", "C26", "C27", "C28", "C30", "C31", "C32", "C33", "C34", "C35", "C36"),
        Verdict.NOT_TESTED,
    ),
}

# Figures that the thesis states in addition to its claims, or that follow from it.
BESIDE = {
    "C11": YES,  # the part of the time that grows with the rays leaves room for the claim
    "C12": NO,  # a non-terminal beam of maceta costs 5.8 times as much at level 7 as at level 6
    "C14": NO,  # the text has rays win gato-bill at 640x480, too; the table has the beams
    "C20": YES,  # 25.6 s against the grid's 93
    "C21": NO,  # of least cost, escena1 takes longer than tetera
}


@pytest.mark.parametrize("claim", SWEPT_CLAIMS, ids=lambda claim: claim.name)
def test_the_thesis_supports_itself_but_for_what_is_said_here(claim: Claim) -> None:
    found = judge(claim, published_evidence())
    assert found.verdict is THESIS.get(claim.name, Verdict.SUPPORTED)
    told = [check.outcome for check in found.checks if check.aside]
    assert told == ([BESIDE[claim.name]] if claim.name in BESIDE else [])


def test_what_does_not_hold_in_the_thesis_is_named() -> None:
    (falls_behind,) = (entry for entry in judge_claims([]) if entry.claim.name == "C19")
    assert [check.cell for check in falls_behind.thesis.checks if check.outcome is NO] == [
        "flamenco to ajedrez, seconds",
        "flamenco to ajedrez, ratio to the beams",
    ]


def test_times_that_two_tables_print_agree() -> None:
    rows = published_evidence().times
    setting = [name for name in rows.columns if name not in ("table", "seconds", "low", "high")]
    assert (rows.groupby(setting)["seconds"].nunique() == 1).all()
    assert rows.duplicated(setting).any()


# A run's rows

BEAM = "max_level=6,max_objects=0,root=cube,assign=surface,pad=1e-06,handover=0,continue=rays"
LAZY = "resolution=32x32x32,density=4,fill=lazy,mailboxes=false"


def row_of(structure: str, parameters: str, **changes: object) -> dict[str, object]:
    """Returns a row of escena1 as written by `beambench run`."""
    row = {"scene": "escena1:seed=1999,spheres=430", "primitives": 430}
    return synthetic_rows()[0] | row | {"structure": structure, "parameters": parameters} | changes


def test_seconds_are_those_of_build_and_trace_with_the_interval_of_a_repeat(
    tmp_path: Path,
) -> None:
    times = {"total_ms_median": 200, "total_ms_ci_low": 199, "total_ms_ci_high": 203}
    write_run(tmp_path, [row_of("beam", BEAM, total_mcycles_median=600, **times)])
    time = measured_evidence([tmp_path]).time("escena1", "beam", COARSEST)
    assert time is not None
    assert time.value == pytest.approx(0.2)
    assert time.low == pytest.approx(0.2 - hypot(sqrt(2) * 0.001, BETWEEN_RUNS * 0.2))
    assert time.high == pytest.approx(0.2 + hypot(sqrt(2) * 0.003, BETWEEN_RUNS * 0.2))


def test_the_interval_of_cycles_goes_before_that_of_milliseconds(tmp_path: Path) -> None:
    """Changes of the clock rate double the spread of milliseconds, but not that of cycles."""
    times = {"total_ms_median": 200, "total_ms_ci_low": 150, "total_ms_ci_high": 300}
    cycles = {"total_mcycles_ci_low": 594, "total_mcycles_ci_high": 612}
    write_run(tmp_path, [row_of("beam", BEAM, total_mcycles_median=600, **times, **cycles)])
    time = measured_evidence([tmp_path]).time("escena1", "beam", COARSEST)
    assert time is not None
    assert time.value == pytest.approx(0.2)
    assert time.low == pytest.approx(0.2 - hypot(sqrt(2) * 0.002, BETWEEN_RUNS * 0.2))
    assert time.high == pytest.approx(0.2 + hypot(sqrt(2) * 0.004, BETWEEN_RUNS * 0.2))


def write_repeated(
    folder: Path, row: dict[str, object], repetitions: Sequence[tuple[float, float]]
) -> Path:
    """Writes a run of one cell and its repetitions: milliseconds of the trace, and gigahertz."""
    folder.mkdir(exist_ok=True)
    trace = [ms for ms, _ in repetitions]
    write_run(folder, [row | {"trace_ms_median": median(trace), "trace_ms_min": min(trace)}])
    write_repeated_cell(
        folder,
        row,
        [
            {"round": turn, "position": 0, "build_ms": 0.0, "trace_ms": ms, "clock_ghz": ghz}
            for turn, (ms, ghz) in enumerate(repetitions)
        ],
    )
    return folder


# Five repetitions that took 200 to 204 ms for 600 million cycles, and four disturbed ones.
QUIET = [(200.0, 3.0), (201.0, 2.985), (202.0, 2.97), (203.0, 2.956), (204.0, 2.94)]
DISTURBED = [(300.0, 3.0), (310.0, 2.1), (320.0, 3.0), (330.0, 2.9)]
MEDIANS = {"total_ms_median": 204, "total_mcycles_median": 612}


def test_the_fastest_repetitions_go_before_the_median(tmp_path: Path) -> None:
    """Other work during most of the repetitions moves the median, but not the fastest."""
    write_repeated(tmp_path, row_of("beam", BEAM, **MEDIANS), [*DISTURBED, *QUIET])
    time = measured_evidence([tmp_path]).time("escena1", "beam", COARSEST)
    assert time is not None
    assert time.value == pytest.approx(0.2, rel=1e-3)
    assert time.high - time.value == pytest.approx(0.2 * BETWEEN_RUNS, rel=0.01)
    assert time.value - time.low == pytest.approx(time.high - time.value)


def test_the_seconds_of_tables_are_those_of_the_fastest_repetitions(tmp_path: Path) -> None:
    run = write_repeated(tmp_path, row_of("beam", BEAM, **MEDIANS), [*DISTURBED, *QUIET])
    (rows,) = with_fastest([read_run(run)])
    assert seconds_of(rows.iloc[0].to_dict())["seconds"] == pytest.approx(0.202)
    medians = {"total_ms_median": 300, "total_ms_ci_low": 220, "total_ms_ci_high": 310}
    assert seconds_of(row_of("beam", BEAM, **medians))["seconds"] == pytest.approx(0.3)


def test_of_three_repetitions_the_fastest_counts_and_has_no_interval(tmp_path: Path) -> None:
    write_repeated(tmp_path, row_of("beam", BEAM, **MEDIANS), [*DISTURBED[:2], QUIET[4]])
    time = measured_evidence([tmp_path]).time("escena1", "beam", COARSEST)
    assert time is not None
    assert time.value == pytest.approx(0.2, rel=1e-3)
    assert isnan(time.low)
    assert isnan(time.high)


def test_a_clock_that_slows_down_makes_no_structure_slower(tmp_path: Path) -> None:
    """The same work takes longer at 2 GHz than at 3; in cycles both take the same."""
    for name, clock in (("first", 3.0), ("second", 2.0)):
        times = {"total_ms_median": 600 / clock, "total_ms_ci_low": "", "total_ms_ci_high": ""}
        levels = BEAM if name == "first" else BEAM.replace("max_level=6", "max_level=5")
        (tmp_path / name).mkdir()
        write_run(tmp_path / name, [row_of("beam", levels, total_mcycles_median=600, **times)])
    found = measured_evidence([tmp_path / "first", tmp_path / "second"])
    six, five = (found.time("escena1", "beam", COARSEST, level=level) for level in (6, 5))
    assert six is not None
    assert five is not None
    assert six.value == pytest.approx(five.value)
    assert six.value == pytest.approx(0.6 / 2.5)


def test_a_time_of_few_repetitions_has_no_interval(tmp_path: Path) -> None:
    nothing = {"total_ms_ci_low": "", "total_ms_ci_high": ""}
    times = {"total_ms_median": 100, "total_mcycles_median": 300}
    write_run(tmp_path, [row_of("beam", BEAM, **times, **nothing)])
    time = measured_evidence([tmp_path]).time("escena1", "beam", COARSEST)
    assert time is not None
    assert isnan(time.low)
    assert isnan(time.high)


@pytest.mark.parametrize(
    "row",
    [
        row_of("beam", BEAM.replace("handover=0", "handover=48")),
        row_of("beam", f"{BEAM},leaf=simd"),
        row_of("beam", BEAM.replace("continue=rays", "continue=beams")),
        row_of("beam", BEAM.replace("max_level=6", "max_level=auto")),
        row_of("voxel-grid", LAZY.replace("lazy", "eager")),
        row_of("voxel-grid", LAZY.replace("32x32x32", "32x16x32")),
        row_of("embree", "mode=single"),
        row_of("beam", BEAM, scene="escena1:seed=1999,spheres=500", primitives=500),
        row_of("beam", BEAM, scene="tetra:n=6", primitives=4096),
        row_of("beam", BEAM, ray_kind="shadow"),
        without_times(row_of("beam", BEAM), "mismatch"),
    ],
)
def test_rows_that_the_claims_do_not_speak_of_are_left_out(
    tmp_path: Path, row: dict[str, object]
) -> None:
    write_run(tmp_path, [row_of("goldsmith-salmon", "order=given,seed=1,queue=heap"), row])
    assert len(measured_evidence([tmp_path]).times) == 1


def test_a_grid_is_known_by_its_cells_per_axis(tmp_path: Path) -> None:
    write_run(
        tmp_path, [row_of("voxel-grid", LAZY), row_of("voxel-grid", "resolution=13,fill=lazy")]
    )
    found = measured_evidence([tmp_path]).times_by("cells", "escena1", "voxel-grid", COARSEST)
    assert list(found) == [13, 32]


def test_the_work_of_beams_is_that_of_the_whole_image(tmp_path: Path) -> None:
    counters = {
        "rays": 1310720,
        "width": 1280,
        "height": 1024,
        "leaves": 4000,
        "empty_leaves": 2400,
        "build_ms_median": 6,
        "samples_leaving_per_ray": 0.25,
        "beams_per_ray": 0.5,
        "beams_nonterminal_per_ray": 0.25,
        "beams_occupied_per_ray": 0.125,
        "beams_nonterminal_ns_per_ray": 100,
        "beams_occupied_ns_per_ray": 850,
        "beams_leaving_ns_per_ray": 50,
    }
    repetitions = [(1000.0 + ms, 3.0) for ms in (-5, -2, 2, 5, 90)]
    write_repeated(tmp_path, row_of("beam", BEAM) | counters, repetitions)
    found = measured_evidence([tmp_path])
    assert found.count("occupied_leaves", "escena1") == Measured.exact(1600)
    assert found.count("exit_pixels", "escena1") == Measured.exact(327680)
    assert found.worked("beams", "escena1") == Measured.exact(655360)
    seconds = found.worked("seconds_occupied", "escena1", FINEST)
    assert seconds is not None
    assert seconds.value == pytest.approx(0.85)  # of the trace, not the 1.1 s of the counting pass
    assert 0.82 < seconds.low < 0.84  # 1% of the trace, 1.5% between runs, 0.15 of the odds' 10%
    occupied = found.share_of_time("occupied", "escena1", FINEST)
    assert occupied is not None
    assert occupied.value == pytest.approx(0.85 / 1.006)
    assert occupied.low < occupied.value < occupied.high


def test_other_work_that_lengthens_the_counting_pass_changes_no_time_of_a_task(
    tmp_path: Path,
) -> None:
    found = []
    for slower in (1, 2):
        counted = {
            f"beams_{task}_ns_per_ray": slower * ns
            for task, ns in (("nonterminal", 100), ("occupied", 850), ("leaving", 50))
        }
        row = row_of("beam", BEAM, beams_per_ray=0.5, trace_ms_min=40, **counted)
        write_run(tmp_path, [row])
        found.append(measured_evidence([tmp_path]))
    calm, disturbed = (run.worked("seconds_nonterminal", "escena1", COARSEST) for run in found)
    assert calm == disturbed
    assert calm is not None
    assert calm.value == pytest.approx(0.004)


def test_of_several_runs_the_repetitions_of_a_cell_count_together(tmp_path: Path) -> None:
    """The first run was disturbed in all of its repetitions; the second had too few of its own."""
    row = row_of("beam", BEAM, **MEDIANS)
    first = write_repeated(tmp_path / "first", row, [(ms * 1.5, ghz) for ms, ghz in QUIET])
    second = write_repeated(tmp_path / "second", row, QUIET[:3])
    third = write_repeated(tmp_path / "third", row, QUIET[3:])
    both = measured_evidence([first, second, third])
    together = both.time("escena1", "beam", COARSEST)
    assert together is not None
    assert together.value == pytest.approx(0.2, rel=1e-3)
    assert together.high - together.value == pytest.approx(0.2 * BETWEEN_RUNS, rel=0.01)
    assert len(both.times) == 1


def test_the_size_and_the_cost_of_a_hierarchy_are_read(tmp_path: Path) -> None:
    settings = "order=given,seed=1,queue=heap,insert=terminal"
    write_run(tmp_path, [row_of("goldsmith-salmon", settings, nodes=296, tree_cost=56.2)])
    found = measured_evidence([tmp_path])
    asked = {"contender": "goldsmith-salmon"}
    assert found.worked("boxes", "escena1", **asked) == Measured.exact(296)
    assert found.worked("cost", "escena1", **asked) == Measured.exact(56.2)


@pytest.mark.parametrize("insertion", ["", ",insert=everywhere"])
def test_only_inserting_at_terminal_nodes_is_the_thesis_s(tmp_path: Path, insertion: str) -> None:
    settings = f"order=given,seed=1,queue=heap{insertion}"
    write_run(tmp_path, [row_of("goldsmith-salmon", settings, nodes=296, tree_cost=56.2)])
    found = measured_evidence([tmp_path])
    assert found.time("escena1", HIERARCHY, COARSEST) is None
    assert found.worked("boxes", "escena1", contender=HIERARCHY) is None
    assert found.time("escena1", PAPER_HIERARCHY, COARSEST) is not None
    assert found.worked("boxes", "escena1", contender=PAPER_HIERARCHY) == Measured.exact(296)


# Whole pictures


def write_censuses(folder: Path, **changes: object) -> Path:
    """Writes the output of `beambench census --json` for one scene of the thesis and another."""
    folder.mkdir()
    counts = {"eye_rays": 900, "reflected_rays": 70, "refracted_rays": 5, "shadow_hidden": 40}
    for order, cached in (("scan", 10), ("beams", 30)):
        scenes = [
            {"scene": scene} | counts | {"shadow_cached": cached}
            for scene in ("escena1:seed=1999,spheres=430", "balls:n=4")
        ]
        source = {"shadows": "cache", "order": order, "scenes": scenes} | changes
        (folder / f"{order}.json").write_text(json.dumps(source))
    return folder


def test_rays_of_whole_pictures_are_read_by_kind(tmp_path: Path) -> None:
    work = census_work(write_censuses(tmp_path / "census"))
    assert set(work["scene"]) == {"escena1"}
    assert dict(zip(work["quantity"], work["value"], strict=True)) == {
        "eye_rays": 900,
        "secondary_rays": 75,
        "shadow_hidden": 40,
        "shadow_cached_scan": 10,
        "shadow_cached_beams": 30,
    }


def test_a_census_decides_its_claims_beside_a_run(tmp_path: Path) -> None:
    run = tmp_path / "run"
    run.mkdir()
    write_run(run, [row_of("beam", BEAM)])
    entries = judge_claims([run, write_censuses(tmp_path / "census")])
    (cache,) = (entry for entry in entries if entry.claim.name == "C31")
    (cell,) = (check for check in cache.ours.checks if check.cell.startswith("escena1"))
    assert (cell.outcome, cell.figures) == (YES, "0.250 against 0.750")


@pytest.mark.parametrize("changes", [{"shadows": "rays"}, {"order": "rows"}, {"scenes": [{}]}])
def test_a_census_of_another_kind_is_refused(tmp_path: Path, changes: dict[str, object]) -> None:
    with pytest.raises(Problem, match=r"scan\.json: is not what `beambench census --json` prints"):
        census_work(write_censuses(tmp_path / "census", **changes))


def test_two_folders_of_censuses_are_refused(tmp_path: Path) -> None:
    folders = [write_censuses(tmp_path / name) for name in "ab"]
    with pytest.raises(Problem, match="there is another folder of censuses"):
        judge_claims(folders)


def test_several_runs_are_read_as_one(tmp_path: Path) -> None:
    folders = [tmp_path / name for name in "ab"]
    rows = [row_of("beam", BEAM), row_of("samet", "max_level=6,max_objects=0")]
    for folder, row in zip(folders, rows, strict=True):
        folder.mkdir()
        write_run(folder, [row])
    assert len(measured_evidence(folders).times) == 2


# The page


def test_every_claim_has_a_line_under_its_question(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_run(tmp_path, [row_of("beam", BEAM), row_of("samet", "max_level=6,max_objects=0")])
    assert main(["claims", str(tmp_path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line[4:] for line in lines if line.startswith("###")] == [q.value for q in Question]
    rows = [line for line in lines if re.search(r"\(C\d\d\) \|", line)]
    assert len(rows) == len(ALL_CLAIMS)
    (first,) = (row for row in rows if "(C01)" in row)
    assert "| 5.3.1, table 5.2 | **not tested** | 1.39 times (1.13 to 1.67) |" in first
    (untestable,) = (row for row in rows if "(C30)" in row)
    assert "**not testable**" in untestable


def test_the_effect_is_a_mean_of_ratios_or_a_median() -> None:
    ratios = [Check("a", YES, ratio=2.0), Check("b", NO, ratio=0.5), aside(Check("c", NO, ratio=9))]
    claim = ALL_CLAIMS[0]
    assert effect(claim, judged(*ratios).ours) == "1.00 times (0.500 to 2.00)"
    of_pixels = replace(claim, quantity="of the pixels")
    values = [Check(name, YES, value=value) for name, value in (("a", 0.1), ("b", 0.3), ("c", 0.2))]
    assert effect(of_pixels, judged(*values).ours) == "0.200 of the pixels (0.100 to 0.300)"
    assert effect(claim, judged(Check("a", MISSING)).ours) == ""
    assert effect(replace(claim, quantity=None), judged(*ratios).ours) == ""


def test_what_speaks_against_a_claim_is_named() -> None:
    against = [Check(name, NO, f"{name} is small") for name in "abc"]
    found = named(judged(Check("z", YES), *against).ours, NO)
    assert found == "a: a is small; b: b is small; 1 more"
    assert named(judged(Check("z", YES)).ours, NO) == ""


def test_the_cells_and_the_variants_that_agree_are_counted() -> None:
    one = judged(Check("a", YES), Check("b", NO), Check("c", UNDECIDED))
    assert agreeing(one.ours) == "1 of 3 (1 undecided)"
    findings = [judged(Check("a", outcome)).ours for outcome in (YES, YES, NO, UNDECIDED, MISSING)]
    assert variants_that_agree(replace(one, variants=tuple(findings))) == (
        "2 of 4 (1 contradicted, 1 undecided)"
    )
    assert variants_that_agree(one) == DASH


def test_the_ledger_is_written_with_its_cells(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "ledger.md"
    assert main(["claims", "--cells", "-o", str(target)]) == 0
    assert capsys.readouterr().out == f"{target}\n"
    text = target.read_text("utf-8")
    assert "| maceta 640x480, 0 to 10 objects | yes | 9.29 against 10.5 | missing |  |" in text


def test_a_folder_that_is_no_run_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["claims", str(tmp_path / "nowhere")]) == 2
    assert "there is no such file" in capsys.readouterr().err
