"""The two verdicts at the head of a page: are the hits correct, and what are the times worth?"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import pandas as pd

from beambench_report.base.cell_files import CellFile, Example, Identity, identity
from beambench_report.base.machine import Manifest
from beambench_report.base.records import ERROR, FAULTLESS_VERDICTS, NO_RAYS, Run

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
class Outcome:
    """The verdicts of a run, summed up."""

    cells: int
    wrong: int
    faults: tuple[Fault, ...]
    """The first of what was wrong."""
    unshown: int
    """How many wrong cells are in the table of all cells only."""
    without_rays: int
    """How many cells are of a kind of rays that their scene has none of."""

    @property
    def right(self) -> int:
        """How many cells have correct hits."""
        return self.cells - self.wrong - self.without_rays


def summarize_verdicts(run: Run, files: Mapping[Identity, CellFile]) -> Outcome:
    """Sums up the verdicts."""
    wrong = run.rows[~run.rows["verdict"].isin(FAULTLESS_VERDICTS)]
    shown = wrong.head(_MOST_SHOWN)
    faults: dict[tuple, Fault] = {}
    for _, row in shown.iterrows():
        fault = _fault(row, files.get(identity(row)))
        reason = (fault.contender, fault.view, fault.verdict, fault.message, fault.examples)
        earlier = faults.get(reason)
        sizes = (*earlier.sizes, *fault.sizes) if earlier else fault.sizes
        faults[reason] = replace(fault, sizes=sizes)
    without_rays = int((run.rows["verdict"] == NO_RAYS).sum())
    unshown = len(wrong) - len(shown)
    return Outcome(len(run.rows), len(wrong), tuple(faults.values()), unshown, without_rays)


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


_NOISY = 0.05  # what the slowest twentieth of equal work took longer
_IDLE = 0.5  # load average
_MOST_ARE_PRECISE = 0.8
_LEAST_FOR_INTERVAL = 6  # repetitions


def doubts_about_times(run: Run, manifest: Manifest) -> list[str]:
    """Why the times are worth little, in clauses; `beambench run` ends with the same."""
    timed = run.rows[run.rows["timed"]]
    doubts = []
    if manifest.noise is not None and manifest.noise > _NOISY:
        doubts.append(f"equal work took up to {manifest.noise:.0%} longer than usual")
    if manifest.load is not None and manifest.load > _IDLE:
        doubts.append(f"other work was running (load {manifest.load:.2f})")
    if manifest.throttling is not None and manifest.throttling.throttled > 0:
        doubts.append(
            f"the kernel throttled the process in {manifest.throttling.throttled} of "
            f"{manifest.throttling.periods} periods of its CPU quota"
        )
    if "stop_reason" in timed and len(timed):
        precise = timed["stop_reason"] == "precision"
        if precise.mean() < _MOST_ARE_PRECISE:
            doubts.append(
                f"{(~precise).sum()} of {len(timed)} timed cells less precise than wanted"
            )
    if "repetitions" in timed:
        few = int((timed["repetitions"] < _LEAST_FOR_INTERVAL).sum())
        if few:
            doubts.append(
                f"{few} of {len(timed)} timed cells repeated fewer than {_LEAST_FOR_INTERVAL} "
                "times, so without intervals"
            )
    return doubts
