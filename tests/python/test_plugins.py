"""User structures and scenes in shared objects: loading, measuring, refusals, and crashes."""

from __future__ import annotations

import csv
import json
import os
import platform
import re
import signal
import subprocess
import time
from pathlib import Path

import pytest

from plugins import BUILD, SOURCES, built, call, configured, reached_headers, run
from program import BINARY, refused
from run_logs import begun_cells, events

SWEEP = {
    "name": "plugged",
    "scenes": ["tetra:n=2", "row:n=2"],
    "structures": ["exhaustive", "faulty"],
    "resolutions": ["16x12"],
    "budget_seconds": 20,
    "repetitions": {"minimum": 2, "maximum": 2},
}


@pytest.fixture(scope="module")
def template(prefix: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The template, built with the installed package."""
    return built(SOURCES / "template", tmp_path_factory.mktemp("template"), prefix) / "libmine.so"


@pytest.fixture(scope="module")
def faulty_folder(prefix: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The faulty plug-in, built with the build folder's package."""
    del prefix  # the fixture skips the tests without an installation
    return built(SOURCES / "faulty", tmp_path_factory.mktemp("faulty"), BUILD)


@pytest.fixture(scope="module")
def faulty(faulty_folder: Path) -> Path:
    return faulty_folder / "libfaulty.so"


def sweep(
    tmp_path: Path, plugin: Path, fault: str, **changes: object
) -> tuple[int, list[dict], str]:
    """Returns the exit code, rows and messages of a small sweep."""
    config = tmp_path / "sweep.json"
    config.write_text(json.dumps({**SWEEP, **changes}))
    done = call("--plugin", plugin, "run", config, "-o", tmp_path / "run", fault=fault)
    results = tmp_path / "run/results.csv"
    rows = list(csv.DictReader(results.open())) if results.exists() else []
    return done.returncode, rows, done.stderr


# Installation


def test_headers_of_plug_ins_need_no_others(prefix: Path) -> None:
    reached = reached_headers(prefix, "plugin.hpp")
    assert len(reached) > 30
    others = {name for name in reached if name.startswith("harness/")}
    assert others == {"harness/plugin/plugin.hpp", "harness/plugin/plugin_stamp.hpp"}


def test_the_installed_program_takes_the_template_in(prefix: Path, template: Path) -> None:
    program = prefix / "bin/beambench"
    done = call("--plugin", template, "verify", "helix:spheres=40", "balls:n=1", "--accel",
                "exhaustive,mine,mine:max_leaf=1", "--resolution", "64x48",
                program=program)  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count(" ok") == 6


def test_the_template_needs_40_lines_beyond_the_algorithm() -> None:
    lines = [
        line
        for name in ("plugin.cpp", "CMakeLists.txt")
        for line in (SOURCES / "template" / name).read_text().splitlines()
        if line.strip() and not line.strip().startswith("//")
    ]
    assert 10 < len(lines) <= 40


@pytest.mark.skipif(platform.machine() != "x86_64", reason="reads another machine's code")
def test_no_traversal_of_the_template_calls_through_a_pointer(template: Path) -> None:
    text = subprocess.run(
        ["objdump", "-dC", "--no-show-raw-insn", template],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    asked = re.compile(r"(find_closest|find_any|closest_hits?|any_hits?|(closest|any)_of_\w+)[<(]")
    timed = {}
    for function in re.split(r"\n\n(?=[0-9a-f]+ <)", text):
        name = function.splitlines()[0]
        if "MedianBvh" in name and "_Function_handler" not in name and asked.search(name):
            timed[name] = function
    for query in ("::closest_hits(", "::any_hits(", "::closest_of_image("):
        assert any(query in name for name in timed)
    # The code of an image ends by destroying the std::function that hands its rows to threads, with
    # a call of the function's manager (operation 3).
    manager = re.compile(r"\bmov +\$0x3,%edx\n(?:.*\bmov .*\n){1,2}.*\bcall +\*%rax")
    for name, code in timed.items():
        assert not re.search(r"\bcall\s+\*", manager.sub("", code)), name


def test_find_package_takes_no_other_version(prefix: Path, tmp_path: Path) -> None:
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(other CXX)\n"
        "find_package(beambench 9.0 REQUIRED)\n"
    )
    with pytest.raises(AssertionError, match="compatible with requested version"):
        built(tmp_path, tmp_path / "build", prefix)


@pytest.mark.parametrize(
    ("variable", "header"),
    [
        ("BEAMBENCH_TINYBVH", "tiny_bvh.h"),
        ("BEAMBENCH_MADMANN91_BVH", "bvh/v2/bvh.h"),
        ("BEAMBENCH_CGAL", "CGAL/AABB_tree.h"),
    ],
)
def test_an_adapter_is_built_where_its_headers_are(
    prefix: Path, tmp_path: Path, variable: str, header: str
) -> None:
    adapters = SOURCES.parents[1] / "harness/plugin/adapters"
    libraries = configured(adapters, tmp_path / "none", prefix)
    assert not libraries
    folder = tmp_path / "their headers"
    folder.mkdir()
    with pytest.raises(AssertionError, match=f"{variable}: there is no {header} in"):
        configured(adapters, tmp_path / "wrong", prefix, f"-D{variable}={folder}")
    (folder / header).parent.mkdir(parents=True, exist_ok=True)
    (folder / header).touch()
    libraries = configured(adapters, tmp_path / "right", prefix, f"-D{variable}={folder}")
    assert libraries == {f"plugins/lib{variable.removeprefix('BEAMBENCH_').lower()}.so"}


def test_an_adapter_states_the_commit_of_its_library_alone(prefix: Path, tmp_path: Path) -> None:
    """The commit must not be that of a checkout that happens to contain the library's folder."""
    adapters = SOURCES.parents[1] / "harness/plugin/adapters"
    library = tmp_path / "library"
    library.mkdir()
    (library / "tiny_bvh.h").touch()
    git = ("git", "-C", library, "-c", "user.name=T", "-c", "user.email=t@example.org")
    run("git", "init", "--quiet", library)

    def stated() -> str:
        configured(adapters, tmp_path / "build", prefix, f"-DBEAMBENCH_TINYBVH={library}")
        text = (tmp_path / "build/build.ninja").read_text()
        (commit,) = set(re.findall(r'BEAMBENCH_LIBRARY_COMMIT=\\"(.*?)\\"', text))
        return commit

    run(*git, "commit", "--quiet", "--allow-empty", "-m", "something else")
    assert not stated()
    run(*git, "add", "tiny_bvh.h")
    run(*git, "commit", "--quiet", "-m", "the library")
    head = subprocess.run([*git, "rev-parse", "HEAD"], capture_output=True, text=True, check=True)
    assert re.fullmatch("[0-9a-f]{7,}", stated())
    assert head.stdout.startswith(stated())
    (library / "tiny_bvh.h").write_text("changed")
    assert stated().endswith("-dirty")


# Loading


def test_list_says_what_is_brought_and_by_whom(template: Path, faulty: Path) -> None:
    text = call("--plugin", template, "list", "--plugin", faulty).stdout
    assert f"mine  [bit-exact, no SIMD]  (of {template})" in text
    assert f"helix  (of {template})" in text
    assert f"*.row  (of {faulty})" in text
    assert "A hierarchy to start from" in text
    everything = json.loads(call("--plugin", template, "list", "--json").stdout)
    origins = {structure["name"]: structure["origin"] for structure in everything["structures"]}
    assert origins["mine"] == str(template)
    assert origins["samet"] == "built in"
    names = [scene["name"] for scene in everything["scenes"]]
    assert names == sorted(names)


def test_the_environment_names_files_and_folders(template: Path, faulty_folder: Path) -> None:
    folder = faulty_folder / "only"
    folder.mkdir()
    (folder / "libfaulty.so").symlink_to(faulty_folder / "libfaulty.so")
    text = call("list", BEAMBENCH_PLUGINS=f"{template}:{folder}").stdout
    assert "mine  [" in text
    assert "faulty  [" in text


def test_a_sweep_measures_it_and_the_manifest_says_what_it_was(
    template: Path, tmp_path: Path
) -> None:
    code, rows, messages = sweep(
        tmp_path, template, "", structures=["mine", "sah-bvh"], scenes=["helix"]
    )
    assert code == 0, messages
    assert [row["verdict"] for row in rows] == ["ok", "ok"]
    mine = next(row for row in rows if row["structure"] == "mine")
    assert float(mine["trace_ms_median"]) > 0
    assert float(mine["primitive_tests_per_ray"]) > 0
    (plugin,) = json.loads((tmp_path / "run/manifest.json").read_text())["plugins"]
    assert plugin["file"] == str(template)
    assert re.fullmatch("[0-9a-f]{16}", plugin["hash"])
    assert plugin["structures"] == ["mine"]
    assert plugin["scenes"] == ["helix"]
    assert plugin["optimized"]


def test_the_self_test_ends_with_a_verdict(template: Path, faulty: Path, tmp_path: Path) -> None:
    done = call("--plugin", template, "selftest", "--accel", "mine", "--scenes", "10")
    assert done.returncode == 0, done.stdout
    assert "\nmine: ok, passes all 16 checks\n" in done.stdout
    assert f"--plugin {template} verify --kit kit --accel mine" in done.stdout.splitlines()[-1]

    def faulty_test(fault: str) -> subprocess.CompletedProcess[str]:
        return call("--plugin", faulty, "selftest", "--accel", "faulty", "--scenes", "10",
                    "--json", tmp_path / "selftest.json", fault=fault)  # fmt: skip

    wrong = faulty_test("any hit is the other way round")
    assert wrong.returncode == 1
    assert re.search(r"^faulty: failed \d+ of 16 checks$", wrong.stdout, re.MULTILINE)
    some = faulty_test("refuses spheres")
    assert some.returncode == 0, some.stdout
    assert ", over cones and polygons only: it does not support spheres\n" in some.stdout
    told = json.loads((tmp_path / "selftest.json").read_text())
    assert told["structures"] == [{"structure": "faulty", "primitives": ["cones", "polygons"]}]


def test_a_crash_fails_its_check_and_the_self_test_goes_on(faulty: Path) -> None:
    done = call("--plugin", faulty, "selftest", "--accel", "faulty", "--scenes", "3",
                fault="crash in trace")  # fmt: skip
    assert done.returncode == 1, done.stderr
    assert f"the plug-in {faulty}: querying 'faulty' over random 1 crashed (SIGSEGV" in done.stdout
    assert "querying 'faulty' over closed mesh crashed" in done.stdout
    assert re.search(r"statistics +0 +ok", done.stdout), done.stdout


def test_a_loop_without_end_over_one_scene_fails_by_its_name(faulty: Path) -> None:
    done = call("--plugin", faulty, "selftest", "--accel", "faulty", "--scenes", "3",
                "--timeout", "1", fault="hang over empty")  # fmt: skip
    assert done.returncode == 1, done.stderr
    assert f"the plug-in {faulty}: querying 'faulty' over empty did not end within 1 s" in (
        done.stdout
    )
    assert "faulty: failed 1 of 16 checks" in done.stdout


@pytest.fixture(scope="module")
def small_kit(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("kit") / "kit"
    assert call("selftest", "--export", folder, "--scenes", "2").returncode == 0
    index = json.loads((folder / "kit.json").read_text())
    index["cases"] = [case for case in index["cases"] if case["triangles"] < 60]
    (folder / "kit.json").write_text(json.dumps(index))
    return folder


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("crash in trace of many", "querying 'faulty' over {} crashed (SIGSEGV"),
        ("abort in trace of many", "querying 'faulty' over {} crashed (SIGABRT"),
        ("exit in trace of many", "querying 'faulty' over {} ended with exit code 0"),
        ("hang in trace of many", "querying 'faulty' over {} did not end within 1 s"),
    ],
)
def test_a_case_of_a_kit_that_crashes_fails_and_the_others_are_verified(
    faulty: Path, small_kit: Path, tmp_path: Path, fault: str, words: str
) -> None:
    done = call("--plugin", faulty, "verify", "--kit", small_kit, "--accel", "faulty",
                "--timeout", "1", "--json", tmp_path / "v.json", fault=fault)  # fmt: skip
    assert done.returncode == 1, done.stdout + done.stderr
    cases = json.loads((tmp_path / "v.json").read_text())["cases"]
    index = json.loads((small_kit / "kit.json").read_text())["cases"]
    assert len(cases) == 2 * len(index)
    failed = [case for case in cases if not case["passed"]]
    assert 0 < len(failed) < len(cases)
    for case in failed:
        assert case["verdict"] == "error"
        scene = small_kit / case["name"].split(",")[0] / "scene.nff"
        assert words.format(scene) in case["message"]
        assert f"replay: {case['replay']}" in done.stdout
    assert {case["verdict"] for case in cases if case["passed"]} == {"ok"}


