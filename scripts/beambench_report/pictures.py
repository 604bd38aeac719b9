"""Pictures of the scenes of a run, rendered by beambench itself."""

from __future__ import annotations

import subprocess
from pathlib import Path

from beambench_report.names import file_stems
from beambench_report.problem import Problem
from beambench_report.records import Run, read_run

_PAINTER = "embree"
_HEATMAP_STRUCTURE = "samet"
_HEATMAP_COUNTER = "traversal_steps"


def write_pictures(directory: Path, beambench: Path) -> list[Path]:
    """Fills DIRECTORY/pictures: each scene of the run, and a heat map of one structure's work."""
    run = read_run(directory)
    folder = directory / "pictures"
    folder.mkdir(exist_ok=True)
    paths = []
    for scene, stem in file_stems(dict.fromkeys(run.rows["scene"])).items():
        picture = folder / f"{stem}.png"
        _render(beambench, scene, _PAINTER, picture)
        paths.append(picture)
        structure = _heatmap_structure(run, scene)
        if structure:
            heatmap = folder / f"{stem}-{_HEATMAP_STRUCTURE}-{_HEATMAP_COUNTER}.png"
            _render(beambench, scene, structure, heatmap, "--heatmap", _HEATMAP_COUNTER)
            paths.append(heatmap)
    return paths


def _heatmap_structure(run: Run, scene: str) -> str | None:
    """The first of the structure's variants that was right on this scene, as `--accel` takes it."""
    rows = run.rows[
        (run.rows["scene"] == scene)
        & (run.rows["structure"] == _HEATMAP_STRUCTURE)
        & (run.rows["verdict"] == "ok")
    ]
    if rows.empty:
        return None
    parameters = rows["parameters"].iloc[0]
    return f"{_HEATMAP_STRUCTURE}:{parameters}" if parameters else _HEATMAP_STRUCTURE


def _render(beambench: Path, scene: str, structure: str, output: Path, *options: str) -> None:
    command = [str(beambench), "render", scene, "--accel", structure, "-o", str(output), *options]
    try:
        status = subprocess.run(command, check=False).returncode
    except OSError as error:
        raise Problem(f"{beambench} cannot be run: {error.strerror}; build it first") from None
    if status != 0:
        raise Problem(f"`{' '.join(command)}` ended with exit code {status}")
