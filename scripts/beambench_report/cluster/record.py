"""What every beam of the thesis's two scenes takes, recorded by the MPI program in one process."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

import pandas as pd

from beambench_report.cluster.calibration import Recorded
from beambench_report.files import write_text
from beambench_report.problem import Problem

SCENES = ("gato-bill", "torre-eiffel")
BEAMS, BLOCKS = WORKS = ("beams", "blocks")

_RESOLUTION = (1280, 1024)
_SAMPLES = 5
_COSTS = ["walk_seconds", "work_seconds", "accept_seconds"]


@dataclass(frozen=True)
class Picture:
    """What is traced: as in section 6.3 of the thesis, but for tests."""

    scene: str
    width: int = _RESOLUTION[0]
    height: int = _RESOLUTION[1]
    samples: int = _SAMPLES
    structure: str = "beam:max_level=6"


def record(folder: Path, program: Path, pictures: list[Picture], repeats: int) -> list[Path]:
    """Writes FOLDER/tasks/SCENE-WORK.csv and FOLDER/recorded.json.

    The costs of a task are the medians of the repeats; everything else is the same in all of them.
    """
    (folder / "tasks").mkdir(parents=True, exist_ok=True)
    (folder / "answers.jsonl").unlink(missing_ok=True)  # of simulations with other costs
    written, sums = [], {}
    for picture in pictures:
        for work in WORKS:
            runs = [_run(program, picture, work) for _ in range(repeats)]
            rows = _medians([rows for rows, _ in runs])
            written.append(
                write_text(tasks_file(folder, picture.scene, work), rows.to_csv(index=False))
            )
            build = sorted(report["each"][0]["build_seconds"] for _, report in runs)
            recorded = Recorded(
                build[len(build) // 2],
                float(rows["walk_seconds"].sum()),
                float(rows["work_seconds"].sum()),
                picture.width * picture.height * picture.samples,
            )
            sums[f"{picture.scene}-{work}"] = asdict(recorded) | {
                "tasks": len(rows) - 1,
                "structure": picture.structure,
                "width": picture.width,
                "height": picture.height,
                "samples_a_pixel": picture.samples,
                "repeats": repeats,
                "commit": runs[0][1]["commit"],
            }
    return [*written, write_text(folder / "recorded.json", json.dumps(sums, indent=1) + "\n")]


def tasks_file(folder: Path, scene: str, work: str) -> Path:
    """Where the tasks of a scene are kept."""
    return folder / "tasks" / f"{scene}-{work}.csv"


def read_recorded(folder: Path) -> dict[tuple[str, str], Recorded]:
    """Sums by scene and kind of work. Raises Problem where nothing was recorded."""
    path = folder / "recorded.json"
    try:
        sums = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError):
        raise Problem(
            f"{path}: it is not there or not JSON; write it with: "
            "python -m beambench_report cluster record DIR"
        ) from None
    names = ("build_seconds", "walk_seconds", "work_seconds", "samples")
    return {
        (key.rpartition("-")[0], key.rpartition("-")[2]): Recorded(*(each[n] for n in names))
        for key, each in sums.items()
    }


def _run(program: Path, picture: Picture, work: str) -> tuple[pd.DataFrame, dict]:
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        command = [
            str(program),
            picture.scene,
            *("--accel", picture.structure),
            *("--resolution", f"{picture.width}x{picture.height}"),
            *("--samples", str(picture.samples)),
            *("--work", work),
            *("-o", str(place / "picture.png")),
            *("--tasks", str(place / "tasks.csv")),
            *("--report", str(place / "report.json")),
        ]
        print(" ".join(command[:2]), work, file=sys.stderr)
        try:
            done = subprocess.run(command, capture_output=True, text=True, check=False)
        except OSError as error:
            raise Problem(f"{program}: {error.strerror}; build beambench-cluster first") from None
        if done.returncode != 0:
            raise Problem(f"{program} {picture.scene}: {done.stderr.strip() or 'failed'}")
        report = json.loads((place / "report.json").read_text("utf-8"))
        return pd.read_csv(place / "tasks.csv"), report


def _medians(runs: list[pd.DataFrame]) -> pd.DataFrame:
    """One table; raises Problem where two runs had other tasks."""
    first = runs[0]
    for other in runs[1:]:
        if not other.drop(columns=_COSTS).equals(first.drop(columns=_COSTS)):
            raise Problem("two runs of one process made other tasks; that is a fault of beambench")
    rows = first.copy()
    for cost in _COSTS:
        rows[cost] = pd.concat([each[cost] for each in runs], axis=1).median(axis=1).round(9)
    return rows
