"""Verifies the hits of several programs over several scenes, and writes a table.

Every program traces the same rays over the same triangles and writes a hit file, which
`beambench verify --hits` verifies. programs.json, in this folder, lists the programs with their
commands. A program that does not run is left out, and the manifest states why. Measured cells stay
in the folder --work, so an interrupted run continues where it stopped.

    python measure.py --work build/programs -o results/published/programs
"""

from __future__ import annotations

import argparse
import csv
import datetime
import json
import os
import platform
import re
import shlex
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[2]
# Runs with any Python that has numpy. Only .venv's Python finds the package without this.
sys.path.append(str(REPOSITORY / "scripts"))

from beambench_report.base.formulas import guarded  # noqa: E402 (found by the line before)

SCENES = [
    "tetera",
    "tetra:n=5",
    "delfines",
    "gears:n=1",
    "bumpy:triangles=1000",
    "soup:triangles=1000",
    "habitacion",
    "bumpy:triangles=20000",
]
# Kinds of rays: the resolution, or the number of rays for kinds generated here.
RAYS = {
    "primary": "512x400",
    "random": "512x400",
    "diffuse": "512x400",
    "edges": 150_000,
    "axis": 450_000,
    "inside": 100_000,
}
CLOSED = "bumpy"  # scenes with a closed surface, so that rays from inside must hit
CLASSES = ["agree", "tie", "graze", "structure_error", "embree_error"]
COLUMNS = [
    *["program", "version", "scene", "triangles", "ray_kind", "rays", "hits", "program_hits"],
    *[*CLASSES, "verdict", "seconds"],
]
# The groups of ray kinds for which summary.csv sums up the rows.
KINDS_TOGETHER = {"primary": "scene's own", "random": "scene's own", "diffuse": "scene's own"}
COUNTS = ["rays", "hits", "program_hits", *CLASSES]
HIT_TYPES = {"t": "<f4", "x": "<f4", "y": "<f4", "z": "<f4", "primitive": "<u4", "triangle": "<u4"}


class FailedError(Exception):
    """Raised if a command ends with an unexpected exit code."""


def slug(text: str) -> str:
    """Returns the text in a form for file names."""
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")


def call(command: list[str], expected: tuple[int, ...] = (0,)) -> str:
    """Returns the standard output of a command."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in expected:
        last = (done.stderr.strip() or done.stdout.strip()).splitlines()[-1:]
        raise FailedError(f"exit code {done.returncode}: {' '.join(last)}")
    return done.stdout


def read_obj(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Returns vertices as float32, and the indices of each triangle's three vertices."""
    lines = path.read_text("utf-8").splitlines()
    vertices = [line.split()[1:4] for line in lines if line.startswith("v ")]
    faces = [line.split()[1:4] for line in lines if line.startswith("f ")]
    return np.array(vertices, np.float32), np.array(faces, np.int64) - 1


def write_rays(path: Path, rays: np.ndarray, note: str) -> None:
    """Writes a .rays file of eight numbers per ray."""
    header = {"query": "closest", "rays": len(rays), "note": note}
    partial = path.with_name(f"{path.name}.{os.getpid()}")
    with partial.open("wb") as out:
        out.write(b"beambench-rays 1\n" + json.dumps(header).encode() + b"\n")
        out.write(rays.astype("<f4").tobytes())
    partial.replace(path)  # another run may use the same folder


def aimed_rays(obj: Path, kind: str, count: int) -> np.ndarray:
    """Returns rays aimed at vertices and midpoints of edges, where wrong hits are most likely.

    `edges`: from a sphere around the scene; direction and target are rounded to float32, so a ray
    passes its target within rounding. `inside`: likewise, but from around the center of a closed
    mesh. `axis`: parallel to an axis, exactly through the target.
    """
    random = np.random.default_rng(1)
    vertices, faces = read_obj(obj)
    corners = vertices[faces].astype(np.float64)
    used = corners.reshape(-1, 3)
    low, high = used.min(0), used.max(0)
    diagonal = float(np.linalg.norm(high - low))
    side = random.integers(0, 3, count)
    triangle = random.integers(0, len(faces), count)
    start = corners[triangle, side]
    middle = (start + corners[triangle, (side + 1) % 3]) / 2
    at_vertex = np.arange(count) % 2 == 0
    targets = np.where(at_vertex[:, None], start, middle).astype(np.float32)
    rays = np.zeros((count, 8), np.float32)
    rays[:, 7] = np.inf
    if kind != "axis":
        outward = random.standard_normal((count, 3))
        outward /= np.linalg.norm(outward, axis=1)[:, None]
        distance = diagonal if kind == "edges" else diagonal / 20
        rays[:, 0:3] = (low + high) / 2 + distance * outward
        rays[:, 4:7] = targets - rays[:, 0:3]
    else:
        ray, axis = np.arange(count), random.integers(0, 3, count)
        sign = random.choice(np.array([-1.0, 1.0], np.float32), count)
        rays[:, 0:3] = targets
        rays[ray, axis] -= sign * np.float32(2 * diagonal)
        rays[ray, 4 + axis] = sign
    return rays


