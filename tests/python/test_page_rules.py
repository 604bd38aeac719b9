"""Pages of results: rankings have intervals, and links and plots have the figures of the rows."""

from __future__ import annotations

import csv
import json
import shutil
from pathlib import Path

import pytest

from beambench_operations.publish.documents import PUBLISHED
from beambench_operations.publish.figures.origins import require_one_origin
from beambench_operations.publish.figures.threads import figures as figures_of_threads
from beambench_operations.publish.plots import differences, texts, write_plots
from beambench_report.base.files import ROOT, Problem
from page_rules import bare_rankings, blocks, stated_otherwise

PAGES = sorted(PUBLISHED.rglob("*.md"))
FINDINGS = [ROOT / "README.md", PUBLISHED / "README.md"]
"""The pages whose figures are those of other pages."""
WITH_PLOTS = sorted(
    path for path in PUBLISHED.iterdir() if path.is_dir() and next(path.rglob("*.svg"), None)
)


def page_of(folder: Path, text: str, name: str = "README.md") -> Path:
    folder.mkdir(exist_ok=True)
    (folder / name).write_text(text, "utf-8")
    return folder / name


# Intervals


def test_no_ranking_lacks_an_interval() -> None:
    assert len(PAGES) > 30
    found = [str(one) for page in [ROOT / "README.md", *PAGES] for one in bare_rankings(page)]
    assert found == []


@pytest.mark.parametrize(
    "sentence",
    [
        "It is 2.4 times as fast as Embree.",
        "It takes 2.4 times as\nlong as Embree.",
        "It takes 0.83 to 3.34 times as long.",
        "It takes 0.9 (single), 0.95 (stream) times as long.",
        "It takes 42% of the time of Embree.",
        "It takes 0.42 of the time of Embree.",
        "It is 12% faster.",
        "It is 2 times faster.",
        "- Without intervals: nothing.\n- It is 2.4 times as fast.",
        "Unranked.\n\n## Next\nIt is 2.4 times as fast.",
        "How many times as fast it is:\n\n| scene | gain |\n|---|---|\n| a | 2.4 |",
        "How many times as fast:\n\n| scene | a | b |\n|---|---|---|\n| a | 2.4 (2 to 3) | *2.4* |",
    ],
)
def test_a_ranking_without_an_interval_is_found(tmp_path: Path, sentence: str) -> None:
    page = page_of(tmp_path, f"# Title\n{sentence}\n")
    (found,) = bare_rankings(page)
    assert found.file == page
    line = page.read_text("utf-8").splitlines()[found.line - 1]
    assert line.startswith(("It ", "- It", "| a"))


@pytest.mark.parametrize(
    "sentence",
    [
        "It is 2.4 (2.3 to 2.5) times as fast as Embree.",
        "It takes 2.4 times (2.3 to 2.5) as long.",
        "It takes 0.42 (0.40 to 0.44) of the time of Embree.",
        "It is 2.4 (no interval) times as fast.",
        "It takes 2.4 times as long: medians, without intervals.",
        "Medians, unranked.\n\n- It is 2.4 times as fast.",
        "The machines were busy 27% of the time of the busiest.",
        "The thesis counts 2.4 times as many beams.",
        "Times as fast:\n\n| scene | rays | gain |\n|---|---|---|\n| a | 512 | 2.4 (2 to 3) |",
        "Milliseconds:\n\n| scene | ms |\n|---|---|\n| a | 2.4 |",
        "```\n2.4 times as fast\n```",
    ],
)
def test_what_has_an_interval_or_ranks_nothing_is_left_alone(tmp_path: Path, sentence: str) -> None:
    assert list(bare_rankings(page_of(tmp_path, f"# Title\n{sentence}\n"))) == []


def test_blocks_know_their_lines_and_the_paragraphs_above_them() -> None:
    text = "# A\none\ntwo\n\n- x\n  y\n- z\n\n| a |\n|---|\n| b |\n\n## B\nthree\n"
    assert [(one.line, one.text, one.lead) for one in blocks(text)] == [
        (2, "one two", ""),
        (5, "- x y", "one two"),
        (7, "- z", "one two"),
        (9, "| a | |---| | b |", "one two"),
        (14, "three", ""),
    ]


