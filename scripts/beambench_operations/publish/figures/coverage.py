"""results/published/coverage: two sweeps, each measured twice, and what this changed."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from beambench.analysis import Ratio, geometric_mean
from beambench_report.base.analysis import Analysis, Mean, read_analysis
from beambench_report.base.files import read_json
from beambench_report.base.records import read_run
from beambench_report.embree_comparison.pairings import Pairing, pairings
from beambench_report.run.coverage import coverage

SWEEPS = ("default", "primary-rays")
RUNS = ("first", "second")
_SIZE = "1280x1024"


@dataclass(frozen=True)
class Headline:
    """A figure before and after times were measured in blocks."""

    title: str
    before: Ratio | None
    after: Ratio


def figures(folder: Path) -> dict[str, Any]:
    """Returns the coverage of each sweep, and headlines beside those of the earlier runs."""
    return {
        "sweeps": {name: _coverage(folder / name) for name in SWEEPS},
        "default": _default(folder.parent / "default", folder / "default" / "first"),
        "primary": _primary(
            folder.parent / "beat-embree" / "main", folder / "primary-rays" / "first"
        ),
        "rasterizer": _rasterizer(folder / "primary-rays" / "first"),
        "isa": [_isa(folder.parent / "default"), _isa(folder / "default" / "first")],
    }


def _coverage(folder: Path) -> dict[str, Any]:
    wanted = float(read_json(folder / RUNS[0] / "config.json")["precision"])
    runs = [(read_run(folder / name), read_analysis(folder / name)) for name in RUNS]
    return {
        "rows": coverage(*runs),
        "reasons": [analysis.reasons_for_care for _, analysis in runs],
        "precise": [_precise(folder / name, wanted) for name in RUNS],
        "wanted": wanted,
    }


def _precise(folder: Path, wanted: float) -> tuple[int, int]:
    """Returns how many timed cells are as precise as the sweep wants, and all of them."""
    rows = read_run(folder).rows
    timed = rows[rows["timed"]]
    width = (timed["trace_ms_pi_high"] - timed["trace_ms_pi_low"]) / timed["trace_ms"]
    return int((width <= 2 * wanted).sum()), len(timed)


def _default(before: Path, after: Path) -> list[Headline]:
    """Returns the mean of each contender at the finest resolution, its structure's best before."""
    old, new = read_analysis(before), read_analysis(after)
    return [
        Headline(mean.contender, _best(old, mean.structure), mean.ratio)
        for mean in _means(new)
        if mean.views == new.means[0].views
    ]


def _means(analysis: Analysis) -> Sequence[Mean]:
    return analysis.means[0].means


def _best(analysis: Analysis, structure: str) -> Ratio | None:
    found = [mean.ratio for mean in _means(analysis) if mean.structure == structure]
    return min(found, key=lambda ratio: ratio.value, default=None)


def _primary(before: Path, after: Path) -> list[Headline]:
    """Returns Embree's time over that of tile-beam, scene by scene and in the mean."""
    old = {pair.scene: pair.ratio for pair in _drawn(before)}
    lines = [
        Headline(f"`{pair.scene}`", old[pair.scene], pair.ratio)
        for pair in _drawn(after)
        if pair.scene in old
    ]
    mean = Headline(
        "geometric mean",
        geometric_mean([line.before for line in lines if line.before]),
        geometric_mean([line.after for line in lines]),
    )
    return [*lines, mean]


def _drawn(folder: Path) -> list[Pairing]:
    """Returns the comparisons that draw the backs of solids, at one resolution."""
    found = pairings([read_run(folder)])
    return [pair for pair in found if pair.resolution == _SIZE and not pair.is_culled]


def _isa(folder: Path) -> str:
    """Returns the instruction set that tile-beam used in a run."""
    rows = read_run(folder).rows
    return str(rows.loc[rows["structure"] == "tile-beam", "structure_isa"].iloc[0])


def _rasterizer(folder: Path) -> dict[str, float]:
    """Returns the rasterizer's time over that of tile-beam, by scene."""
    rows = read_run(folder).rows
    tile = rows[rows["parameters"].str.contains("backface_culling=false")]
    times = tile.set_index("scene")["trace_ms"]
    other = rows[rows["structure"] == "z-buffer"].set_index("scene")["trace_ms"]
    return (other / times).dropna().to_dict()
