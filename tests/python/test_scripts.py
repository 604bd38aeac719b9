"""The scripts, called as by a user."""

from __future__ import annotations

import hashlib
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pandas as pd
import pytest

from program import BINARY

PACKAGE_LISTS = [
    "packages.txt",
    "packages-cluster.txt",
    "packages-test.txt",
    "packages-browser.txt",
]


def call(*command: str | Path, directory: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(part) for part in command], cwd=directory, capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize("script", ["run", "test", "meshes", "setup", "shard", "slurm"])
def test_help_is_given(script: str, repository: Path) -> None:
    result = call(repository / "scripts" / script, "--help", directory=repository)
    assert result.returncode == 0
    assert result.stdout.startswith(f"usage: scripts/{script}")


@pytest.mark.parametrize(
    ("script", "arguments", "message"),
    [
        ("run", ["--swep", "x"], "unknown argument '--swep'"),
        ("run", ["--sweep"], "--sweep needs a file"),
        ("run", ["--sweep", "no/such.json"], "no/such.json is not a file that can be read"),
        ("run", ["--sweep", "quik"], "no sweep has that name; the sweeps are: "),
        ("run", ["--resume"], "--resume needs the folder of a run"),
        ("run", ["--resume", "no/such"], "no/such is not the folder of a run"),
        ("run", ["--resume=a", "--output=b"], "--resume excludes --sweep and --output"),
        ("setup", ["--jobs"], "unknown job '--jobs'; the jobs are program, python, beambench, "),
        ("setup", ["all", "cluster"], "takes one job, not 2"),
        ("test", ["--quick"], "unknown arguments: --quick"),
        ("meshes", ["--all"], "unknown argument '--all'"),
        ("meshes", ["--beambench", "no/such"], "no/such is not a program"),
        ("meshes", ["--beambench"], "--beambench needs a program"),
        ("meshes", ["drogan"], "there is no mesh 'drogan', only cat, bunny, dragon"),
        ("meshes", ["sponza"], "sponza is in no package; download it, and register it with --from"),
        ("meshes", ["--from"], "--from needs a folder"),
        ("meshes", ["--from", "."], "--from needs one name, not 0"),
        (
            "meshes",
            ["--from", ".", "teapot"],
            "--from has no scene 'teapot', only sponza, san-miguel",
        ),
        ("meshes", ["--from", "no/such", "sponza"], "no/such is not a folder; give the one that"),
        ("meshes", ["--from", "scenes", "lucy"], "scenes holds no lucy.ply or lucy.ply.gz; unpack"),
    ],
)
def test_a_wrong_request_is_one_sentence_and_exit_code_2(
    script: str, arguments: list[str], message: str, repository: Path
) -> None:
    result = call(repository / "scripts" / script, *arguments, directory=repository)
    assert result.returncode == 2
    assert result.stdout == ""
    assert result.stderr.startswith("error: ")
    assert message in result.stderr
    assert result.stderr.count("\n") == 1