# Links


def test_the_findings_are_those_of_the_pages_that_they_link() -> None:
    assert [str(one) for page in FINDINGS for one in stated_otherwise(page)] == []


@pytest.mark.parametrize("digit", ["5", "6"])
@pytest.mark.parametrize(
    "text",
    [
        "It is 2.4 (2.3 to 2.{}) times as fast ([other](other/README.md#place)).",
        "[Gain](other/README.md):\n\n| scene | gain |\n|---|---|\n| a | 2.4 (2.3 to 2.{}) |",
    ],
)
def test_a_figure_that_the_linked_page_does_not_state_is_found(
    tmp_path: Path, text: str, digit: str
) -> None:
    page_of(tmp_path / "other", "# Other\nIt is 2.4 (2.3\nto 2.5) times as fast.\n")
    found = list(stated_otherwise(page_of(tmp_path, "# Title\n" + text.format(digit))))
    assert [one.words for one in found] == (
        [] if digit == "5" else ["'2.4 (2.3 to 2.6)' is in none of the linked pages"]
    )


# Plots


@pytest.mark.parametrize("folder", WITH_PLOTS, ids=lambda folder: folder.name)
def test_published_plots_show_the_labels_and_values_of_their_rows(folder: Path) -> None:
    assert [str(one) for one in differences(folder)] == []


def test_a_plot_that_shows_something_else_is_found_and_drawn_again(tmp_path: Path) -> None:
    folder = tmp_path / "frames"
    shutil.copytree(PUBLISHED / "frames", folder)
    right = folder / "plots/frames-primary.svg"
    svg = right.read_text("utf-8")
    label = next(one for one in texts(svg) if one.startswith("tile-beam"))
    right.write_text(svg.replace(label, "samet"), "utf-8")
    shutil.copy(folder / "plots/frames-diffuse.svg", folder / "plots/others.svg")
    altered, others = differences(folder)
    assert altered.file == right
    assert "samet" in altered.shown
    assert altered.computed is not None
    assert label in altered.computed
    assert "no rows beside it" in str(others)
    assert write_plots(tmp_path) == [right]
    assert texts(right.read_text("utf-8")) == texts(svg)


# Machines


def test_the_rows_of_a_run_are_of_its_commit_and_machine() -> None:
    tables = sorted(PUBLISHED.rglob("results.csv"))
    assert len(tables) > 50
    for table in tables:
        manifest = json.loads(table.with_name("manifest.json").read_text("utf-8"))
        with table.open(encoding="utf-8", newline="") as file:
            found = {(row["commit"], row.get("machine_id", "")) for row in csv.DictReader(file)}
        assert len(found) == 1, table
        ((commit, machine),) = found
        assert manifest["program"]["commit"] == commit, table
        assert machine in ("", manifest["machine"].get("id", "")), table


def test_runs_of_two_commits_or_machines_are_not_compared(tmp_path: Path) -> None:
    folder = tmp_path / "threads"
    shutil.copytree(PUBLISHED / "threads", folder)
    require_one_origin(folder / "1", folder / "2")
    figures_of_threads(folder)
    path = folder / "2/manifest.json"
    manifest = json.loads(path.read_text("utf-8"))
    manifest["machine"]["id"] = "another"
    path.write_text(json.dumps(manifest), "utf-8")
    with pytest.raises(Problem, match=r"threads/1 and .*threads/2 are compared.*another"):
        figures_of_threads(folder)


def test_a_page_names_the_commits_of_all_its_runs() -> None:
    for page in sorted(PUBLISHED.glob("*/README.md")):
        commits = {
            json.loads(manifest.read_text("utf-8"))["program"]["commit"][:7]
            for manifest in page.parent.rglob("manifest.json")
        }
        text = page.read_text("utf-8")
        assert {commit for commit in commits if commit not in text} == set(), page
