"""The MPI program on the processes of this machine: measured, and written as a table."""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import pandas as pd

from beambench_report.cluster.record import Picture
from beambench_report.files import write_text
from beambench_report.problem import Problem

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
            runs = [_run(program, picture, processes, options) for _ in range(repeats)]
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
        f"{rows['samples'][0]} samples a pixel, results as hits; medians of {rows['repeats'][0]} "
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


def _run(program: Path, picture: Picture, processes: int, options: tuple[str, ...]) -> dict:
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