def test_a_run_goes_on_with_the_same_plug_ins_only(template: Path, tmp_path: Path) -> None:
    sweep(tmp_path, template, "", structures=["mine"], scenes=["balls:n=1"])
    refused(call("run", "--resume", tmp_path / "run"), ["mine"])
    other = tmp_path / "libother.so"
    other.write_bytes(template.read_bytes())
    refused(
        call("--plugin", other, "run", "--resume", tmp_path / "run"), ["--plugin", str(template)]
    )


def test_a_scene_is_named_as_it_is_asked_for_and_a_file_by_its_path(
    faulty: Path, tmp_path: Path
) -> None:
    done = call("--plugin", faulty, "scene", "row:n=5", "--json")
    assert json.loads(done.stdout)["name"] == "row:n=5"
    file = tmp_path / "some.row"
    file.write_text("")
    done = call("--plugin", faulty, "scene", file, "--json")
    assert json.loads(done.stdout)["name"] == str(file)
    assert "2: a word was skipped" in done.stderr
    done = call("--plugin", faulty, "scene", file, "--strict")
    refused(done, ["a word was skipped"])
    refused(call("--plugin", faulty, "scene", file, fault="reader refuses"), ["holds no spheres"])


# Refusals


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("throw in fill", ["threw", "while it was loaded", "not ready"]),
        ("throw at load", ["crashed", "SIGABRT", "not loaded"]),
        ("crash at load", ["crashed", "SIGSEGV", "not loaded"]),
        ("exit at load", ["ended with exit code 0", "not loaded"]),
        ("hang in fill", ["did not come to an end", "not loaded"]),
        ("brings nothing", ["provides nothing"]),
        ("taken name", ["'samet'", "rename it"]),
        ("no name", ["'my structure:1'", "letters, digits"]),
        ("reserved", ["'all'", "letters, digits"]),
        ("name given twice", ["'faulty'", "rename it"]),
        ("taken scene", ["'balls'", "rename it"]),
        ("taken ending", ["'.obj'", "read already"]),
        ("no summary", ["without a summary"]),
        ("no function", ["without a function to build"]),
        ("default out of range", ["invalid default parameters", "leaf"]),
    ],
)
def test_it_is_refused_by_name(faulty: Path, fault: str, words: list[str]) -> None:
    done = call("--plugin", faulty, "list", fault=fault)
    assert done.returncode == 2, (done.stdout, done.stderr)
    assert done.stdout == ""
    message = done.stderr.splitlines()[-1]
    assert message.startswith(f"beambench: the plug-in {faulty}")
    for word in words:
        assert word in message


