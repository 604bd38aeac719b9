"""Fixtures shared by the tests of scripts/."""

from __future__ import annotations

import os
import shutil
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

from beambench_operations.release.bare_system import why_impossible
from browser import Browser, find_browser
from plugins import installed
from synthetic_run import synthetic_rows, write_full_run, write_run


def pytest_configure(config: pytest.Config) -> None:
    """Restores Ctrl-C: a shell makes background jobs ignore it, and their children inherit that."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    config.addinivalue_line("markers", "full: takes long; runs only where BEAMBENCH_FULL is set")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Deselects the tests marked `full`, unless BEAMBENCH_FULL is set."""
    if "BEAMBENCH_FULL" in os.environ:
        return
    left_out = [item for item in items if item.get_closest_marker("full")]
    config.hook.pytest_deselected(items=left_out)
    items[:] = [item for item in items if item not in left_out]


@pytest.fixture
def run_folder(tmp_path: Path) -> Path:
    """A folder with the results of a run in which every verdict was correct."""
    return write_run(tmp_path, synthetic_rows())


@pytest.fixture(scope="session")
def full_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with everything that scripts/run writes except the page; one structure was wrong."""
    return write_full_run(tmp_path_factory.mktemp("full-run"))


@pytest.fixture(scope="session")
def repository() -> Path:
    """The top of the working tree."""
    return Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def prefix(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder in which the program is installed with its CMake package."""
    return installed(tmp_path_factory.mktemp("prefix"))


@pytest.fixture
def bare_folder(tmp_path: Path) -> Iterator[Path]:
    """A folder for bare systems; skips the test if this machine cannot make a bare system."""
    if why := why_impossible():
        pytest.skip(why)
    yield tmp_path
    shutil.rmtree(tmp_path)


@pytest.fixture(scope="module")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """One browser for all tests of a module."""
    program = find_browser()
    if program is None:
        pytest.skip("no Chromium on this system; scripts/setup installs it where apt has it")
    with Browser(program, tmp_path_factory.mktemp("profile")) as browser:
        yield browser


@pytest.fixture
def opened(chromium: Browser, page: Path) -> Browser:
    """The browser with the module's `page` freshly opened."""
    chromium.open(page)
    return chromium
