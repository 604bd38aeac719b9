"""The commits and machines that made a published folder."""

import re
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from beambench_operations.publish.progress import RECORD
from beambench_report.base.files import Problem, read_json
from beambench_report.base.records import in_blocks


@dataclass(frozen=True)
class Origin:
    """The origin of one run."""

    path: str
    """The path within the published folder; empty for the folder itself."""
    commit: str
    machine_id: str
    processor: str
    cores: int
    embree: str
    noise: float | None
    """How much longer than usual the slowest 5% of equal work took before the run."""

    @property
    def short_commit(self) -> str:
        """Returns the commit as the texts name it."""
        return self.commit[:7]


def origins(folder: Path) -> list[Origin]:
    """Returns the origin of every run in a folder, by path; without runs, that of its record.

    Raises Problem if a manifest does not state its origin.
    """
    found = [_origin(manifest, folder) for manifest in sorted(folder.rglob("manifest.json"))]
    return found or _of_record(folder / RECORD)


def require_one_origin(*folders: Path) -> None:
    """Raises Problem unless runs that are compared are of one commit on one machine."""
    found = {
        (one.commit, one.machine_id): str(folder) for folder in folders for one in origins(folder)
    }
    if len(found) > 1:
        (commit, machine), (other_commit, other_machine) = list(found)[:2]
        raise Problem(
            f"{' and '.join(list(found.values())[:2])} are compared, but one is of commit "
            f"{commit[:7]} on machine {machine}, the other of {other_commit[:7]} on "
            f"{other_machine}; measure both on one machine by one commit"
        )


def _of_record(file: Path) -> list[Origin]:
    source = read_json(file)
    if not isinstance(source, dict):
        return []
    own = source["made_by"]
    names = ("commit", "machine_id", "cpu", "cores", "embree")
    return [Origin("", *(own[name] for name in names), own["noise"])]


def machine_in_words(processor: str) -> str:
    """Returns the name of a processor in the texts: `Xeon`, `EPYC`."""
    known = re.search(r"\b(Xeon|EPYC|Core|Ryzen)\b", processor)
    return known[1] if known else processor


def made(folder: Path) -> str:
    """Returns the commits and machines of a folder's runs: `654e80c, EPYC`.

    Adds a note if runs were not measured in blocks: their order is not a claim.
    """
    found = dict.fromkeys(
        (one.short_commit, machine_in_words(one.processor)) for one in origins(folder)
    )
    by_machine: dict[str, list[str]] = {}
    for commit, machine in found:
        by_machine.setdefault(machine, []).append(commit)
    texts = [f"{', '.join(own)}, {machine}" for machine, own in by_machine.items()]
    if not all(_is_in_blocks(table) for table in folder.rglob("results.csv")):
        texts.append("measured by one process, so unranked")
    return "; ".join(texts)


def _is_in_blocks(table: Path) -> bool:
    """Returns whether the runs of a results.csv were measured in blocks."""
    return in_blocks(pd.read_csv(table, usecols=lambda name: name == "blocks"))


def _origin(manifest: Path, folder: Path) -> Origin:
    source = read_json(manifest)
    try:
        program, machine = source["program"], source["machine"]
        path = manifest.parent.relative_to(folder)
        return Origin(
            "" if path == Path() else str(path),
            program["commit"],
            machine.get("id", ""),
            machine.get("cpu") or machine["processor"],
            machine.get("cores", 0),
            program.get("libraries", {}).get("embree", ""),
            source.get("measurement", {}).get("noise"),
        )
    except (TypeError, KeyError) as error:
        raise Problem(f"{manifest}: is not the manifest of a run ({error!r})") from None
