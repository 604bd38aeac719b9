"""The command `python -m beambench_report embree-comparison RUN... [-o FILE.md]`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from beambench_report.base.figure import house_style, write_plot
from beambench_report.base.files import Problem, write_text
from beambench_report.base.records import read_run
from beambench_report.embree_comparison.pairings import Duel, duels
from beambench_report.embree_comparison.plots import plots
from beambench_report.embree_comparison.report import as_markdown


def beat_text(runs: Sequence[Path]) -> str:
    """As Markdown, without its figures."""
    return as_markdown(_duels_of(runs))


def write_beat(runs: Sequence[Path], file: Path) -> list[Path]:
    """Writes FILE.md, and its figures beside it."""
    found = _duels_of(runs)
    with house_style():
        drawn = plots(found)
        figures = [path for plot in drawn for path in write_plot(plot, file.parent)]
    text = as_markdown(found, [f"{plot.stem}.png" for plot in drawn])
    return [write_text(file, text), *figures]


def _duels_of(runs: Sequence[Path]) -> list[Duel]:
    """Raises Problem where a run cannot be read, or none has both."""
    found = duels(read_run(run) for run in runs)
    if not found:
        names = ", ".join(str(run) for run in runs)
        raise Problem(
            f"{names}: no image was traced rightly by tile-beam and by embree; measure "
            "harness/bench/sweeps/beat-embree.json"
        )
    return found
