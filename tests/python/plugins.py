"""Builds external projects for the tests as their authors do, with only the package."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from program import BINARY

BUILD = BINARY.resolve().parents[1]
SOURCES = Path(__file__).resolve().parents[1] / "plugin"


def run(*command: str | Path, cwd: Path | None = None) -> None:
    done = subprocess.run(
        list(map(str, command)), cwd=cwd, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}"


def installed(prefix: Path) -> Path:
    """Returns the output of `cmake --install`; skips the test if the build folder is incomplete."""
    if not (BUILD / "beambenchConfig.cmake").exists():
        pytest.skip("the program is not in its build folder")
    run("cmake", "--install", BUILD, "--prefix", prefix)
    return prefix


def configured(source: Path, folder: Path, package: Path, *options: str) -> set[str]:
    """Configures an external project's build folder. Returns the shared objects to be built."""
    launcher = shutil.which("ccache")
    speed = [f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}"] if launcher else []
    found = f"-DCMAKE_PREFIX_PATH={package}"
    run("cmake", "-G", "Ninja", "-S", source, "-B", folder, found, *speed, *options)
    statements = (folder / "build.ninja").read_text()
    return set(re.findall(r"^build (\S+\.so): CXX", statements, re.MULTILINE))


def built(source: Path, folder: Path, package: Path, *options: str) -> Path:
    """Returns the folder with an external project's shared objects, built with only the package."""
    configured(source, folder, package, *options)
    run("cmake", "--build", folder)
    return folder


def reached_headers(prefix: Path, *names: str) -> set[str]:
    """Returns these headers and all installed headers that they include, directly or indirectly."""
    reached: set[str] = set()
    waiting = list(names)
    while waiting:
        name = waiting.pop()
        if name not in reached:
            reached.add(name)
            text = (prefix / "include/beambench" / name).read_text()
            waiting += re.findall(r'#include "(.*)"', text)
    return reached


def call(
    *arguments: str | Path, fault: str = "", program: Path = BINARY, **environment: str
) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [program, *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        env={**os.environ, "FAULT": fault, **environment},
    )
