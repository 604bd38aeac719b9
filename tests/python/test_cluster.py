"""One image on several processes, started by mpirun."""

from __future__ import annotations

import contextlib
import csv
import json
import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from beambench_thesis.chapter6.record import Picture, measure, measured_section
from cluster import (
    CLUSTER,
    finish,
    mpirun,
    needs_mpi,
    processes_of,
    skip_where_mpirun_starts_one_program_only,
    start,
)
from program import beambench, output_of

pytestmark = needs_mpi

SMALL = ["--resolution", "120x90", "--samples", "5"]
# Takes some seconds, long enough to be interrupted.
LONG = ["balls:n=2", "--accel", "beam", "--shade", "whitted", "--depth", "8",
        "--resolution", "480x360", "--samples", "5"]  # fmt: skip
READY = "beambench-cluster: all consumers are ready"


@pytest.fixture(scope="module")
def sequential(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The picture drawn by one process of `beambench render`."""
    file = tmp_path_factory.mktemp("sequential") / "balls.png"
    output_of("render", "balls:n=2", "--accel", "beam", "-o", file, "--shade", "whitted", *SMALL)
    return file.read_bytes()


@pytest.mark.parametrize(
    ("processes", "options"),
    [
        (1, []),
        (2, []),
        (3, []),
        (4, ["--batch", "5", "--in-flight", "2"]),
        (3, ["--producer-consumes"]),
        (3, ["--work", "blocks", "--block", "20"]),
        (3, ["--work", "tiles", "--block", "20"]),
        (3, ["--work", "tiles", "--block", "20", "--results", "stored"]),
        (3, ["--work", "contiguous"]),
        (3, ["--work", "interlaced"]),
        (3, ["--work", "windows", "--block", "9"]),
        (3, ["--work", "pre-pass", "--block", "9"]),
    ],
)
def test_the_picture_is_the_sequential_one(
    sequential: bytes, tmp_path: Path, processes: int, options: list[str]
) -> None:
    file = tmp_path / "balls.png"
    run = mpirun(
        "-n", processes, CLUSTER, "balls:n=2", "--shade", "whitted", "-o", file, *SMALL, *options
    )
    assert run.returncode == 0, run.stderr
    assert file.read_bytes() == sequential


def test_pictures_of_hits_are_the_sequential_ones(tmp_path: Path) -> None:
    for shading in ("preview", "id"):
        one, several = tmp_path / "one.png", tmp_path / "several.png"
        asked = ["--shade", shading, *SMALL]
        output_of("render", "tetra:n=3", "--accel", "beam", "-o", one, *asked)
        run = mpirun("-n", 3, CLUSTER, "tetra:n=3", "-o", several, *asked)
        assert run.returncode == 0, run.stderr
        assert one.read_bytes() == several.read_bytes()


def test_files_go_where_links_and_pipes_lead(tmp_path: Path) -> None:
    report, tasks = tmp_path / "run.json", tmp_path / "tasks.csv"
    (tmp_path / "target").write_text("old")
    report.symlink_to("target")
    os.mkfifo(tasks)
    with (tmp_path / "read").open("w") as read:
        reader = subprocess.Popen(["timeout", "60", "cat", tasks], stdout=read)
        run = mpirun("-n", 1, CLUSTER, "tetra:n=1", *SMALL, "--report", report, "--tasks", tasks)
        assert run.returncode == 0, run.stderr
        assert reader.wait() == 0
    assert tasks.is_fifo()
    assert (tmp_path / "read").read_text().startswith("task,")
    assert report.is_symlink()
    assert json.loads((tmp_path / "target").read_text())


def test_the_record_adds_up(tmp_path: Path) -> None:
    report_file, task_file = tmp_path / "run.json", tmp_path / "tasks.csv"
    run = mpirun(
        "-n", 3, CLUSTER, "balls:n=2", *SMALL, "--report", report_file, "--tasks", task_file
    )
    assert run.returncode == 0, run.stderr
    report = json.loads(report_file.read_text())
    with task_file.open() as file:
        rows = list(csv.DictReader(file))
    assert rows[-1]["task"] == "end"
    tasks = rows[:-1]
    assert len(tasks) == report["tasks"] > 20
    assert [process["role"] for process in report["each"]] == ["producer", "consumer", "consumer"]
    for process in report["each"]:
        own = [row for row in tasks if int(row["process"]) == process["process"]]
        assert process["tasks"] == len(own)
        assert process["samples"] == sum(int(row["samples"]) for row in own)
    # Each task takes one message out and one back. In addition, each consumer receives an end
    # message, and sends a ready message and a farewell.
    assert report["from_producer"]["messages"] == len(tasks) + 2
    assert report["to_producer"]["messages"] == len(tasks) + 4
    assert 0.0 < report["producer_busy_share"] < 1.0
    assert report["lost"] == []


@pytest.mark.full
def test_what_processes_of_this_machine_take_is_measured_and_shown(tmp_path: Path) -> None:
    written = measure(tmp_path, CLUSTER, [Picture("stetra", 32, 20, 1)], repeats=1)
    assert written == [tmp_path / "measured.csv"]
    rows = list(csv.DictReader(written[0].read_text().splitlines()))
    assert [row["setting"] for row in rows][:3] == [
        "one process alone",
        "1 consumer",
        "2 consumers",
    ]
    for row in rows:
        assert 0 < float(row["seconds_min"]) <= float(row["seconds"]) <= float(row["seconds_max"])
        assert (int(row["messages_from_producer"]) > 0) == (int(row["processes"]) > 1)
    batched = next(row for row in rows if row["options"] == "'--batch 8")  # not a formula
    assert int(batched["messages_from_producer"]) < int(rows[2]["messages_from_producer"])
    section = measured_section(tmp_path)
    assert section is not None
    assert section.count("\n| stetra |") == len(rows)
    assert measured_section(tmp_path / "elsewhere") is None


def test_the_same_tasks_whoever_does_them(tmp_path: Path) -> None:
    def tasks(processes: int) -> list[tuple[str, ...]]:
        file = tmp_path / f"{processes}.csv"
        run = mpirun("-n", processes, CLUSTER, "balls:n=2", *SMALL, "--tasks", file)
        assert run.returncode == 0, run.stderr
        columns = ["task", "samples", "task_bytes", "result_bytes"]
        with file.open() as opened:
            return [tuple(row[column] for column in columns) for row in csv.DictReader(opened)]

    assert tasks(1) == tasks(3)


def consumer_at_work(run: subprocess.Popen[str], process: int) -> int:
    """Returns the pid of a consumer, once all consumers have joined and received tasks."""
    assert run.stderr is not None
    for line in run.stderr:
        if line.strip() == READY:
            return processes_of(run)[process]
    raise AssertionError(run.communicate(timeout=60))


def state_of(pid: int) -> str:
    """Returns the state shown by ps; empty for a process that has ended."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except OSError:
        return ""


def finish_aborted(run: subprocess.Popen[str]) -> subprocess.CompletedProcess[str]:
    """Ends an aborted run. After MPI_Abort, mpirun of Open MPI 4.1 crashed in 2 of 110 runs when
    all processes had ended; in another run it waited forever for a lock in PMIx_server_finalize.
    """
    pids = processes_of(run).values()
    try:
        return finish(run, timeout=60)
    except subprocess.TimeoutExpired:
        left = {pid: state for pid in pids if (state := state_of(pid)) not in ("", "Z")}
        assert left == {}, run.args
        run.kill()
        return finish(run)


MPIRUN_FAULTS = (-signal.SIGSEGV, -signal.SIGKILL)


def test_a_killed_consumer_ends_the_run_without_a_picture(tmp_path: Path) -> None:
    file = tmp_path / "balls.png"
    file.write_text("the picture before")
    run = start("-n", 3, CLUSTER, *LONG, "-o", file)
    os.kill(consumer_at_work(run, 2), signal.SIGKILL)
    done = finish_aborted(run)
    assert done.returncode != 0
    assert "rank 2" in done.stderr  # mpirun names the process
    assert file.read_text() == "the picture before"
    assert names_in(tmp_path) <= {file.name, f"{file.name}.kept"}


def names_in(folder: Path) -> set[str]:
    return {file.name for file in folder.iterdir()}


@pytest.mark.parametrize(
    ("victim", "work"),
    [
        ("consumer", ["--work", "beams"]),
        pytest.param("producer", ["--work", "beams"], marks=pytest.mark.full),
        pytest.param("mpirun", ["--work", "tiles", "--block", "8"], marks=pytest.mark.full),
        pytest.param(
            "consumer",
            ["--work", "tiles", "--block", "8", "--results", "stored"],
            marks=pytest.mark.full,
        ),
        ("producer", ["--work", "interlaced", "--results", "stored"]),
        pytest.param(
            "mpirun", ["--work", "interlaced", "--results", "stored"], marks=pytest.mark.full
        ),
    ],
    ids=lambda value: value if isinstance(value, str) else " ".join(value[1::2]),
)
def test_a_killed_run_is_resumed_with_the_same_picture(
    tmp_path: Path, victim: str, work: list[str]
) -> None:
    file, report = tmp_path / "balls.png", tmp_path / "run.json"
    asked = [*LONG, *work, "-o", file]
    run = start("-n", 2, CLUSTER, *asked)
    consumer = consumer_at_work(run, 1)
    kept = tmp_path / "balls.png.kept"
    whole_header = 2000
    wait_until(lambda: sum(one.stat().st_size for one in kept.iterdir()) > whole_header)
    producer = processes_of(run)[0]
    pids = {"consumer": consumer, "producer": producer, "mpirun": run.pid}
    os.kill(pids[victim], signal.SIGKILL)
    finish_aborted(run)
    # Both processes may outlive mpirun for a moment, and the producer locks the folder of results.
    wait_until(lambda: not any(Path(f"/proc/{pid}").exists() for pid in (producer, consumer)))
    assert not file.exists()
    other = ["balls:n=1", *asked[1:]]
    refused(mpirun("-n", 2, CLUSTER, *other, "--resume"), ["scene balls:n=1", "--resume"])
    again = mpirun("-n", 2, CLUSTER, *asked, "--resume", "--report", report)
    assert again.returncode == 0, again.stderr
    assert json.loads(report.read_text())["resumed_tasks"] > 0
    assert names_in(tmp_path) == {"balls.png", "run.json"}
    one = tmp_path / "one.png"
    output_of("render", *LONG, "-o", one)
    assert file.read_bytes() == one.read_bytes()


def wait_until(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_without_resume_a_run_begins_anew(tmp_path: Path) -> None:
    file = tmp_path / "tetra.png"
    kept = tmp_path / "tetra.png.kept"
    kept.mkdir()
    (kept / "results-0-0").write_bytes(b"not results")
    # If other programs use the processors, each message waits until its receiver gets one.
    run = mpirun("-n", 2, CLUSTER, "tetra:n=1", *SMALL, "--batch", "64", "-o", file)
    assert run.returncode == 0, run.stderr
    assert names_in(tmp_path) == {"tetra.png"}


def test_a_consumer_that_hangs_is_done_without(tmp_path: Path) -> None:
    one, several = tmp_path / "one.png", tmp_path / "several.png"
    run = start("-n", 3, CLUSTER, *LONG, "-o", several, "--timeout", "2")
    os.kill(consumer_at_work(run, 2), signal.SIGSTOP)
    done = finish_aborted(run)
    # On a busy machine the process may be stopped only after its work is done, while MPI shuts
    # down.
    if "did not end within 2 s" not in done.stderr:
        assert done.returncode in (0, *MPIRUN_FAULTS), done.stderr
        assert "process 2 was silent for 2 s" in done.stderr
    output_of("render", *LONG, "-o", one)
    assert one.read_bytes() == several.read_bytes()


def when_begun(run: subprocess.Popen[str], process: int) -> int:
    """Returns the pid of a process as soon as it exists, when MPI has hardly started."""
    while run.poll() is None:
        if process in (found := processes_of(run)):
            return found[process]
        time.sleep(0.001)
    raise AssertionError(run.communicate(timeout=60))


SPLIT = ["tetra:n=8", "--split", "3", "--shade", "id", "--resolution", "1600x1200"]


SPLIT_LIGHT = [*LONG, "--split", "3"]


@pytest.mark.parametrize("process", [0, 2])
@pytest.mark.parametrize(
    "asked", [LONG, SPLIT, SPLIT_LIGHT], ids=["producer", "split", "split light"]
)
@pytest.mark.parametrize("seconds", [0.0, 0.2, 0.8])
def test_a_process_stopped_at_any_moment_ends_in_a_picture_or_a_message(
    tmp_path: Path, process: int, asked: list[str], seconds: float
) -> None:
    file = tmp_path / "picture.png"
    file.write_text("the picture before")
    # Open MPI 5 may end before it has forwarded the output of the processes; a file loses nothing.
    messages = tmp_path / "messages"
    to_file = ["bash", "-c", 'exec 2>>"$0" "$@"', messages]
    run = start("-n", 3, *to_file, CLUSTER, *asked, "-o", file, "--timeout", "1.5")
    pid = when_begun(run, process)
    time.sleep(seconds)
    os.kill(pid, signal.SIGSTOP)
    done = finish_aborted(run)
    assert names_in(tmp_path) <= {file.name, f"{file.name}.kept", messages.name}
    if file.read_bytes() == b"the picture before":
        assert done.returncode != 0
        written = messages.read_text()
        assert "was silent for 1.5 s" in written or "within 1.5 s" in written, done.stderr
    else:
        one = tmp_path / "one.png"
        output_of("render", *without_split(asked), "--accel", "beam", "-o", one)
        assert one.read_bytes() == file.read_bytes()


def without_split(asked: list[str]) -> list[str]:
    words = [word for word in asked if word not in ("--accel", "beam")]
    return [word for word, before in zip(words, ["", *words], strict=False)
            if "--split" not in (word, before)]  # fmt: skip


def refused(done: subprocess.CompletedProcess[str], words: list[str]) -> None:
    assert done.returncode == 2, (done.returncode, done.stderr)
    lines = [line for line in done.stderr.splitlines() if line != READY]
    sentences = [line for line in lines if line.startswith("beambench-cluster:")]
    assert len(sentences) == 1, done.stderr
    for word in words:
        assert word in sentences[0]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["no-such-scene"], ["no-such-scene"]),
        ([], ["SCENE"]),
        (["tetra", "--accel", "sah-bvh"], ["sah-bvh", "'beam'"]),
        (["tetra", "--accel", "beam:continue=beams"], ["continue=beams"]),
        (["tetra", "--work", "rays"], ["--work"]),
        (["tetra", "--samples", "3"], ["3"]),
        (["tetra", "-o", "/no/such/folder/a.png"], ["/no/such/folder"]),
        (["tetra", "--batch", "0"], ["--batch"]),
        (["tetra", "--work", "interlaced", "--in-flight", "2"], ["interlaced", "--in-flight"]),
        (["tetra", "--resume"], ["--resume", "-o FILE"]),
        (["tetra", "--results", "stored"], ["--results stored", "-o FILE"]),
        (["tetra", "--split", "3", "--resume"], ["--split", "--resume"]),
        (
            ["tetra", "--split", "3", "--shade", "whitted", "--shadows", "cache"],
            ["--split", "--shadows"],
        ),
        (["tetra", "--split", "7"], ["max_level"]),
    ],
)
def test_wrong_requests_are_refused_in_one_sentence(arguments: list[str], words: list[str]) -> None:
    refused(mpirun("-n", 2, CLUSTER, *arguments), words)


