"""Tile beams compared with Embree: ratios, intervals and outcomes worked out by hand."""

from __future__ import annotations

import json
from math import exp
from pathlib import Path

import pytest

from beambench.analysis import Ratio
from beambench_report.__main__ import main
from beambench_report.base.files import Problem
from beambench_report.base.palette import PAPER, structure_color
from beambench_report.base.records import read_run
from beambench_report.embree_comparison.pairings import Pairing, headlines, pairings
from beambench_report.embree_comparison.plots import plots
from beambench_report.embree_comparison.report import as_markdown
from beambench_report.embree_comparison.results import outcome
from beambench_report.embree_comparison.targets import groups
from program import output_of
from svg_texts import missing_in
from synthetic_run import write_run, write_trace_cell

BACKS_DRAWN = "backface_culling=false"
REPOSITORY = Path(__file__).resolve().parents[2]
Row = dict[str, object]


def row(
    structure: str,
    trace: float,
    *,
    scene: str = "tetra:n=6",
    resolution: str = "1280x1024",
    spread: float = 0.1,
    verdict: str = "ok",
    primitives: int = 4096,
    kind: str = "primary",
    shading: float = 0.0,
    **parameters: str,
) -> Row:
    width, height = (int(side) for side in resolution.split("x"))
    return {
        "schema_version": 1,
        "run_id": "20261122-100000-beat-embree",
        "commit": "0123456789abcdef",
        "dirty": "false",
        "machine_id": "feedfeedfeedfeed",
        "threads": 1,
        "structure_isa": "AVX512" if structure == "embree" else "AVX3",
        "scene": scene,
        "camera": "default",
        "primitives": primitives,
        "structure": structure,
        "parameters": ",".join(f"{name}={value}" for name, value in parameters.items()),
        "width": width,
        "height": height,
        "samples": 1,
        "ray_kind": kind,
        "harness_ms": shading,
        "rays": width * height,
        "build_ms_median": 1,
        "trace_ms_median": trace,
        "trace_ms_ci_low": (1 - spread) * trace,
        "trace_ms_ci_high": (1 + spread) * trace,
        "trace_warm_ms_median": 0.9 * trace,
        "total_ms_median": 1 + trace,
        "memory_bytes": 1,
        "verdict": verdict,
    }


def duels_of(folder: Path, *rows: Row) -> list[Pairing]:
    return pairings([read_run(write_run(folder, list(rows)))])


def test_the_fastest_right_mode_counts(tmp_path: Path) -> None:
    (pairing,) = duels_of(
        tmp_path,
        row("tile-beam", 2),
        row("embree", 90, mode="single", robust="false"),
        row("embree", 20, mode="packet16", robust="false"),
        row("embree", 15, mode="stream", robust="false", verdict="mismatch"),
        row("embree", 17, mode="stream", robust="true"),
        row("sah-bvh", 1),
    )
    assert pairing.embree.contender == "stream, robust"
    assert pairing.ratio.value == pytest.approx(8.5)
    assert not pairing.ratio.paired
    # Both medians are 10% from their ends: ln 0.9 and ln 1.1 in quadrature.
    assert pairing.ratio.low == pytest.approx(8.5 * exp(-0.142073), rel=1e-5)
    assert pairing.ratio.high == pytest.approx(8.5 * exp(0.142073), rel=1e-5)
    assert pairing.second_ratio == Ratio(pytest.approx(8.5))


def with_and_without_backs() -> list[Row]:
    return [
        made
        for scene in groups()[0].scenes
        for made in (
            row("tile-beam", 1, scene=scene, backface_culling="true"),
            row("tile-beam", 3, scene=scene, backface_culling="false"),
            row("embree", 12, scene=scene, mode="stream"),
        )
    ]


def test_the_headline_draws_the_backs_of_solids(tmp_path: Path) -> None:
    found = duels_of(tmp_path, *with_and_without_backs())
    assert sorted(one.ratio.value for one in found) == [4] * 6 + [12] * 6
    assert [one.ratio.value for one in headlines(found)] == [4] * 6
    text = as_markdown(found)
    assert "| tetra, 4 k | 4.00 (3.47 to 4.61), target 8: missed |" in text
    assert "| **geometric mean, first traces** | 4.00 (3.77 to 4.24), target 12: missed |" in text
    assert "| geometric mean, backs left out | 12.0" in text
    assert "| stream | 12.0 | 3.00 | 4.00 (3.47 to 4.61) |" in text
    assert "Omitted backs of solids: neither." in text


