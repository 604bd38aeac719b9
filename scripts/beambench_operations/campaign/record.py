"""The record of all campaigns, to which pieces are added, and its folder."""

import fcntl
import json
import os
import platform
import re
import shlex
import shutil
import subprocess
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path

from beambench_operations.campaign.piece import Finding, Piece
from beambench_report.base.files import ROOT, Problem, read_json, write_text

VERSION = 1


class Record:
    """The record of all campaigns in a folder, by default `results/robustness`."""

    def __init__(self, folder: Path) -> None:
        """Creates nothing until the first piece is added."""
        self.folder = folder
        self.file = folder / "record.json"
        self.findings = folder / "findings"
        self._commit = _commit()
        self._machine = _machine()

    def corpus(self, target: str) -> Path:
        """Returns the folder in which libFuzzer keeps the inputs of a target."""
        return self.folder / "corpus" / target

    def pieces(self) -> list[dict]:
        """Returns all pieces, the oldest first. Raises Problem if the file is not a record."""
        record = read_json(self.file)
        if record is None:
            return []
        if not isinstance(record, dict) or record.get("version") != VERSION:
            raise Problem(f"{self.file}: it is not a record of version {VERSION}; move it away")
        return record["pieces"]

    def total(self, command: str, subject: str, what: str) -> int:
        """Returns the sum of a count, or of seconds, over the pieces of one subject."""
        ours = (p for p in self.pieces() if (p["command"], p["subject"]) == (command, subject))
        return int(sum(p["counts"].get(what, p.get(what, 0)) for p in ours))

    def add(self, piece: Piece) -> None:
        """Adds a piece; concurrent campaigns keep each other's pieces."""
        self.folder.mkdir(parents=True, exist_ok=True)
        with (self.folder / "record.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            time = f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ}"
            facts = {"time_utc": time, "commit": self._commit, "machine": self._machine}
            pieces = [*self.pieces(), asdict(piece) | facts]
            write_text(self.file, as_json(pieces))

    def keep(self, source: Path, name: str, message: str, command: list[str | Path]) -> Finding:
        """Copies the files of a finding; in the finding's command, the copy replaces `source`."""
        self.findings.mkdir(parents=True, exist_ok=True)
        kept = self.findings / re.sub(r"[^A-Za-z0-9._=-]", "-", name)
        if source.is_dir():
            shutil.copytree(source, kept, dirs_exist_ok=True)
        else:
            shutil.copy(source, kept)
        words = [kept if word == source else word for word in command]
        return Finding(kept.name, message, shlex.join(_shown(word) for word in words))


def as_json(pieces: list[dict]) -> str:
    """Formats a record of pieces, one on each line."""
    lines = ",\n".join(json.dumps(piece) for piece in pieces)
    return f'{{"version": {VERSION}, "pieces": [\n{lines}\n]}}\n'


def _shown(word: str | Path) -> str:
    """Returns a path below the repository's top relative to it."""
    path = Path(word)
    return str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else str(word)


def _commit() -> str:
    git = ["git", "-C", str(ROOT), "describe", "--always", "--dirty", "--exclude=*", "--abbrev=40"]
    done = subprocess.run(git, capture_output=True, text=True, check=False)
    return done.stdout.strip() or "unknown"


def _machine() -> str:
    try:
        names = re.findall(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text("utf-8"), re.M)
    except OSError:
        names = []
    return f"{names[0] if names else platform.machine()}, {os.cpu_count()} cores"
