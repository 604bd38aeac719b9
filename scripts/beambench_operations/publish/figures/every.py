"""All published rows together: for the page over all of them."""

import csv
from dataclasses import dataclass
from pathlib import Path

_RIGHT = ("ok", "baseline", "no_rays", "unsupported")


@dataclass(frozen=True)
class Counted:
    """Cells, and those whose hits are wrong by structure."""

    cells: int
    wrong: dict[str, int]

    @property
    def all_wrong(self) -> int:
        """The number of wrong cells of all structures."""
        return sum(self.wrong.values())


def counted(published: Path) -> Counted:
    """Counts the cells of every results.csv."""
    cells, wrong = 0, {}
    for file in sorted(published.rglob("results.csv")):
        with file.open(encoding="utf-8", newline="") as table:
            for row in csv.DictReader(table):
                cells += 1
                if row["verdict"] not in _RIGHT:
                    wrong[row["structure"]] = wrong.get(row["structure"], 0) + 1
    return Counted(cells, wrong)