def test_setup_does_not_clear_what_a_linked_environment_points_to(
    repository: Path, tmp_path: Path
) -> None:
    tree, others = tmp_path / "tree", tmp_path / "others"
    (tree / "scripts").mkdir(parents=True)
    for script in ("setup", "packages.sh"):
        shutil.copy(repository / "scripts" / script, tree / "scripts")
    for path in [*PACKAGE_LISTS, "requirements.txt"]:
        (tree / "scripts" / path).touch()  # nothing to install
    others.mkdir()
    (others / "precious").touch()
    (tree / ".venv").symlink_to(others)
    result = call(tree / "scripts/setup", directory=tmp_path)
    assert (others / "precious").exists()
    assert result.returncode == 2
    assert result.stderr.startswith("error: .venv is a symbolic link")
    assert str(others) in result.stderr
    assert result.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("sent", "code", "words"),
    [
        (None, 0, "could not be fetched: continuing without it"),
        (b"another archive", 1, "three 0.147.0 does not have the expected checksum"),
    ],
)
def test_a_library_of_pages_is_the_expected_one_or_left_out(
    sent: bytes | None,
    code: int,
    words: str,
    repository: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    (tmp_path / "tree/scripts").mkdir(parents=True)
    script = shutil.copy(repository / "scripts/viewer", tmp_path / "tree/scripts")
    archive = tmp_path / "registry/three/-/three-0.147.0.tgz"
    archive.parent.mkdir(parents=True)
    if sent:
        archive.write_bytes(sent)
    monkeypatch.setenv("NPM_CONFIG_REGISTRY", (tmp_path / "registry").as_uri())
    done = call(script, directory=tmp_path)
    assert done.returncode == code
    assert words in done.stdout + done.stderr
    left = [path for path in (tmp_path / "tree/build/viewer").rglob("*") if path.is_file()]
    assert left == [], "neither an archive nor a part of it"


@pytest.fixture
def bare_tree(repository: Path, tmp_path: Path) -> Path:
    """A tree in which scripts/setup has nothing to install and whose build prints its arguments."""
    tree, tools = tmp_path / "bare", tmp_path / "tools"
    (tree / "scripts").mkdir(parents=True)
    tools.mkdir()
    for script in ("setup", "packages.sh"):
        shutil.copy(repository / "scripts" / script, tree / "scripts")
    (tree / "scripts/viewer").symlink_to("/bin/true")
    for path in [*PACKAGE_LISTS, "requirements.txt"]:
        (tree / "scripts" / path).touch()
    version = call("/usr/bin/python3", "--version", directory=tree).stdout
    (tree / ".venv/bin").mkdir(parents=True)
    (tree / ".venv/bin/python").symlink_to("/usr/bin/python3")
    (tree / ".venv/beambench-fingerprint").write_text(
        f"{hashlib.sha256(version.encode()).hexdigest()}  -\n"
    )
    cmake = tools / "cmake"
    cmake.write_text('#!/bin/sh\necho "cmake $*"\n[ "$1" != --build ] || sleep 1\n')
    cmake.chmod(0o755)
    return tree


def set_up(tree: Path, *arguments: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [tree / "scripts/setup", *arguments],
        env={**os.environ, "PATH": f"{tree.parent / 'tools'}:{os.environ['PATH']}"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


@pytest.mark.parametrize(
    ("job", "targets"),
    [
        ("program", "beambench"),
        ("beambench", "beambench beambench_python"),
        ("python", "beambench_python"),
        ("cluster", "beambench-cluster beambench-cluster-simulated beambench_python"),
        ("all", "all"),
    ],
)
def test_setup_builds_only_what_the_job_needs(bare_tree: Path, job: str, targets: str) -> None:
    output, _ = set_up(bare_tree, job).communicate(timeout=120)
    assert f"cmake --build --preset release --target {targets}\n" in output


def test_two_set_ups_of_one_tree_take_turns(bare_tree: Path) -> None:
    first = set_up(bare_tree, "beambench")
    while not (bare_tree / "build/setup.lock").exists():
        time.sleep(0.01)
    second = set_up(bare_tree, "beambench")
    outputs = [process.communicate(timeout=120)[0] for process in (first, second)]
    assert [process.returncode for process in (first, second)] == [0, 0]
    assert sum("Another scripts/setup is running in this tree" in output for output in outputs) == 1


def test_scripts_run_installs_nothing_that_only_tests_or_the_cluster_need(repository: Path) -> None:
    needed = (repository / "scripts/packages.txt").read_text()
    for package in ("libgtest-dev", "librapidcheck-dev", "libopenmpi-dev", "libsimgrid-dev"):
        assert package not in needed
    run = (repository / "scripts/run").read_text()
    assert re.findall(r"scripts/setup (\w+)\n", run) == ["program", "python"]


def test_program_and_python_are_set_up_apart(bare_tree: Path) -> None:
    output, _ = set_up(bare_tree, "python").communicate(timeout=120)
    assert "Making the Python environment" not in output, "it is there"
    shutil.rmtree(bare_tree / ".venv")
    output, _ = set_up(bare_tree, "program").communicate(timeout=120)
    assert "cmake --build --preset release --target beambench\n" in output
    assert not (bare_tree / ".venv").exists()


def test_ctrl_c_ends_the_tests_instead_of_going_on_with_the_next_check(
    repository: Path, tmp_path: Path
) -> None:
    tree = tmp_path / "tree"
    (tree / "scripts").mkdir(parents=True)
    shutil.copy(repository / "scripts/test", tree / "scripts")
    tools = tmp_path / "tools"
    tools.mkdir()
    for path in (tree / "scripts/setup", tools / "ctest"):
        path.write_text("#!/bin/sh\n")
        path.chmod(0o755)
    # Like pytest: ends by itself on SIGINT, with its own exit code.
    python = tree / ".venv/bin/python"
    python.parent.mkdir(parents=True)
    python.write_text(
        "#!/bin/bash\ntrap 'exit 2' INT\necho started\nfor i in {1..100}; do sleep 0.1; done\n"
    )
    python.chmod(0o755)
    tests = subprocess.Popen(
        [tree / "scripts/test"],
        env={**os.environ, "PATH": f"{tools}:{os.environ['PATH']}"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    assert tests.stdout is not None
    for line in tests.stdout:
        if line == "started\n":
            break
    os.killpg(tests.pid, signal.SIGINT)  # like a terminal: to the whole group
    rest = tests.stdout.read()
    assert tests.wait(timeout=30) == 130
    assert "interrupted" in rest
    assert "== C++ format" not in rest


def test_the_lists_of_packages_name_each_once(repository: Path) -> None:
    lists = [repository / "scripts" / name for name in PACKAGE_LISTS]
    lines = [line for path in lists for line in path.read_text().splitlines()]
    packages = [line.split("#")[0].strip() for line in lines]
    packages = [package for package in packages if package]
    assert len(packages) == len(set(packages)) > 10


def test_every_long_test_that_ci_leaves_out_exists(repository: Path) -> None:
    listed = re.search(r"^long=\(\n(.*?)^\)", (repository / ".ci/run").read_text(), re.M | re.S)
    assert listed is not None
    patterns = re.findall(r"'([^']+)'", listed.group(1))
    assert patterns
    program = BINARY.with_name("test_accel")
    for pattern in patterns:
        result = call(
            program, "--gtest_list_tests", f"--gtest_filter={pattern}", directory=repository
        )
        assert "\n  " in result.stdout, pattern


def test_an_interrupted_run_is_resumed_and_leaves_records_pictures_plots_and_a_page(
    repository: Path, tmp_path: Path
) -> None:
    if not (repository / "build/release/bin/beambench").exists():
        pytest.skip("beambench is not built; run scripts/setup")
    sweep = {
        "name": "small",
        "description": "One scene, for a test of scripts/run.",
        "scenes": ["stetra"],
        "structures": ["exhaustive", "samet", "null"],
        "resolutions": ["32x20", "64x40"],
        "precision": 1e-9,
        "repetitions": {"minimum": 20, "maximum": 100000},
        "budget_seconds": 1,  # of each of six cells: the run is interrupted during its second
        "warm_up_seconds": 0,
    }
    (tmp_path / "small.json").write_text(json.dumps(sweep))
    run = tmp_path / "a run"
    picture = repository / "results/runs/first-picture.png"
    picture.unlink(missing_ok=True)
    begun = subprocess.Popen(
        # Relative names are relative to the caller's folder, whatever folder the script works in.
        [repository / "scripts/run", "--sweep", "small.json", "--output", "a run"],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    for _ in range(2400):  # set-up and a first picture take a minute on a busy machine
        if (run / "run.jsonl").exists():
            break
        time.sleep(0.1)
    time.sleep(1)
    os.killpg(begun.pid, signal.SIGINT)
    printed, messages = begun.communicate(timeout=60)
    assert begun.returncode == 130, messages
    assert f"habitacion: {picture}\n== Measuring" in printed
    assert picture.read_bytes().startswith(b"\x89PNG")
    hint = messages.strip().splitlines()[-1]
    assert hint.startswith("Resume, with pictures, plots and the page: ")
    command = shlex.split(hint.split(": ", 1)[1])
    assert command == [str(repository / "scripts/run"), "--resume", str(run)]

    resumed = call(*command, directory=tmp_path)
    assert resumed.returncode == 0, resumed.stderr
    rows = pd.read_csv(run / "results.csv", keep_default_na=False)
    assert len(rows) == 6
    assert set(rows["verdict"]) == {"ok", "baseline"}
    assert (run / "plots" / "resolutions.png").exists()
    assert (run / "pictures" / "stetra.png").exists()
    assert (run / "pictures" / "stetra-samet-traversal_steps.png").exists()
    assert f"Look at {run}/report.html\n" in resumed.stdout
    assert resumed.stdout.endswith((run / "summary.txt").read_text())
    assert "Fastest by trace time" in resumed.stdout
    assert "\nHits:  6 cells, all verified\nTimes: " in resumed.stdout
    page = re.sub(r"<[^>]*>", "", (run / "report.html").read_text())
    assert "The hits of all 6 cells are correct" in page
