"""Runs the MPI program here: records task costs in one process, and times several processes."""

import json
import os
import statistics
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

import pandas as pd

from beambench_report.base.csv_texts import csv_of, unguarded
from beambench_report.base.files import Problem, load_json, output_of, read_json, write_text
from beambench_report.base.quantities import markdown_table
from beambench_thesis.chapter6.machines import Recorded, options
from beambench_thesis.chapter6.page import rendered

SCENES = ("gato-bill", "torre-eiffel")
LARGE = "tetra:n=8"
BEAMS, BLOCKS, ROWS, WINDOWS, TILES = WORKS = ("beams", "blocks", "rows", "windows", "tiles")
# How each kind of work is recorded. Tiles are recorded one by one; the process that traces a tile
# keeps its results, and the times include this.
_RECORDED_WITH: dict[str, tuple[str, ...]] = {
    BEAMS: ("--work", "beams"),
    BLOCKS: ("--work", "blocks"),
    ROWS: ("--work", "contiguous"),
    WINDOWS: ("--work", "pre-pass", "--block", "16"),
    TILES: ("--work", "tiles", "--block", "16", "--batch", "1", "--results", "stored"),
}
MEASURED = "measured.csv"
_COSTS = ["walk_seconds", "work_seconds", "accept_seconds", "estimate_seconds"]

# Setting, processes, and the options of beambench-cluster.
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

# Unless allowed, Open MPI refuses to run as root or to start more processes than cores.
ENVIRONMENT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_hwloc_base_binding_policy": "none",
    # The same for version 5, whose launcher has different names.
    "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
    "PRTE_MCA_hwloc_default_binding_policy": "none",
}


@dataclass(frozen=True)
class Picture:
    """The picture to trace; by default as in section 6.3 of the thesis."""

    scene: str
    width: int = 1280
    height: int = 1024
    samples: int = 5
    structure: str = "beam:max_level=6"
    works: tuple[str, ...] = WORKS

    def arguments(self) -> list[str]:
        """Returns arguments of beambench-cluster."""
        size = f"{self.width}x{self.height}"
        given = options(accel=self.structure, resolution=size, samples=self.samples)
        return [self.scene, *given]


