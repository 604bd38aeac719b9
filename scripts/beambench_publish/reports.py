"""The reports in results/published that other commands write from the same rows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from beambench_report.base.records import read_run
from beambench_report.embree_comparison.pairings import pairings
from beambench_report.embree_comparison.report import as_markdown
from beambench_report.run.ratio_table import write_ratios
from beambench_report.run.winners import write_winners

WATERTIGHT = "embree mode=single robust=true coherent=auto"
BEAT_EMBREE = ("main", "scenes", "soup", "avx2", "scaling", "resolutions")
PENCILS = ("shadows", "mirrors", "pictures")


def _winners(folder: Path) -> str:
    return str(write_winners(folder, None))


def _ratios(to: str, folder: Path) -> str:
    return str(write_ratios(folder, to, None))


def _comparison(names: Sequence[str], folder: Path) -> str:
    """With the figures that are drawn beside it, as SVG where they are."""
    runs = [read_run(folder / name) for name in names if (folder / name).is_dir()]
    drawn = list(folder.glob("beat-embree*.svg")) or list(folder.glob("beat-embree*.png"))
    names_of_plots = [path.name for path in sorted(drawn, key=lambda path: path.stem)]
    return as_markdown(pairings(runs), names_of_plots)


REPORTS: dict[str, Callable[[Path], str]] = {
    "beat-embree/report.md": partial(_comparison, BEAT_EMBREE),
    "libraries/embree-4/to-embree.md": partial(_ratios, WATERTIGHT),
    "libraries/to-embree.md": partial(_ratios, WATERTIGHT),
    "libraries/to-tinybvh.md": partial(_ratios, "tinybvh"),
    "pencils/report.md": partial(_comparison, PENCILS),
    "structures/winners.md": _winners,
}
