"""Drawing a whole run, called as by a user."""

from __future__ import annotations

import json
import shutil
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from xml.etree import ElementTree

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from beambench_report.__main__ import main
from beambench_report.base.figure import (
    caption,
    house_style,
    new_figure,
    svg_of,
    untimed,
    write_plot,
)
from beambench_report.base.names import brief_name
from beambench_report.base.quantities import number
from beambench_report.base.records import read_run
from beambench_report.run.counters import counters, counters_in_common
from beambench_report.run.crossings import cost_of_a_ray, crossings, leaders, overtakes
from beambench_report.run.distributions import thinned
from beambench_report.run.fronts import pareto_front
from beambench_report.run.labels import place_labels
from beambench_report.run.measured import read_measured
from beambench_report.run.plots import KINDS, draw
from beambench_report.run.resolutions import resolutions
from beambench_report.run.trade_offs import trade_offs
from svg_texts import missing_in
from synthetic_run import synthetic_rows, without_times, write_run, write_trace_cell

SVG = "{http://www.w3.org/2000/svg}"

PLOTS = {
    "overall",
    "trade-offs-escena1",
    "trade-offs-tetra-n-5",
    "resolutions",
    "break-even",
    "counters-escena1",
    "counters-tetra-n-5",
}


def plotted(folder: Path) -> set[str]:
    return {path.stem for path in (folder / "plots").glob("*.png")}


def svg_text(path: Path) -> str:
    return " ".join("".join(ElementTree.parse(path).getroot().itertext()).split())


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A run with all of its plots, and the printed messages."""
    run = write_run(tmp_path_factory.mktemp("drawn"), synthetic_rows())
    printed = StringIO()
    with redirect_stdout(printed):
        assert main(["plots", str(run)]) == 0
    return run, printed.getvalue()


def test_every_plot_is_written_as_png_and_svg(drawn: tuple[Path, str]) -> None:
    run, printed = drawn
    folder = run / "plots"
    assert plotted(run) == PLOTS
    assert {path.stem for path in folder.glob("*.svg")} == PLOTS
    for path in folder.glob("*.png"):
        assert path.read_bytes().startswith(b"\x89PNG")
    assert {Path(line).name for line in printed.splitlines()} == {
        path.name for path in folder.iterdir()
    }
    readme = (folder / "README.md").read_text()
    assert all(f"{stem}.png" in readme for stem in PLOTS)
    assert len(pd.read_csv(folder / "break-even.csv", keep_default_na=False)) == 24


def test_every_axis_and_color_of_a_plot_is_named(drawn: tuple[Path, str]) -> None:
    assert missing_in(drawn[0] / "plots") == {}


def test_plotting_again_replaces_and_leaves_nothing_beside(
    drawn: tuple[Path, str], tmp_path: Path
) -> None:
    run = shutil.copytree(drawn[0], tmp_path / "run")
    former = {path.name: path.read_bytes() for path in (run / "plots").iterdir()}
    assert main(["plots", str(run), "--kinds", "overall", "counters"]) == 0
    again = {path.name: path.read_bytes() for path in (run / "plots").iterdir()}
    kinds = ("overall", "counters")
    assert [name for name in again if Path(name).suffix in (".png", ".svg")]
    for name, content in former.items():
        if Path(name).suffix in (".png", ".svg"):
            assert again.get(name) == (content if name.startswith(kinds) else None), name
    assert again.keys() <= former.keys()


def test_only_the_kinds_that_are_named_are_drawn(
    run_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["plots", str(run_folder), "--kinds", "overall"]) == 0
    assert plotted(run_folder) == {stem for stem in PLOTS if stem.startswith("overall")}
    assert "Not drawn" not in (run_folder / "plots" / "README.md").read_text()
    with pytest.raises(SystemExit):
        main(["plots", str(run_folder), "--kinds", "pies"])
    assert "overall" in capsys.readouterr().err


def titles(path: Path) -> list[str]:
    """Returns the tooltips of a plot's SVG."""
    return [text.text or "" for text in ElementTree.parse(path).iter(f"{SVG}title")]


