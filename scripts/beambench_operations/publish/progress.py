"""How far a folder is: beside the folder that is being made, and in the published one."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path

from beambench_operations.publish.setting import Setting
from beambench_report.base.files import read_json, write_text
from beambench_report.base.machine import read_manifest

RECORD = "published.json"
"""In a published folder: the commit, the machine and its state, and what each step took."""


@dataclass
class Progress:
    """Of a folder that is being made at `folder`."""

    folder: Path
    made_by: dict[str, object]
    seconds: list[float] = field(default_factory=list)
    """That the finished steps took."""
    wrong: list[int] = field(default_factory=list)
    """The steps in which a structure's hits were wrong."""

    def done(self, seconds: float, *, wrong: bool = False) -> None:
        """Keeps that one more step is finished."""
        if wrong:
            self.wrong.append(len(self.seconds))
        self.seconds.append(round(seconds, 1))
        self.keep()

    def keep(self) -> None:
        """Writes it beside the folder, so that a run that is cut off can go on."""
        self.folder.parent.mkdir(parents=True, exist_ok=True)
        write_text(state_file(self.folder), json.dumps(self._document(), indent=1) + "\n")

    def publish(self) -> None:
        """Writes it into the folder, which is complete."""
        write_text(self.folder / RECORD, json.dumps(self._document(), indent=1) + "\n")

    def _document(self) -> dict[str, object]:
        return {"made_by": self.made_by, "seconds": self.seconds, "wrong": self.wrong}


def state_file(folder: Path) -> Path:
    """Where the progress of a folder that is being made is kept."""
    return folder.with_name(f"{folder.name}.progress.json")


def progress_of(folder: Path, setting: Setting) -> Progress | None:
    """What was begun there by the same sources on the same machine; None where nothing was."""
    source = read_json(state_file(folder))
    if not isinstance(source, dict) or not setting.is_of(source.get("made_by", {})):
        return None
    return Progress(folder, source["made_by"], source["seconds"], source["wrong"])


def seconds_of(folder: Path) -> float | None:
    """What a published folder took: by its record, else by the manifests of its runs."""
    source = read_json(folder / RECORD)
    if isinstance(source, dict):
        return sum(source["seconds"])
    manifests = [read_manifest(file.parent) for file in folder.rglob("manifest.json")]
    known = [one.seconds for one in manifests if one is not None and one.seconds is not None]
    return sum(known) if known else None


def is_published(folder: Path, setting: Setting) -> bool:
    """Is this folder complete, by the same sources on the same machine?"""
    source = read_json(folder / RECORD)
    return isinstance(source, dict) and setting.is_of(source.get("made_by", {}))