def read_rays(path: Path) -> np.ndarray:
    """Returns the eight numbers of each ray of a .rays file."""
    with path.open("rb") as file:
        file.readline()
        file.readline()
        return np.fromfile(file, "<f4").reshape(-1, 8)


def read_hits(path: Path) -> np.ndarray:
    """Returns the closest hits of a .hits file as an array with its column names."""
    with path.open("rb") as file:
        file.readline()
        columns = json.loads(file.readline())["columns"]
        return np.fromfile(file, np.dtype([(name, HIT_TYPES[name]) for name in columns]))


def hits_in(path: Path) -> int:
    """Returns the number of rays in a .hits file that hit something."""
    hits = read_hits(path)
    return int(np.count_nonzero(np.isfinite(hits[hits.dtype.names[0]])))


def add_common_options(parser: argparse.ArgumentParser) -> None:
    """Adds the options for folders."""
    parser.add_argument("--work", type=Path, required=True, help="folder for rays and cells")
    parser.add_argument("--programs", type=Path, default=HERE / "programs.json")
    parser.add_argument("--build", type=Path, default=REPOSITORY / "build", help="default: build")
    parser.add_argument("--beambench", type=Path, help="default: that of the build folder")


def places_of(arguments: argparse.Namespace) -> dict[str, str]:
    """Returns the values of the words in braces in commands."""
    build = arguments.build.resolve()
    beambench = (arguments.beambench or build / "release/bin/beambench").resolve()
    return {
        "python": sys.executable,
        "here": str(HERE),
        "build": str(build),
        "beambench": str(beambench),
    }


class Measurement:
    """The programs, the scenes and the folder of finished cells."""

    def __init__(self, work: Path, places: dict[str, str]) -> None:
        """`places` are the values of the words in braces in commands."""
        self.commit = of_git("rev-parse", "HEAD")
        self.dirty = bool(of_git("status", "--porcelain"))
        self.work = work
        self.places = places
        self.beambench = places["beambench"]
        (work / "cells").mkdir(parents=True, exist_ok=True)

    def mesh(self, scene: str) -> Path:
        """Returns the scene's triangles."""
        obj = self.work / f"{slug(scene)}.obj"
        if not obj.exists():
            call([self.beambench, "export", scene, "-o", str(obj)])
        return obj

    def rays(self, scene: str, kind: str) -> Path:
        """Returns the rays of a kind."""
        file = self.work / f"{slug(scene)}-{kind}.rays"
        if not file.exists():
            size = RAYS[kind]
            if isinstance(size, int):
                write_rays(file, aimed_rays(self.mesh(scene), kind, size), f"{kind} of {scene}")
            else:
                options = ["--rays", kind, "--resolution", size, "-o", str(file)]
                call([self.beambench, "rays", scene, *options])
        return file

    def run(self, program: dict[str, Any], scene: str, mesh: Path, rays: Path, hits: Path) -> str:
        """Runs a program, which writes its hits; returns its version."""
        places = {**self.places, "scene": scene, "mesh": mesh, "rays": rays, "hits": hits}
        printed = call([word.format(**places) for word in shlex.split(program["command"])])
        return program.get("version") or json.loads(printed.splitlines()[-1])["version"]

    def verify(self, scene: str, rays: Path, hits: Path) -> dict[str, Any]:
        """Returns the report of `beambench verify --hits`."""
        found = hits.with_suffix(".json")
        files = ["--rays", str(rays), "--hits", str(hits), "--json", str(found)]
        call([self.beambench, "verify", scene, *files], expected=(0, 1))
        verified = json.loads(found.read_text("utf-8"))["cases"][0]
        found.unlink()
        return verified

    def cell_file(self, program: dict[str, Any], scene: str, kind: str) -> Path:
        """Returns the file in which a row is kept."""
        return self.work / "cells" / f"{slug(program['name'])}-{slug(scene)}-{kind}.json"

    def cell(self, program: dict[str, Any], scene: str, kind: str) -> dict[str, Any]:
        """Returns a row, measured if necessary, with the disputed rays in `examples`."""
        kept = self.cell_file(program, scene, kind)
        if kept.exists():
            return json.loads(kept.read_text("utf-8"))
        mesh, rays = self.mesh(scene), self.rays(scene, kind)
        hits = kept.with_suffix(".hits")
        begin = time.monotonic()
        version = self.run(program, scene, mesh, rays, hits)
        seconds = time.monotonic() - begin
        verified = self.verify(scene, rays, hits)
        row = {
            "program": program["name"],
            "version": version,
            "scene": scene,
            "triangles": len(read_obj(mesh)[1]),
            "ray_kind": kind,
            "program_hits": hits_in(hits),
            "seconds": round(seconds, 1),
            "commit": self.commit,
            "dirty": self.dirty,
            **{name: verified[name] for name in ("rays", "hits", "verdict", *CLASSES)},
            "examples": verified["examples"],
        }
        hits.unlink()
        kept.write_text(json.dumps(row, indent=1), "utf-8")
        return row


