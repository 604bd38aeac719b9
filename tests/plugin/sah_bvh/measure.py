"""Does it cost anything to be a plug-in? Measures sah-bvh built in and plugged in, in turns.

    cmake --build build/release --target plugged_sah_bvh
    .venv/bin/python tests/plugin/sah_bvh/measure.py build/release

Ends with 1 when a median ratio is off by more than 1.5% and its 95% interval leaves out 1: the same
machine code in two files lies at other addresses, which alone makes up to that much
(harness/measure/record/cell_record.hpp, kBetweenRuns).
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
BETWEEN_FILES = 0.015
PHASES = {"build": ["build_ms"], "trace": ["trace_ms"], "total": ["build_ms", "trace_ms"]}


def cycles(cell: dict, phases: list[str]) -> dict[int, float]:
    """Returns the cycles of each round."""
    return {
        repetition["round"]: sum(repetition[phase] for phase in phases) * repetition["clock_ghz"]
        for repetition in cell["repetitions"]
    }


def interval(logs: np.ndarray) -> tuple[float, float]:
    """Returns the 95% interval of the median, by bootstrap."""
    drawn = np.random.default_rng(1999).choice(logs, (4000, len(logs)))
    low, high = np.quantile(np.median(drawn, axis=1), (0.025, 0.975))
    return float(np.exp(low)), float(np.exp(high))


def main(build: Path) -> int:
    """Runs the sweep with the program and the plug-in of a build folder, and prints the ratios."""
    with tempfile.TemporaryDirectory() as folder:
        run = Path(folder) / "run"
        plugin = build / "plugins/libplugged_sah_bvh.so"
        subprocess.run(
            [build / "bin/beambench", "--plugin", plugin, "run", HERE / "sweep.json", "-o", run],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        cells = [json.loads(path.read_text()) for path in (run / "cells").iterdir()]
    by_name = {cell["name"]: cell for cell in cells}
    equal = True
    print(f"{'plugged / built in':<18}  {'95% interval':<16}  rounds  phase  cell")
    for name, built_in in sorted(by_name.items()):
        plugged = by_name.get(name.replace("/sah-bvh", "/plugged-sah-bvh"))
        if "plugged" in name or plugged is None:
            continue
        for phase, members in PHASES.items():
            a, b = cycles(built_in, members), cycles(plugged, members)
            logs = np.log([b[turn] / a[turn] for turn in sorted(a.keys() & b.keys())])
            ratio, (low, high) = float(np.exp(np.median(logs))), interval(logs)
            other = abs(ratio - 1) > BETWEEN_FILES and not low <= 1 <= high
            equal = equal and not other
            print(f"{ratio:18.4f}  {low:.4f} to {high:.4f}  {len(logs):>6}  {phase:<5}  {name}"
                  f"{'  DIFFERS' if other else ''}")  # fmt: skip
    return 0 if equal else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1] if len(sys.argv) > 1 else "build/release")))
