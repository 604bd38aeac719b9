"""results/published/plugged: what it costs to be a plug-in."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from beambench_report.base.files import Problem

_LINE = re.compile(
    r"^\s*([\d.]+)\s+([\d.]+) to ([\d.]+)\s+(\d+)\s+(\w+)\s+(\S+)(?:\s+DIFFERS)?$", re.MULTILINE
)
_MAY_DIFFER = 0.015


def figures(folder: Path) -> dict[str, Any]:
    """The range of the ratios of each phase, and those that differ by more than two builds may."""
    file = folder / "sah-bvh.txt"
    found = [
        {
            "ratio": float(ratio),
            "low": float(low),
            "high": float(high),
            "rounds": int(rounds),
            "phase": phase,
            "cell": cell,
        }
        for ratio, low, high, rounds, phase, cell in _LINE.findall(file.read_text("utf-8"))
    ]
    if not found:
        raise Problem(f"{file}: has no lines of ratios; restore it with git")
    phases = {
        phase: sorted(one["ratio"] for one in found if one["phase"] == phase)
        for phase in dict.fromkeys(one["phase"] for one in found)
    }
    return {
        "ratios": len(found),
        "rounds": max(one["rounds"] for one in found),
        "range": {phase: (own[0], own[-1]) for phase, own in phases.items()},
        "may_differ": _MAY_DIFFER,
        "more": [one for one in found if abs(one["ratio"] - 1) > _MAY_DIFFER],
    }