def test_what_is_no_plug_in_is_refused(faulty_folder: Path, tmp_path: Path) -> None:
    refused(call("list", "--plugin"), ["--plugin needs a file"])
    refused(call("--plugin", tmp_path / "nowhere.so", "list"), ["nowhere.so", "is not there"])
    refused(call("--plugin", tmp_path, "list"), ["is not a file"])
    text = tmp_path / "text.so"
    text.write_text("not a shared object")
    refused(call("--plugin", text, "list"), ["text.so", "cannot be loaded"])
    stranger = faulty_folder / "libstranger.so"
    refused(call("--plugin", stranger, "list"), ["libstranger.so", "not a beambench plug-in"])


def test_another_interface_is_refused_by_its_stamp(
    template: Path, repository: Path, tmp_path: Path
) -> None:
    header = (repository / "harness/plugin/plugin_stamp.hpp").read_text()
    version = int(re.search(r"kPluginInterface = (\d+)", header)[1])
    code = template.read_bytes()
    stamp = code.index(b"beambenc" + version.to_bytes(4, "little"))

    def refusal_of(offset: int, value: int, words: list[str]) -> None:
        changed = bytearray(code)
        changed[stamp + offset] = value
        file = tmp_path / "libchanged.so"
        file.write_bytes(changed)
        refused(call("--plugin", file, "list"), ["libchanged.so", *words])

    refusal_of(0, 0, ["not a beambench plug-in"])
    for other in (1, 2, version + 1):
        refusal_of(8, other, [f"version {other} of the interface", f"this program has {version}"])
        refusal_of(8, other, ["build it again"])
    refusal_of(
        8,
        2,
        [
            "since then: each query exists once",
            "RayBatch (version 3);",
            "counts tests by kind of primitive (version 5);",
            "change hits (version 6); two queries",
            "update() (version 7); a scene has a frame",
            "may move (version 8); an",
        ],
    )
    refusal_of(
        8,
        1,
        [
            "image (version 2); each query",
            "(version 3); a RayBatch",
            "counts tests by kind of primitive (version 5);",
            "change hits (version 6); two queries",
            "update() (version 7); a scene has a frame",
            "may move (version 8); an",
        ],
    )
    refusal_of(8, version + 1, [f"this program has {version}, an older one; build it again"])
    refusal_of(16, code[stamp + 16] ^ 2, ["other types", "build it again"])


