"""Object-space sampling compared with the thesis's five samples, from invented comparisons."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from beambench_report.base.files import Problem
from beambench_thesis.__main__ import main
from beambench_thesis.chapter5.sampling import (
    read_comparison,
    read_comparisons,
    sampling_section,
    write_sampling,
)
from beambench_thesis.paper.section import section_as_markdown
from beambench_thesis.report.plan import make_plan
from beambench_thesis.report.write import write_report
from svg_texts import missing_in
from synthetic_thesis import pages_of, texts_of, write_runs

Result = tuple[str, str, float, float, float]
RESULTS: list[Result] = [
    ("uniform", "1", 0.5, 50.0, 8.0),
    ("uniform", "5", 2.5, 200.0, 4.0),
    ("object-space", "0.15 0.6", 1.5, 160.0, 2.0),
    ("object-space", "0.3 1.2", 0.7, 40.0, 8.0),
    ("image-space", "0.1 0.5", 1.0, 300.0, 6.0),
    ("image-space", "0.05 0.3", 2.0, 400.0, 5.0),
]


def write_comparison(path: Path, scene: str = "delfines", results: list[Result] = RESULTS) -> Path:
    names = ("method", "setting", "rays_per_pixel", "trace_ms", "error")
    document = {
        "scene": scene,
        "primitives": 1692,
        "structure": "beam",
        "resolution": "640x480",
        "repetitions": 3,
        "results": [dict(zip(names, result, strict=True)) for result in results],
    }
    path.write_text(json.dumps(document))
    return path


def test_settings_between_two_that_were_tried_lie_on_the_line_that_is_drawn(
    tmp_path: Path,
) -> None:
    comparison = read_comparison(write_comparison(tmp_path / "a.json"))
    assert comparison.methods == ["uniform", "object-space", "image-space"]
    assert comparison.thesis.milliseconds == 200
    # The line runs from 40 ms, error 8, to 160 ms, error 2; on logarithmic scales, 4 is halfway.
    assert comparison.time_at_error("object-space", 4.0) == pytest.approx(80)
    assert comparison.error_at_time("object-space", 80.0) == pytest.approx(4)
    assert comparison.error_at_time("uniform", 100.0) == pytest.approx(math.sqrt(32))
    assert comparison.time_at_error("image-space", 4.0) is None
    assert comparison.error_at_time("object-space", 200.0) is None


def test_the_section_compares_with_five_samples_in_every_pixel(tmp_path: Path) -> None:
    slower = [
        *RESULTS[:2],
        ("object-space", "a", 1.0, 100.0, 8.0),
        ("object-space", "b", 1, 400, 2),
    ]
    files = [
        write_comparison(tmp_path / "a.json"),
        write_comparison(tmp_path / "b.json", "escena1:seed=1999,spheres=430", slower),
        write_comparison(tmp_path / "c.json", "tetra:n=6", RESULTS[2:]),
    ]
    section = sampling_section(read_comparisons(files)[0])
    text = section_as_markdown(section)
    assert [figure.stem for figure in section.figures] == [
        "sampling-delfines-640x480",
        "sampling-escena-1-640x480",
        "sampling-tetra-n-6-640x480",
    ]
    assert "|  | object-space | – | – | 80.0 ms | 40% | – |" in text  # noqa: RUF001
    assert "|  | object-space | – | – | 200 ms | 100% | 4.00 |" in text  # noqa: RUF001
    # 40% in delfines and 100% in escena1; tetra has no uniform samples for comparison.
    assert (
        "less time in 1 of the 2 scenes that were tried; the median, of 2, is 70% of the "
        "thesis's time." in text
    )
    assert "image-space: every setting that was tried has a larger error than five samples" in text
    assert "| object-space | 0.15, 0.6 | 1.500 | 160 ms | 2.000 |" in text


def test_a_method_whose_settings_all_have_a_smaller_error_is_better_and_no_failure(
    tmp_path: Path,
) -> None:
    better = [
        *RESULTS[:2],
        ("image-space", "a", 1.0, 100.0, 1.0),
        ("image-space", "b", 2, 150, 0.5),
    ]
    worse = [*RESULTS[:2], ("image-space", "a", 1.0, 100.0, 9.0)]
    files = [
        write_comparison(tmp_path / "a.json", "delfines", better),
        write_comparison(tmp_path / "b.json", "maceta", worse),
    ]
    comparison = read_comparison(files[0])
    assert comparison.time_at_error("image-space", 4.0) is None  # they do not reach that error
    assert comparison.reached("image-space", 4.0) == (100.0, False)
    assert read_comparison(files[1]).reached("image-space", 4.0) is None
    section = sampling_section(read_comparisons(files)[0])
    assert section.findings == (
        "image-space reaches the error of the thesis's five samples, or a smaller error, in less "
        "time in 1 of the 2 scenes that were tried; the median, of 1, is at most 50% of the "
        "thesis's time; in 1 of them, every setting has a larger error.",
    )
    text = section_as_markdown(section)
    assert "|  | image-space | – | – | at most 100 ms | at most 50% |" in text  # noqa: RUF001


def test_where_settings_crowd_only_the_ends_of_a_line_are_named(tmp_path: Path) -> None:
    results = [("uniform", str(n), n, 10.0 + 1e-3 * n, 10.0 - 1e-3 * n) for n in range(10, 70)]
    results += [("image-space", "0.5", 1, 100.0, 1.0)]
    section = sampling_section(
        [read_comparison(write_comparison(tmp_path / "a.json", results=results))]
    )
    (axes,) = section.figures[0].draw().figure.axes
    assert sorted(text.get_text() for text in axes.texts) == ["0.5", "10", "69"]


def test_the_plot_rings_what_the_thesis_did(tmp_path: Path) -> None:
    section = sampling_section([read_comparison(write_comparison(tmp_path / "a.json"))])
    (axes,) = section.figures[0].draw().figure.axes
    lines = {str(line.get_label()): line for line in axes.get_lines()}
    assert list(lines) == ["uniform", "object-space", "image-space", "the thesis's five samples"]
    assert lines["the thesis's five samples"].get_xydata().tolist() == [[200.0, 4.0]]
    assert lines["object-space"].get_xydata().tolist() == [[40.0, 8.0], [160.0, 2.0]]
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")


def test_every_setting_stands_beside_its_point_but_the_ringed_one(tmp_path: Path) -> None:
    comparison = read_comparison(write_comparison(tmp_path / "a.json"))
    (axes,) = sampling_section([comparison]).figures[0].draw().figure.axes
    settings = [point.setting for point in comparison.points if point is not comparison.thesis]
    shown = {text.get_text(): text for text in axes.texts}
    assert sorted(shown) == sorted(setting.replace(" ", ", ") for setting in settings)
    renderer = axes.figure.canvas.get_renderer()
    boxes = [text.get_window_extent(renderer) for text in shown.values()]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])


def test_the_command_writes_a_table_and_a_plot_a_scene(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = [
        write_comparison(tmp_path / f"{scene}.json", scene) for scene in ("delfines", "maceta")
    ]
    assert main(["sampling", *map(str, files), "-o", str(tmp_path / "out")]) == 0
    written = capsys.readouterr().out.split()
    assert [Path(name).name for name in written] == [
        "sampling.md",
        "sampling-delfines-640x480.png",
        "sampling-delfines-640x480.svg",
        "sampling-maceta-640x480.png",
        "sampling-maceta-640x480.svg",
    ]
    assert "](sampling-maceta-640x480.png)" in (tmp_path / "out/sampling.md").read_text()
    assert missing_in(tmp_path / "out") == {}


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"results": []}, "no results"),
        ({"results": [{"method": "uniform"}]}, "setting"),
        ({"results": [["uniform"]]}, "is not what"),
        ({"repetitions": "many"}, "many"),
    ],
)
def test_what_is_no_comparison_is_refused(
    tmp_path: Path, changes: dict[str, object], says: str
) -> None:
    path = write_comparison(tmp_path / "a.json")
    path.write_text(json.dumps(json.loads(path.read_text()) | changes))
    with pytest.raises(Problem, match=says):
        read_comparison(path)


def test_times_that_cannot_be_and_missing_and_doubled_files_are_refused(tmp_path: Path) -> None:
    zero = write_comparison(tmp_path / "a.json", results=[("uniform", "5", 2.5, 0.0, 4.0)])
    with pytest.raises(Problem, match="uniform 5: trace_ms"):
        read_comparison(zero)
    with pytest.raises(Problem, match="no such file"):
        read_comparison(tmp_path / "none.json")
    twice = [write_comparison(tmp_path / name) for name in ("b.json", "c.json")]
    with pytest.raises(Problem, match="are both of Delfines, 640x480"):
        write_sampling(twice, tmp_path)


def test_the_report_has_the_section_where_there_are_comparisons(tmp_path: Path) -> None:
    plan = make_plan(["5.6"], [], False)
    run = write_runs(tmp_path / "run", plan)
    (run / "sampling").mkdir()
    write_comparison(run / "sampling/delfines.json")
    (run / "sampling/maceta.json").write_text("cut o")  # affects its scene, not the report
    write_report(run, plan)
    page = pages_of(run)
    assert "sampling/maceta.json: is not what" in page
    assert '<section id="sampling">' in page
    assert "## Samples chosen in object space" in texts_of(run)
    assert (run / "figures/sampling-delfines-640x480.png").exists()
