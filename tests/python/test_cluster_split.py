"""Divided scenes on simulated clusters: the simulator, the table, the page."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from beambench_thesis.__main__ import main
from beambench_thesis.chapter6 import scene_divisions
from beambench_thesis.chapter6.split import SCENES, read_split, split_plot, split_section
from cluster import CLUSTER, mpirun, needs_mpi
from program import BINARY, output_of

SIMULATOR = BINARY.resolve().with_name("beambench-cluster-simulated")
needs_simulator = pytest.mark.skipif(
    not SIMULATOR.is_file(), reason="beambench-cluster-simulated was not built: no libsimgrid-dev"
)
DIVISIONS = ("primitives", "cost", "interleaved", "bisection", "scattered")
ASKED = ["--accel", "beam:max_level=6", "--split", "3", "--resolution", "80x60"]


def simulated(processes: int, *arguments: str, level: str = "3") -> dict:
    asked = [level if each == "3" else each for each in ASKED]
    done = subprocess.run(
        [SIMULATOR, "split", "tetra:n=4", *asked, "--processes", str(processes), *arguments],
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    return json.loads(done.stdout)


@needs_simulator
def test_the_old_names_work_with_a_warning() -> None:
    arguments = ["tetra:n=4", *ASKED, "--processes", "2"]
    old = SIMULATOR.with_name("beambench-split-simulated")
    done = subprocess.run([old, *arguments], capture_output=True, text=True, check=True)
    assert "now called 'beambench-cluster-simulated split'" in done.stderr
    assert json.loads(done.stdout)["result_hash"] == simulated(2)["result_hash"]


@needs_simulator
def test_parts_give_the_picture_of_the_whole() -> None:
    runs = {processes: simulated(processes) for processes in (1, 2, 5)}
    assert len({run["result_hash"] for run in runs.values()}) == 1
    alone = runs[1]["processes"][0]
    assert alone["messages_out"] == alone["beams_out"] == alone["rays_out"] == 0
    for processes, run in list(runs.items())[1:]:
        assert len(run["processes"]) == processes
        assert all(each["primitives"] < run["primitives"] for each in run["processes"])
        assert sum(each["bytes_out"] for each in run["processes"]) > 0


@needs_simulator
@pytest.mark.parametrize("level", ["2", "4", "6"])
def test_every_division_gives_the_picture_of_the_whole(level: str) -> None:
    """Most of a tetrahedron's cells are empty: beams and rays pass through them in any process."""
    whole = simulated(1)["result_hash"]
    for division in DIVISIONS:
        run = simulated(6, "--division", division, level=level)
        assert run["result_hash"] == whole, division


@needs_mpi
def test_another_division_is_refused_with_the_names() -> None:
    run = mpirun("-n", 1, CLUSTER, "tetra:n=4", "--split", "3", "--division", "halves")
    assert run.returncode == 2
    assert all(name in run.stderr for name in ("halves", *DIVISIONS))
    alone = mpirun("-n", 1, CLUSTER, "tetra:n=4", "--division", "cost")
    assert alone.returncode == 2
    assert "--split" in alone.stderr


@needs_simulator
@needs_mpi
@pytest.mark.parametrize("division", ["primitives", "scattered"])
def test_the_real_program_finds_the_same_and_hands_over_the_same(
    tmp_path: Path, division: str
) -> None:
    report = tmp_path / "run.json"
    run = mpirun("-n", 3, CLUSTER, "tetra:n=4", *ASKED, "--division", division, "--report", report)
    assert run.returncode == 0, run.stderr
    real, simulation = json.loads(report.read_text()), simulated(3, "--division", division)
    assert simulation["result_hash"] == real["result_hash"]
    for here, there in zip(simulation["processes"], real["each"], strict=True):
        for quantity in ("primitives", "beams_out", "rays_out"):
            assert here[quantity] == there[quantity]