def write_table(path: Path, columns: list[str], rows: list[dict[str, Any]]) -> None:
    """Writes a CSV file of these columns, in which spreadsheets do not read any text as a
    formula."""
    with path.open("w", newline="", encoding="utf-8") as table:
        writer = csv.DictWriter(table, columns, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: guarded(value) for name, value in row.items()} for row in rows)


def summary(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Returns the rows of each program summed over the scenes."""
    sums: dict[tuple[str, str], dict[str, Any]] = {}
    for row in rows:
        kinds = KINDS_TOGETHER.get(row["ray_kind"], row["ray_kind"])
        start = {"program": row["program"], "ray_kinds": kinds, "scenes": set(), "not_ok": 0}
        total = sums.setdefault((row["program"], kinds), start | dict.fromkeys(COUNTS, 0))
        total["scenes"].add(row["scene"])
        total["not_ok"] += row["verdict"] != "ok"
        for name in COUNTS:
            total[name] += row[name]
    return [{**total, "scenes": len(total["scenes"])} for total in sums.values()]


def machine() -> dict[str, str]:
    """Returns a description of the machine."""
    names = re.findall(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text("utf-8"), re.M)
    return {"processor": names[0] if names else "", "system": platform.platform()}


def of_git(*arguments: str) -> str:
    """Returns the output of a git command in this repository."""
    return call(["git", "-C", str(REPOSITORY), *arguments]).strip()


def main() -> int:
    """Returns the exit code: 0 for success, whatever the verdicts; 2 for invalid arguments."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add_common_options(parser)
    parser.add_argument(
        "-o", dest="out", type=Path, help="folder for hits.csv, summary.csv and manifest.json"
    )
    parser.add_argument(
        "--only", default="", help="names of the programs to run, separated by commas"
    )
    parser.add_argument("--scenes", nargs="+", default=SCENES, help="default: the published ones")
    parser.add_argument("--rays", nargs="+", default=list(RAYS), choices=list(RAYS))
    parser.add_argument(
        "--measured", action="store_true", help="write the table only, from the existing cells"
    )
    arguments = parser.parse_args()
    programs = json.loads(arguments.programs.read_text("utf-8"))["programs"]
    chosen = [name for name in arguments.only.split(",") if name]
    unknown = set(chosen) - {program["name"] for program in programs}
    if unknown:
        parser.error(f"no program {', '.join(sorted(unknown))} in {arguments.programs}")
    measurement = Measurement(arguments.work, places_of(arguments))
    rows, left_out = [], {}
    for program in programs:
        if chosen and program["name"] not in chosen:
            continue
        for scene in arguments.scenes:
            triangles = len(read_obj(measurement.mesh(scene))[1])
            if program["name"] in left_out or triangles > program.get("most_triangles", triangles):
                continue
            for kind in arguments.rays:
                if kind == "inside" and not scene.startswith(CLOSED):
                    continue
                kept = measurement.cell_file(program, scene, kind)
                if arguments.measured and not kept.exists():
                    continue
                try:
                    row = measurement.cell(program, scene, kind)
                except (FailedError, OSError) as problem:
                    left_out[program["name"]] = str(problem)
                    print(f"{program['name']}: left out: {problem}", flush=True)
                    break
                rows.append(row)
                print(" ".join(str(row[name]) for name in COLUMNS), flush=True)
    if arguments.out:
        arguments.out.mkdir(parents=True, exist_ok=True)
        write_table(arguments.out / "hits.csv", COLUMNS, rows)
        columns = ["program", "ray_kinds", "scenes", *COUNTS, "not_ok"]
        write_table(arguments.out / "summary.csv", columns, summary(rows))
        manifest = {
            "program": {
                "commit": " ".join(sorted({row["commit"] for row in rows})),
                "dirty": any(row["dirty"] for row in rows),
            },
            "time": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
            "command": shlex.join(sys.argv),
            "machine": machine(),
            "left_out": left_out,
            "programs": programs,
        }
        text = json.dumps(manifest, indent=1, ensure_ascii=False)
        (arguments.out / "manifest.json").write_text(text + "\n", "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