def record(folder: Path, program: Path, pictures: list[Picture], repeats: int) -> list[Path]:
    """Writes FOLDER/tasks/SCENE-WORK.csv and FOLDER/recorded.json.

    The costs of a task are the medians of the repeats; everything else is equal in all repeats.
    """
    (folder / "tasks").mkdir(parents=True, exist_ok=True)
    (folder / "answers.jsonl").unlink(missing_ok=True)  # results of simulations with other costs
    written, sums = [], {}
    for picture in pictures:
        for work in picture.works:
            runs = [_record_once(program, picture, work) for _ in range(repeats)]
            rows = _medians([rows for rows, _ in runs])
            path = tasks_file(folder, picture.scene, work)
            written.append(write_text(path, csv_of(rows)))
            recorded = Recorded(
                statistics.median_high(one["each"][0]["build_seconds"] for _, one in runs),
                float(rows["walk_seconds"].sum()),
                float(rows["work_seconds"].sum()),
                picture.width * picture.height * picture.samples,
                statistics.median(one["pre_pass_seconds"] for _, one in runs),
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
    """Returns the path of the file with the tasks of a scene."""
    return folder / "tasks" / f"{scene}-{work}.csv"


def read_recorded(folder: Path) -> dict[tuple[str, str], Recorded]:
    """Returns totals by scene and kind of work. Raises Problem if nothing was recorded."""
    path = folder / "recorded.json"
    try:
        sums = load_json(path)
    except (OSError, ValueError):
        raise Problem(
            f"{path}: it is missing or not JSON; write it with: "
            "python -m beambench_thesis cluster record DIR"
        ) from None
    names = ("build_seconds", "walk_seconds", "work_seconds", "samples")
    return {
        (key.rpartition("-")[0], key.rpartition("-")[2]): Recorded(
            *(each[n] for n in names), each.get("pre_pass_seconds", 0.0)
        )
        for key, each in sums.items()
    }


def measure(folder: Path, program: Path, pictures: list[Picture], repeats: int) -> list[Path]:
    """Writes FOLDER/measured.csv: each setting for each picture, seconds as medians of repeats.

    Raises Problem if mpirun is missing, a run fails, or two runs have different pictures.
    """
    rows = []
    for picture in pictures:
        hashes = set()
        for setting, processes, more in _SETTINGS:
            print(picture.scene, setting, file=sys.stderr)
            runs = [_run_mpi(program, picture, processes, more) for _ in range(repeats)]
            hashes |= {run["result_hash"] for run in runs}
            first, seconds = runs[0], [run["seconds"] for run in runs]
            rows.append(
                {
                    "scene": picture.scene,
                    "setting": setting,
                    "processes": processes,
                    "options": " ".join(more),
                    "width": picture.width,
                    "height": picture.height,
                    "samples": picture.samples,
                    "commit": first["commit"],
                    "repeats": repeats,
                    "seconds": statistics.median(seconds),
                    "seconds_min": min(seconds),
                    "seconds_max": max(seconds),
                    "producer_busy": statistics.median(run["producer_busy_share"] for run in runs),
                    "tasks": first["tasks"],
                    "tasks_of_producer": first["each"][0]["tasks"],
                }
                | {
                    f"{what}_{end}": first[end][what]
                    for end in ("from_producer", "to_producer")
                    for what in ("messages", "bytes")
                }
            )
        if len(hashes) != 1:
            raise Problem(
                f"{picture.scene}: {len(hashes)} different pictures; this is a bug in beambench"
            )
    folder.mkdir(parents=True, exist_ok=True)
    return [write_text(folder / MEASURED, csv_of(pd.DataFrame(rows)))]


def measured_section(folder: Path) -> str | None:
    """Returns the page's section on this machine; None if nothing was measured."""
    if not (folder / MEASURED).is_file():
        return None
    rows = unguarded(pd.read_csv(folder / MEASURED, keep_default_na=False))
    first = rows.iloc[0]
    alone = rows[rows["processes"] == 1].drop_duplicates("scene").set_index("scene")["seconds"]
    lines = (
        (
            row["scene"],
            row["setting"],
            f"{row['seconds']:.2f} ({row['seconds_min']:.2f} to {row['seconds_max']:.2f})",
            f"{alone[row['scene']] / row['seconds']:.2f}",
            f"{row['producer_busy']:.0%}",
            f"{row['messages_from_producer']:,}, {row['messages_to_producer']:,}",
            f"{row['bytes_from_producer'] / 1e6:.2f}, {row['bytes_to_producer'] / 1e6:.1f}",
        )
        for _, scene in rows.groupby("scene", sort=False)
        for _, row in scene.iterrows()
    )
    heads = "scene; processes; seconds; speedup over one process alone; producer busy; "
    heads += "messages out, back; MB out, back"
    return rendered("measured", first=first, rows=markdown_table(heads.split("; "), lines))


def _record_once(program: Path, picture: Picture, work: str) -> tuple[pd.DataFrame, dict]:
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        print(program, picture.scene, work, file=sys.stderr)
        output_of(
            [
                *(str(program), *picture.arguments(), *_RECORDED_WITH[work]),
                *(("-o", str(place / "picture.png")) if work == TILES else ()),
                *("--tasks", str(place / "tasks.csv")),
                *("--report", str(place / "report.json")),
            ],
            remedy="build beambench-cluster first",
        )
        return pd.read_csv(place / "tasks.csv"), read_json(place / "report.json")


def _medians(runs: list[pd.DataFrame]) -> pd.DataFrame:
    """Returns one table of medians. Raises Problem if two runs have different tasks."""
    first = runs[0]
    for other in runs[1:]:
        if not other.drop(columns=_COSTS).equals(first.drop(columns=_COSTS)):
            raise Problem(
                "two runs of one process made different tasks; this is a bug in beambench"
            )
    rows = first.copy()
    for cost in _COSTS:
        rows[cost] = pd.concat([each[cost] for each in runs], axis=1).median(axis=1).round(9)
    return rows


def _run_mpi(program: Path, picture: Picture, processes: int, more: tuple[str, ...]) -> dict:
    with tempfile.TemporaryDirectory() as name:
        report = Path(name) / "report.json"
        command = ["mpirun", "-n", str(processes), str(program), *picture.arguments()]
        output_of(
            [*command, "--report", str(report), *more],
            remedy="install it with: scripts/setup cluster",
            env={**os.environ, **ENVIRONMENT},
        )
        return load_json(report)
