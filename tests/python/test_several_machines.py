"""Rows of several machines in one record: times are never divided across machines."""

from __future__ import annotations

from pathlib import Path

import pytest

from beambench_operations.site.entry import entry_of
from beambench_report.base.analysis import read_analysis
from beambench_report.base.files import Problem
from beambench_report.base.machine import Machine
from beambench_report.base.records import read_run
from beambench_report.run.crossings import break_even_table
from beambench_report.run.page import render
from beambench_report.run.ratio_table import write_ratios
from beambench_report.run.reference import compared
from beambench_report.run.winners import races
from beambench_thesis.paper.measured import measured_evidence
from synthetic_run import synthetic_rows, write_run

MACHINES = ("0123456789abcdef", "fedcba9876543210")
SLOWER = 10.0
"""The factor by which everything takes longer on the second machine."""


def on_two_machines() -> list[dict[str, object]]:
    """Assigns the largest images to the second machine, which is slow; the others to the first."""
    rows = synthetic_rows()
    for row in rows:
        is_large = row["width"] == 1280
        row["machine_id"] = MACHINES[is_large]
        if is_large:
            for name, value in row.items():
                if "_ms_" in name and isinstance(value, float):
                    row[name] = SLOWER * value
    return rows


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_run(tmp_path, on_two_machines())


def test_a_view_is_what_one_machine_measured(folder: Path) -> None:
    run = read_run(folder)
    assert run.views == [
        "escena1, machine 01234567",
        "escena1, machine fedcba98",
        "tetra:n=5, machine 01234567",
        "tetra:n=5, machine fedcba98",
    ]
    assert set(run.rows["subject"]) == {"escena1", "tetra:n=5"}
    for view in run.views:
        assert run.view(view)["machine_id"].nunique() == 1


def test_means_are_over_the_highest_resolution_of_each_view(folder: Path) -> None:
    analysis = read_analysis(folder)
    assert [(one.view, one.size) for one in analysis.views] == [
        ("escena1, machine 01234567", "640x480"),
        ("escena1, machine fedcba98", "1280x1024"),
        ("tetra:n=5, machine 01234567", "640x480"),
        ("tetra:n=5, machine fedcba98", "1280x1024"),
    ]
    assert {one.size for one in analysis.views if one.in_means} == {"1280x1024"}
    (whole,) = analysis.means
    assert whole.views == 2


def test_ratios_are_those_of_one_machine(folder: Path, tmp_path: Path) -> None:
    """The ratios must be the same as if one machine had measured everything."""
    alone = tmp_path / "alone"
    alone.mkdir()
    write_run(alone, synthetic_rows())
    embree = "embree"
    found, wanted = (
        {
            (group.rows["scene"].iloc[0], group.rows["rays"].iloc[0], contender): ratio.value
            for view in run.views
            for group in compared(run, view, embree, {})
            for contender, ratio in group.ratios.items()
        }
        for run in map(read_run, (folder, alone))
    )
    assert found == pytest.approx(wanted)
    assert len(races(read_run(folder).rows, {})) == len(races(read_run(alone).rows, {}))
    assert len(entry_of(read_run(folder)).cells) == len(entry_of(read_run(alone)).cells)


def test_a_page_names_the_machines(folder: Path) -> None:
    text = render(read_run(folder))
    assert "escena1, machine fedcba98" in text
    assert "escena1, machine 01234567" in text


def test_break_even_is_between_rows_of_one_machine(folder: Path) -> None:
    table = break_even_table(read_run(folder))
    assert table["view"].str.contains(", machine ").all()


def test_tables_over_scenes_and_resolutions_are_refused(folder: Path) -> None:
    with pytest.raises(Problem, match=r"from 2 machines \(0123456789abcdef, fedcba9876543210\)"):
        measured_evidence([folder])


def test_several_machines_are_different_even_from_themselves() -> None:
    one = Machine(MACHINES[:1], "")
    both = Machine(MACHINES, "")
    assert both.differs_from(both)
    assert both.differs_from(one)
    assert not one.differs_from(one)


def test_the_table_of_ratios_has_them_within_each_machine(tmp_path: Path) -> None:
    rows = on_two_machines()
    for row in rows:
        row["trace_net_ms_median"] = row["trace_ms_median"]
    text = write_ratios(write_run(tmp_path, rows), "embree", None)
    assert isinstance(text, str)
    embree = next(line for line in text.splitlines() if line.startswith("| `embree"))
    assert embree.count("; 1.00 |") == 2
    assert embree.rstrip(" |").endswith("1.000")
