"""Contenders in other languages: the C interface in shared objects, and separate programs."""

from __future__ import annotations

import csv
import json
import os
import shutil
import stat
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from plugins import SOURCES, built, call
from program import refused

PYTHON = SOURCES / "python/mine.py"
# The Python with NumPy comes first on the PATH, as in an activated environment.
WITH_NUMPY = {"PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
SMALL = ("--resolution", "24x18", "--rays", "primary,shadow,random")


@pytest.fixture(scope="module")
def in_c(prefix: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The template in C, built with the installed package by a project without C++."""
    return built(SOURCES / "c", tmp_path_factory.mktemp("c"), prefix) / "libmine_in_c.so"


@pytest.fixture(scope="module")
def in_rust(tmp_path_factory: pytest.TempPathFactory) -> Path:
    cargo = shutil.which("cargo")
    if cargo is None:
        pytest.skip("the template in Rust needs cargo, which is not installed")
    folder = shutil.copytree(SOURCES / "rust", tmp_path_factory.mktemp("rust") / "mine")
    subprocess.run([cargo, "build", "--release", "--offline", "--quiet"], cwd=folder, check=True)
    return folder / "target/release/libmine_in_rust.so"


def verifies(plugin: Path, name: str) -> None:
    done = call("--plugin", plugin, "verify", "tetera", "balls:n=1", "--accel", name, *SMALL,
                **WITH_NUMPY)  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count(" ok") == 3, done.stdout
    assert done.stdout.count(" unsupported\n") == 3, done.stdout


def test_the_template_in_c_returns_right_hits(in_c: Path) -> None:
    verifies(in_c, "mine-in-c")


def test_the_template_in_rust_returns_right_hits(in_rust: Path) -> None:
    verifies(in_rust, "mine-in-rust")


def test_the_template_in_python_returns_right_hits() -> None:
    verifies(PYTHON, "mine-in-python")


@pytest.mark.parametrize("file", ["c/mine.c", "rust/src/lib.rs", "python/mine.py"])
def test_a_template_has_at_most_60_lines(file: str) -> None:
    assert 20 < len((SOURCES / file).read_text().splitlines()) <= 60


def test_the_header_is_c99(prefix: Path, tmp_path: Path) -> None:
    source = tmp_path / "only.c"
    source.write_text("#include <beambench/contender.h>\n")
    flags = ["-std=c99", "-pedantic-errors", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"]
    for compiler in ("cc", "c++ -xc++ -std=c++11"):
        used = flags[1:] if "+" in compiler else flags
        command = [*compiler.split(), *used, "-I", prefix / "include", source]
        subprocess.run(command, check=True)


def times(tmp_path: Path, plugin: Path, name: str, scene: str = "tetra:n=2") -> dict[str, str]:
    """Returns the row of a small sweep."""
    config = {"name": "one", "scenes": [scene], "structures": [name],
              "resolutions": ["16x12"], "budget_seconds": 20,
              "repetitions": {"minimum": 2, "maximum": 2, "second_traces": 1}}  # fmt: skip
    (tmp_path / "sweep.json").write_text(json.dumps(config))
    done = call("--plugin", plugin, "run", tmp_path / "sweep.json", "-o", tmp_path / "run",
                **WITH_NUMPY)  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    (row,) = csv.DictReader((tmp_path / "run/results.csv").open())
    return row


def test_a_structure_of_the_c_interface_is_timed(in_c: Path, tmp_path: Path) -> None:
    row = times(tmp_path, in_c, "mine-in-c")
    assert row["verdict"] == "ok"
    assert row["library_version"] == "mine 1.0"
    assert float(row["trace_ms_median"]) > 0


# The effects of a faulty table or function

BROKEN = """
#include <beambench/contender.h>
static int create(const beambench_scene* scene, void** structure) {
  *structure = (void*)scene;
  return CREATE;
}
static int closest(const void* scene, const beambench_batch* batch, float* t, uint32_t* primitive) {
  (void)scene;
  for (size_t i = 0; i < batch->count; ++i) { t[i] = 1.0f; primitive[i] = 1000000000u; }
  return CLOSEST;
}
static void destroy(void* structure) { (void)structure; }
static const beambench_contender broken = {SIZE, NAME, "broken on purpose", 0, BEAMBENCH_TRIANGLES,
                                           create, closest, 0, destroy, 0};
const beambench_contender* beambench_contenders(uint32_t version, uint32_t* count) {
  *count = version == VERSION;
  return &broken;
}
"""
SOUND = {
    "CREATE": "0",
    "CLOSEST": "0",
    "SIZE": "sizeof(broken)",
    "NAME": '"broken"',
    "VERSION": "1",
}


def broken(prefix: Path, folder: Path, **changes: str) -> Path:
    source, library = folder / "broken.c", folder / "libbroken.so"
    source.write_text(BROKEN)
    defined = [f"-D{name}={value}" for name, value in {**SOUND, **changes}.items()]
    subprocess.run(["cc", "-shared", "-fPIC", *defined, "-I", prefix / "include", source, "-o",
                    library], check=True)  # fmt: skip
    return library


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"VERSION": "99"}, ["libbroken.so", "version 1 of the C interface"]),
        ({"SIZE": "8"}, ["libbroken.so", "contender 0", "'size' is 8"]),
        ({"NAME": "0"}, ["contender 0", "without a name"]),
        ({"NAME": '"sah-bvh"'}, ["'sah-bvh'", "there is one of that name already"]),
    ],
)
def test_a_table_that_is_not_sound_is_refused(
    prefix: Path, tmp_path: Path, changes: dict[str, str], words: list[str]
) -> None:
    refused(call("--plugin", broken(prefix, tmp_path, **changes), "list"), words)


def verify_tetra(plugin: Path, name: str, rays: str = "primary") -> subprocess.CompletedProcess:
    return call("--plugin", plugin, "verify", "tetra:n=2", "--accel", name, "--resolution", "16x12",
                "--rays", rays)  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "rays", "code", "words"),
    [
        ({}, "primary", 1, ["mismatch"]),  # an id that is not in the scene
        ({"CREATE": "2"}, "primary", 1, ["'broken' failed", "create", "returned 2"]),
        ({"CLOSEST": "7"}, "primary", 1, ["'broken' failed", "closest_hits", "returned 7"]),
        ({"CREATE": "1"}, "primary", 2, ["unsupported", "'broken' declines 'create'"]),
        ({"CLOSEST": "1"}, "primary", 2, ["unsupported", "declines 'closest_hits'"]),
        ({}, "shadow", 2, ["unsupported", "declines 'any_hits'"]),
    ],
)
def test_what_a_function_returns_decides_the_verdict(
    prefix: Path, tmp_path: Path, changes: dict[str, str], rays: str, code: int, words: list[str]
) -> None:
    done = verify_tetra(broken(prefix, tmp_path, **changes), "broken", rays)
    assert done.returncode == code, done.stdout + done.stderr
    for word in words:
        assert word in done.stdout, done.stdout


# Programs


def program(folder: Path, answers: str) -> Path:
    """Writes a program that handles requests by code in terms of `verb` and `words`."""
    file = folder / "mine"
    file.write_text(
        f"#!{sys.executable}\n"
        "import os, sys, time\n"
        "def answer(*words): print(*words, flush=True)\n"
        "for line in sys.stdin:\n"
        "    verb, *words = line.split()\n"
        '    if verb == "describe":\n'
        '        answer(\'{"name": "odd", "description": "odd", "version": "odd 1"}\')\n'
        "        continue\n" + textwrap.indent(textwrap.dedent(answers), "    ")
    )
    file.chmod(file.stat().st_mode | stat.S_IXUSR)
    return file


def test_times_of_a_program_are_marked(tmp_path: Path) -> None:
    row = times(tmp_path, PYTHON, "mine-in-python")
    assert row["verdict"] == "ok"
    assert row["library_version"] == "mine 1.0 (times are self-reported)"
    assert 0 < float(row["trace_ms_median"]) < 1000


def test_the_table_of_times_marks_those_of_a_program() -> None:
    done = call("--plugin", PYTHON, "time", "tetra:n=1", "--accel", "mine-in-python,sah-bvh",
                "--resolution", "16x12", "--seconds", "1", **WITH_NUMPY)  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "mine-in-python (self-reported)" in done.stdout
    assert "self-reported: times of the program's own clock" in done.stdout
    assert "sah-bvh (" not in done.stdout


def test_times_of_a_program_are_its_own(tmp_path: Path) -> None:
    """The program sleeps longer than it reports. All rays miss, as is correct for this view."""
    file = program(
        tmp_path,
        """\
        time.sleep(0.02)
        if verb == "closest":
            count = int(words[1])
            with open(words[0], "r+b") as memory:
                memory.seek(32 * count)
                memory.write(MISSES * count)
        answer("ok", 0.001)
        """.replace("MISSES * count", r'b"\0\0\x80\x7f" * count + b"\xff" * (4 * count)'),
    )
    away = tmp_path / "away.nff"
    away.write_text("v\nfrom 0 0 5\nat 0 0 9\nup 0 1 0\nangle 40\nhither 1\nresolution 8 6\n"
                    "p 3\n0 0 0\n1 0 0\n0 1 0\n")  # fmt: skip
    row = times(tmp_path, file, "odd", str(away))
    assert row["verdict"] == "ok"
    assert float(row["trace_ms_median"]) == 1.0


@pytest.mark.parametrize(
    ("answers", "words"),
    [
        ("answer('ok', 9.5)", ["reports 9.5 s for 'build'", "longer than"]),
        ("answer('ok', -1)", ["answered 'ok -1' to 'build'", "expected 'ok SECONDS'"]),
        ("answer('ok', 'nan')", ["answered 'ok nan'"]),
        ("answer('error', 'no memory')", ["answered 'error no memory' to 'build'"]),
        ("answer('ok 0\\nok 0')", ["more than one line", "stderr"]),
        ("os._exit(3)", ["ended with exit code 3", "'build'"]),
        ("os.abort()", ["crashed (SIGABRT", "'build'"]),
    ],
)
def test_a_program_that_breaks_the_protocol_is_an_error(
    tmp_path: Path, answers: str, words: list[str]
) -> None:
    done = verify_tetra(program(tmp_path, answers), "odd")
    assert done.returncode == 1, done.stdout + done.stderr
    for word in words:
        assert word in done.stdout, done.stdout


def test_one_process_builds_all_scenes(tmp_path: Path) -> None:
    log = tmp_path / "log"
    answers = f"print(os.getpid(), verb, file=open({str(log)!r}, 'a'))\nanswer('ok', 0)"
    done = call("--plugin", program(tmp_path, answers), "verify", "tetra:n=1", "tetra:n=2",
                "--accel", "odd", "--resolution", "8x6")  # fmt: skip
    assert done.returncode == 1  # it writes no hits
    lines = [line.split() for line in log.read_text().splitlines()]
    assert [verb for _, verb in lines] == ["build", "closest", "build", "closest"]
    assert len({pid for pid, _ in lines}) == 1


def test_a_program_that_hangs_is_ended_after_its_timeout(tmp_path: Path) -> None:
    file = program(tmp_path, "print(os.getpid(), file=open('pid', 'w'), flush=True)\n"
                             "time.sleep(1000)").resolve()  # fmt: skip
    file.write_text(file.read_text().replace("'pid'", repr(str(tmp_path / "pid"))))
    done = verify_tetra(file, "odd:timeout=1")
    assert done.returncode == 1
    assert "did not answer 'build' within 1 s" in done.stdout
    with pytest.raises(ProcessLookupError):
        os.kill(int((tmp_path / "pid").read_text()), 0)


def test_a_program_that_writes_no_hits_is_wrong(tmp_path: Path) -> None:
    done = verify_tetra(program(tmp_path, "answer('ok', 0)"), "odd")
    assert done.returncode == 1
    assert "mismatch" in done.stdout


def test_a_program_may_decline_a_query(tmp_path: Path) -> None:
    file = program(tmp_path, "answer(*(['ok', 0] if verb == 'build' else ['unsupported', 'no']))")
    done = verify_tetra(file, "odd", "shadow")
    assert done.returncode == 2, done.stdout
    assert "declines 'any': no" in done.stdout


def test_what_is_not_a_contender_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "mine"
    file.write_text("#!/bin/sh\nread line\necho hello\n")
    file.chmod(0o755)
    refused(call("--plugin", file, "list"), ["mine", "'hello' to 'describe'", "JSON"])
    file.write_text("#!/bin/sh\nexit 4\n")
    refused(call("--plugin", file, "list"), ["mine", "ended with exit code 4", "'describe'"])
