"""The MPI program on this machine: what every task takes in one process, and times of several."""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

import pandas as pd

from beambench_report.base.files import Problem, write_text
from beambench_report.thesis.chapter6.machines import Recorded

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


MEASURED = "measured.csv"

# Processes, and the options of beambench-cluster.
_SETTINGS: tuple[tuple[str, int, tuple[str, ...]], ...] = (
    ("one process alone", 1, ()),
    ("1 consumer", 2, ()),
    ("2 consumers", 3, ()),
    ("2 consumers, two messages in flight", 3, ("--in-flight", "2")),
    ("2 consumers, eight beams a message", 3, ("--batch", "8")),
    ("blocks, 1 consumer", 2, ("--work", "blocks")),
    ("blocks, 2 consumers", 3, ("--work", "blocks")),
    ("1 consumer, the producer consumes, too", 2, ("--producer-consumes",)),
)

# Open MPI refuses to start as root, or more processes than cores, unless it is allowed to.
ENVIRONMENT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_hwloc_base_binding_policy": "none",
}


def measure(folder: Path, program: Path, pictures: list[Picture], repeats: int) -> list[Path]:
    """Writes FOLDER/measured.csv: each setting over each picture, seconds as medians of repeats.

    Raises Problem where mpirun is missing, a run fails, or two runs have other pictures.
    """
    rows = []
    for picture in pictures:
        hashes = set()
        for setting, processes, options in _SETTINGS:
            print(picture.scene, setting, file=sys.stderr)
            runs = [_run_mpi(program, picture, processes, options) for _ in range(repeats)]
            hashes |= {run["result_hash"] for run in runs}
            first = runs[0]
            rows.append(
                {
                    "scene": picture.scene,
                    "setting": setting,
                    "processes": processes,
                    "options": " ".join(options),
                    "width": picture.width,
                    "height": picture.height,
                    "samples": picture.samples,
                    "commit": first["commit"],
                    "repeats": repeats,
                    "seconds": statistics.median(run["seconds"] for run in runs),
                    "seconds_min": min(run["seconds"] for run in runs),
                    "seconds_max": max(run["seconds"] for run in runs),
                    "producer_busy": statistics.median(run["producer_busy_share"] for run in runs),
                    "tasks": first["tasks"],
                    "tasks_of_producer": first["each"][0]["tasks"],
                    "messages_from_producer": first["from_producer"]["messages"],
                    "bytes_from_producer": first["from_producer"]["bytes"],
                    "messages_to_producer": first["to_producer"]["messages"],
                    "bytes_to_producer": first["to_producer"]["bytes"],
                }
            )
        if len(hashes) != 1:
            raise Problem(f"{picture.scene}: {len(hashes)} different pictures; that is a fault")
    folder.mkdir(parents=True, exist_ok=True)
    return [write_text(folder / MEASURED, pd.DataFrame(rows).to_csv(index=False))]


def measured_section(folder: Path) -> str | None:
    """The page's section on this machine; None where nothing was measured."""
    if not (folder / MEASURED).is_file():
        return None
    rows = pd.read_csv(folder / MEASURED, keep_default_na=False)
    lines = [
        "## The same program on this machine\n",
        f"`mpirun -n N beambench-cluster SCENE`, {rows['width'][0]}x{rows['height'][0]}, "
        f"{rows['samples'][0]} samples per pixel, results as hits; medians of {rows['repeats'][0]} "
        "runs (shortest to longest in brackets). All pictures of a scene have the same bits.\n",
        "| scene | processes | seconds | times as fast as one process alone | producer busy "
        "| messages out, back | MB out, back |",
        "|---|---|---|---|---|---|---|",
    ]
    for _, scene in rows.groupby("scene", sort=False):
        alone = float(scene.loc[scene["processes"] == 1, "seconds"].iloc[0])
        for _, row in scene.iterrows():
            sent = (
                f"{row['messages_from_producer']:,}, {row['messages_to_producer']:,} "
                f"| {row['bytes_from_producer'] / 1e6:.2f}, {row['bytes_to_producer'] / 1e6:.1f}"
            )
            lines.append(
                f"| {row['scene']} | {row['setting']} | {row['seconds']:.2f} "
                f"({row['seconds_min']:.2f} to {row['seconds_max']:.2f}) "
                f"| {alone / row['seconds']:.2f} | {row['producer_busy']:.0%} | {sent} |"
            )
    return "\n".join([*lines, ""])


def _run_mpi(program: Path, picture: Picture, processes: int, options: tuple[str, ...]) -> dict:
    with tempfile.TemporaryDirectory() as name:
        report = Path(name) / "report.json"
        command = [
            *("mpirun", "-n", str(processes), str(program), picture.scene),
            *("--accel", picture.structure),
            *("--resolution", f"{picture.width}x{picture.height}"),
            *("--samples", str(picture.samples)),
            *("--report", str(report)),
            *options,
        ]
        try:
            done = subprocess.run(
                command,
                env={**os.environ, **ENVIRONMENT},
                capture_output=True,
                text=True,
                check=False,
            )
        except OSError as error:
            raise Problem(
                f"mpirun: {error.strerror}; install it with: scripts/setup cluster"
            ) from None
        if done.returncode != 0:
            raise Problem(f"{' '.join(command)}: {done.stderr.strip() or 'failed'}")
        return json.loads(report.read_text("utf-8"))