def test_without_the_backs_of_solids_a_target_cannot_be_met(tmp_path: Path) -> None:
    rows = [made for made in with_and_without_backs() if made["parameters"] != BACKS_DRAWN]
    text = as_markdown(duels_of(tmp_path, *rows))
    assert "| tetra, 4 k | 12.0 (10.4 to 13.8), target 8: open, backs left out |" in text
    assert "| **geometric mean, first traces** | 12.0 (11.3 to 12.7), target 12: open, b" in text
    assert "for single scenes, 0 of 6 are met, 6 open and 0 missed" in text
    assert "Omitted backs of solids: `tile-beam`, where a table states it." in text


def test_an_older_run_with_the_backs_of_solids_is_the_headline(tmp_path: Path) -> None:
    both = with_and_without_backs()[:3]
    runs = []
    for name, rows in (("a-1", both), ("b-2", [both[0], both[2]])):
        (tmp_path / name).mkdir()
        named = [made | {"run_id": name} for made in rows]
        runs.append(read_run(write_run(tmp_path / name, named)))
    found = pairings(runs)
    assert {(one.run_id, one.ratio.value) for one in found} == {("a-1", 4), ("b-2", 12)}
    assert [one.run_id for one in headlines(found)] == ["a-1"]


def test_lines_of_sizes_are_of_one_way_to_draw(tmp_path: Path) -> None:
    rows = [
        made
        for size in (10, 20, 40, 80, 160)
        for made in bumpy(size, "a-1", "1" * 40, backface_culling="true")
    ]
    rows += bumpy(40, "a-1", "1" * 40, backface_culling="false")[:1]
    (plot,) = (one for one in plots(duels_of(tmp_path, *rows)) if "scaling" in one.stem)
    assert plot.figure.axes[0].get_title() == "bumpy, 1280x1024, no backs"


def test_the_report_states_what_each_side_has(tmp_path: Path) -> None:
    tuned = {"parameter_sets": 8}
    rows = [
        row("tile-beam", 2, kind="shadow"),
        row("embree", 12, kind="shadow", mode="stream") | tuned,
        row("embree", 6, kind="shadow:order=sorted", mode="stream") | tuned,
    ]
    (pairing,) = found = duels_of(tmp_path, *rows)
    assert (pairing.kind, pairing.ratio.value) == ("shadow", 3)
    assert pairing.embree.contender == "stream (best of 8), sorted rays"
    text = as_markdown(found)
    assert "SIMD: both. Tuned parameters: Embree, by its times from another camera" in text
    assert "Sorted rays: both, where sorting is faster." in text
    neither = as_markdown(duels_of(tmp_path, *(made for made in with_and_without_backs())))
    assert "Tuned parameters: Embree, the fastest of up to 1 mode by the times below" in neither
    assert "Sorted rays: neither." in neither


def test_images_and_instruction_sets_are_kept_apart(tmp_path: Path) -> None:
    found = duels_of(
        tmp_path,
        row("tile-beam", 2, resolution="320x200"),
        row("embree", 8, resolution="320x200", mode="single"),
        row("tile-beam", 4, isa="avx2"),
        row("embree", 12, mode="single", isa="best"),
        row("embree", 20, mode="single", isa="avx2"),
        row("tile-beam", 4, scene="shells:n=5"),
    )
    assert [(pairing.resolution, pairing.isa) for pairing in found] == [
        ("320x200", "best"),
        ("1280x1024", "avx2"),
    ]
    assert [pairing.ratio.value for pairing in found] == [4, 5]


def test_without_an_interval_nothing_is_decided(tmp_path: Path) -> None:
    times = {"trace_ms_ci_low": "", "trace_ms_ci_high": ""}
    (pairing,) = duels_of(tmp_path, row("tile-beam", 2) | times, row("embree", 12, mode="single"))
    assert pairing.ratio == Ratio(6)
    assert outcome(pairing.ratio, 3) == outcome(pairing.ratio, 9) == "open"


