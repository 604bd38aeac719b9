"""Which machine a run was made on.

The column machine_id suffices for runs since 22 November 2026. Before that it was a hash of the
host's name, which a Xeon and an EPYC once shared; the manifest beside such a run names the
processor.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from beambench_report.page.manifest import read_manifest


@dataclass(frozen=True)
class Machine:
    """What is known of it."""

    ids: tuple[str, ...]
    """One, unless a file has runs of several machines."""
    processor: str
    """Empty where no manifest is beside the run."""

    def differs_from(self, other: Machine) -> bool:
        """Are they two, as far as both are known?"""
        both_known = self.processor and other.processor
        return self.ids != other.ids or bool(both_known and self.processor != other.processor)

    def __str__(self) -> str:
        """As people read it."""
        ids = " and ".join(self.ids)
        return f"{ids} ({self.processor})" if self.processor else ids


def machine_of(rows: pd.DataFrame, folder: Path) -> Machine:
    """The machine of the rows; FOLDER may hold the manifest of their run."""
    manifest = read_manifest(folder)
    is_theirs = manifest is not None and set(rows["run_id"]) == {manifest.run_id}
    return Machine(tuple(sorted(set(rows["machine_id"]))), manifest.machine if is_theirs else "")
