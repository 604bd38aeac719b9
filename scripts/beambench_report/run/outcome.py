"""What a page shows first of the cells whose hits are wrong."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import pandas as pd

from beambench_report.base.cell_files import CellFile, Example, Identity, identity
from beambench_report.base.records import ERROR, FAULTLESS_VERDICTS, Run

# More wrong cells than this have one cause, not many.
_MOST_SHOWN = 40

_MEANINGS = {
    "mismatch": "wrong hits",
    "grazes": "too many rays were disputed at the edges of primitives",
    ERROR: "could not be built",
    "": "was not verified",
}


@dataclass(frozen=True)
class Fault:
    """Cells of one contender in one view that were wrong for one reason."""

    contender: str
    view: str
    sizes: tuple[str, ...]
    verdict: str
    meaning: str
    message: str
    examples: tuple[Example, ...]


@dataclass(frozen=True)
class Faults:
    """The wrong cells of a run."""

    faults: tuple[Fault, ...]
    """The first of what was wrong."""
    unshown: int
    """How many wrong cells are in the table of all cells only."""


def faults_of(run: Run, files: Mapping[Identity, CellFile]) -> Faults:
    """Groups the wrong cells by contender, view and reason."""
    wrong = run.rows[~run.rows["verdict"].isin(FAULTLESS_VERDICTS)]
    shown = wrong.head(_MOST_SHOWN)
    faults: dict[tuple, Fault] = {}
    for _, row in shown.iterrows():
        fault = _fault(row, files.get(identity(row)))
        reason = (fault.contender, fault.view, fault.verdict, fault.message, fault.examples)
        earlier = faults.get(reason)
        sizes = (*earlier.sizes, *fault.sizes) if earlier else fault.sizes
        faults[reason] = replace(fault, sizes=sizes)
    return Faults(tuple(faults.values()), len(wrong) - len(shown))


def _fault(row: pd.Series, file: CellFile | None) -> Fault:
    return Fault(
        row["contender"],
        row["view"],
        (f"{row['width']:.0f}x{row['height']:.0f}",),
        row["verdict"] or "no verdict",
        _MEANINGS.get(row["verdict"], "was wrong"),
        file.message if file else "",
        file.examples if file else (),
    )
