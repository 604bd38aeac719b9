"""Scenes that move: the plot over frames, and the published figures on updates."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from beambench_operations.publish.figures.frames import figures
from beambench_report.base.analysis import read_analysis
from beambench_report.base.figure import house_style
from beambench_report.base.names import brief_name
from beambench_report.run.frames import frames, moving_views
from beambench_report.run.labels import spread
from beambench_report.run.measured import read_measured
from synthetic_run import synthetic_rows, write_repeated_cell, write_run

FRAMES = (0, 5, 19)
SUBJECT = "sheet/default/320x200/1/primary"


def cost(ready: float, trace: float) -> dict[str, float | None]:
    return {"ready_ms": ready, "trace_ms": trace, "sah_cost": None}


def ratio(value: float) -> dict[str, float | bool]:
    return {"value": value, "low": 0.9 * value, "high": 1.1 * value, "paired": True}


def series(contender: str, rebuild_after: int | None, totals: tuple[float, ...]) -> dict:
    return {
        **{"contender": contender, "subject": SUBJECT, "mean_ms": 3.0},
        "rebuild_after": rebuild_after,
        "frames": [
            {
                **{"frame": frame, "updated": cost(1, 2), "built": cost(4, 2)},
                **{"total_ratio": ratio(total), "trace_ratio": ratio(1 + 0.1 * frame)},
            }
            for frame, total in zip(FRAMES, totals, strict=True)
        ],
    }


@pytest.fixture
def moving(tmp_path: Path) -> Path:
    """A run of three frames of a scene: two structures, rebuilt and updated, and a grid."""
    base = next(row for row in synthetic_rows() if row["structure"] == "samet")
    rows = []
    for frame in FRAMES:
        for structure, parameters in (
            ("sah-bvh", "builder=binned,update=false"),
            ("sah-bvh", "builder=binned,update=true"),
            ("sah-bvh", "builder=lbvh,update=false"),
            ("embree", "update=false"),
            ("embree", "update=true"),
            ("voxel-grid", "density=4"),
        ):
            names = {"structure": structure, "parameters": parameters, "frame": frame}
            total = 3.0 + frame if "update=true" in parameters else 6.0
            times = {"trace_ms_median": 2.0, "total_ms_median": total}
            rows.append(base | names | times | {"scene": f"sheet@{frame}"})
    write_run(tmp_path, rows)
    path = tmp_path / "analysis.json"
    source = json.loads(path.read_text())
    won = series("sah-bvh", None, (0.5, 0.6, 0.7))
    lost = series("embree:robust=false", 4, (0.5, 1.0, 1.5))
    path.write_text(json.dumps(source | {"frame_series": [won, lost]}))
    return tmp_path


def test_each_contender_has_a_line_over_the_frames(moving: Path) -> None:
    (view,) = moving_views(read_measured(moving))
    assert (view.title, view.ray_kind) == ("sheet, 320x200", "primary")
    assert [(line.label, line.is_updated) for line in view.lines] == [
        ("sah-bvh binned", False),
        ("sah-bvh binned, updated", True),
        ("sah-bvh lbvh", False),
        ("embree", False),
        ("embree, updated", True),
        ("voxel-grid", False),
    ]
    assert view.lines[1].points == ((0, 3.0), (5, 8.0), (19, 22.0))
    assert [one.contender for one in view.series] == ["sah-bvh", "embree:robust=false"]


def test_updated_lines_are_solid_and_names_stand_beside_the_ends(moving: Path) -> None:
    with house_style():
        (plot,) = frames(read_measured(moving))
    assert plot.stem == "frames-primary"
    times, ratios = plot.figure.axes
    assert [line.get_linestyle() for line in times.lines] == ["--", "-", "--", "--", "-", "--"]
    assert {text.get_text() for text in times.texts} >= {"sah-bvh lbvh", "embree, updated"}
    assert [text.get_text() for text in ratios.texts] == ["sah-bvh", "embree robust=false"]
    assert (times.get_ylabel(), ratios.get_xlabel()) == (
        "ms per frame\n(lower is better)",
        "frame",
    )


def test_a_run_without_frames_has_no_such_figure(run_folder: Path) -> None:
    assert frames(read_measured(run_folder)) == []
    assert read_analysis(run_folder).frame_series == ()


def test_the_published_figures_say_which_series_an_update_wins(moving: Path) -> None:
    found = figures(moving)
    assert (found["series"], found["won"], found["lost"], found["whole"]) == (2, 1, 1, 1)
    assert found["frames"] == 20
    assert found["means"]["embree"]["primary"]["total"].value == pytest.approx(1.5)
    assert [row["primary"].every for row in found["rows"]] == ["all 20 frames", "4 frames"]
    (fastest,) = found["fastest"]
    assert fastest["name"]["grid"] == "voxel-grid"
    assert fastest["updated"]["total_ms"] == 22
    assert fastest["built"]["total_ms"] == 6


def test_the_time_of_an_updated_frame_is_without_the_build(tmp_path: Path) -> None:
    row = synthetic_rows()[0]
    repetition = {"round": 0, "position": 0, "build_ms": 50.0, "trace_ms": 2.0, "update_ms": 1.0}
    (tmp_path / "run").mkdir()
    write_repeated_cell(tmp_path / "run", row, [repetition])
    write_run(tmp_path / "run", [row])
    (cell,) = read_measured(tmp_path / "run").files.values()
    assert cell.total_ms == {0: 3.0}


@pytest.mark.parametrize(
    ("contender", "brief"),
    [
        ("samet", "samet"),
        ("sah-bvh builder=lbvh reinsertion=true update=false", "sah-bvh lbvh reinsertion"),
        ("samet max_level=6", "samet max_level=6"),
        (
            "embree mode=packet16 robust=false coherent=true",
            "embree packet16 robust=false coherent",
        ),
    ],
)
def test_crowded_plots_name_values_only(contender: str, brief: str) -> None:
    assert brief_name(contender) == brief


def test_names_are_moved_apart_within_the_panel() -> None:
    assert spread([1, 5], 0, 10, 2) == [1, 5]
    apart = spread([5, 5, 5], 0, 10, 2)
    assert apart == [3, 5, 7]
    assert spread([9.5, 10, 10], 0, 10, 2) == [6, 8, 10]
    crowded = spread([1, 1, 1, 1, 1], 0, 4, 2)
    assert crowded == [0, 1, 2, 3, 4]
    assert spread([3], 0, 10, 2) == [3]
