"""The progress of a folder, stored next to it while it is made and inside it once published."""

import json
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from beambench_operations.publish.provenance import Provenance
from beambench_report.base.files import read_json, write_text
from beambench_report.base.machine import read_manifest

RECORD = "published.json"
"""The file in a published folder: commit, machine, machine state, and the time of each step."""


@dataclass
class Progress:
    """The progress of making the folder at `folder`."""

    folder: Path
    made_by: dict[str, object]
    seconds: list[float] = field(default_factory=list)
    """The seconds that the finished steps took."""
    wrong: list[int] = field(default_factory=list)
    """The steps in which a structure's hits were wrong."""

    def done(self, seconds: float, *, wrong: bool = False) -> None:
        """Records that one more step is finished."""
        if wrong:
            self.wrong.append(len(self.seconds))
        self.seconds.append(round(seconds, 1))
        self.keep()

    def keep(self) -> None:
        """Writes the progress next to the folder, so that an interrupted run can continue."""
        self.folder.parent.mkdir(parents=True, exist_ok=True)
        self._write(state_file(self.folder))

    def publish(self) -> None:
        """Writes the progress into the complete folder."""
        self._write(self.folder / RECORD)

    def _write(self, file: Path) -> None:
        document = {"made_by": self.made_by, "seconds": self.seconds, "wrong": self.wrong}
        write_text(file, json.dumps(document, indent=1) + "\n")


def state_file(folder: Path) -> Path:
    """Returns the file that stores the progress of a folder while it is made."""
    return folder.with_name(f"{folder.name}.progress.json")


def progress_of(folder: Path, provenance: Provenance) -> Progress | None:
    """Returns the progress made by the same sources on the same machine, if any."""
    source = read_json(state_file(folder))
    if not isinstance(source, dict) or not provenance.is_of(source.get("made_by", {})):
        return None
    return Progress(folder, source["made_by"], source["seconds"], source["wrong"])


@dataclass(frozen=True)
class Extent:
    """The extent of a published folder."""

    seconds: float | None
    cells: int
    blocks: int | None
    """The fewest blocks of a cell with times; None if no row states blocks."""


def extent_of(folder: Path) -> Extent:
    """Returns the extent of a published folder, from its record or manifests, and its rows."""
    nested = [file.parent for file in folder.rglob(RECORD) if file.parent != folder]
    within = [
        file for file in folder.rglob("*") if not any(file.is_relative_to(one) for one in nested)
    ]
    source = read_json(folder / RECORD)
    manifests = [read_manifest(file.parent) for file in within if file.name == "manifest.json"]
    known = [one.seconds for one in manifests if one is not None and one.seconds is not None]
    seconds = source["seconds"] if isinstance(source, dict) else known
    tables = [pd.read_csv(file, dtype=str) for file in within if file.name == "results.csv"]
    blocks = [int(n) for one in tables if "blocks" in one for n in one["blocks"].dropna()]
    return Extent(
        sum(seconds) if seconds else None, sum(map(len, tables)), min(blocks, default=None)
    )


def is_published(folder: Path, provenance: Provenance) -> bool:
    """Returns whether the same sources made the complete folder on the same machine."""
    source = read_json(folder / RECORD)
    return isinstance(source, dict) and provenance.is_of(source.get("made_by", {}))