def with_cells(folder: Path, rows: list[dict[str, object]]) -> Path:
    """Adds nine repetitions of every cell, 1% apart, to a run."""
    write_run(folder, rows)
    for row in rows:
        median = float(str(row["trace_ms_median"]))
        write_trace_cell(folder, row, [median * (0.96 + 0.01 * turn) for turn in range(9)], [])
    return folder


def many_rows(scenes: int, variants: int, kind: str = "primary") -> list[dict[str, object]]:
    """Returns rows of two resolutions, with any number of views and contenders."""
    first = [row for row in synthetic_rows() if row["scene"] == "escena1" and row["width"] != 640]
    samet = [row for row in first if row["parameters"] == "max_level=5,max_objects=0"]
    return [
        row
        | {
            "scene": f"scene-with-a-long-name:parameter={scene}",
            "parameters": f"max_level={variant},max_objects=0",
            "ray_kind": kind,
            "trace_ms_median": float(str(row["trace_ms_median"])) * (1 + variant / 3),
            "build_ms_median": 1.0 + 9 / (1 + variant),
        }
        for scene in range(scenes)
        for variant in range(variants)
        for row in samet
    ]


def test_a_wrong_contender_has_no_line_and_is_named_in_the_caption(tmp_path: Path) -> None:
    rows = [
        without_times(row, "mismatch")
        if row["scene"] == "escena1" and row["parameters"] == "max_level=6,max_objects=0"
        else row
        for row in synthetic_rows()
    ]
    run = read_run(write_run(tmp_path, rows))
    assert untimed(run.view("escena1")) == ["samet max_level=6 in escena1: mismatch"]
    assert main(["plots", str(tmp_path), "--kinds", "trade-offs"]) == 0
    wrong, right = (
        tmp_path / "plots" / f"trade-offs-{stem}.svg" for stem in ("escena1", "tetra-n-5")
    )
    named = "samet max_level=6 in escena1: mismatch"
    assert named in svg_text(wrong)
    assert named not in svg_text(right)
    assert not any("max_level=6" in title for title in titles(wrong))
    assert any("max_level=6" in title for title in titles(right))


def test_of_a_structure_with_many_variants_only_the_fastest_have_lines(tmp_path: Path) -> None:
    (plot,) = resolutions(read_measured(write_run(tmp_path, many_rows(2, 6))))
    for panel in plot.figure.axes:
        names = [text.get_text() for text in panel.texts]
        assert sorted(names) == ["samet max_level=0", "samet max_level=1"]
    caption = " ".join(plot.figure.get_supxlabel().split())
    assert "Left out: 4 slower contenders; of each structure, the 2 fastest variants" in caption


def test_break_even_draws_who_is_ahead_and_names_each_line_at_its_end(run_folder: Path) -> None:
    measured = read_measured(run_folder)
    with house_style():
        [plot] = crossings(measured)
    for panel, view in zip(plot.figure.axes, measured.run.views, strict=True):
        rows = measured.finest(view)
        rows = rows[rows["structure"] != "null"]
        names = {text.get_text() for text in panel.texts}
        assert {brief_name(name) for name in rows["contender"]} <= names
        lines = [line for line in panel.lines if len(line.get_xdata()) > 1]
        thick = [line for line in lines if line.get_linewidth() > 1]
        assert len(lines) == len(rows)
        assert len(thick) == len(leaders(rows)) < len(rows)
        lowest = np.min([line.get_ydata() for line in lines], axis=0)
        assert np.array_equal(lowest, np.min([line.get_ydata() for line in thick], axis=0))


def test_counters_of_zero_are_stated_in_words(tmp_path: Path) -> None:
    rows = [
        {**row, "traversal_steps_per_ray": 0.0 if row["structure"] == "exhaustive" else 11.5}
        for row in synthetic_rows()
    ]
    measured = read_measured(write_run(tmp_path, rows))
    with house_style():
        [plot, _] = counters(measured)
    panel = next(one for one in plot.figure.axes if one.get_title("left") == "traversal steps")
    words = [text.get_text() for text in panel.texts]
    assert words.count("none") == 1
    assert "0" not in words
    assert all(value > 0 for line in panel.lines for value in line.get_xdata())


