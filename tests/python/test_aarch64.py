"""`scripts/aarch64` builds for ARM; the tests pass there, and hits are those of x86-64."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from beambench_operations.release.bare_system import BareSystem
from beambench_report.base.files import ROOT

SCRIPT = ROOT / "scripts/aarch64"


def test_help_is_printed_and_other_arguments_are_refused() -> None:
    helped = subprocess.run([SCRIPT, "--help"], capture_output=True, text=True, check=True)
    assert helped.stdout.startswith("usage: scripts/aarch64")
    done = subprocess.run([SCRIPT, "--fast"], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "--help" in done.stderr


@pytest.mark.full
def test_the_tests_pass_under_emulation(bare_folder: Path) -> None:
    """Runs in a separate system, so that no second architecture is added to this system's apt."""
    system = BareSystem("bookworm", "", bare_folder)
    system.copy_repository("/root/beambench")
    system.run("scripts/aarch64", folder="/root/beambench")
