"""What results/published states of its own runs."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest


@pytest.fixture
def published(repository: Path) -> Path:
    return repository / "results/published"


def rows_of_folders(published: Path) -> dict[str, str]:
    """The README's row of each folder."""
    rows = {}
    for line in (published / "README.md").read_text("utf-8").splitlines():
        if line.startswith("| `"):
            for folder in re.findall(r"`([a-z0-9-]+)/`", line.split("|")[1]):
                rows[folder] = line
    return rows


def test_every_folder_has_a_row(published: Path) -> None:
    folders = {entry.name for entry in published.iterdir() if entry.is_dir()}
    assert set(rows_of_folders(published)) == folders


def test_the_row_states_the_commit_of_each_run(published: Path) -> None:
    rows = rows_of_folders(published)
    manifests = sorted(published.rglob("manifest.json"))
    assert manifests
    for manifest in manifests:
        folder = manifest.relative_to(published).parts[0]
        program = json.loads(manifest.read_text("utf-8"))["program"]
        assert program["commit"][:7] in rows[folder], manifest
        assert not program["dirty"], manifest
