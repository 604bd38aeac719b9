"""The steps of scripts/container/Dockerfile make a small image whose user is not root."""

from __future__ import annotations

from pathlib import Path

import pytest

from bare_system import REPOSITORY, BareSystem
from container_steps import instructions, replay

DOCKERFILE = REPOSITORY / "scripts/container/Dockerfile"


def test_the_image_has_no_more_than_the_package_and_a_user_of_its_own() -> None:
    steps = list(instructions(DOCKERFILE.read_text("utf-8")))
    last = max(place for place, (name, _) in enumerate(steps) if name == "FROM")
    assert [name for name, _ in steps[last:]] == "FROM COPY RUN USER WORKDIR ENTRYPOINT".split()
    assert ("USER", "beambench") in steps[last:]


def test_instructions_are_joined_from_several_lines() -> None:
    text = "# comment\nFROM a AS b\nRUN one \\\n    && two\n\nUSER c\n"
    assert list(instructions(text)) == [
        ("FROM", "a AS b"),
        ("RUN", "one && two"),
        ("USER", "c"),
    ]


@pytest.mark.full
def test_the_replayed_image_measures_and_draws_as_its_user(tmp_path: Path) -> None:
    def make(suite: str) -> BareSystem:
        return BareSystem(suite, "", Path(tmp_path / f"{len(list(tmp_path.iterdir()))}-{suite}"))

    image = replay(DOCKERFILE, make)
    assert "uid=0" not in image.system.run("id", folder="/", user=image.user)
    image.system.run("chown", image.user, image.folder)  # like a volume of the user's
    assert "samet" in image.run("time", "tetra", "--accel", "samet,embree", "--seconds", "1")
    image.run("render", "tetra:n=1", "--resolution", "8x8", "-o", "a.png")
    assert image.system.path(image.folder + "/a.png").stat().st_uid != 0
    image.run("run", "quick", "-o", "run", "--benchmark_filter=tetra.*samet")
    assert image.system.path(image.folder + "/run/results.csv").is_file()
