"""The simulated cluster: its simulator with small tasks, calibration, tables, page."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Sequence
from pathlib import Path

import pandas as pd
import pytest

from beambench_thesis.__main__ import main
from beambench_thesis.chapter6.machines import (
    ALL_BUILDING,
    ALL_WALKING,
    Recorded,
    slowness_of_1999,
    thesis_seconds,
)
from beambench_thesis.chapter6.plots import cluster_plots
from beambench_thesis.chapter6.record import LARGE, SCENES, WORKS, tasks_file
from beambench_thesis.chapter6.results import read_processes, read_simulations
from beambench_thesis.chapter6.simulate import (
    DIVISIONS,
    LARGE_OPTIONS,
    MACHINES,
    OPTIONS,
    simulate,
    simulations,
)
from svg_texts import missing_in

BINARIES = Path(
    os.environ.get("BEAMBENCH_BINARY", Path(__file__).parents[2] / "build/release/bin/beambench")
).parent
SIMULATOR = BINARIES / "beambench-cluster-simulated"
needs_simulator = pytest.mark.skipif(
    not SIMULATOR.is_file(), reason="beambench-cluster-simulated was not built: no libsimgrid-dev"
)

HEADER = (
    "task,process,walk_seconds,work_seconds,accept_seconds,samples,task_bytes,result_bytes,"
    "estimate_seconds\n"
)


def tasks(path: Path, works: Sequence[float], walk: float = 1e-4) -> Path:
    rows = [f"{i},0,{walk},{work},1e-5,100,120,800,{work}\n" for i, work in enumerate(works)]
    path.write_text(HEADER + "".join(rows) + f"end,0,{walk},0,0,0,0,0,0\n", "utf-8")
    return path


def simulated(path: Path, *arguments: str) -> dict:
    done = subprocess.run(
        [SIMULATOR, "cluster", path, *arguments],
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    return json.loads(done.stdout)


def refusal(path: Path) -> str:
    done = subprocess.run([SIMULATOR, "cluster", path], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    return done.stderr


@needs_simulator
def test_a_cluster_of_one_takes_the_sum(tmp_path: Path) -> None:
    path = tasks(tmp_path / "t.csv", [0.01] * 50)
    run = simulated(path, "--consumers", "0", "--build-seconds", "2")
    assert run["sequential_seconds"] == pytest.approx(2 + 51e-4 + 0.5)
    assert run["seconds"] == pytest.approx(run["sequential_seconds"] + 50e-5, rel=1e-3)
    assert run["processes"][0]["tasks"] == 50
    assert run["messages_from_producer"] == 0


@needs_simulator
def test_short_tasks_take_their_time(tmp_path: Path) -> None:
    path = tasks(tmp_path / "t.csv", [4e-7] * 1000, walk=2e-7)
    run = simulated(path, "--consumers", "0", "--look-seconds", "3e-7")
    # Traversal, work, 1e-5 to accept each, and a check in between.
    assert run["seconds"] > 1000 * (2e-7 + 4e-7 + 1e-5 + 3e-7)
    assert run["seconds"] == pytest.approx(1000 * 1.09e-5, rel=0.05)


@needs_simulator
def test_consumers_share_the_work_and_every_task_is_done_once(tmp_path: Path) -> None:
    path = tasks(tmp_path / "t.csv", [0.001 * (1 + i % 7) for i in range(200)])
    seconds = []
    for consumers in (1, 2, 4, 8):
        run = simulated(path, "--consumers", str(consumers))
        each = run["processes"]
        assert sum(one["tasks"] for one in each) == run["tasks"] == 200
        assert sum(one["samples"] for one in each) == 200 * 100
        assert sum(one["busy_seconds"] for one in each) == pytest.approx(run["work_seconds"])
        # One parcel per task, and a greeting, an end and a farewell for each process.
        assert run["messages_from_producer"] == 200 + consumers
        assert run["messages_to_producer"] == 200 + 2 * consumers
        seconds.append(run["seconds"])
    assert seconds == sorted(seconds, reverse=True)
    assert seconds[0] > 0.8
    assert seconds[2] < seconds[0] / 3


@needs_simulator
def test_a_shared_network_is_full_sooner(tmp_path: Path) -> None:
    path = tasks(tmp_path / "t.csv", [0.001] * 200)
    slow = ("--consumers", "8", "--bandwidth", "1e5", "--message-seconds", "0", "--latency", "0")
    shared = simulated(path, "--network", "shared", *slow)
    switched = simulated(path, "--network", "switched", *slow)
    everything = shared["bytes_to_producer"] + shared["bytes_from_producer"]
    assert shared["traced_seconds"] == pytest.approx(everything / 1e5, rel=0.05)
    assert switched["traced_seconds"] < shared["traced_seconds"]


@needs_simulator
def test_a_slow_producer_is_busy_all_the_time(tmp_path: Path) -> None:
    path = tasks(tmp_path / "t.csv", [0.001] * 100, walk=0.01)
    run = simulated(path, "--consumers", "4")
    assert run["producer_busy"] > 0.95
    assert run["traced_seconds"] == pytest.approx(1.01, rel=0.1)


@needs_simulator
@pytest.mark.parametrize("arguments", [*DIVISIONS.values(), *LARGE_OPTIONS.values()])
def test_every_division_does_all_the_work(tmp_path: Path, arguments: tuple[str, ...]) -> None:
    path = tasks(tmp_path / "t.csv", [0.002] * 100)
    run = simulated(path, "--consumers", "5", *arguments)
    assert sum(one["samples"] for one in run["processes"]) == 100 * 100
    assert simulated(path, "--consumers", "5", *arguments) == run


@needs_simulator
@pytest.mark.parametrize("arguments", [*OPTIONS.values(), *MACHINES.values()])
def test_every_option_does_every_task(tmp_path: Path, arguments: tuple[str, ...]) -> None:
    run = simulated(tasks(tmp_path / "t.csv", [0.002] * 100), "--consumers", "5", *arguments)
    assert sum(one["tasks"] for one in run["processes"]) == 100
    again = simulated(tasks(tmp_path / "t.csv", [0.002] * 100), "--consumers", "5", *arguments)
    assert again == run


def shares(path: Path, division: str, *arguments: str) -> list[int]:
    """Returns how many tasks each of four consumers did, expecting all to be done."""
    run = simulated(path, "--consumers", "4", "--division", division, *arguments)
    each = [one["tasks"] for one in run["processes"][1:]]
    assert run["messages_from_producer"] == 4 + 4
    assert sum(each) == run["tasks"]
    return each


@needs_simulator
def test_a_static_division_is_one_message_for_each_consumer(tmp_path: Path) -> None:
    path = tasks(tmp_path / "t.csv", [0.004] * 25 + [0.001] * 75)
    assert shares(path, "contiguous") == [25] * 4
    assert shares(path, "interlaced") == [25] * 4
    assert sorted(shares(path, "equal-cost")) != [25] * 4


def seconds_of(path: Path, division: str, *arguments: str) -> float:
    run = simulated(path, "--consumers", "4", "--division", division, *arguments)
    return run["traced_seconds"]


@needs_simulator
def test_the_slowest_share_is_what_a_static_division_takes(tmp_path: Path) -> None:
    first = tasks(tmp_path / "first.csv", [0.004] * 25 + [0.001] * 75)
    every_fourth = tasks(tmp_path / "every.csv", [0.004, 0.001, 0.001, 0.001] * 25)
    assert seconds_of(first, "contiguous") == pytest.approx(0.1, rel=0.2)
    assert seconds_of(first, "interlaced") < 0.6 * seconds_of(first, "contiguous")
    assert seconds_of(every_fourth, "interlaced") == pytest.approx(0.1, rel=0.2)
    estimated = seconds_of(every_fourth, "equal-cost")
    assert estimated < 0.6 * seconds_of(every_fourth, "interlaced")
    late = seconds_of(every_fourth, "equal-cost", "--pre-pass-seconds", "0.5")
    assert late == pytest.approx(estimated + 0.5, rel=0.02)


@needs_simulator
def test_falling_messages_are_few_and_balance(tmp_path: Path) -> None:
    path = tasks(tmp_path / "t.csv", [0.0001 * (1 + i % 11) for i in range(4096)], walk=1e-6)
    costs = ("--message-seconds", "1e-6", "--look-seconds", "1e-6", "--latency", "1e-5")
    cheap = ("--consumers", "16", *costs)
    one_by_one = simulated(path, *cheap)
    falling = simulated(path, *cheap, "--division", "falling", "--stored")
    assert falling["messages_from_producer"] < one_by_one["messages_from_producer"] / 3
    assert falling["bytes_to_producer"] < one_by_one["bytes_to_producer"] / 3
    assert falling["traced_seconds"] < 1.1 * falling["work_seconds"] / 16
    assert sum(one["samples"] for one in falling["processes"]) == 4096 * 100


@needs_simulator
def test_shares_of_equal_cost_need_estimates(tmp_path: Path) -> None:
    path = tasks(tmp_path / "t.csv", [0.0] * 5)
    done = subprocess.run(
        [SIMULATOR, "cluster", path, "--division", "equal-cost"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 2
    assert "--work pre-pass" in done.stderr


@needs_simulator
def test_slow_machines_get_fewer_tasks(tmp_path: Path) -> None:
    path = tasks(tmp_path / "t.csv", [0.005] * 300)
    run = simulated(path, "--consumers", "2", "--speeds", "1,0.25")
    first, second = (one["tasks"] for one in run["processes"][1:])
    assert first == pytest.approx(4 * second, rel=0.1)


@needs_simulator
def test_wrong_files_are_refused_with_their_line(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    assert "t.csv: cannot be read: No such file" in refusal(path)
    path.write_text("", "utf-8")
    assert "cannot read tasks" in refusal(path)
    path.write_text("a,b\n", "utf-8")
    assert "t.csv:1: there is no column 'task'" in refusal(path)
    path.write_text(HEADER + "0,0,1,x,0,1,1,1,0\n", "utf-8")
    assert "t.csv:2: work_seconds is 'x'" in refusal(path)
    path.write_text(HEADER + "0,0,1,1\n", "utf-8")
    assert "t.csv:2: 4 fields, but the first line has 9" in refusal(path)
    path.write_text(HEADER + "0,0,1,1,1,1,1,1,1\n", "utf-8")
    assert "cut off" in refusal(path)


def test_the_parts_of_1999_come_to_what_the_thesis_prints() -> None:
    constant, per_ray = thesis_seconds()
    recorded = Recorded(build_seconds=0.002, walk_seconds=0.008, work_seconds=5.0, samples=10**6)
    for constant_is in ("as ours", ALL_WALKING, ALL_BUILDING):
        slow = slowness_of_1999(recorded, constant_is)
        whole = 0.002 * slow.build + 0.008 * slow.walk
        assert whole == pytest.approx(constant)
        assert 5.0 * slow.work == pytest.approx(per_ray * 10**6)
    assert 9 < constant < 10
    assert 32e-6 < per_ray < 36e-6


def test_the_plan_asks_nothing_twice() -> None:
    plan = simulations(SCENES)
    assert len(set(plan)) == len(plan)
    assert max(each.consumers for each in plan) == 1023
    assert max(each.consumers for each in simulations(SCENES, most=16)) == 15 - 1 + 1


def recorded_tasks(folder: Path) -> None:
    """Writes the files that `cluster record` writes."""
    (folder / "tasks").mkdir()
    recorded = {}
    for scene in (*SCENES, LARGE):
        for work in WORKS:
            tasks(tasks_file(folder, scene, work), [0.001 * (1 + i % 5) for i in range(60)])
            recorded[f"{scene}-{work}"] = {
                "build_seconds": 0.002,
                "walk_seconds": 61e-4,
                "work_seconds": 0.18,
                "samples": 6000,
            }
    (folder / "recorded.json").write_text(json.dumps(recorded), "utf-8")


def counting_simulator(folder: Path) -> tuple[Path, Path]:
    """Writes a program with a fixed result; returns it, and a file with a line for each call."""
    zeros = dict.fromkeys(
        "tasks traced_seconds build_seconds walk_seconds work_seconds accept_seconds producer_busy "
        "messages_from_producer bytes_from_producer messages_to_producer bytes_to_producer".split(),
        0,
    )
    program, calls = folder / "simulator", folder / "calls"
    answer = json.dumps({"seconds": 1.0, "processes": []} | zeros)
    program.write_text(f"#!/bin/sh\necho call >> {calls}\necho '{answer}'\n", "utf-8")
    program.chmod(0o755)
    return program, calls


@pytest.mark.parametrize("jobs", [1, 3])
def test_an_interrupted_simulation_goes_on_where_it_was(tmp_path: Path, jobs: int) -> None:
    recorded_tasks(tmp_path)
    program, calls = counting_simulator(tmp_path)
    plan = simulations(SCENES, most=5)[:6]
    simulate(tmp_path, program, plan[:4], jobs)
    answers = tmp_path / "answers.jsonl"
    answers.write_text(answers.read_text("utf-8")[:-40], "utf-8")  # killed during writing
    simulate(tmp_path, program, plan, jobs)
    assert len(calls.read_text("utf-8").splitlines()) == 4 + 1 + 2
    assert list(read_simulations(tmp_path)["consumers"]) == [each.consumers for each in plan]
    simulate(tmp_path, program, plan, jobs)
    assert len(calls.read_text("utf-8").splitlines()) == 7


@needs_simulator
def test_all_steps_write_a_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recorded_tasks(tmp_path)
    step = ["cluster", "simulate", str(tmp_path), "--program", str(SIMULATOR), "--most", "8"]
    assert main(step) == 0
    rows = read_simulations(tmp_path)
    assert set(rows["era"]) == {"1999", "today"}
    assert ((rows["efficiency"] > 0) & (rows["efficiency"] <= 1)).all()
    assert main(["cluster", "write", str(tmp_path)]) == 0
    page = (tmp_path / "report.md").read_text("utf-8")
    for figure in ("figure-6.3", "many-processes-1999", "many-processes-today", "divisions"):
        assert f"]({figure}.png)" in page
        assert (tmp_path / f"{figure}.svg").is_file()
    assert missing_in(tmp_path) == {}
    capsys.readouterr()


def test_figures_6_3_and_6_4_name_each_panel_and_show_the_thesis(repository: Path) -> None:
    published = repository / "results/published/cluster"
    simulations, processes = read_simulations(published), read_processes(published)
    plots = {plot.stem: plot.figure for plot in cluster_plots(simulations, processes)}
    panels = plots["figure-6.3"].axes
    assert [panel.get_title(loc="left") or panel.get_title() for panel in panels] == [
        "a) Time",
        "b) Speedup",
        "c) Efficiency",
        "d) Efficiency, the producer not counted",
    ]
    marks = {
        line.get_label(): line.get_xydata().tolist()
        for line in panels[2].get_lines()
        if line.get_marker() == "*"
    }
    assert marks == {
        "thesis, gato-bill: best": [[11, 0.75]],
        "thesis, torre-eiffel: mean, at best": [[7, 0.65]],
    }
    # A small difference looks small, and no point is cut off.
    for panel in plots["figure-6.4"].axes:
        low, high = panel.get_ylim()
        highest = max(float(max(line.get_ydata())) for line in panel.get_lines())
        assert low == 0
        assert high > 1.05 * highest


def test_a_line_of_many_processes_has_one_network() -> None:
    """Two networks have different speedups for the same size: a common line would zigzag."""
    rows = [
        {"scene": "s", "era": "1999", "options": options, "machines": "equal", "network": network,
         "consumers": consumers, "speed_up": speed_up, "producer_busy": 0.5}
        for options, network, speed_up in (
            ("thesis", "shared", 3.0), ("thesis", "switched", 6.0), ("two in flight", "switched", 7)
        )
        for consumers in (63, 15, 31)
    ]  # fmt: skip
    plots = {plot.stem: plot for plot in cluster_plots(pd.DataFrame(rows), pd.DataFrame())}
    panel = plots["many-processes-1999"].figure.axes[0]
    drawn = {line.get_label(): line for line in panel.lines if not line.get_label().startswith("_")}
    assert list(drawn) == ["thesis", "two in flight", "thesis, shared"]
    for name, speed_up in (("thesis", 6.0), ("two in flight", 7.0), ("thesis, shared", 3.0)):
        assert list(drawn[name].get_xdata()) == [16, 32, 64]
        assert set(drawn[name].get_ydata()) == {speed_up}


def test_what_is_missing_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cluster", "write", str(tmp_path)]) == 2
    assert "simulations.csv" in capsys.readouterr().err
    assert main(["cluster", "simulate", str(tmp_path)]) == 2
    assert "cluster record" in capsys.readouterr().err
    assert main(["cluster", "record", str(tmp_path), "--program", str(tmp_path / "none")]) == 2
    assert "build beambench-cluster first" in capsys.readouterr().err
