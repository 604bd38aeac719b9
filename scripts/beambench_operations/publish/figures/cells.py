"""The rows of one published run, and ratios of its contenders with their intervals."""

from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd

from beambench.analysis import Ratio, geometric_mean
from beambench_report.base.cell_files import CellFile, Identity, ratio_of, read_cell_files
from beambench_report.base.files import Problem
from beambench_report.base.names import parameter_items
from beambench_report.base.records import FAULTLESS_VERDICTS, read_run

Phase = Literal["total", "trace"]


class Cells:
    """The rows of a run.

    Contenders are named as in sweeps, with the parameters that differ: `samet:max_level=6`.
    """

    def __init__(self, folder: Path) -> None:
        """Reads the rows. Raises Problem if FOLDER/results.csv cannot be read."""
        self.folder = folder
        rows = read_run(folder).rows
        sizes = rows["width"].map("{:.0f}".format) + "x" + rows["height"].map("{:.0f}".format)
        self.rows = rows.assign(size=sizes, scene=rows["scene"])

    @cached_property
    def files(self) -> dict[Identity, CellFile]:
        """The repetitions of each cell, if they are published."""
        return read_cell_files(self.folder)

    def having(self, contender: str = "", **columns: str) -> pd.DataFrame:
        """Returns the rows of a contender, or of all, with these values; may be empty."""
        # A single selection, because each one copies all columns.
        wanted = [self.rows[name] == value for name, value in columns.items()]
        if contender:
            wanted.append(self._is(contender))
        return self.rows[np.logical_and.reduce(wanted)] if wanted else self.rows

    def row(self, contender: str, **columns: str) -> pd.Series:
        """Returns the matching row with times. Raises Problem unless there is exactly one."""
        found = self.having(contender, **columns)
        found = found[found["timed"]]
        if len(found) != 1:
            raise Problem(
                f"{self.folder}/results.csv: {len(found)} rows of {contender} have times at "
                f"{columns}, but one was expected; name what distinguishes it"
            )
        return found.iloc[0]

    def ratio(self, over: str, under: str, phase: Phase = "trace", **columns: str) -> Ratio:
        """Returns a contender's time over another's, paired if the repetitions are published."""
        both = (self.row(contender, **columns) for contender in (over, under))
        return ratio_of(phase, *both, self.files)

    def mean(self, over: str, under: str, **columns: str) -> Ratio:
        """Returns the geometric mean of `ratio` over all scenes."""
        return geometric_mean(
            [self.ratio(over, under, scene=scene, **columns) for scene in self.scenes]
        )

    @property
    def scenes(self) -> list[str]:
        """The scenes in the order of the rows."""
        return list(dict.fromkeys(self.rows["scene"]))

    @property
    def sizes(self) -> list[str]:
        """The resolutions, the lowest first."""
        return list(dict.fromkeys(self.rows.sort_values("rays")["size"]))

    @property
    def wrong(self) -> pd.DataFrame:
        """The rows whose hits are not correct."""
        return self.rows[~self.rows["verdict"].isin(FAULTLESS_VERDICTS)]

    def _is(self, contender: str) -> pd.Series:
        structure, _, text = contender.partition(":")
        wanted = parameter_items(text).items()
        parameters = self.rows["parameters"]
        those = [own for own in parameters.unique() if wanted <= parameter_items(own).items()]
        return (self.rows["structure"] == structure) & parameters.isin(those)


def counted(published: Path) -> dict[str, Any]:
    """Counts the cells of every results.csv, and those with wrong hits by structure."""
    columns = ["structure", "verdict"]
    rows = pd.concat(
        pd.read_csv(file, usecols=columns, keep_default_na=False)
        for file in sorted(published.rglob("results.csv"))
    )
    wrong = rows.loc[~rows["verdict"].isin(FAULTLESS_VERDICTS), "structure"]
    by_structure = wrong.groupby(wrong, sort=False).size().to_dict()
    return {"cells": len(rows), "all_wrong": len(wrong), "wrong": by_structure}
