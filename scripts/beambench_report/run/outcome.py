"""The summary of wrong hits at the top of a page."""

from collections.abc import Mapping
from dataclasses import dataclass

from beambench_report.base.cell_files import CellFile, Example, Identity, identity
from beambench_report.base.records import ERROR, FAULTLESS_VERDICTS, Run, size_of

# More wrong cells than this usually share one cause.
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
    verdict: str
    meaning: str
    message: str
    examples: tuple[Example, ...]
    sizes: tuple[str, ...]


@dataclass(frozen=True)
class Faults:
    """The wrong cells of a run."""

    faults: tuple[Fault, ...]
    """The first groups of wrong cells."""
    unshown: int
    """The number of wrong cells that only the table of all cells shows."""


def faults_of(run: Run, files: Mapping[Identity, CellFile]) -> Faults:
    """Groups the wrong cells by contender, view and reason."""
    wrong = run.rows[~run.rows["verdict"].isin(FAULTLESS_VERDICTS)]
    shown = wrong.head(_MOST_SHOWN)
    sizes: dict[tuple, list[str]] = {}
    for row in shown.to_dict("records"):
        file = files.get(identity(row))
        reason = (file.message, file.examples) if file else ("", ())
        verdict = (row["verdict"] or "no verdict", _MEANINGS.get(row["verdict"], "was wrong"))
        fault = (row["contender"], row["view"], *verdict, *reason)
        sizes.setdefault(fault, []).append(size_of(row))
    faults = tuple(Fault(*fault, tuple(own)) for fault, own in sizes.items())
    return Faults(faults, len(wrong) - len(shown))