def test_another_scene_on_one_process_is_refused(tmp_path: Path) -> None:
    """Two processes read a scene with the same name from different folders."""
    skip_where_mpirun_starts_one_program_only()
    file = tmp_path / "picture.png"
    for folder, size in (("a", 1), ("b", 2)):
        (tmp_path / folder).mkdir()
        scene = tmp_path / folder / "scene.nff"
        assert beambench("export", f"tetra:n={size}", "-o", scene).returncode == 0
    line = [CLUSTER, "./scene.nff", "-o", file]
    one, two = (["-n", 1, "-wdir", tmp_path / folder, *line] for folder in ("a", "b"))
    done = mpirun(*one, ":", *two)
    refused(done, ["process 1", "a different scene"])
    (tmp_path / "b" / "scene.nff").unlink()
    done = mpirun(*one, ":", *two)
    refused(done, ["process 1", "scene.nff"])
    assert not file.exists()


def test_another_version_on_one_process_is_refused(tmp_path: Path) -> None:
    """Runs the same program, but one copy states a commit that does not exist."""
    skip_where_mpirun_starts_one_program_only()
    report = tmp_path / "run.json"
    assert mpirun("-n", 1, CLUSTER, "tetra:n=1", "--report", report).returncode == 0
    commit = json.loads(report.read_text())["commit"].encode()
    other = tmp_path / "beambench-cluster"
    program = CLUSTER.read_bytes()
    assert commit in program
    other.write_bytes(program.replace(commit, bytes(reversed(commit))))
    other.chmod(0o755)
    file = tmp_path / "picture.png"
    line = ["tetra:n=1", "-o", file]
    refused(mpirun("-n", 1, CLUSTER, *line, ":", "-n", 1, other, *line), ["process 1", "version"])
    assert not file.exists()