def test_a_caption_does_not_outgrow_its_figure(tmp_path: Path) -> None:
    rows = many_rows(12, 13)
    rows = [*rows[:80], *(without_times(row, "mismatch") for row in rows[80:])]
    run = read_run(write_run(tmp_path, rows))
    figure, _ = new_figure(2.0)
    caption(figure, run.rows, "What it shows.", times=True)
    assert figure.get_size_inches()[1] < 4.5
    assert "and 110 more" in figure.get_supxlabel()


def test_a_run_in_which_nothing_was_right_shows_its_counters_and_says_what_is_missing(
    tmp_path: Path,
) -> None:
    rows = [without_times(row, "error") for row in synthetic_rows()]
    assert main(["plots", str(write_run(tmp_path, rows))]) == 0
    assert plotted(tmp_path) == {"counters-escena1", "counters-tetra-n-5"}
    readme = (tmp_path / "plots" / "README.md").read_text()
    missing = readme[readme.index("Not drawn") :]
    kinds = ("overall", "trade-offs", "resolutions", "break-even", "distributions")
    assert all(f"- {kind}: " in missing for kind in kinds)


def test_one_cell_makes_no_plot_of_one_point(tmp_path: Path) -> None:
    assert main(["plots", str(write_run(tmp_path, synthetic_rows()[3:4]))]) == 0
    assert plotted(tmp_path) == set()
    assert json.loads((tmp_path / "plots" / "index.json").read_text()) == []


def test_of_one_resolution_there_is_no_plot_of_resolutions(tmp_path: Path) -> None:
    rows = [row for row in synthetic_rows() if row["width"] == 320]
    run = write_run(tmp_path, rows)
    assert main(["plots", str(run), "--kinds", "resolutions", "break-even"]) == 0
    assert plotted(tmp_path) == {"break-even"}


def test_what_was_drawn_before_and_is_no_more_goes_away(tmp_path: Path) -> None:
    draw = ["plots", str(tmp_path), "--kinds", "counters"]
    write_run(tmp_path, synthetic_rows())
    assert main(draw) == 0
    (tmp_path / "plots" / "mine.png").write_text("not ours")
    write_run(tmp_path, [row for row in synthetic_rows() if row["scene"] == "escena1"])
    assert main(draw) == 0
    assert plotted(tmp_path) == {"counters-escena1", "mine"}


def test_a_run_that_was_cut_off_is_drawn_at_the_size_that_two_contenders_have(
    tmp_path: Path,
) -> None:
    rows = [row for row in synthetic_rows() if row["scene"] == "escena1"]
    rows = [row for row in rows if row["width"] == 320 or row["structure"] == "embree"]
    measured = read_measured(write_run(tmp_path, rows))
    assert set(measured.finest("escena1")["width"]) == {320}
    assert main(["plots", str(tmp_path), "--kinds", "trade-offs", "resolutions"]) == 0
    assert plotted(tmp_path) == {"trade-offs-escena1", "resolutions"}


def test_repetitions_are_drawn_each(tmp_path: Path) -> None:
    run = with_cells(tmp_path, synthetic_rows())
    assert main(["plots", str(run), "--kinds", "distributions"]) == 0
    stems = {"distributions-escena1", "distributions-tetra-n-5"}
    assert plotted(tmp_path) == stems
    assert missing_in(tmp_path) == {}
    for stem in stems:
        shown = titles(tmp_path / "plots" / f"{stem}.svg")
        assert "samet max_level=5: 220 ns per ray (213 to 227); 9 repetitions" in " ".join(shown)