def test_with_single_repetitions_the_ratio_is_paired_by_rounds(tmp_path: Path) -> None:
    """Rounds in which the machine was three times slower do not affect the ratio."""
    tile, embree = row("tile-beam", 2), row("embree", 12, mode="single")
    slow = [3.0 if turn in (1, 4, 5) else 1.0 for turn in range(7)]
    first = [2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 1.5]
    write_trace_cell(tmp_path, tile, [2 * s for s in slow], warm=[1.0 * s for s in slow[:6]])
    times = [6 * f / 2 * 2 * s for f, s in zip(first, slow, strict=True)]
    write_trace_cell(tmp_path, embree, times, warm=[5.0 * s for s in slow[:6]])
    (pairing,) = duels_of(tmp_path, tile, embree)
    assert pairing.ratio == Ratio(6, 4.5, 6, paired=True)
    assert pairing.second_ratio == Ratio(5, 5, 5, paired=True)


def test_an_image_that_two_runs_measured_counts_once_by_the_newest(tmp_path: Path) -> None:
    runs = []
    for name, time in (("20261122-2", 3), ("20261121-1", 2)):
        (tmp_path / name).mkdir()
        rows = [row("tile-beam", time), row("embree", 12, mode="single")]
        runs.append(
            read_run(write_run(tmp_path / name, [each | {"run_id": name} for each in rows]))
        )
    for order in (runs, runs[::-1]):
        (pairing,) = pairings(order)
        assert (pairing.run_id, pairing.ratio.value) == ("20261122-2", 4)
        assert "for single scenes, 0 of 1 are met" in as_markdown([pairing])


def test_no_scene_is_in_two_groups() -> None:
    scenes = [(group.kind, scene) for group in groups() for scene in group.scenes]
    assert len(scenes) == len(set(scenes))


def test_runs_of_two_machines_are_not_mixed(tmp_path: Path) -> None:
    runs = []
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        scene = {"machine_id": name, "scene": f"tetra:n={len(runs) + 5}"}
        rows = [row("tile-beam", 2) | scene, row("embree", 12, mode="single") | scene]
        runs.append(read_run(write_run(tmp_path / name, rows)))
    with pytest.raises(Problem, match=r"2 machines \(a, b\)"):
        pairings(runs)


def test_an_aim_within_the_interval_is_open() -> None:
    ratio = Ratio(6, 5, 7)
    assert [outcome(ratio, aim) for aim in (5, 5.5, 6.5, 7.1)] == [
        "met",
        "open",
        "open",
        "missed",
    ]


def all_triangles(tile: float, isa: str = "best") -> list[Row]:
    return [
        made
        for scene in groups()[0].scenes
        for made in (
            row("tile-beam", tile, scene=scene, spread=0.01, isa=isa),
            row("embree", 12, scene=scene, spread=0.01, mode="stream", isa=isa),
        )
    ]


def test_the_report_tells_what_is_met(tmp_path: Path) -> None:
    text = as_markdown(duels_of(tmp_path, *all_triangles(1.2)))
    assert "| tetra, 4 k | 10.0 (9.86 to 10.1), target 8: met |" in text
    assert "| **geometric mean, first traces** | 10.0 (9.94 to 10.1), target 12: missed |" in text
    assert "| geometric mean, second traces | 10.0 |" in text
    assert "95% confidence interval" in text
    assert "## Both on AVX-512" in text
    scenes = "for single scenes, 6 of 6 are met, 0 open and 0 missed"
    assert f"{scenes}; for geometric means, 0 of 1 are met, 0 open and 1 missed." in text
    assert "(not paired)" in text
    assert "run 20261122-100000-beat-embree, commit 0123456789ab, machine feedfeed" in text


def test_half_the_aims_hold_where_both_are_held_to_less(tmp_path: Path) -> None:
    text = as_markdown(duels_of(tmp_path, *all_triangles(1.5, isa="avx2")))
    assert "| **geometric mean, first traces** | 8.00 (7.95 to 8.05), target 6: met |" in text


def test_a_mean_of_some_scenes_is_not_judged(tmp_path: Path) -> None:
    text = as_markdown(duels_of(tmp_path, *all_triangles(1.5)[:4]))
    assert "| **geometric mean, first traces** | 8.00 (7.92 to 8.08), of 2 scenes |" in text


