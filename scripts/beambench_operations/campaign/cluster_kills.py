"""Kills processes of the cluster program: the picture must be right, or a message must say why."""

import contextlib
import os
import shutil
import signal
from pathlib import Path
from random import Random

from beambench_operations.campaign.killed import Tally, finished, undisturbed
from beambench_operations.campaign.programs import Program, Programs
from beambench_thesis.chapter6.record import ENVIRONMENT

PROGRAM = "beambench-cluster"
_RUNS = 5
_TIMEOUT = 5  # seconds, for --timeout
_SIGNALS = (signal.SIGKILL, signal.SIGSTOP)
_ENDING = 60  # more seconds, for mpirun and a busy machine
_WORK = ["balls:n=2", "--shade", "whitted", "--depth", "6", "--resolution", "320x240"]


def is_possible(beambench: Path) -> bool:
    """Returns whether MPI is installed and the program was built."""
    return shutil.which("mpirun") is not None and beambench.with_name(PROGRAM).exists()


def kill_cluster(beambench: Path, folder: Path, random: Random, programs: Programs) -> Tally:
    """Kills or stops one of three processes in each of several runs."""
    tally = Tally()
    right = folder / "right.png"

    def begun(picture: Path) -> Program:
        program = beambench.with_name(PROGRAM)
        command = ["mpirun", "-n", "3", program, *_WORK, "--timeout", str(_TIMEOUT), "-o", picture]
        return programs.start(command, folder, ENVIRONMENT)

    whole = undisturbed(begun(right), tally)
    for number in range(_RUNS):
        if tally.faults:
            break
        picture = folder / f"picture-{number}.png"
        run = begun(picture)
        ended = run.wait(random.uniform(0, whole))
        if ended is None and (victims := _processes(run)):
            with contextlib.suppress(ProcessLookupError):
                os.kill(random.choice(victims), random.choice(_SIGNALS))
            tally.kills += 1
        if run.wait(whole + _TIMEOUT + _ENDING) is None:
            tally.faults.append("it hung after a process was killed or stopped")
            run.end()
        ended = finished(run, tally)
        whole_picture = picture.exists() and picture.read_bytes() == right.read_bytes()
        if ended.code == 0 and not whole_picture:
            tally.faults.append("it succeeded, but the picture is wrong or missing")
        elif picture.exists() and not whole_picture:
            tally.faults.append("it failed and left a wrong picture")
        elif ended.code != 0 and not ended.errors.strip():
            tally.faults.append(f"it ended with {ended.code} and without a message")
    return tally


def _processes(run: Program) -> list[int]:
    """Returns the program's processes that mpirun has started."""
    try:
        children = Path(f"/proc/{run.pid}/task/{run.pid}/children").read_text().split()
        names = {int(child): Path(f"/proc/{child}/comm").read_text() for child in children}
    except OSError:
        return []
    return [child for child, name in names.items() if name.startswith(PROGRAM[:15])]
