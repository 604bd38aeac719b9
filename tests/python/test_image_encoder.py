"""OpenImageIO is loaded when a picture is written, by a shared object beside the program."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from program import BINARY, refused

ENCODER = "libbeambench_image_encoder.so"
PROGRAM = BINARY.resolve()
BUILT = PROGRAM.parents[1] / "lib/beambench" / ENCODER


def render(program: Path, picture: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [program, "render", "tetra:n=1", "--resolution", "8x8", "-o", picture],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def test_the_program_alone_does_not_load_openimageio() -> None:
    """OpenImageIO needs over 200 shared libraries, which made each start take 20 times as long."""
    listed = subprocess.run(["ldd", PROGRAM], capture_output=True, text=True, check=True).stdout
    assert "libembree" in listed
    assert "libOpenImageIO" not in listed


@pytest.mark.parametrize("place", ["bin", "lib/beambench"])
def test_the_encoder_is_found_beside_the_program(tmp_path: Path, place: str) -> None:
    for folder in ("bin", place):
        (tmp_path / folder).mkdir(parents=True, exist_ok=True)
    program = tmp_path / "bin/beambench"
    shutil.copy(PROGRAM, program)
    refused(
        render(program, tmp_path / "a.png"),
        [ENCODER, str(tmp_path / "lib/beambench"), "build or install again"],
    )
    shutil.copy(BUILT, tmp_path / place)
    done = render(program, tmp_path / "a.png")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_an_encoder_that_cannot_be_loaded_is_one_sentence(tmp_path: Path) -> None:
    shutil.copy(PROGRAM, tmp_path)
    (tmp_path / ENCODER).write_bytes(b"no shared object")
    refused(render(tmp_path / "beambench", tmp_path / "a.png"), [ENCODER, "cannot be loaded"])
    assert not (tmp_path / "a.png").exists()
