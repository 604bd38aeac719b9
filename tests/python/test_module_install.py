"""`pip install .` in the root folder builds and installs the Python module."""

from __future__ import annotations

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from module import PACKAGE

REPOSITORY = Path(__file__).resolve().parents[2]
CACHE = PACKAGE.parent / "CMakeCache.txt"

# Obtains the verdict on one's own arrays in less than ten lines.
PROGRAM = """
import numpy as np
import beambench as bb
scene = bb.Scene.from_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
rays = bb.rays([[0.2, 0.2, 1], [0.3, 0.3, 1], [2, 2, 1]], [0, 0, -1])
report = bb.verify(scene, rays, t=[1, 1.5, np.inf])
print(report.verdict, report.classes.tolist(), bb.__version__, bb.__file__)
"""


def cached(name: str) -> str:
    """Returns the configuration of the program's build."""
    found = re.search(rf"^{name}:\w+=(.*)$", CACHE.read_text("utf-8"), re.MULTILINE)
    return found[1] if found else ""


@pytest.mark.full
def test_pip_installs_a_module_that_verifies_arrays(tmp_path: Path) -> None:
    for needed in ("pip", "nanobind", "scikit_build_core"):
        if importlib.util.find_spec(needed) is None:
            pytest.skip(f"{needed} is not installed here; scripts/setup installs it")
    if not CACHE.exists() or cached("CMAKE_BUILD_TYPE") != "Release":
        pytest.skip(
            "the program is not a release build, which shares its compiled files with pip's"
        )
    # The same compiler and options, so that ccache has all objects.
    environment = {
        **os.environ,
        "CXX": cached("CMAKE_CXX_COMPILER"),
        "CMAKE_ARGS": f"-DBEAMBENCH_WERROR={cached('BEAMBENCH_WERROR')}",
        "PYTHONPATH": "",
    }
    target = tmp_path / "installed"
    installing = subprocess.run(
        [
            *(sys.executable, "-m", "pip", "install", "--no-build-isolation", "--no-deps"),
            *("--no-index", "--disable-pip-version-check", "--target", str(target)),
            str(REPOSITORY),
        ],
        env=environment,
        capture_output=True,
        text=True,
        timeout=1500,
        check=False,
    )
    assert installing.returncode == 0, installing.stdout + installing.stderr
    installed = {str(path.relative_to(target)) for path in target.rglob("*") if path.is_file()}
    sources = {f"beambench/{path.name}" for path in PACKAGE.glob("beambench/*.py")}
    compiled = {"beambench/_beambench.pyi", "beambench/libbeambench_image_encoder.so"}
    assert sources | compiled | {"beambench/py.typed"} <= installed
    strange = {name for name in installed if not name.startswith("beambench")}
    assert strange == set(), "the program and its manual are not Python's"
    assert len([line for line in PROGRAM.splitlines() if line]) < 10
    done = subprocess.run(
        # Only numpy of this environment's packages: a .pth file could add another beambench.
        [sys.executable, "-S", "-c", PROGRAM],
        env={
            **environment,
            "PYTHONPATH": os.pathsep.join([str(target), str(Path(np.__file__).parents[1])]),
        },
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    verdict, classes, version, file = re.match(
        r"(\w+) (\[.*\]) ([\d.]+) (.*)\n", done.stdout
    ).groups()
    assert (verdict, classes) == ("mismatch", "[0, 3, 0]")
    assert Path(file).is_relative_to(target)
    assert f"beambench-{version}.dist-info" in {Path(name).parts[0] for name in installed}
