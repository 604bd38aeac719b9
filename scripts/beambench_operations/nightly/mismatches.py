"""Pictures of a night's wrong hits."""

import json
import subprocess
from pathlib import Path

import pandas as pd

from beambench_operations.site.history_page import MISMATCHES
from beambench_report.base.files import write_text
from beambench_report.base.records import ERROR, FAULTLESS_VERDICTS, Run, size_of

_MAX_PICTURES = 12  # one cause makes many cells wrong, and people read the page
_SECONDS = 120


def picture_mismatches(run: Run, beambench: Path) -> list[Path]:
    """Renders RUN/mismatches/*.png for cells of primary rays; returns the pictures.

    If a picture cannot be made, the page is written without it.
    """
    wrong = run.rows[~run.rows["verdict"].isin((*FAULTLESS_VERDICTS, ERROR))]
    wrong = wrong[wrong["ray_kind"] == "primary"]
    # The lowest resolution shows the same as the highest and is easier to read.
    wrong = wrong.sort_values("rays", kind="stable").drop_duplicates(
        ["scene", "camera", "structure", "parameters"]
    )
    index = run.directory / MISMATCHES
    folder = index.parent
    entries, paths = [], []
    for number, (_, row) in enumerate(wrong.head(_MAX_PICTURES).iterrows(), 1):
        folder.mkdir(exist_ok=True)
        made = {}
        for kind, options in (("picture", []), ("difference", ["--difference", "oracle"])):
            path = folder / f"{number:02d}-{kind}.png"
            if _render(beambench, row, path, options):
                made[kind] = path.name
                paths.append(path)
        entries.append({"contender": row["contender"], "view": row["view"], **made})
    if entries:
        write_text(index, json.dumps(entries, indent=2) + "\n")
    return paths


def _render(beambench: Path, row: pd.Series, path: Path, options: list[str]) -> bool:
    accel = f"{row['structure']}:{row['parameters']}".rstrip(":")
    command = [str(beambench), "render", row["scene"], "--accel", accel, "-o", str(path)]
    command += ["--resolution", size_of(row), "--samples", f"{row['samples']:.0f}"]
    command += ["--camera", row["camera"], *options]
    try:
        done = subprocess.run(command, capture_output=True, timeout=_SECONDS, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode in (0, 1) and path.exists()