@pytest.fixture
def full_disk(tmp_path: Path) -> Iterator[Path]:
    """A device without free space for another file."""
    folder = tmp_path / "full"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=64k", "none", folder]
    mounted = subprocess.run(mount, check=False, capture_output=True)
    if mounted.returncode != 0:
        pytest.skip("needs to mount a small disk, as root")
    (folder / "tetra.png").write_text("the picture before")
    filler = (folder / "filler").open("wb", 0)
    with filler, contextlib.suppress(OSError):
        while filler.write(bytes(1024)):
            pass
    yield folder / "tetra.png"
    subprocess.run(["umount", folder], check=True)


def test_a_full_disk_leaves_no_half_picture(full_disk: Path) -> None:
    run = mpirun("-n", 2, CLUSTER, "balls:n=1", *SMALL, "-o", full_disk)
    assert run.returncode == 2
    warning, reason = (
        line for line in run.stderr.splitlines()
        if line.startswith("beambench-cluster:") and line != READY
    )  # fmt: skip
    assert "results cannot be kept" in warning
    for word in ("tetra.png", "disk", "full"):
        assert word in reason
    assert full_disk.read_text() == "the picture before"
    assert {file.name for file in full_disk.parent.iterdir()} == {"filler", "tetra.png"}


def test_a_divided_scene_gives_the_same_picture(tmp_path: Path) -> None:
    one, parts, record = tmp_path / "one.png", tmp_path / "parts.png", tmp_path / "run.json"
    asked = ["--shade", "id", "--resolution", "200x150"]
    output_of("render", "tetra:n=4", "--accel", "beam", "-o", one, *asked)
    run = mpirun(
        "-n", 3, CLUSTER, "tetra:n=4", "--split", 3, "-o", parts, "--report", record, *asked
    )
    assert run.returncode == 0, run.stderr
    assert parts.read_bytes() == one.read_bytes()
    report = json.loads(record.read_text())
    sums = {
        way: sum(process[way]["bytes"] for process in report["each"])
        for way in ("crossings_out", "crossings_in")
    }
    assert sums["crossings_out"] == sums["crossings_in"] > 0
    assert all(part["primitives"] < report["whole_primitives"] for part in report["each"])


def test_help_and_version_end_all_processes() -> None:
    done = mpirun("-n", 3, CLUSTER, "--help")
    assert done.returncode == 0
    assert done.stdout.count("Usage:") == 1
    assert mpirun("-n", 2, CLUSTER, "--version").stdout.startswith("beambench-cluster ")