# Shadows and mirrors; mirrors and glass; polygons with shading normals; textures.
@needs_mpi
@pytest.mark.parametrize(
    "scene",
    [
        "balls:n=2",
        pytest.param("escena2", marks=pytest.mark.full),
        pytest.param("bola-espacial", marks=pytest.mark.full),
        "delfines",
    ],
)
def test_its_light_is_that_of_one_process(tmp_path: Path, scene: str) -> None:
    one = tmp_path / "one.png"
    asked = ["--shade", "whitted", "--resolution", "90x70", "--samples", "5"]
    output_of("render", scene, "--accel", "beam", "-o", one, *asked)
    for processes, level, division in ((2, 3, "scattered"), (3, 4, "primitives"), (3, 2, "cost")):
        parts, report = tmp_path / "parts.png", tmp_path / "run.json"
        run = mpirun("-n", processes, CLUSTER, scene, "-o", parts, *asked, "--split", level,
                     "--division", division, "--report", report)  # fmt: skip
        assert run.returncode == 0, run.stderr
        assert parts.read_bytes() == one.read_bytes(), division
        record = json.loads(report.read_text())
        lights = [each["light"] for each in record["each"]]
        assert sum(light["rays_out"] for light in lights) > 0
        assert record["rays"]["shadow"] > 0
        # Only process 0 has the whole scene, once.
        assert record["shading_bytes"] == record["whole_scene_bytes"]
        # Rays were sent and received, and so were results of 12 bytes each.
        received = sum(light["rays_in"]["bytes"] for light in lights)
        answered = sum(light["answers_out"] for light in lights)
        assert sum(light["out"]["bytes"] for light in lights) == received + 12 * answered


@needs_mpi
@pytest.mark.parametrize("shading", ["preview", "normals"])
def test_surfaces_are_those_of_the_whole_scene(tmp_path: Path, shading: str) -> None:
    one, parts = tmp_path / "one.png", tmp_path / "parts.png"
    asked = ["--shade", shading, "--resolution", "90x70"]
    output_of("render", "escena2", "--accel", "beam", "-o", one, *asked)
    run = mpirun("-n", 3, CLUSTER, "escena2", "-o", parts, *asked, "--split", "3")
    assert run.returncode == 0, run.stderr
    assert parts.read_bytes() == one.read_bytes()


@needs_mpi
def test_its_light_is_that_of_the_undivided_run(tmp_path: Path) -> None:
    hashes = set()
    for divided in ([], ["--split", "3"]):
        report = tmp_path / "run.json"
        run = mpirun("-n", 2, CLUSTER, "gears:n=1", "--shade", "whitted", "--resolution", "80x60",
                     "--depth", "3", "--report", report, *divided)  # fmt: skip
        assert run.returncode == 0, run.stderr
        hashes.add(json.loads(report.read_text())["result_hash"])
    assert len(hashes) == 1


@needs_simulator
def test_time_is_what_work_and_messages_take() -> None:
    run = simulated(1, "--build-scale", "1e5", "--walk-scale", "1e4", "--work-scale", "1e3",
                    "--look-seconds", "1e-9")  # fmt: skip
    (each,) = run["processes"]
    walked, rest = each["walk_seconds"], each["test_seconds"] + each["take_seconds"]
    expected = 1e5 * each["build_seconds"] + 1e4 * walked + 1e3 * rest
    assert run["seconds"] == pytest.approx(expected, rel=1e-3)
    assert run["traced_seconds"] == pytest.approx(1e4 * walked + 1e3 * rest, rel=1e-3)
    # If messages take long, nothing else matters.
    slow = simulated(2, "--latency", "1000")
    assert slow["seconds"] > 5000


@needs_simulator
def test_wrong_requests_are_refused() -> None:
    for arguments, word in (
        (["no-such-scene"], "no-such-scene"),
        (["tetra:n=2", "--split", "7", "--accel", "beam:max_level=4"], "max_level"),
        (["tetra:n=2", "--accel", "sah-bvh"], "sah-bvh"),
        (["tetra:n=2", "--division", "halves"], "interleaved"),
    ):
        done = subprocess.run(
            [SIMULATOR, "split", *arguments],
            capture_output=True,
            text=True,
            check=False,
            timeout=60,
        )
        assert done.returncode == 2
        assert word in done.stderr
        assert done.stdout == ""


