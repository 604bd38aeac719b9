"""`scripts/wheel` builds a wheel of the program that needs nothing else."""

from __future__ import annotations

import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
LIMIT = 35_000_000


def test_help_is_printed_and_other_arguments_are_refused() -> None:
    script = REPOSITORY / "scripts/wheel"
    helped = subprocess.run([script, "--help"], capture_output=True, text=True, check=True)
    assert helped.stdout.startswith("usage: scripts/wheel")
    for arguments in (["--fast"], ["a", "b"]):
        refused = subprocess.run([script, *arguments], capture_output=True, text=True, check=False)
        assert refused.returncode == 2
        assert "--help" in refused.stderr


@pytest.mark.full
def test_the_wheel_has_licenses_and_gives_the_committed_fingerprint(tmp_path: Path) -> None:
    subprocess.run([REPOSITORY / "scripts/wheel", tmp_path], check=True)
    (wheel,) = tmp_path.glob("beambench_program-*-py3-none-manylinux_*.whl")
    assert wheel.stat().st_size <= LIMIT

    names = zipfile.ZipFile(wheel).namelist()
    bundled = [name for name in names if re.match(r"[^/]*\.libs/lib", name)]
    licenses = [name for name in names if ".dist-info/licenses/" in name]
    assert len(licenses) == len(bundled) + 1  # and beambench's own
    assert not any(name.endswith((".hpp", ".a", ".cmake")) for name in names)
    assert not any("OpenImageIO" in name for name in names)

    subprocess.run([sys.executable, "-m", "venv", tmp_path / "venv"], check=True)
    pip = [tmp_path / "venv/bin/python", "-m", "pip", "install", "--quiet", "--no-index", wheel]
    subprocess.run(pip, check=True)
    program = tmp_path / "venv/bin/beambench"
    for picture in ("a.png", "a.exr"):
        render = [program, "render", "tetra:n=1", "--resolution", "8x8", "-o", picture]
        subprocess.run(render, cwd=tmp_path, check=True)
        assert (tmp_path / picture).stat().st_size > 0
    got = subprocess.run([program, "fingerprint"], capture_output=True, text=True, check=True)
    committed = (REPOSITORY / "tests/golden/fingerprint.txt").read_text("utf-8")
    assert got.stdout.split("all\t")[0] == committed.split("all\t")[0]
