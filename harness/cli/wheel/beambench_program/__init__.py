"""The program beambench, which a command of the same name starts."""

import os
import sys
from pathlib import Path


def main() -> None:
    """Replaces this process with the program, which gets the arguments of the command line."""
    program = Path(__file__).parent / "bin/beambench"
    os.environ.setdefault("BEAMBENCH_REPORT_PYTHON", sys.executable)  # for `beambench report`
    os.execv(program, [sys.argv[0], *sys.argv[1:]])