# Crashes


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("throw in build", ["threw when 'faulty' was built", "no memory of that"]),
        ("throw a number in build", ["threw when 'faulty' was built", "not a std::exception"]),
        ("nothing built", ["built no 'faulty", "nullptr"]),
        ("parameter ignored", ["'faulty' was built", "leaf"]),
        ("throw in trace", ["threw when 'faulty' was queried", "lost the way"]),
        ("throw in statistics", ["threw when 'faulty' was queried", "never counted"]),
        ("crash in build", ["building 'faulty'", "crashed", "SIGSEGV"]),
        ("crash in trace", ["querying 'faulty'", "crashed", "SIGSEGV"]),
        ("abort in trace", ["querying 'faulty'", "crashed", "SIGABRT"]),
        ("exit in trace", ["querying 'faulty'", "ended with exit code 0"]),
    ],
)
def test_a_sweep_says_in_the_row_what_went_wrong_and_goes_on(
    faulty: Path, tmp_path: Path, fault: str, words: list[str]
) -> None:
    structures = ["exhaustive", "faulty:leaf=3"]
    code, rows, messages = sweep(tmp_path, faulty, fault, structures=structures)
    assert code == 1, messages
    verdicts = {(row["structure"], row["verdict"]) for row in rows}
    assert verdicts == {("exhaustive", "ok"), ("faulty", "error")}
    assert len(rows) == 4
    for row in rows:
        assert (row["trace_ms_median"] == "") == (row["structure"] == "faulty")
    names = {cell["index"]: cell["name"] for cell in begun_cells(tmp_path / "run")}
    told = [
        event["message"]
        for event in events(tmp_path / "run")
        if event["event"] == "finished" and "faulty" in names[event["index"]]
    ]
    assert len(told) == 2
    for message in told:
        assert str(faulty) in message
        for word in words:
            assert word in message


