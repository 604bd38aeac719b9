"""The report on the thesis, from invented runs."""

from __future__ import annotations

import csv
import re
from dataclasses import replace
from pathlib import Path

import pytest

from beambench_report.base.files import Problem
from beambench_thesis.chapter5.best import best_table, choose
from beambench_thesis.claims.register import ALL_CLAIMS
from beambench_thesis.paper.cells import Cells, read_cells
from beambench_thesis.paper.evidence import Measured, setting
from beambench_thesis.paper.printed import parts_of, printed_parts
from beambench_thesis.report.plan import Plan, keep_plan, make_plan, read_plan
from beambench_thesis.report.report import Report, gather
from beambench_thesis.report.tables import fill
from beambench_thesis.report.write import write_report
from browser import Browser, find_browser
from svg_texts import missing_in
from synthetic_run import without_times
from synthetic_thesis import Row, pages_of, texts_of, write_runs

PLAN = make_plan([], [], False)


@pytest.fixture(scope="module")
def everything(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of all runs, whose hits are all correct."""
    return write_runs(tmp_path_factory.mktemp("thesis") / "run", PLAN)


@pytest.fixture(scope="module")
def cells(everything: Path) -> Cells:
    """The cells of all runs."""
    return cells_in(everything)


@pytest.fixture(scope="module")
def report(everything: Path) -> Report:
    """The facts that the page of all runs states."""
    return gather(everything, PLAN)


@pytest.fixture(scope="module")
def page(everything: Path) -> str:
    """The text of the page of all runs."""
    assert write_report(everything, PLAN).wrong == 0
    return pages_of(everything)


def cells_in(directory: Path, plan: Plan = PLAN) -> Cells:
    return read_cells(directory, [sweep.name for sweep in plan.sweeps])


def nothing(_: str) -> str:
    return "not run"


def test_every_number_that_the_thesis_prints_has_its_place_and_a_time_of_ours(
    cells: Cells, repository: Path
) -> None:
    seen = 0
    with (repository / "results/thesis/times.csv").open() as file:
        printed = len(list(csv.reader(file))) - 1
    for part in printed_parts():
        for line in fill(part, cells, nothing).lines:
            told = [entry for entry in line.entries if entry.thesis is not None]
            assert all(entry.ours and entry.ours.time for entry in line.entries), line.label
            assert bool(told) != line.is_reference
            seen += len(told)
    assert seen == printed


def test_a_cell_holds_both_times_and_both_shapes_over_the_first_row_at_320x200(
    cells: Cells,
) -> None:
    table = fill(parts_of("5.4")[0], cells, nothing)
    beam, samet = table.lines[0].entries, table.lines[1].entries
    assert (beam[0].thesis, beam[0].thesis_shape) == (2.21, 1.0)
    assert samet[4].thesis == 45.87
    assert samet[4].thesis_shape == pytest.approx(45.87 / 2.21)
    # Level 6: 5 + 6.4 ms for beams, 4 + 2 * 131.072 ms for Samet.
    assert beam[0].ours.time.value == pytest.approx(0.0114)
    assert samet[4].ours.time.value == pytest.approx(0.004 + 0.2621440)
    assert samet[4].shape.value == pytest.approx(0.266144 / 0.0114)
    assert samet[4].shape.low < samet[4].shape.value < samet[4].shape.high
    assert samet[4].ours.build == 0.004
    assert samet[4].ours.run == "synthetic"
    assert [line.label for line in table.lines if line.is_reference] == [
        "sah-bvh (of today)",
        "embree (of today)",
    ]


def test_the_thesiss_hierarchy_places_objects_beside_terminal_nodes_and_the_other_is_an_extra(
    cells: Cells,
) -> None:
    for part in (*parts_of("5.6"), *parts_of("5.7"), *parts_of("5.8")):
        lines = fill(part, cells, nothing).lines
        of_hierarchies = [line for line in lines if line.structure == "goldsmith-salmon"]
        assert [(line.label, line.is_reference) for line in of_hierarchies] == [
            ("hierarchy (Bounding Box)", False),
            ("hierarchy, insert=everywhere (Goldsmith and Salmon 1987)", True),
        ]
        for line, insertion in zip(of_hierarchies, ("terminal", "everywhere"), strict=True):
            for entry in line.entries:
                wanted = {"order": "given", "queue": "heap", "insert": insertion}
                assert wanted.items() <= entry.ours.parameters.items()


def test_leaves_and_pixels_stand_beside_table_5_3(cells: Cells) -> None:
    lines = fill(parts_of("5.3")[0], cells, nothing).lines
    assert lines[2].label == "level 6"
    assert lines[2].counts == ((1529, 600), (212142, round(0.2 * 1310720)))


def test_a_cell_that_was_wrong_has_no_time_but_its_verdict(tmp_path: Path) -> None:
    plan = make_plan(["5.4"], [], False)

    def spoil(row: Row) -> Row:
        wrong = row["structure"] == "samet" and row["width"] == 640
        return without_times(row, "mismatch") if wrong else row

    run = write_runs(tmp_path / "run", plan, spoil)
    written = write_report(run, plan)
    entry = fill(parts_of("5.4")[0], cells_in(run, plan), nothing).lines[1].entries[1]
    assert (entry.missing, entry.shape) == ("no time: mismatch", None)
    assert written.wrong == 2
    text = pages_of(run)
    assert "2 of them wrong, and without times" in text
    assert "no time: mismatch" in text
    assert "no time: mismatch" in texts_of(run)


def test_the_best_is_the_quickest_by_cycles_of_those_that_were_right(cells: Cells) -> None:
    part = parts_of("5.7")[1]
    table = best_table(part, cells)
    assert table.resolutions == ("320x200", "1280x1024")
    named = {line.label: line for line in table.lines}
    grid = named["voxel grid (Matriz Voxel)"].choices[1]
    assert grid.parameters == "resolution=24, fill=lazy"
    assert grid.tried == 11
    assert not grid.is_edge
    assert grid.ratio.value == pytest.approx((20 + 1.5 * 131.072) / (5 + 131.072))
    beam = named["beams (Tr. Haces), handover=0, leaf=exact"].choices[1]
    assert (beam.parameters, beam.tried, beam.ratio.value) == ("max_level=6", 5, 1.0)
    assert named["beams (Tr. Haces), with today's means"].choices[1].tried == 11
    assert named["embree"].choices[0].parameters == ""


def test_seconds_decide_only_where_no_cycles_were_counted(tmp_path: Path) -> None:
    plan = make_plan(["5.5"], [], False)

    def slow_clock(row: Row) -> Row:
        """Simulates a slow clock at level 6: more milliseconds, but the same cycles."""
        if "max_level=6" not in str(row["parameters"]):
            return row
        return row | {"total_ms_median": 3 * float(str(row["total_ms_median"]))}

    def no_cycles(row: Row) -> Row:
        return slow_clock(row) | {name: "" for name in row if str(name).startswith("total_mcycles")}

    levels = []
    for number, change in enumerate((slow_clock, no_cycles)):
        run = write_runs(tmp_path / str(number), plan, change)
        found = cells_in(run, plan).of("misil", "samet", "1280x1024")
        levels.append(choose(found).cell.parameters["max_level"])
    assert levels[0] == "6"
    assert levels[1] in ("5", "7")


def test_a_best_level_at_the_end_of_the_sweep_is_told(tmp_path: Path) -> None:
    plan = make_plan(["5.5"], [], False)

    def deep(row: Row) -> Row:
        level = int(str(row["parameters"]).partition("max_level=")[2][:1] or 6)
        return row | {"total_mcycles_median": 1000.0 - level}

    run = write_runs(tmp_path / "run", plan, deep)
    choice = choose(cells_in(run, plan).of("misil", "samet", "320x200"))
    assert (choice.parameters, choice.is_edge) == ("max_level=9", True)
    write_report(run, plan)
    assert "at the end of the tried range" in texts_of(run)


def test_the_page_holds_everything_and_every_number_leads_to_its_row(page: str) -> None:
    links = set(re.findall(r'href="(?:details.html)?#([^"]+)"', page))
    anchors = set(re.findall(r'id="([^"]+)"', page))
    assert links <= anchors
    assert sum(link.startswith("row-") for link in links) > 300
    assert not re.search(r'(?:src|href)="(?!#|data:|details.html|report.html)', page)
    for table in ("5.2", "5.3", "5.4", "5.5", "5.6", "5.7", "5.8"):
        assert f'id="table-{table}"' in page
    for figure in ("5.6", "5.7", "5.8", *(f"5.{n}" for n in range(10, 19))):
        assert f'id="figure-{figure}"' in page
    for claim in (*range(1, 22), *range(25, 32)):
        assert f'id="claim-C{claim:02}"' in page
    planned = sum(len(sweep.cells()) for sweep in PLAN.sweeps)
    assert f"{planned:,} measurements in 15 runs, all with correct hits." in page


def test_a_row_of_the_list_names_file_line_and_cell(
    everything: Path, cells: Cells, page: str
) -> None:
    assert page
    cell = cells.at(setting("escena2", "samet", "640x480", level=6))
    with (everything / "rows.csv").open() as file:
        row = list(csv.DictReader(file))[cell.number - 1]
    assert (row["file"], row["row"]) == ("synthetic/results.csv", str(cell.number))
    with (everything / row["file"]).open() as file:
        there = list(csv.DictReader(file))[int(row["line"]) - 2]
    assert (there["scene"], there["structure"], there["width"]) == ("escena2", "samet", "640")
    assert row["cell"].startswith("escena2/default/640x480/1/primary/samet:max_level=6,")
    assert f"#{cell.number} |" in texts_of(everything)


def test_captions_hold_the_thesiss_numbers(report: Report) -> None:
    captions = {figure.number: figure.caption for figure in report.figures}
    assert "Samet 2.26 to 45.87 s" in captions["5.12"]
    assert "Escena 1 2.21 to 13.52 s (+512%)" in captions["5.8"]
    assert "Caracol" in captions["5.10"]
    assert "93 s" in captions["5.17"]


def test_captions_state_that_few_repetitions_have_no_bars(report: Report) -> None:
    captions = [figure.caption for figure in report.figures]
    with_bars = [caption for caption in captions if "ars are 95% intervals" in caption]
    assert len(with_bars) > 10
    assert all("points without bars have too few repetitions" in caption for caption in with_bars)


def test_every_axis_and_color_of_a_figure_is_named(everything: Path, page: str) -> None:
    assert 'id="figure-5.12"' in page
    assert missing_in(everything / "figures") == {}


def test_figures_are_drawn_as_multiples_of_the_same_base(report: Report) -> None:
    figures = {figure.number: figure for figure in report.figures}
    for panel in figures["5.12"].panels:
        for side in (panel.left, panel.right):
            assert side.lines[0].at[0][1].value == pytest.approx(1.0)
            assert len(side.lines) == 3
    five = figures["5.11"].panels[0]
    assert len(five.left.lines) == len(five.right.lines) == 4
    assert [place for place, _ in figures["5.14"].panels[0].right.lines[0].at] == [4, 5, 6, 7, 8]
    flamenco = {line.label: line.at for line in figures["5.17"].panels[0].right.lines}
    # The thesis's 93 s with 13 cells and 516 s with 32, divided by 516 s.
    assert flamenco["thesis"] == [
        (13.0, Measured.exact(pytest.approx(93 / 516))),
        (32.0, Measured.exact(1.0)),
    ]
    grids = flamenco["ours, grid filled lazily"]
    assert [place for place, _ in grids] == [8, 10, 13, 15, 16, 20, 24, 32, 48]


@pytest.mark.parametrize("present", ["synthetic", "none"])
def test_a_part_of_the_runs_makes_a_report_that_says_what_is_missing(
    present: str, tmp_path: Path
) -> None:
    run = write_runs(tmp_path / "run", PLAN, only=lambda sweep: sweep.name == present)
    write_report(run, PLAN)
    text = pages_of(run)
    assert ("Nothing has been measured yet." in text) == (present == "none")
    assert "Some planned runs are missing or incomplete" in text
    assert "not run" in text
    assert ('id="figure-5.12"' in text) == (present == "synthetic")
    assert 'id="figure-5.13"' not in text
    assert "– not run" in texts_of(run)  # noqa: RUF001


def test_a_run_that_cannot_be_read_is_told_and_the_others_are_shown(tmp_path: Path) -> None:
    plan = make_plan(["5.4"], [], False)
    run = write_runs(tmp_path / "run", plan)
    (run / "best-synthetic" / "results.csv").write_text("nothing,of,this\n1,2,3\n")
    write_report(run, plan)
    text = pages_of(run)
    assert "best-synthetic/results.csv" in text
    assert "100 measurements in 1 runs" in text


def test_a_plan_of_before_a_figure_was_drawn_shows_it_too(tmp_path: Path) -> None:
    plan = make_plan(["5.2"], [], False)
    keep_plan(replace(plan, figures=("5.6",)), tmp_path)
    assert read_plan(tmp_path) == plan


def test_a_plan_is_read_as_it_was_kept(everything: Path, tmp_path: Path) -> None:
    assert read_plan(everything) == PLAN
    with pytest.raises(Problem, match="give the folder that an earlier scripts/thesis wrote"):
        read_plan(tmp_path)
    (tmp_path / "thesis.json").write_text("[]")
    with pytest.raises(Problem, match="is not the plan of a run"):
        read_plan(tmp_path)


def test_the_report_is_short_and_names_no_claim_without_its_sentence(everything: Path) -> None:
    text = (everything / "report.md").read_text()
    assert len(text.split()) <= 5000
    said = {claim.name: claim.says for claim in ALL_CLAIMS}
    for line in text.splitlines():
        for name in re.findall(r"\bC\d\d\b", line):
            assert said[name] in line, line
    first = text.splitlines()[:12]
    assert "formerly" in text
    assert "variants that agree" not in text  # none was measured
    assert [line for line in first if line.startswith("- **Do beams beat single rays")]


@pytest.mark.parametrize("name", ["report", "details"])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_browser_complains_of_nothing_and_fetches_nothing(
    everything: Path, page: str, scheme: str, name: str, tmp_path: Path
) -> None:
    assert page
    program = find_browser()
    if program is None:
        pytest.skip("no Chromium on this system; scripts/setup installs it where apt has it")
    file = everything / f"{name}.html"
    with Browser(program, tmp_path / "profile") as browser:
        browser.open(file, scheme=scheme)
        assert browser.complaints == []
        assert [at for at in browser.requests if not at.startswith("data:")] == [file.as_uri()]
        wide = "document.documentElement.scrollWidth <= document.documentElement.clientWidth"
        assert browser.evaluate(wide)
