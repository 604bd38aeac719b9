"""The compiled traversals prefetch the memory that they need next.

GCC treats a function that only prefetches as having no effect and removes calls to it, unless it
has been inlined before. The loops of tiles and pencils once lost all prefetches in this way, and an
image of a million triangles took far longer.
"""

from __future__ import annotations

import platform
import re
import shutil
import subprocess
from collections import Counter

import pytest

from program import BINARY

_FUNCTION = re.compile(r"^[0-9a-f]+ <(.*)>:$")


@pytest.fixture(scope="module")
def prefetches() -> Counter[str]:
    """Returns the number of prefetch instructions in each function of the program."""
    if platform.machine() != "x86_64" or not shutil.which("objdump"):
        pytest.skip("the test needs objdump and an x86-64 program")
    counts: Counter[str] = Counter()
    name = ""
    command = ["objdump", "--disassemble", "--no-show-raw-insn", "--wide", str(BINARY)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as listing:
        assert listing.stdout is not None
        for line in listing.stdout:
            if line.endswith(">:\n"):
                found = _FUNCTION.match(line)
                name = found[1] if found else ""
                counts[name] += 0
            elif "prefetch" in line:
                counts[name] += 1
    return counts


@pytest.mark.parametrize("traversal", ["8TileWalk", "10PencilWalk", "interleave_rays_below"])
def test_asks_for_what_it_needs_next(prefetches: Counter[str], traversal: str) -> None:
    own = {name: count for name, count in prefetches.items() if traversal in name}
    assert own, f"the program has no function of {traversal}"
    steps = {name: count for name, count in own.items() if name.endswith("clEv")} or own
    assert all(count > 0 for count in steps.values()), steps
