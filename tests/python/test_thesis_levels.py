"""The automatically chosen level compared with the best level: losses worked out by hand."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

from beambench_report.base.published import primitives_by_scene
from beambench_thesis.__main__ import main
from beambench_thesis.chapter5.levels import LevelChoice, draw_losses, level_choices, losses
from beambench_thesis.paper.cells import Cell, read_cells
from beambench_thesis.report.plan import LEVELS, PlannedCell, make_plan, quick, read_sweep
from beambench_thesis.report.report import gather
from beambench_thesis.report.write import write_report
from svg_texts import missing_in
from synthetic_run import without_times, write_manifest, write_run
from synthetic_thesis import Row, pages_of, row_of, texts_of, write_runs

REPOSITORY = Path(__file__).resolve().parents[2]
SWEEP = REPOSITORY / "harness/measure/sweeps/levels.json"


def row(
    level: int | str,
    total: float,
    *,
    depth: int | None = None,
    scene: str = "maceta",
    structure: str = "beam",
    cycles: float | None = None,
) -> Row:
    """Returns a cell at 320x200, measured at 3 GHz by default."""
    made = row_of(PlannedCell(scene, structure, (), "320x200", 1))
    parameters = str(made["parameters"]).replace("max_level=6", f"max_level={level}")
    return made | {
        "parameters": parameters,
        "depth": depth if depth is not None else level,
        "total_ms_median": total,
        "total_mcycles_median": 3 * total if cycles is None else cycles,
    }


def cells_of(folder: Path, *runs: tuple[str, list[Row]]) -> list[Cell]:
    for name, rows in runs:
        (folder / name).mkdir()
        write_run(folder / name, rows)
    return list(read_cells(folder, [name for name, _ in runs]).cells)


def one(folder: Path, *rows: Row) -> LevelChoice:
    (choice,) = level_choices(cells_of(folder, ("levels", list(rows))))
    return choice


def test_a_loss_is_against_the_best_level_with_the_choosing_and_without(tmp_path: Path) -> None:
    choice = one(tmp_path, row(5, 120), row(6, 100), row(7, 105), row("auto", 112, depth=7))
    assert (choice.level, choice.best, choice.is_best_at_end) == (7, 6, False)
    assert choice.loss == pytest.approx(0.12)
    assert choice.loss_of_level == pytest.approx(0.05)


def test_cycles_decide_and_milliseconds_where_some_were_not_counted(tmp_path: Path) -> None:
    rows = [row(5, 90, cycles=330), row(6, 100, cycles=300), row("auto", 99, depth=6, cycles=330)]
    choice = one(tmp_path, *rows)
    assert (choice.best, choice.is_best_at_end) == (6, True)
    assert choice.loss == pytest.approx(0.1)
    (tmp_path / "ms").mkdir()
    rows[1]["total_mcycles_median"] = ""
    choice = one(tmp_path / "ms", *rows)
    assert choice.best == 5
    assert choice.loss == pytest.approx(0.1)
    assert choice.loss_of_level == pytest.approx(100 / 90 - 1)


def test_levels_of_other_runs_count_but_not_those_measured_beside_the_choice(
    tmp_path: Path,
) -> None:
    cells = cells_of(
        tmp_path,
        ("best-octree", [row(6, 10), row(9, 80)]),
        ("levels", [row(5, 100), row(6, 90), row("auto", 96, depth=9)]),
    )
    (choice,) = level_choices(cells)
    assert {level: cell.time.value for level, cell in choice.fixed.items()} == {
        5: pytest.approx(0.1),
        6: pytest.approx(0.09),
        9: pytest.approx(0.08),
    }
    assert choice.loss == pytest.approx(0.2)
    assert choice.loss_of_level == pytest.approx(0)


def test_only_the_level_may_differ_and_only_what_was_right_counts(tmp_path: Path) -> None:
    handed = row(7, 1)
    handed["parameters"] = str(handed["parameters"]).replace("handover=0", "handover=48")
    wrong = without_times(row(8, 1), "mismatch")
    choice = one(
        tmp_path,
        handed,
        wrong,
        row(4, 1, scene="delfines"),
        row(4, 1, structure="samet"),
        row(5, 100),
        row(6, 110),
        row("auto", 100, depth=7),
    )
    assert list(choice.fixed) == [5, 6]
    assert (choice.level, choice.loss_of_level) == (7, None)


def test_a_choice_without_two_levels_beside_it_is_none(tmp_path: Path) -> None:
    rows = [row(5, 100), row("auto", 100, depth=5), row(4, 1, scene="delfines")]
    assert level_choices(cells_of(tmp_path, ("levels", rows))) == []


def synthetic_levels(folder: Path) -> list[Cell]:
    """Returns cells of ten scenes: losses of 0, 1, ... 8 and 30% for beams, 25% less for samet."""
    rows = []
    for number, scene in enumerate(list(primitives_by_scene())[:10]):
        loss = 0.01 * number if number < 9 else 0.3
        for structure, less in (("beam", 0.0), ("samet", 0.25)):
            auto = row("auto", 100 * (1 + loss - less), depth=7, scene=scene, structure=structure)
            rows += [
                row(6, 100, scene=scene, structure=structure),
                row(7, 104, scene=scene, structure=structure),
                auto,
            ]
    return cells_of(folder, ("levels", rows))


def test_the_summary_counts_good_choices_and_lists_the_worst(tmp_path: Path) -> None:
    choices = level_choices(synthetic_levels(tmp_path))
    beams = losses(choices, "beam")
    assert (len(beams.choices), beams.good, beams.share) == (10, 9, 0.9)
    assert beams.good_levels == (10, 10)
    assert beams.median == pytest.approx(0.045)
    assert [round(choice.loss, 2) for choice in beams.worst] == [0.3, 0.08, 0.07, 0.06, 0.05]
    assert losses(choices).share == 0.95
    assert losses(choices, "samet").worst[0].loss == pytest.approx(0.05)
    assert losses(choices, "samet").good == 10


def test_the_axis_of_losses_has_ticks_where_it_is_logarithmic(tmp_path: Path) -> None:
    write_run(tmp_path, [row("auto", 14.5, depth=6), row(6, 10), row(7, 12)])
    (run,) = (read_cells(tmp_path.parent, [tmp_path.name]),)
    panels = draw_losses("losses", level_choices(run.cells)).figure.axes
    low, high = panels[0].get_xlim()
    assert high > 45
    assert {10, 20, 50} <= {tick for tick in panels[0].get_xticks() if low <= tick <= high}


def test_the_command_prints_the_choices_or_writes_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    synthetic_levels(tmp_path)
    assert main(["levels", str(tmp_path / "levels")]) == 0
    printed = capsys.readouterr().out
    assert "19 of 20 choices (95%) lose less than 10%; the target, 90% of them, is met." in printed
    assert "| beam | 10 | 9 (90%) | 10 of 10 (100%) | +4.5% | +30.0% |" in printed
    assert "| 130 ms, levels:58 | 100 ms, levels:56 | +30.0% | +4.0%, levels:57 |" in printed
    file = tmp_path / "levels.md"
    assert main(["levels", str(tmp_path / "levels"), "-o", str(file)]) == 0
    assert "![Loss of the automatic choice against the best level](level-choice.png)" in (
        file.read_text()
    )
    assert (tmp_path / "level-choice.svg").exists()
    assert missing_in(tmp_path) == {}


@pytest.mark.parametrize("rows", [[], [row(5, 1), row(6, 1)]])
def test_a_run_without_choices_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], rows: list[Row]
) -> None:
    if rows:
        write_run(tmp_path, rows)
    assert main(["levels", str(tmp_path)]) == 2
    assert ("max_level=auto" if rows else "results.csv") in capsys.readouterr().err


def test_the_sweep_has_all_scenes_and_both_structures() -> None:
    source = json.loads(SWEEP.read_text())
    schema = json.loads((REPOSITORY / "harness/measure/sweep.schema.json").read_text())
    jsonschema.Draft202012Validator(schema).validate(source)
    sweep = read_sweep(LEVELS, SWEEP.parent)
    assert {cell.scene for cell in sweep.cells()} == set(primitives_by_scene())
    assert len(sweep.cells()) == 15 * 3 * 2 * 5
    assert ("max_level", "auto") in {pair for cell in sweep.cells() for pair in cell.parameters}
    assert quick(sweep).source["resolutions"] == ["320x200", "640x480"]


def test_a_plan_has_the_levels_where_they_are_asked_for() -> None:
    without, plan = make_plan(["5.4"], [], False), make_plan(["5.4"], [], False, with_levels=True)
    assert [sweep.name for sweep in plan.sweeps] == [
        *(sweep.name for sweep in without.sweeps),
        LEVELS,
    ]


def test_the_report_shows_choices_but_no_table_takes_their_rows(tmp_path: Path) -> None:
    plan = make_plan(["5.5"], [], False)
    run = write_runs(tmp_path / "run", plan)
    (run / LEVELS).mkdir()
    rows = [row(level, 1e-3, scene="misil") for level in (5, 6)]  # would win every table
    rows.append(row("auto", 2e-3, depth=6, scene="misil"))
    write_run(run / LEVELS, rows)
    write_manifest(run / LEVELS)
    source = {
        "name": "levels",
        "scenes": ["misil"],
        "resolutions": ["320x200"],
        "structures": [{"structure": "beam", "parameters": {"max_level": [5, 6, "auto"]}}],
    }
    (run / LEVELS / "config.json").write_text(json.dumps(source))
    report = gather(run, plan)
    assert "levels" in [section.anchor for section in report.sections]
    assert (report.runs[-1].name, report.runs[-1].planned) == (LEVELS, 3)
    shown = [
        entry.ours
        for _, parts in report.tables
        for part in parts
        for line in part.table.lines
        for entry in line.entries
    ]
    assert shown
    assert all(cell is None or cell.run != LEVELS for cell in shown)
    written = write_report(run, plan)
    assert written.cells == len(report.cells.cells)
    number = report.cells.cells[-1].number
    page, text = pages_of(run), texts_of(run)
    assert f'<a href="#row-{number}"' in page
    assert f'<tr id="row-{number}">' in page
    assert "## The level chosen automatically" in text
    assert f"0.00200 ms, #{number} |" in text
    assert (run / "figures/level-choice.png").exists()
