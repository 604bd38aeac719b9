"""Does a repeated sweep find the medians of the first one again?"""

from dataclasses import dataclass

import pandas as pd

from beambench_report.base.cell_files import IDENTITY
from beambench_report.base.files import Problem
from beambench_report.base.machine import machine_of
from beambench_report.base.records import Run


@dataclass(frozen=True)
class Repeatability:
    """The cells that two runs have in common, with times and an interval in the first."""

    cells: (
        pd.DataFrame
    )  # identity, total_mcycles_median of both, the interval of the first, `within`

    @property
    def share(self) -> float:
        """The part of the cells whose second median lies within the first one's interval."""
        return float(self.cells["within"].mean())

    def summary(self) -> str:
        """A sentence, then the cells that were not found again, the farthest off first."""
        within, count = int(self.cells["within"].sum()), len(self.cells)
        lines = [
            f"{within} of {count} medians ({100 * self.share:.1f}%, in clock cycles) of the second "
            "run lie within the intervals that the first one states for a repeat."
        ]
        missed = self.cells[~self.cells["within"]].sort_values("change", key=abs, ascending=False)
        for _, cell in missed.iterrows():
            lines.append(
                f"{cell['change']:+.1%}  {cell['view']}, {cell['width']:.0f}x{cell['height']:.0f}, "
                f"{cell['contender']}: {cell['total_mcycles_median_b']:.4g} million cycles are "
                f"not in {cell['total_mcycles_pi_low']:.4g} to "
                f"{cell['total_mcycles_pi_high']:.4g}"
            )
        return "\n".join(lines)


def repeatability(first: Run, second: Run) -> Repeatability:
    """Compares cell by cell. Raises Problem when none can be, or the runs are of two machines."""
    machines = [machine_of(run.rows, run.directory) for run in (first, second)]
    if machines[0].differs_from(machines[1]):
        raise Problem(
            f"{first.directory} is of machine {machines[0]}, {second.directory} of {machines[1]}: "
            "a run is repeated on one machine; ratios of two are compared by `diff`"
        )
    keys = list(IDENTITY)
    again = second.rows[second.rows["timed"]][[*keys, "total_mcycles_median"]]
    known = first.rows[first.rows["timed"] & first.rows["total_mcycles_pi_low"].notna()]
    cells = known.merge(again, on=keys, suffixes=("", "_b"), validate="one_to_one")
    if cells.empty:
        raise Problem(
            f"{first.directory} and {second.directory} have no cell in common that has times and "
            "an interval; give two runs of one sweep"
        )
    repeated = cells["total_mcycles_median_b"]
    cells["change"] = repeated / cells["total_mcycles_median"] - 1.0
    cells["within"] = repeated.between(
        cells["total_mcycles_pi_low"], cells["total_mcycles_pi_high"]
    )
    return Repeatability(cells)
