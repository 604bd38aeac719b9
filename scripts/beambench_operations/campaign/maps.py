"""Fuzzes the reader of Quake 3 maps, which is written in Python."""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from beambench_operations.campaign.piece import Piece
from beambench_operations.campaign.programs import PYTHON, Programs
from beambench_operations.campaign.record import Record
from beambench_report.base.files import ROOT, Problem

SUBJECT = "bsp"
_MODULE = [sys.executable, "-m", "beambench_operations.campaign.quake3_maps"]
_FOLDERS = [ROOT / f"tests/fuzz/{kind}/{SUBJECT}" for kind in ("corpus", "regressions")]


def fuzz_maps(seed: int, seconds: float, record: Record, programs: Programs) -> Piece:
    """Mutates maps for some time, and keeps one map for each place in the code that fails."""
    with TemporaryDirectory(prefix="beambench-campaign-") as name:
        faults = Path(name)
        folders = [folder for folder in _FOLDERS if folder.is_dir()]
        numbers = [f"{seconds:.1f}", str(seed)]
        done = programs.run([*_MODULE, *numbers, faults, *folders], seconds + 120, None, PYTHON)
        if done.code != 0:
            raise Problem(f"the maps could not be fuzzed: {done.last_words()}")
        findings = []
        for file in sorted(faults.iterdir()):
            message = programs.run([*_MODULE, file], 60, None, PYTHON).output.strip()
            command: list[str | Path] = [".venv/bin/python", *_MODULE[1:], file]
            findings.append(record.keep(file, f"{SUBJECT}-{file.name}", message, command))
    counts = {"executions": int(done.output), "seconds": round(seconds)}
    return Piece("fuzz", SUBJECT, seed, counts, round(done.cpu_seconds, 1), {}, findings)
