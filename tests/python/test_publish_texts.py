"""The texts of results/published agree with their committed rows."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pandas as pd
import pytest

from bare_figures import bare_figures
from beambench.analysis import Ratio
from beambench_operations.publish.documents import (
    PUBLISHED,
    differences,
    documents,
    module_of,
    write_documents,
)
from beambench_operations.publish.figures.thesis import compared, times_found_again
from beambench_operations.publish.figures.threads import is_implausible
from beambench_operations.publish.layout import laid_out
from beambench_report.base.files import Problem
from beambench_report.base.records import read_run
from beambench_thesis.claims.verdict import Verdict
from synthetic_run import synthetic_rows, write_repeated_cell, write_run


@pytest.fixture
def copied(tmp_path: Path) -> Path:
    """A folder of published runs with one of them, which may be corrupted."""
    shutil.copytree(PUBLISHED / "structures", tmp_path / "structures")
    return tmp_path


def test_every_text_states_what_its_rows_give() -> None:
    assert [str(one) for one in differences()] == []


def test_two_runs_of_the_thesis_are_compared_by_the_claims_that_both_decide() -> None:
    first = {
        "C01": Verdict.SUPPORTED,
        "C02": Verdict.SUPPORTED,
        "C03": Verdict.CONTRADICTED,
        "C04": Verdict.UNDECIDED,
        "C22": Verdict.MIXED,
    }
    second = {
        "C01": Verdict.SUPPORTED,
        "C02": Verdict.MIXED,
        "C03": Verdict.UNDECIDED,
        "C04": Verdict.UNDECIDED,
        "C22": Verdict.NOT_TESTED,
    }
    assert compared(first, second) == {
        "tested": 4,
        "decided": 2,
        "differ": ["C02"],
        "undecided": [["C04"], ["C03", "C04"]],
    }


def test_times_are_found_again_where_a_second_run_lies_in_their_intervals(tmp_path: Path) -> None:
    """One of 30 cells is outside its interval, and one has no interval; -4% counts like +4%."""
    changes = [1.06, 1.5, *(14 * [0.96]), *(14 * [1.04])]
    runs = []
    for name in ("first", "second"):
        rows = synthetic_rows()
        repeated = []
        for row, change in zip(rows, changes, strict=True):
            factor = change if name == "second" else 1.0
            times = [
                factor * ms for ms in ((97.5, 99, 100, 101.5, 102.5) if change < 1.5 else (100,))
            ]
            repeated.append(
                [
                    {"round": turn, "position": 0, "build_ms": 0, "trace_ms": ms, "clock_ghz": 3}
                    for turn, ms in enumerate(times)
                ]
            )
            row["trace_ms_median"] = 100.0 * factor
            row["total_mcycles_median"] = 110.0 * factor**2
        folder = tmp_path / name
        folder.mkdir()
        runs.append(read_run(write_run(folder, rows)))
        for row, repetitions in zip(rows, repeated, strict=True):
            write_repeated_cell(folder, row, repetitions)
    found = times_found_again([(runs[0], runs[1])])
    assert (found["cells"], found["within"]) == (29, 28)
    assert found["half"]["fastest"] == pytest.approx(0.04)
    assert found["most"] == {"fastest": pytest.approx(0.04), "median": pytest.approx(0.04 * 2.04)}


@pytest.mark.parametrize(
    ("speedup", "threads", "expected"),
    [
        (Ratio(2.27), 2, True),
        (Ratio(2.01, 1.9, 2.1), 2, False),
        (Ratio(2.2, 2.1, 2.3), 2, True),
        (Ratio(2.0), 2, False),
        (Ratio(2.27), 3, False),
    ],
)
def test_a_speedup_above_the_number_of_threads_is_implausible(
    speedup: Ratio, threads: int, expected: bool
) -> None:
    assert is_implausible(speedup, threads) is expected


def test_implausible_speedups_are_marked_and_left_out_of_ranges(tmp_path: Path) -> None:
    shutil.copytree(PUBLISHED / "threads", tmp_path / "threads")
    table = tmp_path / "threads/1/results.csv"
    rows = pd.read_csv(table, dtype=str, keep_default_na=False)
    slow = (rows["structure"] == "samet") & (rows["scene"] == "gato-bill")
    times = [name for name in rows if name.startswith("trace_ms")]
    rows.loc[slow, times] = rows.loc[slow, times].map(lambda ms: str(1.5 * float(ms)))
    rows.to_csv(table, index=False)
    write_documents(tmp_path)
    text = " ".join((tmp_path / "threads/README.md").read_text("utf-8").split())
    assert len(re.findall(r"\), implausible \|", text)) == 1
    assert "Of 24 speedups 1 is above 2" in text
    assert "the single-threaded run was probably disturbed" in text
    assert not re.search(r"other structures [\d.]+ to 2\.[1-9]", text)


def test_every_published_table_of_results_is_that_of_a_run() -> None:
    """The site lists any other table as unreadable."""
    tables = sorted(PUBLISHED.rglob("results.csv"))
    assert len(tables) > 50
    for table in tables:
        assert not read_run(table.parent).rows.empty


def test_there_are_templates_and_reports() -> None:
    found = {str(one.path.relative_to(PUBLISHED)) for one in documents()}
    assert {"structures/README.md", "structures/winners.md"} <= found


def test_a_wrong_digit_in_a_text_is_found(copied: Path) -> None:
    text = copied / "structures/README.md"
    stated = text.read_text("utf-8")
    figures = list(re.finditer(r"(?<=\| )\d+\.\d\d", stated))
    assert len(figures) > 20
    for figure in figures[:: len(figures) // 3]:
        last = figure.end() - 1
        digit = (int(stated[last]) + 1) % 10
        text.write_text(f"{stated[:last]}{digit}{stated[last + 1 :]}", "utf-8")
        (found,) = differences(copied)
        assert found.file == text
        assert found.line == stated.count("\n", 0, last) + 1
        assert f"{digit}" in found.stated
    text.write_text(stated, "utf-8")
    assert differences(copied) == []


def test_a_wrong_digit_in_the_rows_is_found(copied: Path) -> None:
    table = copied / "structures/results.csv"
    head, *rows = table.read_text("utf-8").splitlines()
    place = head.split(",").index("build_ms_median") - len(head.split(","))
    for number, row in enumerate(rows):
        fields = row.split(",")
        if ",kd-tree," in row and fields[place]:
            fields[place] = f"{10 * float(fields[place])}"
            rows[number] = ",".join(fields)
    table.write_text("\n".join([head, *rows]) + "\n", "utf-8")
    assert "winners.md" in {one.file.name for one in differences(copied)}


def test_the_command_writes_what_differs_and_nothing_else(copied: Path) -> None:
    text = copied / "structures/README.md"
    right = text.read_text("utf-8")
    text.write_text("nothing\n", "utf-8")
    assert write_documents(copied) == [text]
    assert text.read_text("utf-8") == right
    assert write_documents(copied) == []


def test_an_unknown_figure_names_template_and_line(copied: Path) -> None:
    template = copied / "structures/README.md.j2"
    template.write_text("# Title\n\nIt takes {{ nothing | fixed }} ms.\n", "utf-8")
    with pytest.raises(Problem, match=r"README\.md\.j2:3: 'nothing' is undefined"):
        differences(copied)


def test_a_sentence_that_is_not_so_any_more_is_found(copied: Path) -> None:
    template = copied / "structures/README.md.j2"
    sentence = "# Title\n\n{}The best is `tile-beam`.\n"
    template.write_text(sentence.format("{{ holds(order[0] == 'tile-beam') }}"), "utf-8")
    assert documents(copied)[0].text().endswith("\nThe best is `tile-beam`.\n")
    template.write_text(sentence.format("{{ holds(order[0] == 'samet') }}"), "utf-8")
    with pytest.raises(Problem, match=r"README\.md\.j2:3: this sentence no longer follows"):
        documents(copied)[0].text()


def test_lines_are_broken_anew() -> None:
    words = "word " * 40
    text = f"{words}\n12.5 ms\n\n| a | {words}|\n- {words}\n  {words}\n- b\n```\n{words}\n```\n# T"
    lines = laid_out(text).split("\n")
    assert max(len(line) for line in lines if line[0:1] not in ("|", "w")) <= 120
    assert "12.5 ms" in lines[1]
    assert lines[2] == ""
    assert lines[3].startswith("| a | word")
    assert [line[:6] for line in lines[4:8]] == ["- word", "  word", "  word", "  word"]
    assert lines[-5:] == ["- b", "```", words.rstrip(), "```", "# T"]


# Without a row, nothing is stated


def templates() -> list[Path]:
    return sorted(PUBLISHED.rglob("*.md.j2"))


@pytest.mark.parametrize("template", templates(), ids=lambda path: path.parent.name)
def test_templates_state_no_figure_of_their_own(template: Path) -> None:
    assert [str(one) for one in bare_figures(template)] == []


@pytest.mark.parametrize("template", templates(), ids=lambda path: path.parent.name)
def test_a_template_belongs_to_a_module(template: Path) -> None:
    if template.parent != PUBLISHED:
        assert module_of(template.parent.name)


@pytest.mark.parametrize(
    ("sentence", "figure"),
    [
        ("It takes 1.4 times as long.", "1.4"),
        ("It takes 3 times as long.", "3 times"),
        ("A third, 33%, are occluded.", "33%"),
        ("Of 2,088 cells", "2,088"),
        ("| `samet` | 4.57 |", "4.57"),
        ("within 45 s", "45 s"),
    ],
)
def test_a_figure_that_is_not_computed_is_found(tmp_path: Path, sentence: str, figure: str) -> None:
    template = tmp_path / "README.md.j2"
    template.write_text(f"# Title\n{{{{ value }}}}\n{sentence}\n", "utf-8")
    (found,) = bare_figures(template)
    assert (found.line, found.figure) == (3, figure)


@pytest.mark.parametrize(
    "sentence",
    [
        "It takes {{ ratio | fixed(2) }} times as long at 1280x1024 (`max_level=6`, `pad=0.5`).",
        "`--seconds 1.5` and [a link](../a-1.5.md), C12, SPD, the fifteen scenes of 1999.",
        "The thesis states {{ cited('0.75') }}.",
        "{% set digits = 2.5 %}",
    ],
)
def test_what_is_no_measurement_is_left_alone(tmp_path: Path, sentence: str) -> None:
    template = tmp_path / "README.md.j2"
    template.write_text(f"# Title\n{sentence}\n", "utf-8")
    assert list(bare_figures(template)) == []
