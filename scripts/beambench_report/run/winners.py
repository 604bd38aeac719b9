"""Finds the structure that wins in each view, every structure with its best parameters.

The analysis of a run ranks every contender. Here a structure counts once, with the parameters and
the order of the rays that give it the least trace time in the view. Ties with the fastest are
decided by `Ratio.rank`, as in the analysis. If a ratio has no interval, because a cell was repeated
too seldom, the times decide.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from scipy.stats import gmean

from beambench_report.base.cell_files import CellFile, Identity, ratio_of, read_cell_files
from beambench_report.base.files import Problem, write_text
from beambench_report.base.quantities import markdown_table, number
from beambench_report.base.records import REFERENCES, contenders_with_times, read_run

_VIEW = ["scene", "camera", "width", "height", "machine_id"]


@dataclass(frozen=True)
class Race:
    """The structures in one view for one kind of rays, the fastest first."""

    scene: str
    ray_kind: str
    ranked: pd.DataFrame
    """The best rows of the structures, with the columns of `with_ratios`."""

    @property
    def tied(self) -> list[str]:
        """Returns the fastest structure and the structures tied with it."""
        return list(self.ranked.loc[self.ranked["is_tied"], "structure"])

    @property
    def is_decided(self) -> bool:
        """Whether the second is known to be tied with the fastest, or behind it."""
        return len(self.ranked) < 2 or self.ranked["rank"].iloc[1] in ("tied", "behind")

    @property
    def words(self) -> str:
        """Formats the winners and the next structure: `sah-bvh; 1.31 kd-tree`."""
        tied = self.tied
        others = self.ranked[~self.ranked["structure"].isin(tied)]
        text = ", ".join(f"`{name}`" for name in tied)
        if others.empty:
            return text
        second = others.iloc[0]
        note = ", undecided" * (second["rank"] == "undecided")
        return f"{text}; {second['ratio']:.2f} `{second['structure']}`{note}"


def races(rows: pd.DataFrame, files: Mapping[Identity, CellFile]) -> list[Race]:
    """Returns the winners of all views and kinds of rays, in the order of the rows."""
    timed = contenders_with_times(rows)
    timed = timed[~timed["structure"].isin(REFERENCES)]
    found = []
    for (scene, _, _, _, _, kind), group in timed.groupby([*_VIEW, "kind"], sort=False):
        best = group.loc[group.groupby("structure")["trace_ms"].idxmin()]
        found.append(Race(str(scene), str(kind), with_ratios(best, files)))
    return found


def with_ratios(rows: pd.DataFrame, files: Mapping[Identity, CellFile]) -> pd.DataFrame:
    """Returns the rows of one view, the fastest first, compared with the fastest.

    `ratio` is the ratio of the trace times, as in the plots. `is_tied` is true for the fastest and
    for rows with the `rank` "tied".
    """
    ranked = rows.sort_values("trace_ms")
    fastest = ranked.iloc[0]
    ratios = [ratio_of("trace", row, fastest, files) for _, row in ranked.iterrows()]
    return ranked.assign(
        ratio=[ratio.value for ratio in ratios],
        rank=[ratio.rank for ratio in ratios],
        is_tied=[place == 0 or ratio.rank == "tied" for place, ratio in enumerate(ratios)],
    )


def write_winners(run: Path, output: Path | None = None) -> str | list[Path]:
    """Returns the tables as Markdown, or the file that was written."""
    found = races(read_run(run).rows, read_cell_files(run))
    if not found:
        raise Problem(f"{run}: no structure has times; a run with correct hits is needed")
    text = "\n".join((*_by_structure(found), _by_scene(found)))
    return [write_text(output, text)] if output else text


def _by_structure(found: Sequence[Race]) -> list[str]:
    parts = []
    for kind in dict.fromkeys(race.ray_kind for race in found):
        of_kind = [race for race in found if race.ray_kind == kind]
        rows = pd.concat([race.ranked for race in of_kind])
        table = sorted(
            (float(gmean(group["ratio"])), str(name), group)
            for name, group in rows.groupby("structure")
        )
        lines = markdown_table(
            ("structure", "times the fastest", "fastest or tied", "build, ms",
             "bytes per primitive", "best parameters"),
            [
                (
                    f"`{name}`",
                    f"{mean:.2f}",
                    f"{group['is_tied'].sum()} of {len(of_kind)}"
                    + ("" if len(group) == len(of_kind) else f" (in {len(group)})"),
                    number(group["build_ms_median"].median()),
                    number((group["memory_bytes"] / group["primitives"]).median()),
                    "; ".join(
                        f"{label} ({times})"
                        for label, times in Counter(group["contender"]).most_common(3)
                    ),
                )
                for mean, name, group in table
            ],
            right=(1, 3, 4),
        )  # fmt: skip
        parts.append(f"## {kind} rays, {len(of_kind)} views\n\n" + "\n".join(lines) + "\n")
    return parts


def _by_scene(found: Sequence[Race]) -> str:
    kinds = list(dict.fromkeys(race.ray_kind for race in found))
    words = {(race.scene, race.ray_kind): race.words for race in reversed(found)}
    scenes = dict.fromkeys(race.scene for race in found)
    rows = [(scene, *(words.get((scene, kind), "-") for kind in kinds)) for scene in scenes]
    lines = markdown_table(("scene", *kinds), rows)
    return (
        "## By scene\n\nThe fastest structures, including ties, and the next one with its ratio. "
        "Ties are decided by the 95% confidence interval of the ratio of the times, "
        "as in the analysis of a run.\n\n" + "\n".join(lines) + "\n"
    )
