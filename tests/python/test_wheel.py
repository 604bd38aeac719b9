"""`scripts/wheel` builds wheels of the program and the Python module that need nothing else."""

from __future__ import annotations

import re
import subprocess
import zipfile
from pathlib import Path

import pytest

from beambench_operations.release.trials import (
    PYTHON_OF_SUITE,
    download_dependencies,
    try_wheels,
)
from beambench_report.base.files import ROOT

LIMIT = 35_000_000
SECONDS = 60
"""The limit for the processor time to the first results, including the installation."""


def test_help_is_printed_and_other_arguments_are_refused() -> None:
    script = ROOT / "scripts/wheel"
    helped = subprocess.run([script, "--help"], capture_output=True, text=True, check=True)
    assert helped.stdout.startswith("usage: scripts/wheel")
    for arguments in (["--fast"], ["a", "b"]):
        done = subprocess.run([script, *arguments], capture_output=True, text=True, check=False)
        assert done.returncode == 2
        assert "--help" in done.stderr


@pytest.fixture(scope="session")
def wheels(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with both wheels and, for both systems, the packages that they and reports need."""
    folder = tmp_path_factory.mktemp("wheels")
    subprocess.run([ROOT / "scripts/wheel", folder], check=True)
    for python in PYTHON_OF_SUITE.values():
        download_dependencies(folder, python)
    return folder


@pytest.mark.full
@pytest.mark.parametrize("name", ["beambench_program-*-py3-none", "beambench-*-cp311-abi3"])
def test_a_wheel_is_small_and_has_the_licenses_of_its_libraries(wheels: Path, name: str) -> None:
    (wheel,) = wheels.glob(f"{name}-manylinux_*.whl")
    glibc = re.search(r"manylinux_2_(\d+)_x86_64\.whl$", wheel.name)
    assert glibc
    assert int(glibc[1]) <= 39
    assert wheel.stat().st_size <= LIMIT
    names = zipfile.ZipFile(wheel).namelist()
    bundled = [name for name in names if re.match(r"[^/]*\.libs/lib", name)]
    licenses = [name for name in names if ".dist-info/licenses/" in name]
    assert len(licenses) > len(bundled) > 3
    assert {"three", "datatables.net"} <= {name.rsplit("/", 1)[1] for name in licenses}
    assert not any(name.endswith((".hpp", ".a", ".cmake")) for name in names)
    assert not any("OpenImageIO" in name for name in names)


@pytest.mark.full
@pytest.mark.parametrize("suite", PYTHON_OF_SUITE)
def test_a_bare_system_has_results_within_a_minute(
    wheels: Path, bare_folder: Path, suite: str
) -> None:
    assert try_wheels(suite, wheels, bare_folder) <= SECONDS
