"""results/published/haines: tests by kind of primitive over TETRA, ours and Haines's."""

import re
from pathlib import Path
from typing import Any

from beambench_report.base.files import ROOT, Problem
from beambench_report.haines.counts import CONTENDERS, published_tests, read_tests

_PINS = ROOT / "tests/accel/haines_counts_test.cpp"
_SCENE = "tetra"


def figures(folder: Path) -> dict[str, Any]:
    """Returns box and polygon tests over TETRA: Haines's, ours, and the C++ test's."""
    ours = read_tests(folder / "tests.csv")
    given, shuffled = (ours[contender][_SCENE] for contender in CONTENDERS)
    return {
        "his": published_tests()[_SCENE],
        "given": given,
        "shuffled": shuffled,
        "plain": {"box": _pinned("plain.boxes"), "polygon": _pinned("plain.polygons")},
        "given_in_test": _pinned("queue_given.polygons"),
    }


def _pinned(name: str) -> int:
    """Returns the count that the test expects. Raises Problem if there is none."""
    found = re.search(rf"EXPECT_EQ\({re.escape(name)}, ([\d']+)U\)", _PINS.read_text("utf-8"))
    if found is None:
        raise Problem(f"{_PINS}: does not expect a value of {name}; name what the text states")
    return int(found[1].replace("'", ""))
