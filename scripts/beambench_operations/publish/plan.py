"""The plan of publication, plan.json: folders in order, their commands and durations."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from beambench_operations.publish.progress import Extent
from beambench_report.base.files import ROOT, Problem, load_json
from beambench_report.base.quantities import markdown_table

PLAN = Path(__file__).parent / "plan.json"
SWEEPS = ROOT / "harness/measure/sweeps"


@dataclass(frozen=True)
class Sweep:
    """A sweep that beambench runs in its own folder and resumes if interrupted."""

    source: Path
    into: str
    seconds: float
    changes: dict[str, Any] = field(default_factory=dict)
    """Members that replace those of the sweep's file, so that the whole plan fits the time."""

    @property
    def words(self) -> str:
        """Describes the step in the plan."""
        changed = f", with other {', '.join(self.changes)}" if self.changes else ""
        return f"beambench run {self.source.name}{changed}"

    def config(self) -> dict[str, Any]:
        """Returns the sweep as it will be run. Raises Problem if its file cannot be read."""
        try:
            config = load_json(self.source)
        except (OSError, ValueError) as error:
            raise Problem(f"{self.source}: cannot be read as a sweep: {error}") from None
        return {name: value for name, value in config.items() if name != "$schema"} | self.changes


@dataclass(frozen=True)
class Command:
    """A program with arguments, in which {folder} and other names are replaced."""

    words_of: tuple[str, ...]
    seconds: float
    resume: tuple[str, ...] = ()
    """Arguments that continue the program after an interruption; if empty, it is restarted."""
    into: str = ""
    """The file for its standard output; if empty, the output is discarded."""

    @property
    def words(self) -> str:
        """Describes the step in the plan."""
        named = [word for word in self.words_of if not word.startswith("{folder}")]
        text = " ".join(named).replace("{python} -m ", "").replace("{beambench}", "beambench")
        return text.replace(" --beambench beambench", "").split(" --program")[0]


Step = Sweep | Command


@dataclass(frozen=True)
class Folder:
    """A folder of results/published, made by one commit on one machine."""

    name: str
    question: str
    """The question that its page answers."""
    steps: tuple[Step, ...]
    needs: str = ""
    """A requirement: `meshes`, `debian-13`, `libraries`, or `its name`, which must be given by
    --only. Without it the folder is left as it is.
    """
    embree: str = ""
    """The major version of Embree that it requires; if empty, any version."""
    keep: Sequence[str] = ()
    """Files of an earlier commit that no step makes; the texts name their commit."""
    leave_out: Sequence[str] = ()
    """Patterns of files and folders that steps make but no published text needs."""
    is_apart: bool = False
    """Whether its time is excluded from the total."""

    @property
    def name_aside(self) -> str:
        """Returns the folder's name while it is made: a nested folder is made beside its parent."""
        return self.name.replace("/", "-")

    @property
    def seconds(self) -> float:
        """Returns the expected seconds."""
        return sum(step.seconds for step in self.steps)


@dataclass(frozen=True)
class Plan:
    """The whole plan, in order."""

    folders: tuple[Folder, ...]
    most_minutes: float

    @property
    def minutes(self) -> float:
        """The expected minutes of all folders, except separate ones."""
        return sum(one.seconds for one in self.folders if not one.is_apart) / 60

    def only(self, names: Iterable[str]) -> Plan:
        """Returns the named folders, or all if none is named. Raises Problem for an unknown one."""
        known = {one.name: one for one in self.folders}
        for name in (wanted := set(names)) - known.keys():
            raise Problem(f"no folder '{name}' is planned, only {', '.join(known)}")
        folders = (one for one in self.folders if one.name in wanted or not wanted)
        return Plan(tuple(folders), self.most_minutes)


def read_plan(path: Path = PLAN) -> Plan:
    """Reads the plan. Raises Problem if the file is not a plan."""
    try:
        source = load_json(path)
        return Plan(tuple(map(_folder, source["folders"])), source["most_minutes"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise Problem(f"{path}: is not a plan ({error!r}); restore it with git") from None


def as_table(plan: Plan, states: dict[str, str], published: dict[str, Extent]) -> str:
    """Returns the plan as a table.

    `states` has the state of each folder, `published` the extent of each published folder.
    """
    rows = []
    for one in plan.folders:
        minutes = f"{one.seconds / 60:.1f}{' (apart)' if one.is_apart else ''}"
        own = published.get(one.name, Extent(None, 0, None))
        took = "" if own.seconds is None else f"{own.seconds / 60:.1f}"
        extent = (took, str(own.cells or ""), str(own.blocks or ""))
        rows.append((one.name, one.question, minutes, *extent, states.get(one.name, "")))
    heads = ("folder", "question", "minutes", "took", "cells", "blocks", "state")
    lines = markdown_table(heads, rows, right=(2, 3, 4, 5))
    return "\n".join([*lines, "", f"{plan.minutes:.0f} minutes in all, not counting (apart)"])


def _folder(entry: dict[str, Any]) -> Folder:
    steps = tuple(_step(step) for step in entry["steps"])
    plain = {name: value for name, value in entry.items() if name not in ("steps", "apart")}
    return Folder(**plain, steps=steps, is_apart="apart" in entry)


def _step(entry: dict[str, Any]) -> Step:
    if "sweep" in entry:
        name = entry["sweep"]
        source = ROOT / name if "/" in name else SWEEPS / f"{name}.json"
        return Sweep(source, entry["into"], entry["seconds"], entry.get("changes", {}))
    words = tuple(entry["print"] if "print" in entry else entry["command"])
    return Command(words, entry["seconds"], tuple(entry.get("resume", ())), entry.get("into", ""))
