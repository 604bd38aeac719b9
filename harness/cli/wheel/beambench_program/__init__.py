"""Starts the program beambench, for the command of the same name."""

import os
import sys
from pathlib import Path


def main() -> None:
    """Replaces this process with the program, which gets the command line's arguments."""
    program = Path(__file__).parent / "bin/beambench"
    os.environ.setdefault("BEAMBENCH_REPORT_PYTHON", sys.executable)  # for `beambench report`
    os.execv(program, [sys.argv[0], *sys.argv[1:]])
