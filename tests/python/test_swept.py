"""A parameter swept by a run: the resulting plots, and ratios worked out by hand."""

from __future__ import annotations

from pathlib import Path

from beambench_report.base.figure import PAGE_WIDTH
from beambench_report.base.palette import structure_color
from beambench_report.run.measured import read_measured
from beambench_report.run.swept import swept
from synthetic_run import synthetic_rows, write_run

Row = dict[str, object]


def swept_rows(scenes: int, times: dict[tuple[str, str], dict[int, float]]) -> list[Row]:
    """Returns rows of two resolutions; `times` has trace ms by structure, parameters and level."""
    sizes = [row for row in synthetic_rows() if row["structure"] == "null" and row["width"] != 640]
    return [
        row
        | {
            "scene": f"scene-{scene}",
            "structure": structure,
            "parameters": f"max_level={level}{others}",
            "trace_ms_median": time,
            "trace_ms_ci_low": 0.9 * time,
            "trace_ms_ci_high": 1.1 * time,
            "verdict": "ok",
        }
        for scene in range(scenes)
        for (structure, others), by_level in times.items()
        for level, time in by_level.items()
        for row in sizes[:2]
    ]


TIMES = {
    ("samet", ""): {6: 8.0, 7: 6.0},
    ("beam", ",handover=0"): {6: 4.0, 7: 12.0},
    ("beam", ",handover=48"): {6: 2.0, 7: 3.0},
    ("samet-net", ""): {6: 8.0},
}


def test_the_others_are_divided_by_the_structure_that_sweeps_nothing_else(tmp_path: Path) -> None:
    (plot,) = swept(read_measured(write_run(tmp_path, swept_rows(1, TIMES))))
    assert plot.stem == "by-max-level"
    panels = [axes for axes in plot.figure.axes if axes.get_title()]
    assert [axes.get_title() for axes in panels] == ["scene-0, 320x200", "scene-0, 1280x1024"]
    for axes in panels:
        joined = {
            tuple(map(float, line.get_ydata())): line
            for line in axes.lines
            if line.get_marker() in ("o", "s")
        }
        # 8 / 4, 6 / 12; 8 / 2, 6 / 3. samet-net has only one level, too few for a line.
        assert set(joined) == {(2.0, 0.5), (4.0, 2.0)}
        assert {line.get_color() for line in joined.values()} == {structure_color("beam")}
        assert {line.get_marker() for line in joined.values()} == {"o", "s"}
        bars = [line for line in axes.lines if len(set(line.get_xdata())) == 1]
        assert len(bars) == 4


def test_no_figure_is_taller_than_a_page(tmp_path: Path) -> None:
    plots = swept(read_measured(write_run(tmp_path, swept_rows(8, TIMES))))
    assert [plot.stem for plot in plots] == ["by-max-level", "by-max-level-2"]
    for plot in plots:
        width, height = plot.figure.get_size_inches()
        assert width == PAGE_WIDTH
        assert height <= 1.4 * width


def test_one_structure_alone_or_one_value_makes_no_figure(tmp_path: Path) -> None:
    alone = {key: of for key, of in TIMES.items() if key[0] == "samet"}
    assert swept(read_measured(write_run(tmp_path, swept_rows(1, alone)))) == []
    single = {key: {6: of[6]} for key, of in TIMES.items()}
    assert swept(read_measured(write_run(tmp_path, swept_rows(1, single)))) == []


def test_without_a_plain_structure_there_is_nothing_to_compare_with(tmp_path: Path) -> None:
    beams = {key: of for key, of in TIMES.items() if key[0] == "beam"}
    both = beams | {("samet", f",pad={pad}"): {6: 1.0, 7: 1.0} for pad in (1, 2)}
    assert swept(read_measured(write_run(tmp_path, swept_rows(1, both)))) == []
