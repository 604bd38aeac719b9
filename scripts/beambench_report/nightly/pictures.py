"""Pictures of what was not right: the scene as the structure sees it, and where it errs."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pandas as pd

from beambench_report.files import write_text
from beambench_report.records import FAULTLESS_VERDICTS, Run

INDEX = "mismatches.json"
_MOST = 12  # one cause makes many cells wrong, and a page is read by people
_SECONDS = 120


def picture_mismatches(run: Run, beambench: Path) -> list[Path]:
    """Renders RUN/mismatches/*.png for cells of primary rays; returns what could be rendered.

    A picture that cannot be made keeps no page from being written: the index is without it.
    """
    wrong = run.rows[~run.rows["verdict"].isin((*FAULTLESS_VERDICTS, "error"))]
    wrong = wrong[wrong["ray_kind"] == "primary"]
    # The lowest resolution shows what the highest does, and is read faster.
    wrong = wrong.sort_values("rays", kind="stable").drop_duplicates(
        ["scene", "camera", "structure", "parameters"]
    )
    folder = run.directory / "mismatches"
    entries, paths = [], []
    for number, (_, row) in enumerate(wrong.head(_MOST).iterrows(), 1):
        folder.mkdir(exist_ok=True)
        made = {}
        for kind, options in (("picture", []), ("difference", ["--difference", "oracle"])):
            path = folder / f"{number:02d}-{kind}.png"
            if _render(beambench, row, path, options):
                made[kind] = path.name
                paths.append(path)
        entries.append({"contender": row["contender"], "view": row["view"], **made})
    if entries:
        write_text(folder / INDEX, json.dumps(entries, indent=2) + "\n")
    return paths


def _render(beambench: Path, row: pd.Series, path: Path, options: list[str]) -> bool:
    accel = f"{row['structure']}:{row['parameters']}" if row["parameters"] else row["structure"]
    size = f"{row['width']:.0f}x{row['height']:.0f}"
    command = [str(beambench), "render", row["scene"], "--accel", accel, "-o", str(path)]
    command += ["--resolution", size, "--samples", f"{row['samples']:.0f}"]
    command += ["--camera", row["camera"], *options]
    try:
        done = subprocess.run(command, capture_output=True, timeout=_SECONDS, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode in (0, 1) and path.exists()
