"""The manifest of a run, and the machine that the run was made on."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path

import pandas as pd

from beambench_report.base.files import Problem, read_json
from beambench_report.base.quantities import size_in_words

_NOT_FACTS = ("uncontrolled", "notes", "google_benchmark")


@dataclass(frozen=True)
class Facts:
    """A titled list of names and values, or a table of several similar things."""

    title: str
    pairs: list[tuple[str, str]] = field(default_factory=list)
    table: list[dict[str, str]] = field(default_factory=list)


@dataclass(frozen=True)
class Manifest:
    """The program and the machine of a measurement."""

    run_id: str = ""
    sweep: str = ""
    begun: str = ""
    seconds: float | None = None
    cut_off: bool = False
    machine: str = ""
    noise: float | None = None
    """How much longer than usual the slowest 5% of equal work took before the run."""
    scenes: list[str] = field(default_factory=list)
    """The scenes of the sweep, with their parameters."""
    uncontrolled: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    facts: list[Facts] = field(default_factory=list)


def read_manifest(directory: Path) -> Manifest | None:
    """Reads DIRECTORY/manifest.json; None if it is missing."""
    source = _read_object(directory / "manifest.json")
    if source is None:
        return None
    begun, finished = source.get("time_utc"), source.get("finished_utc")
    return Manifest(
        run_id=source.get("run_id", ""),
        sweep=source.get("sweep", ""),
        begun=begun or "",
        seconds=_seconds_between(begun, finished),
        cut_off="finished_utc" in source and not finished,
        machine=_dictionary(source, "machine").get("cpu", ""),
        noise=_dictionary(source, "measurement").get("noise"),
        scenes=[one["name"] for one in source.get("scenes", []) if "name" in one],
        uncontrolled=source.get("uncontrolled", []),
        notes=source.get("notes", []),
        facts=_facts(source),
    )


def read_description(directory: Path) -> str:
    """Returns the description of the sweep in DIRECTORY/config.json; empty without one."""
    return str((_read_object(directory / "config.json") or {}).get("description", ""))


def _read_object(path: Path) -> dict | None:
    source = read_json(path)
    if not isinstance(source, dict | None):
        raise Problem(f"{path}: does not hold a JSON object")
    return source


def _facts(source: dict) -> list[Facts]:
    """Returns one list of the plain members, then a list for each group of members."""
    plain = Facts("Run")
    groups = [plain]
    for name, value in source.items():
        if name in _NOT_FACTS:
            continue
        if isinstance(value, dict):
            groups.append(Facts(_label(name), _pairs(value)))
        elif isinstance(value, list) and value and all(isinstance(one, dict) for one in value):
            rows = [dict(_pairs(one)) for one in value]
            groups.append(Facts(_label(name), table=rows))
        else:
            plain.pairs.append((_label(name), _text(name, value)))
    return groups


def _pairs(source: dict, prefix: str = "") -> list[tuple[str, str]]:
    pairs = []
    for name, value in source.items():
        label = f"{prefix}{_label(name)}"
        if isinstance(value, dict):
            pairs += _pairs(value, f"{label}: ")
        else:
            pairs.append((label, _text(name, value)))
    return pairs


def _label(name: str) -> str:
    return name.replace("_", " ")


def _text(name: str, value: object) -> str:
    if value is None:
        return "not reported"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        return ", ".join(_text(name, one) for one in value) or "none"
    if isinstance(value, int | float) and name.endswith("_bytes"):
        return size_in_words(value)
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _dictionary(source: dict, name: str) -> dict:
    value = source.get(name)
    return value if isinstance(value, dict) else {}


def _seconds_between(begun: str | None, finished: str | None) -> float | None:
    try:
        return (datetime.fromisoformat(finished) - datetime.fromisoformat(begun)).total_seconds()
    except (TypeError, ValueError):
        return None


@dataclass(frozen=True)
class Machine:
    """A machine, as far as it is known."""

    ids: tuple[str, ...]
    """The machine's ids: one, unless a file has runs of several machines."""
    processor: str
    """The processor; empty if the run has no manifest."""

    def differs_from(self, other: Machine) -> bool:
        """Returns whether the machines differ, as far as both are known.

        Several machines differ even from the same several machines: another run may have measured
        a cell on a different one of them.
        """
        if max(len(self.ids), len(other.ids)) > 1:
            return True
        both_known = self.processor and other.processor
        return self.ids != other.ids or bool(both_known and self.processor != other.processor)

    def __str__(self) -> str:
        """Formats the ids and, if known, the processor."""
        ids = " and ".join(self.ids)
        return f"{ids} ({self.processor})" if self.processor else ids


def require_one_machine(rows: pd.DataFrame, folder: Path) -> None:
    """Raises Problem if the rows of FOLDER are from several machines.

    Tables that divide times of different views need the rows of one machine.
    """
    ids = sorted(set(rows["machine_id"]))
    if len(ids) > 1:
        raise Problem(
            f"{folder}: its rows are from {len(ids)} machines ({', '.join(ids)}), but this "
            "compares times of different scenes and resolutions; measure the sweep on one machine"
        )


def machine_of(rows: pd.DataFrame, folder: Path) -> Machine:
    """Returns the machine of the rows; FOLDER may hold the manifest of their run."""
    manifest = read_manifest(folder)
    is_theirs = manifest is not None and set(rows["run_id"]) == {manifest.run_id}
    return Machine(tuple(sorted(set(rows["machine_id"]))), manifest.machine if is_theirs else "")