def test_intervals_are_drawn(tmp_path: Path) -> None:
    measured = read_measured(with_cells(tmp_path, synthetic_rows()))
    with house_style():
        [plot] = resolutions(measured)
        [trade_off, _] = trade_offs(measured)
    samet = measured.looks["samet max_level=5"].color
    row = measured.timed.query("contender == 'samet max_level=5' and width == 1280").iloc[0]
    assert row["ns_low"] == pytest.approx(0.97 * row["ns"])
    assert row["ns_high"] == pytest.approx(1.03 * row["ns"])
    ends = [row["ns_low"], row["ns_high"]]
    lines = [line for line in plot.figure.axes[0].lines if line.get_color() == samet]
    assert any(set(ends) <= set(line.get_ydata()) for line in lines)
    lines = [line for line in trade_off.figure.axes[0].lines if line.get_color() == samet]
    assert any(list(line.get_xdata()) == ends for line in lines)


def test_no_figure_is_taller_than_a_page_or_a_large_file(tmp_path: Path) -> None:
    of_one_view = {"trade-offs", "distributions", "counters"}  # more views, more such figures
    stems = set()
    for scenes in (1, 12):
        (folder := tmp_path / str(scenes)).mkdir()
        measured = read_measured(with_cells(folder, many_rows(scenes, 13)))
        kinds = [kind for kind in KINDS if (kind.name in of_one_view) == (scenes == 1)]
        with house_style():
            for plot in draw(measured, kinds):
                stems.add(plot.stem)
                width, height = plot.figure.get_size_inches()
                assert height <= 1.4 * width, plot.stem
                assert len(svg_of(plot).encode()) < 70_000, plot.stem
    assert {"resolutions", "resolutions-2", "break-even", "break-even-3", "overall"} <= stems
    assert len([stem for stem in stems if stem.startswith(tuple(of_one_view))]) == 3


def test_points_say_contender_values_and_units(drawn: tuple[Path, str]) -> None:
    folder = drawn[0] / "plots"
    assert "samet max_level=6: 160 ns per ray; build 4.00 ms; memory 879 KiB" in titles(
        folder / "trade-offs-escena1.svg"
    )
    assert "embree: build 0.600 ms, then 60.0 ns per ray" in titles(folder / "break-even.svg")
    assert "samet max_level=6: 17.2 per ray" in titles(folder / "counters-escena1.svg")
    assert "exhaustive: 33.3 times the fastest, geometric mean over 2 views" in titles(
        folder / "overall.svg"
    )
    assert any(
        title.startswith("embree: 320x200 60.0 ns per ray; 640x480 60.0")
        for title in titles(folder / "resolutions.svg")
    )


def test_each_kind_of_rays_has_its_own_overview(tmp_path: Path) -> None:
    rows = [*many_rows(2, 3), *many_rows(2, 3, "whitted:shadows=cache")]
    assert main(["plots", str(write_run(tmp_path, rows)), "--kinds", "overall"]) == 0
    assert plotted(tmp_path) == {"overall-primary", "overall-whitted-shadows-cache"}


def test_unknown_structures_and_memory_of_nothing_are_drawn(tmp_path: Path) -> None:
    rows = [
        row | {"structure": "newcomer", "memory_bytes": 0} if row["structure"] == "embree" else row
        for row in synthetic_rows()
    ]
    with house_style():
        plots = {plot.stem: plot for plot in draw(read_measured(write_run(tmp_path, rows)))}
        write_plot(plots["trade-offs-escena1"], tmp_path)
    assert plots.keys() == PLOTS
    shown = titles(tmp_path / "trade-offs-escena1.svg")
    assert "newcomer: 60.0 ns per ray; build 0.600 ms; memory 0 B" in shown


def test_the_front_has_those_that_no_other_one_beats() -> None:
    assert pareto_front([(3, 1), (1, 3), (2, 2), (2, 3), (4, 1), (1, 3)]) == [1, 2, 0]
    assert pareto_front([(1, 1), (2, 2)]) == [0]
    assert pareto_front([]) == []


def test_the_fastest_overtakes_others_where_both_cost_the_same(run_folder: Path) -> None:
    rows = read_measured(run_folder).finest("escena1").query("structure != 'null'")
    [(rays, other)] = overtakes(rows)
    assert other == "exhaustive"
    costs = [
        cost_of_a_ray(row["build_ms_median"], row["ns"], np.array([rays]))
        for _, row in rows.iterrows()
        if row["contender"] in ("embree", "exhaustive")
    ]
    assert costs[0] == pytest.approx(costs[1])