def test_a_sweep_that_is_interrupted_in_a_plug_in_says_how_to_go_on(
    faulty: Path, tmp_path: Path
) -> None:
    config, folder = tmp_path / "sweep.json", tmp_path / "run"
    config.write_text(json.dumps(SWEEP))
    with subprocess.Popen(
        [BINARY, "--plugin", faulty, "run", config, "-o", folder],
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "FAULT": "hang in trace"},
    ) as running:
        for _ in range(600):
            if (folder / "run.jsonl").exists():
                break
            time.sleep(0.1)
        time.sleep(0.5)  # the log comes first, then the plug-in is called
        running.send_signal(signal.SIGINT)
        _, messages = running.communicate(timeout=60)
    assert running.returncode == 130
    assert f"beambench --plugin {faulty} run --resume {folder}" in messages.splitlines()[-1]


@pytest.mark.parametrize(
    "fault", ["primitive out of range", "t is not a number", "answers nothing"]
)
def test_nonsense_is_no_result(faulty: Path, tmp_path: Path, fault: str) -> None:
    code, rows, _ = sweep(tmp_path, faulty, fault)
    assert code == 1
    faults = [row for row in rows if row["structure"] == "faulty"]
    assert {row["verdict"] for row in faults} == {"mismatch"}
    assert {row["trace_ms_median"] for row in faults} == {""}
    done = call("--plugin", faulty, "verify", "row", "--accel", "faulty", fault=fault)
    assert done.returncode == 1
    assert "mismatch" in done.stdout
    assert f"replay beambench --plugin {faulty} trace row" in done.stdout