def test_a_mean_without_an_interval_is_open(tmp_path: Path) -> None:
    rows = all_triangles(1.5)
    rows[0] |= {"trace_ms_ci_low": "", "trace_ms_ci_high": ""}
    text = as_markdown(duels_of(tmp_path, *rows))
    assert "| **geometric mean, first traces** | 8.00, target 12: open |" in text


def test_a_ratio_near_its_aim_shows_on_which_side_it_is(tmp_path: Path) -> None:
    rows = [row("tile-beam", 1), row("embree", 8.004, mode="single")]
    text = as_markdown(duels_of(tmp_path, *rows))
    assert "| tetra, 4 k | 8.004 (6.94 to 9.23), target 8: open |" in text


def test_weak_baselines_and_what_is_compared_are_named(tmp_path: Path) -> None:
    spheres = {"scene": "balls:n=4"}
    rows = [row("tile-beam", 1) | spheres, row("embree", 6, mode="single") | spheres]
    text = as_markdown(duels_of(tmp_path, *rows))
    assert "a frustum rasterizer beside a general ray tracer" in text.splitlines()[0]
    below = text.partition("### Scenes of spheres")[2].partition("| scene |")[0]
    assert "baseline is weak" in below


def test_builds_are_stated(tmp_path: Path) -> None:
    rows = [
        row("tile-beam", 1) | {"build_ms_median": 352},
        row("embree", 6, mode="single") | {"build_ms_median": 1470},
    ]
    text = as_markdown(duels_of(tmp_path, *rows))
    assert "| Embree's build ms | tile-beam's build ms |" in text
    assert text.rstrip().endswith("| 1,470 | 352 |")


def test_plots_follow_what_was_measured(tmp_path: Path) -> None:
    few = duels_of(tmp_path, *all_triangles(1.5))
    assert [plot.stem for plot in plots(few)] == ["beat-embree"]
    many = duels_of(
        tmp_path,
        *all_triangles(1.5),
        *(
            made
            for size in (10, 20, 40, 80, 160)
            for made in (
                row("tile-beam", size, scene=f"soup:triangles={size}", primitives=size),
                row("embree", 3 * size, scene=f"soup:triangles={size}", primitives=size),
            )
        ),
        *(
            made
            for side in (100, 200, 300, 400, 500)
            for made in (
                row("tile-beam", side, scene="shells:n=5", resolution=f"{side}x{side}"),
                row("embree", 2 * side, scene="shells:n=5", resolution=f"{side}x{side}"),
            )
        ),
    )
    stems = ["beat-embree", "beat-embree-scaling", "beat-embree-resolutions"]
    assert [plot.stem for plot in plots(many)] == stems


def bumpy(size: int, run_id: str, commit: str, **parameters: str) -> list[Row]:
    scene = {"scene": f"bumpy:triangles={size}", "run_id": run_id, "commit": commit}
    return [
        row("tile-beam", size, primitives=size, **parameters) | scene,
        row("embree", 3 * size, primitives=size, mode="single") | scene,
    ]


def test_growth_shows_each_image_once_and_which_commit_measured_it(tmp_path: Path) -> None:
    older = [made for size in (10, 20, 40, 80, 160) for made in bumpy(size, "a-1", "1" * 40)]
    newer = [made for size in (40, 80) for made in bumpy(size, "b-2", "2" * 40)]
    runs = []
    for name, rows in (("older", older), ("newer", newer)):
        (tmp_path / name).mkdir()
        runs.append(read_run(write_run(tmp_path / name, rows)))
    (plot,) = (one for one in plots(pairings(runs)) if one.stem == "beat-embree-scaling")
    times, ratios, *_ = plot.figure.axes
    colors = {structure_color(name) for name in ("embree", "tile-beam")}
    assert {line.get_color() for line in times.lines} == colors
    points = [line for line in ratios.lines if line.get_marker() == "o"]
    assert [line.get_xdata()[0] for line in points] == [10, 20, 40, 80, 160]
    filled = [line.get_xdata()[0] for line in points if line.get_markerfacecolor() != PAPER]
    assert filled == [40, 80]
    bars = [line for line in ratios.lines if line.get_marker() == "_"]
    assert len(bars) == 5
    caption = " ".join(plot.figure.get_supxlabel().split())
    assert "Filled: commit 222222222222; hollow: 111111111111." in caption
    assert "drawn once, from the newest" in caption


