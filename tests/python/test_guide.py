"""The guides' examples: a toy structure and a toy scene, each one file and one line of CMake."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from program import BINARY

REPOSITORY = Path(__file__).resolve().parents[2]
BUILD = BINARY.resolve().parents[1]  # of the program under test: the examples are linked with it
SETTINGS = r"^((?:BEAMBENCH_|CMAKE_BUILD_TYPE|CMAKE_CXX_COMPILER:|CMAKE_CXX_FLAGS)[^=]*=.*)$"


def checked(*command: str | Path, cwd: Path) -> str:
    """Returns the standard output of a command that must succeed."""
    done = subprocess.run(
        command, cwd=cwd, capture_output=True, text=True, timeout=600, check=False
    )
    assert done.returncode == 0, f"{command}\n{done.stdout[-4000:]}{done.stderr[-4000:]}"
    return done.stdout


def follow_guide(folder: str, section: str, tree: Path) -> Path:
    """Follows a guide in a copy of the tree: adds its file and its line of CMake."""
    guide = (REPOSITORY / folder / "README.md").read_text().split(f"\n## {section}\n")[1]
    source = re.search(r"```cpp\n// (\S+\.cpp)\n(.*?)```", guide, re.S)
    line = re.search(r"```cmake\n((\w+)\(.*\)\n)```", guide)
    assert source
    assert line
    file = Path(source[1])
    (tree / file).parent.mkdir(exist_ok=True)
    (tree / file).write_text(source[2])
    lists = tree / folder / "CMakeLists.txt"
    text = lists.read_text()
    last = [place.end() for place in re.finditer(rf"^{line[2]}\([^)]*\)\n", text, re.M)][-1]
    lists.write_text(text[:last] + line[1] + text[last:])
    return file


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The program with both examples. CMake configures the tree with the two files and lines; only
    their objects and those of the generated registrations are compiled.
    """
    tree = tmp_path_factory.mktemp("tree")
    shutil.copy(REPOSITORY / "CMakeLists.txt", tree)
    for folder in ("scenes", "accel", "harness"):
        shutil.copytree(REPOSITORY / folder, tree / folder)
    files = [
        follow_guide("scenes", "A new scene", tree),
        follow_guide("accel", "A new structure", tree),
        Path("build/scenes/register_scenes.cpp"),
        Path("build/accel/register_families.cpp"),
    ]
    settings = re.findall(SETTINGS, (BUILD / "CMakeCache.txt").read_text(), re.M)
    defines = [f"-D{setting}" for setting in settings]
    checked("cmake", "-G", "Ninja", *defines, "-DBEAMBENCH_TESTS=OFF", "-B", "build", cwd=tree)
    commands = json.loads((tree / "build/compile_commands.json").read_text())
    object_of = {Path(c["file"]): re.findall(r" -o (\S+)", c["command"])[0] for c in commands}
    objects = [object_of[tree / file] for file in files]
    checked("cmake", "--build", "build", "--target", *objects, cwd=tree)

    # The command that links the program, with our objects in place of those with the same names.
    link = checked("ninja", "-t", "commands", "bin/beambench", cwd=BUILD).splitlines()[-1]
    words = [word for word in link.split(" && ")[1].split() if word not in objects]
    result = tree / "beambench"
    words[words.index("bin/beambench")] = str(result)
    checked(words[0], *(tree / "build" / name for name in objects), *words[1:], cwd=BUILD)
    return result


def test_the_scene_is_listed_and_generated(program: Path) -> None:
    listed = json.loads(checked(program, "list", "--json", cwd=program.parent))
    names = [scene["name"] for scene in listed["scenes"]]
    assert "helix" in names
    assert names == sorted(names)
    about = json.loads(checked(program, "scene", "helix:spheres=50", "--json", cwd=program.parent))
    assert about["spheres"] == 50
    growth = checked(program, "scene", "helix", "--growth", "--csv", cwd=program.parent)
    assert len(growth.splitlines()) > 2


def test_the_structure_is_listed_and_keeps_the_contract(program: Path) -> None:
    listed = json.loads(checked(program, "list", "--json", cwd=program.parent))
    assert "boxes" in [structure["name"] for structure in listed["structures"]]
    checked(program, "selftest", "--accel", "boxes", cwd=program.parent)
    scenes = ("helix", "escena1", "tetra:n=4")
    checked(program, "verify", *scenes, "--accel", "boxes,samet", cwd=program.parent)