@pytest.mark.parametrize(
    "command",
    [
        ["verify", "row", "--accel", "exhaustive,faulty"],
        ["stats", "row", "--accel", "faulty"],
        ["trace", "row", "--accel", "faulty", "--pixel", "160,100"],
    ],
    ids=lambda command: command[0],
)
def test_other_commands_end_by_name_when_it_crashes(faulty: Path, command: list[str]) -> None:
    done = call("--plugin", faulty, *command, fault="crash in trace")
    assert done.returncode == 1, done.stderr
    message = done.stderr.splitlines()[-1]
    assert message.startswith(
        f"beambench: the plug-in {faulty}: querying 'faulty' over row:n=3 crashed"
    )
    assert "none of its results were kept" in message


def failure_of_picture(faulty: Path, tmp_path: Path, fault: str, *options: str) -> str:
    """Returns the last line of the error output when a picture cannot be written."""
    picture = tmp_path / "out.png"
    done = call("--plugin", faulty, "render", "row", "--accel", "faulty", "-o", picture,
                *options, fault=fault)  # fmt: skip
    assert done.returncode == 1, done.stderr
    assert not picture.exists()
    return done.stderr.splitlines()[-1]


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("throw in trace", ["threw when 'faulty' was queried"]),
        ("crash in build", ["building 'faulty' over row", "crashed (SIGSEGV", "gdb"]),
        ("crash in trace", ["querying 'faulty' over row", "crashed (SIGSEGV"]),
        ("primitive out of range", ["structure 'faulty' returned an invalid hit", "4000000000"]),
        (
            "t is not a number",
            ["structure 'faulty' returned an invalid hit", "t = nan", "pixel (0, 0)"],
        ),
        ("throw in scene", ["threw when it made the scene row", "no idea"]),
        ("crash in scene", ["making the scene row", "crashed"]),
        ("scene beyond its arrays", ["invalid scene row", "primitive 0", "does not exist"]),
    ],
)
def test_a_picture_of_it_fails_by_name(
    faulty: Path, tmp_path: Path, fault: str, words: list[str]
) -> None:
    message = failure_of_picture(faulty, tmp_path, fault, "--shade", "whitted")
    assert message.startswith(f"beambench: the plug-in {faulty}")
    for word in words:
        assert word in message


@pytest.mark.parametrize("fault", ["places of too few rays", "a side of no cube"])
def test_an_overlay_of_places_that_cannot_be_fails_by_name(
    faulty: Path, tmp_path: Path, fault: str
) -> None:
    message = failure_of_picture(faulty, tmp_path, fault, "--overlay", "beams")
    assert f"the plug-in {faulty}: structure 'faulty' returned invalid places" in message


@pytest.mark.parametrize("fault", ["t is not a number", "primitive out of range"])
@pytest.mark.parametrize(
    "command",
    [
        ["verify", "row", "--accel", "exhaustive,faulty", "--rays", "whitted"],
        ["census", "row", "--accel", "faulty"],
        ["render", "row", "--accel", "faulty", "--shade", "whitted", "-o", "out.png"],
        ["render", "row", "--accel", "faulty", "--heatmap", "leaves", "-o", "out.png"],
        ["render", "row", "--accel", "exhaustive", "--difference", "faulty", "-o", "out.png"],
    ],
    ids=lambda command: " ".join(word for word in command if word != "row"),
)
def test_nothing_is_made_of_hits_that_cannot_be(
    faulty: Path, tmp_path: Path, command: list[str], fault: str
) -> None:
    words = [str(tmp_path / word) if word == "out.png" else word for word in command]
    done = call("--plugin", faulty, *words, "--resolution", "32x32", fault=fault)
    assert done.returncode == 1, done.stderr
    assert "crashed" not in done.stderr
    message = next(line for line in done.stderr.splitlines() if "invalid hit" in line)
    assert f"the plug-in {faulty}: structure 'faulty' returned an invalid hit: " in message
    assert ("t = nan" if fault == "t is not a number" else "primitive 4000000000") in message
    assert not (tmp_path / "out.png").exists()
    if command[0] == "verify":  # the other structures are still judged
        assert "exhaustive over row:n=3, whitted rays: ok" in done.stderr