def test_no_figure_is_taller_than_a_page(tmp_path: Path) -> None:
    rows = [
        made | {"scene": scene}
        for group in groups()
        for scene in group.scenes
        for resolution in group.targets
        for made in (
            row("tile-beam", 2, resolution=resolution),
            row("embree", 12, resolution=resolution, mode="single"),
        )
    ]
    drawn = plots(duels_of(tmp_path, *rows))
    assert [plot.stem for plot in drawn] == [
        "beat-embree",
        "beat-embree-2",
        "beat-embree-3",
    ]
    for plot in drawn:
        width, height = plot.figure.get_size_inches()
        assert height <= 1.4 * width


def test_the_command_writes_the_report_and_its_plots(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = write_run(tmp_path, all_triangles(1.5))
    assert main(["embree-comparison", str(run)]) == 0
    assert capsys.readouterr().out.startswith("# Tile beams against Embree")
    assert main(["embree-comparison", str(run), "-o", str(tmp_path / "beat.md")]) == 0
    assert "![beat-embree.png](beat-embree.png)" in (tmp_path / "beat.md").read_text()
    assert (tmp_path / "beat-embree.png").stat().st_size > 0
    assert missing_in(tmp_path) == {}


def test_runs_without_both_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = write_run(tmp_path, [row("tile-beam", 2), row("sah-bvh", 3)])
    assert main(["embree-comparison", str(run)]) == 2
    assert "beat-embree.json" in capsys.readouterr().err


def test_the_aims_name_the_scenes_of_the_sweeps() -> None:
    named = {(group.kind, scene) for group in groups() for scene in group.scenes}
    swept = set()
    for file in (REPOSITORY / "harness/measure/sweeps").glob("beat-embree*.json"):
        # Lines of sizes, without aims; and lists, whose aims their page has.
        if file.stem.rpartition("-")[2] in ("scaling", "resolutions", "everywhere"):
            continue
        config = json.loads(file.read_text())
        swept |= {
            (kind, json.loads(output_of("scene", scene, "--json"))["name"])
            for scene in config["scenes"]
            for kind in config.get("rays", ["primary"])
        }
    assert swept == named


def test_kinds_of_rays_have_targets_of_their_own(tmp_path: Path) -> None:
    rows = [
        made | {"scene": "habitacion"}
        for kind in ("shadow", "mirror")
        for made in (
            row("tile-beam", 2, kind=kind),
            row("embree", 4, kind=kind, mode="stream"),
        )
    ]
    found = duels_of(tmp_path, *rows)
    assert [one.kind for one in found] == ["shadow", "mirror"]
    report = as_markdown(found)
    shadows = report[report.index("### Shadow rays") : report.index("### Rays from small")]
    assert "2.00 (1.74 to 2.31), target 2.5: missed" in shadows
    mirrors = report[report.index("### Rays from small") : report.index("## All rays")]
    assert "2.00 (1.74 to 2.31), target 0.9: met" in mirrors


def test_pictures_are_compared_without_their_shading(tmp_path: Path) -> None:
    tile, embree = (
        row(structure, trace, scene="finishes", kind="whitted", shading=10.0)
        for structure, trace in (("tile-beam", 14), ("embree", 22))
    )
    run = write_run(tmp_path, [tile, embree])
    (pairing,) = pairings([read_run(run)])
    assert pairing.tile.first.value == pytest.approx(4)
    assert pairing.ratio.value == pytest.approx(3)
    assert pairing.second_ratio is not None
    assert pairing.second_ratio.value == pytest.approx((0.9 * 22 - 10) / (0.9 * 14 - 10))
    for made, trace in ((tile, 14.0), (embree, 22.0)):
        write_trace_cell(run, made, [trace + 0.1 * turn for turn in range(7)], warm=[])
    (pairing,) = pairings([read_run(run)])
    assert pairing.ratio.paired
    assert pairing.ratio.value == pytest.approx(12.3 / 4.3)
