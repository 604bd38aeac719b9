"""scripts/outside: what it offers and refuses. Installing needs registries, so it is not tested."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
ADAPTERS = REPOSITORY / "harness/plugin/outside"


def outside(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [REPOSITORY / "scripts/outside", *arguments], capture_output=True, text=True, check=False
    )


def test_help_lists_the_libraries() -> None:
    done = outside("--help")
    assert done.returncode == 0
    assert "scripts/outside obvhs embreex" in done.stdout
    assert "Libraries: embreex trimesh open3d vtk mitsuba obvhs" in done.stdout
    assert outside().stdout == done.stdout


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("moana", ["there is no library 'moana'", "choose among: embreex"]),
        ("tinybvh", ["built from a folder", "TINYBVH=DIR scripts/outside tinybvh"]),
    ],
)
def test_what_cannot_be_installed_is_refused(name: str, words: list[str]) -> None:
    done = outside(name)
    assert done.returncode == 2
    assert done.stdout == ""
    for word in words:
        assert word in done.stderr


def test_each_adapter_is_offered_and_each_version_pinned() -> None:
    script = (REPOSITORY / "scripts/outside").read_text()
    (names,) = re.findall(r'^names="(.*)"$', script, re.MULTILINE)
    adapters = {path.name for path in (ADAPTERS / "rust").iterdir()}
    adapters |= {path.name.removesuffix("_contender.py")
                 for path in (ADAPTERS / "python").glob("*_contender.py")}  # fmt: skip
    assert adapters <= set(names.split())
    for line in re.findall(r"python_library \w+ (.*) ;;", script):
        assert all("==" in package for package in line.split()), line
    for path in (ADAPTERS / "rust").glob("*/Cargo.toml"):
        assert f'{path.parent.name} = "=' in path.read_text()
