"""The steps of scripts/container/Dockerfile make a small image whose user is not root."""

from __future__ import annotations

from pathlib import Path

import pytest

from beambench_operations.release.container_steps import DOCKERFILE, instructions
from beambench_operations.release.trials import package_of


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
def test_the_replayed_image_measures_and_draws_as_its_user(bare_folder: Path) -> None:
    assert package_of("trixie", None, bare_folder).name.endswith("+debian13_amd64.deb")