def pretended_simulator(folder: Path, wrong_picture_of: int = 0) -> Path:
    """Returns a simulator that takes 8 s for one part, and half as long for twice as many."""
    program = folder / "simulator"
    program.write_text(
        f"""#!/usr/bin/env python3
import json, sys
parts = int(sys.argv[sys.argv.index("--processes") + 1])
part = dict.fromkeys("beams_out rays_out messages_out bytes_out take_seconds".split(), parts - 1)
part |= dict(primitives=64 // parts, bytes=6400 // parts, build_seconds=0.001, walk_seconds=0.01,
             test_seconds=0.1, busy=1.0)
print(json.dumps(dict(
    primitives=64, scene_bytes=5000, seconds=8 / parts, traced_seconds=6 / parts,
    result_hash="beef" if parts == {wrong_picture_of} else "cafe", processes=[part] * parts)))
""",
        "utf-8",
    )
    program.chmod(0o755)
    return program


def divide(folder: Path, program: Path) -> int:
    sums = {"build_seconds": 0.002, "walk_seconds": 0.006, "work_seconds": 5, "samples": 6553600}
    (folder / "recorded.json").write_text(json.dumps({"gato-bill-beams": sums}), "utf-8")
    asked = ["--resolution", "40x30", "--repeats", "2", "--most", "4", "--program", str(program)]
    return main(["cluster", "split", str(folder), *asked])


@pytest.mark.full
def test_the_table_has_speed_ups_and_the_page_shows_them(tmp_path: Path) -> None:
    assert divide(tmp_path, pretended_simulator(tmp_path)) == 0
    rows = read_split(tmp_path)
    assert rows is not None
    assert list(rows["processes"]) == [1, 2, 4] * 2 * len(SCENES)
    assert (rows["speed_up"] == rows["processes"]).all()
    assert (rows["efficiency"] == 1).all()
    assert (rows["balance"] == 1).all()
    page = split_section(rows)
    assert "| 6 s | 2.0 (1.00) | 4.0 (1.00) |" in page
    assert "| tetra:n=7 | 4 |" in page
    assert_divisions_are_compared(tmp_path)
    labels = [line.get_label() for line in split_plot(rows).figure.axes[0].lines]
    assert labels[: len(SCENES)] == [each.scene for each in SCENES]
    answers = tmp_path / "split-answers.jsonl"
    remembered = answers.read_text("utf-8")
    assert divide(tmp_path, tmp_path / "simulator") == 0
    assert answers.read_text("utf-8") == remembered


def assert_divisions_are_compared(folder: Path) -> None:
    rows = scene_divisions.read_scene_divisions(folder)
    assert rows is not None
    of_scene = rows[rows["scene"].eq("tetra:n=8")]
    assert list(zip(of_scene["division"], of_scene["processes"], strict=True)) == [
        ("primitives", 1),
        *((division, 4) for division in DIVISIONS),
    ]
    assert (rows["speed_up"] == rows["processes"]).all()
    # 1 s of work in each process; one process alone takes 6 s.
    assert list(of_scene["busy_share"]) == pytest.approx([1 / 6] + [4 / 6] * len(DIVISIONS), 1e-5)
    page = scene_divisions.scene_divisions_section(rows)
    assert "| tetra:n=8 | scattered | 4 | 1500.0 | 4.0 | 1.00 | 1.00 | 0.67 |" in page
    panels = scene_divisions.scene_divisions_plot(rows).figure.axes
    assert len(panels) == 2 * len(scene_divisions.SCENES)
    assert [line.get_label() for line in panels[0].lines] == list(DIVISIONS)


def test_another_picture_is_a_fault(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert divide(tmp_path, pretended_simulator(tmp_path, wrong_picture_of=4)) == 2
    assert "gato-bill in 4 parts is a different picture" in capsys.readouterr().err
    assert read_split(tmp_path) is None
