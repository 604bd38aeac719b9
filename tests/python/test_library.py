"""The libraries, linked by another project that verifies its own hits."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from plugins import BUILD, SOURCES, built, configured, reached_headers

REPOSITORY = SOURCES.parents[1]
EXAMPLE = REPOSITORY / "tests/library"


@pytest.fixture(scope="module")
def example(prefix: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example program, built with the installed libraries."""
    return built(EXAMPLE, tmp_path_factory.mktemp("example"), prefix) / "my_tracer_hits"


def output_of(program: Path, *arguments: str, code: int) -> str:
    done = subprocess.run(
        [program, *arguments], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout


def counts_in(output: str) -> dict[str, int]:
    return {name: int(n) for name, n in re.findall(r"^(\w+): (\d+)$", output, re.MULTILINE)}


def test_right_hits_are_found_right(example: Path) -> None:
    counts = counts_in(output_of(example, code=0))
    assert list(counts) == ["agree", "tie", "graze", "structure_error", "oracle_error"]
    assert counts["structure_error"] == counts["oracle_error"] == 0
    assert sum(counts.values()) == 80 * 60


@pytest.mark.parametrize(
    ("fault", "reported"),
    [
        ("moved", r"primitive (\d+) \(polygon\) at t = [\d.]+"),
        ("exchanged", r"primitive (\d+) \(polygon\) at t = [\d.]+"),
        ("dropped", "miss"),
    ],
)
def test_one_wrong_hit_is_found_and_described(example: Path, fault: str, reported: str) -> None:
    output = output_of(example, fault, code=1)
    assert counts_in(output)["structure_error"] == 1
    found = re.search(
        r"^ray \d+: structure_error, .*\n  ray .*\n  reported  (.*)\n  oracle    (.*)\n  exact ",
        output,
        re.MULTILINE,
    )
    assert found, output
    assert re.fullmatch(reported, found[1])
    assert found[1] != found[2] != "miss"


def test_the_build_folder_gives_the_same(prefix: Path, example: Path, tmp_path: Path) -> None:
    del prefix  # the fixture skips the test without an installation
    configured(EXAMPLE, tmp_path, BUILD)
    other = built(EXAMPLE, tmp_path, BUILD) / "my_tracer_hits"  # configured again, from the cache
    assert output_of(other, code=0) == output_of(example, code=0)
    assert output_of(other, "moved", code=1) == output_of(example, "moved", code=1)


def test_the_example_of_the_readme_works(prefix: Path, tmp_path: Path) -> None:
    text = (REPOSITORY / "harness/verify/README.md").read_text().split("## From C++")[1]
    for language, file in (("cmake", "CMakeLists.txt"), ("cpp", "main.cpp")):
        block = re.search(rf"```{language}\n(.*?)```", text, re.DOTALL)
        assert block
        (tmp_path / file).write_text(block[1])
    program = built(tmp_path, tmp_path / "build", prefix) / "my_tracer_hits"
    assert output_of(program, code=0) == ""
    source = tmp_path / "main.cpp"
    source.write_text(source.read_text().replace("t{4}", "t{5}"))
    built(tmp_path, tmp_path / "build", prefix)
    assert "ray 0: structure_error" in output_of(program, code=1)


# What the package brings


@pytest.mark.parametrize("place", ["installed", "built"])
def test_users_get_the_options_that_round_and_no_warnings(
    prefix: Path, tmp_path: Path, place: str
) -> None:
    configured(EXAMPLE, tmp_path, prefix if place == "installed" else BUILD)
    statements = (tmp_path / "build.ninja").read_text()
    flags = " ".join(re.findall(r"^  (?:FLAGS|INCLUDES) = (.*)$", statements, re.MULTILINE)).split()
    assert "-ffp-contract=off" in flags
    assert any(flag.startswith("-std=") and flag.endswith("20") for flag in flags)
    assert [flag for flag in flags if flag.startswith("-W")] == []
    assert "-fno-semantic-interposition" not in flags
    assert not {str(REPOSITORY), f"-I{REPOSITORY}"} & set(flags)


def test_installed_headers_include_only_each_other_and_all_are_reached(prefix: Path) -> None:
    include = prefix / "include/beambench"
    headers = {str(path.relative_to(include)) for path in include.rglob("*.hpp")}
    assert reached_headers(prefix, "plugin.hpp", "verify.hpp") == headers


@pytest.mark.parametrize(
    ("absent", "named"),
    [("embree", "embree [34]"), ("TBB", "TBB, embree [34]"), ("PkgConfig", "libxxhash")],
)
def test_a_missing_package_is_named_and_plug_ins_do_without(
    prefix: Path, tmp_path: Path, absent: str, named: str
) -> None:
    without = f"-DCMAKE_DISABLE_FIND_PACKAGE_{absent}=ON"
    message = rf"(?s)component\s+verify\s+links\s+packages\s+.*found:\s+{named}"
    with pytest.raises(AssertionError, match=message):
        configured(EXAMPLE, tmp_path / "library", prefix, without)
    assert configured(SOURCES / "template", tmp_path / "plugin", prefix, without) == {"libmine.so"}


@pytest.mark.parametrize(
    ("components", "absent", "found"),
    [
        ("", "", "yes yes"),
        ("", "embree", "no no"),
        ("COMPONENTS plugin", "", "no no"),
        ("OPTIONAL_COMPONENTS verify", "", "yes yes"),
        ("OPTIONAL_COMPONENTS verify", "embree", "no no"),
    ],
)
def test_a_project_learns_whether_the_libraries_are_there(
    prefix: Path, tmp_path: Path, components: str, absent: str, found: str
) -> None:
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(other CXX)\n"
        f"find_package(beambench REQUIRED {components})\n"
        "set(found $<IF:$<BOOL:${beambench_verify_FOUND}>,yes,no>)\n"
        "set(target $<IF:$<TARGET_EXISTS:beambench::verify>,yes,no>)\n"
        'file(GENERATE OUTPUT found CONTENT "${found} ${target}")\n'
    )
    without = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{absent}=ON"] if absent else []
    configured(tmp_path, tmp_path / "build", prefix, *without)
    assert (tmp_path / "build/found").read_text() == found
