"""Drawing a whole run, as a user calls it."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import matplotlib.pyplot as plt
import pandas as pd
import pytest

from beambench_report.__main__ import main
from beambench_report.base.figure import Look, untimed
from beambench_report.base.quantities import number
from beambench_report.base.records import read_run
from beambench_report.run.bars import Bar, draw_bars
from beambench_report.run.plots import time_over_rays
from synthetic_run import synthetic_rows, without_times, write_run

PLOTS = {
    "time-escena1",
    "time-tetra-n-6",
    "build-and-trace",
    "break-even",
    "memory",
    "counters-escena1",
    "counters-tetra-n-6",
}


def plotted(folder: Path) -> set[str]:
    return {path.stem for path in (folder / "plots").glob("*.png")}


def svg_text(path: Path) -> str:
    return " ".join("".join(ElementTree.parse(path).getroot().itertext()).split())


def test_every_plot_is_written_as_png_and_svg(
    run_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["plots", str(run_folder)]) == 0
    folder = run_folder / "plots"
    assert plotted(run_folder) == PLOTS
    assert {path.stem for path in folder.glob("*.svg")} == PLOTS
    for path in folder.glob("*.png"):
        assert path.read_bytes().startswith(b"\x89PNG")
    written = {Path(line).name for line in capsys.readouterr().out.splitlines()}
    assert written == {path.name for path in folder.iterdir()}
    readme = (folder / "README.md").read_text()
    assert all(f"{stem}.png" in readme for stem in PLOTS)
    assert len(pd.read_csv(folder / "break-even.csv", keep_default_na=False)) == 24


def test_plotting_again_replaces_and_leaves_nothing_beside(run_folder: Path) -> None:
    assert main(["plots", str(run_folder)]) == 0
    first = {path.name: path.read_bytes() for path in (run_folder / "plots").iterdir()}
    assert main(["plots", str(run_folder)]) == 0
    assert {path.name: path.read_bytes() for path in (run_folder / "plots").iterdir()} == first


def test_a_wrong_contender_has_no_line_and_is_named_in_the_caption(tmp_path: Path) -> None:
    rows = [
        without_times(row, "mismatch")
        if row["scene"] == "escena1" and row["parameters"] == "max_level=6,max_objects=0"
        else row
        for row in synthetic_rows()
    ]
    run = read_run(write_run(tmp_path, rows))
    assert untimed(run.view("escena1")) == ["samet max_level=6 in escena1: mismatch"]
    plot = next(plot for plot in time_over_rays(run) if plot.stem == "time-escena1")
    lines = plot.figure.axes[0].get_legend_handles_labels()[1]
    assert lines == ["exhaustive", "samet max_level=5", "embree", "null"]
    assert main(["plots", str(tmp_path)]) == 0
    text = svg_text(tmp_path / "plots" / "time-escena1.svg")
    assert "samet max_level=6 in escena1: mismatch" in text
    assert "judged right" not in svg_text(tmp_path / "plots" / "time-tetra-n-6.svg")


def test_a_run_in_which_nothing_was_right_still_shows_its_counters(tmp_path: Path) -> None:
    rows = [without_times(row, "error") for row in synthetic_rows()]
    assert main(["plots", str(write_run(tmp_path, rows))]) == 0
    assert plotted(tmp_path) == {"memory", "counters-escena1", "counters-tetra-n-6"}


def test_one_cell_is_enough(tmp_path: Path) -> None:
    assert main(["plots", str(write_run(tmp_path, synthetic_rows()[3:4]))]) == 0
    assert plotted(tmp_path) == {"time-escena1", "build-and-trace", "memory", "counters-escena1"}


def test_a_wrong_request_is_one_sentence_and_exit_code_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["plots", str(tmp_path)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith(f"error: {tmp_path}/results.csv: there is no such file")
    assert captured.err.count("\n") == 1


def test_an_unwritable_folder_is_one_sentence_and_exit_code_2(
    run_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (run_folder / "plots").write_text("a file where the folder should be")
    assert main(["plots", str(run_folder)]) == 2
    assert f"error: {run_folder}/plots: " in capsys.readouterr().err


@pytest.mark.parametrize(
    ("value", "text"),
    [(0, "0"), (0.00123, "0.00123"), (4.567, "4.57"), (123.4, "123"), (12345.6, "12,346")],
)
def test_numbers_keep_three_significant_digits(value: float, text: str) -> None:
    assert number(value) == text


def test_a_bar_beside_bars_of_no_length_is_on_the_axis() -> None:
    figure, panel = plt.subplots()
    bars = [Bar(name, [value], "") for name, value in (("a", 0.0), ("b", 0.0), ("c", 14.3))]
    draw_bars(panel, bars, {name: Look("black", "o", "-") for name in "abc"}, "per ray")
    assert panel.get_xlim()[1] > 14.3
    plt.close(figure)
