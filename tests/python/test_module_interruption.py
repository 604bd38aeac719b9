"""The Python module: Ctrl-C ends any long call, and everything works afterwards."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from module import ENVIRONMENT, bb
from run_logs import events

# Each defines `work`, which would take minutes, or several seconds where it cannot be interrupted.
WORK = {
    "list of closest hits": """
structure = bb.Structure(bb.Scene("tetra:n=8"), "exhaustive")
rays = structure.scene.rays(resolution=(512, 512))
work = lambda: structure.closest_hits(rays)
""",
    "list of any hits": """
structure = bb.Structure(bb.Scene("tetra:n=8"), "exhaustive")
rays = structure.scene.rays(resolution=(512, 512))
work = lambda: structure.any_hits(rays)
""",
    "image": """
structure = bb.Structure(bb.Scene("tetra:n=8"), "exhaustive")
work = lambda: structure.trace_image()
""",
    "image on two threads": """
structure = bb.Structure(bb.Scene("tetra:n=8"), "exhaustive", threads=2)
work = lambda: structure.trace_image()
""",
    "image of beams": """
structure = bb.Structure(bb.Scene("tetra:n=8"), "beam:max_level=2")
work = lambda: structure.trace_image(resolution=(4096, 4096))
""",
    "picture": """
structure = bb.Structure(bb.Scene("tetra:n=8"), "exhaustive")
work = lambda: structure.render(shading="whitted")
""",
    "build": """
scene = bb.Scene("tetra:n=10")
work = lambda: [bb.Structure(scene, "samet:max_level=12") for _ in range(100)]
""",
    "scene": """
work = lambda: [bb.Scene("tetra:n=11") for _ in range(100)]
""",
    "verification": """
scene = bb.Scene("tetra:n=7")
rays = np.tile(scene.rays(), (40, 1))
work = lambda: bb.verify(scene, rays, t=np.full(len(rays), 3.0))
""",
    "sweep": """
work = lambda: bb.sweep({"name": "long", "scenes": ["tetra:n=6"], "budget_seconds": 600,
    "structures": ["samet"], "resolutions": ["640x480"],
    "repetitions": {"minimum": 10000, "maximum": 10000}})
""",
}
AROUND = """
import sys
import numpy as np
import beambench as bb
{work}
print("ready", flush=True)
try:
    work()
except KeyboardInterrupt:
    print("interrupted", flush=True)
    scene = bb.Scene("tetra:n=2")
    hits = bb.Structure(scene, "sah-bvh").closest_hits(scene.rays(resolution=(32, 32)))
    print("still working", int(hits.hit.sum()), flush=True)
    sys.exit(7)
"""


@pytest.mark.parametrize("what", WORK)
def test_an_interrupt_ends_long_work(what: str) -> None:
    program = AROUND.format(work=WORK[what])
    with subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=ENVIRONMENT,
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        assert process.stdout.readline() == "ready\n", process.stderr.read()
        time.sleep(0.5)
        assert process.poll() is None, "it was done too soon to be interrupted"
        sent = time.perf_counter()
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "interrupted\n", process.stderr.read()
        waited = time.perf_counter() - sent
        assert process.stdout.readline().startswith("still working ")
        assert process.wait(timeout=30) == 7, "the exit code is the program's own"
        ended = time.perf_counter() - sent
        assert process.stderr.read() == ""
    assert waited < 5
    assert ended < 15, "work without a waiting caller is cut off"


def test_an_interrupt_that_nobody_catches_ends_the_program_as_usual() -> None:
    program = f"import numpy as np\nimport beambench as bb\n{WORK['image of beams']}\n"
    with subprocess.Popen(
        [sys.executable, "-c", program + 'print("ready", flush=True)\nwork()\n'],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=ENVIRONMENT,
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        _, messages = process.communicate(timeout=30)
    assert process.returncode == -signal.SIGINT
    assert messages.rstrip().endswith("KeyboardInterrupt")


def test_a_handler_of_the_users_own_may_let_the_work_go_on() -> None:
    program = """
import signal, beambench as bb
seen = []
signal.signal(signal.SIGINT, lambda *_: seen.append(1))
scene = bb.Scene("tetra:n=7")
structure = bb.Structure(scene, "exhaustive")
rays = scene.rays(resolution=(96, 96))
print("ready", flush=True)
hits = structure.closest_hits(rays)
report = bb.verify(scene, rays, t=hits.t, primitive=hits.primitive)
print(len(seen), report.verdict)
"""
    with subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, env=ENVIRONMENT
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        process.send_signal(signal.SIGINT)
        rest, _ = process.communicate(timeout=60)
    assert rest == "1 ok\n"


def test_an_interrupted_sweep_goes_on_where_it_stopped(tmp_path: Path) -> None:
    config = {
        "name": "stopped",
        "scenes": ["tetra:n=4"],
        "structures": ["samet", "sah-bvh"],
        "resolutions": [f"{size}x{size}" for size in range(40, 240, 20)],
        "repetitions": {"minimum": 40, "maximum": 40},
        "budget_seconds": 1,
    }
    program = f"import beambench as bb\nbb.sweep({config!r}, 'run', progress=True)\n"
    with subprocess.Popen(
        [sys.executable, "-c", program],
        stderr=subprocess.PIPE,
        text=True,
        env=ENVIRONMENT,
        cwd=tmp_path,
    ) as process:
        assert process.stderr is not None
        for line in process.stderr:
            if line.startswith("[2/20]"):
                break
        process.send_signal(signal.SIGINT)
        rest = process.stderr.read()
        assert process.wait(timeout=30) == -signal.SIGINT
    assert rest.rstrip().endswith("KeyboardInterrupt")
    kept = [event for event in events(tmp_path / "run") if event["event"] == "repetition"]
    assert len(kept) >= 2 * 40
    frame = bb.sweep(config, tmp_path / "run", resume=True)
    assert len(frame) == 20
    found = [event for event in events(tmp_path / "run") if event["event"] == "repetition"]
    assert found[: len(kept)] == kept
    # A repetition that other processes disturbed is repeated in its round.
    assert len({(event["index"], event["round"]) for event in found}) == 20 * 40
