"""What the tests of scripts/ share."""

from __future__ import annotations

from pathlib import Path

import pytest

from made_up_run import made_up_rows, write_full_run, write_run


@pytest.fixture
def run_folder(tmp_path: Path) -> Path:
    """A folder with the results of a run in which every verdict was right."""
    return write_run(tmp_path, made_up_rows())


@pytest.fixture(scope="session")
def full_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with all that scripts/run leaves but the page; one structure was wrong."""
    return write_full_run(tmp_path_factory.mktemp("full-run"))


@pytest.fixture(scope="session")
def repository() -> Path:
    """The top of the working tree."""
    return Path(__file__).resolve().parents[2]