def test_only_counters_that_two_contenders_have_are_shown(run_folder: Path) -> None:
    rows = read_run(run_folder).finest("escena1").assign(alone=np.nan, nothing=0.0)
    rows.loc[rows.index[0], "alone"] = 1.0
    names = ["traversal_steps_per_ray", "alone", "nothing"]
    assert counters_in_common(rows, names) == names[:1]


def test_names_beside_points_cover_no_other_point() -> None:
    figure, panel = plt.subplots(dpi=100)
    spread = [(0.1, 0.1), (0.5, 0.5), (0.9, 0.9)]
    panel.plot(*zip(*spread, strict=True))
    assert place_labels(panel, spread, ["a name", "another", "third"], ["1", "2", "3"]) == set()
    assert len(panel.texts) == 3
    crowd = [(0.5 + 0.001 * place, 0.5) for place in range(40)]
    names = [f"contender {place}" for place in range(40)]
    assert place_labels(panel, crowd, names, [str(place) for place in range(40)]) is None
    assert len(panel.texts) == 3
    plt.close(figure)


def test_names_lie_off_slanting_lines_and_have_their_colors() -> None:
    figure, panel = plt.subplots(dpi=100)
    points = [(0.2, 0.2), (0.8, 0.8)]
    panel.set(xlim=(0, 1), ylim=(0, 1))
    # The line extends beyond the points, where a name would otherwise be placed.
    lines = [[(0.0, 0.2), (1.0, 0.2)], [(0.0, 0.0), (1.0, 1.0)]]
    assert (
        place_labels(panel, points, ["lower", "upper"], ["l", "u"], lines, ["#111111", "#222222"])
        == set()
    )
    assert [text.get_color() for text in panel.texts] == ["#222222", "#111111"]
    renderer = figure.canvas.get_renderer()
    for text in panel.texts:
        box = text.get_window_extent(renderer).transformed(panel.transData.inverted())
        assert not (box.y0 < 0.2 < box.y1)
        corners = [(x, y) for x in (box.x0, box.x1) for y in (box.y0, box.y1)]
        assert len({y > x for x, y in corners}) == 1, f"{text.get_text()} is crossed"
    plt.close(figure)


def test_points_without_room_for_a_name_have_a_number(tmp_path: Path) -> None:
    figure, panel = plt.subplots(dpi=100)
    points = [(0.2, 0.2), (0.50, 0.7), (0.52, 0.7), (0.54, 0.7)]
    panel.plot(*zip(*points, strict=True))
    names = ["alone", "the left one", "the one between", "the right one"]
    assert place_labels(panel, points, names, ["1", "2", "3", "4"]) == {2}
    assert {text.get_text() for text in panel.texts} == {"alone", names[1], "3", names[3]}
    plt.close(figure)


def test_the_legend_of_trade_offs_lists_the_numbered(tmp_path: Path) -> None:
    rows = [row for row in many_rows(1, 3) if row["width"] == 1280]

    def figure_of(traces: tuple[float, float, float]) -> Figure:
        timed = [row | {"trace_ms_median": trace} for row, trace in zip(rows, traces, strict=True)]
        with house_style():
            [plot] = trade_offs(read_measured(write_run(tmp_path, timed)))
        return plot.figure

    spread, same = figure_of((10.0, 40.0, 70.0)), figure_of((40.0, 40.0, 40.0))
    assert not any(axes.get_legend() for axes in spread.axes)
    [legend] = [axes.get_legend() for axes in same.axes if axes.get_legend()]
    assert [text.get_text()[0] for text in legend.get_texts()] == ["1", "2", "3"]


def test_many_repetitions_are_thinned_with_both_ends() -> None:
    assert thinned([1.0, 2.0, 3.0], 5) == [1.0, 2.0, 3.0]
    few = thinned([float(value) for value in range(100)], 10)
    assert len(few) == 10
    assert (few[0], few[-1]) == (0, 99)


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
