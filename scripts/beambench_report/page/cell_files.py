"""What the files of single cells tell beyond results.csv: messages, examples, every repetition."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from beambench_report.problem import Problem

# A run has some hundreds of cells. Thousands of files would be read for longer than anybody waits.
MOST_FILES = 5000

IDENTITY = ("scene", "camera", "structure", "parameters", "width", "height", "samples", "ray_kind")
Identity = tuple[str, ...]


@dataclass(frozen=True)
class Example:
    """One disputed ray in words, and the command that shows its way again."""

    text: str
    replay: str


@dataclass(frozen=True)
class CellFile:
    """One file of DIRECTORY/cells."""

    message: str
    examples: tuple[Example, ...]
    total_ms: Mapping[int, float]
    """Build and trace of each repetition, by the round in which it had its turn."""
    trace_ms: Mapping[int, float] = field(default_factory=dict)
    """The first trace after each build, likewise."""
    warm_ms: Mapping[int, float] = field(default_factory=dict)
    """The second trace of the same structure, in the rounds that had one."""


def identity(row: Mapping[str, object]) -> Identity:
    """What tells a row from every other row of its run."""
    return tuple(_plain(row[name]) for name in IDENTITY)


def read_cell_files(directory: Path) -> dict[Identity, CellFile]:
    """Every cell's file; none where there are no files, or too many to be read."""
    paths = [path for path in directory.glob("cells/*.json") if not path.name.startswith(".")]
    if len(paths) > MOST_FILES:
        return {}
    return dict(_read(path) for path in paths)


def _read(path: Path) -> tuple[Identity, CellFile]:
    try:
        source = json.loads(path.read_text("utf-8"))
        total, trace, warm = {}, {}, {}
        for repetition in source["repetitions"]:
            turn = repetition["round"]
            trace[turn] = repetition["trace_ms"]
            total[turn] = repetition["build_ms"] + trace[turn]
            if "warm_trace_ms" in repetition:
                warm[turn] = repetition["warm_trace_ms"]
        examples = tuple(_example(text) for text in source["examples"])
        return identity(source["row"]), CellFile(source["message"], examples, total, trace, warm)
    except (ValueError, KeyError, TypeError) as error:
        raise Problem(
            f"{path}: is not a cell of a run ({type(error).__name__}: {error}); remove it"
        ) from None


def _example(text: str) -> Example:
    """The command stands in a line of its own: `  replay beambench trace ...`."""
    lines = text.rstrip().splitlines()
    replays = [line.strip() for line in lines if line.lstrip().startswith("replay ")]
    told = [line for line in lines if line.strip() not in replays]
    return Example("\n".join(told), replays[0].removeprefix("replay ").strip() if replays else "")


def _plain(value: object) -> str:
    return str(int(value)) if isinstance(value, float) else str(value)
