"""Imports the Python module that was built with the program."""

from __future__ import annotations

import os
import sys

import pytest

from program import BINARY

PACKAGE = BINARY.resolve().parents[1] / "python"

if not list(PACKAGE.glob("beambench/_beambench*.so")):
    pytest.skip(
        f"no Python module in {PACKAGE}: it is built where nanobind and Python's headers are",
        allow_module_level=True,
    )
sys.path.insert(0, str(PACKAGE))

import beambench as bb  # noqa: E402

ENVIRONMENT = {**os.environ, "PYTHONPATH": str(PACKAGE)}

__all__ = ["ENVIRONMENT", "PACKAGE", "bb"]
