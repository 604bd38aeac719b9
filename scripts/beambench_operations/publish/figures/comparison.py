"""Figures of tile beams compared with Embree's fastest mode, as the texts state them."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from beambench_operations.publish.figures.formats import brief, interval
from beambench_operations.publish.figures.origins import require_one_origin
from beambench_report.base.records import read_run
from beambench_report.embree_comparison.pairings import Pairing, pairings
from beambench_report.embree_comparison.results import Result, outcomes_in_words, results


def read_pairings(folder: Path, names: Sequence[str]) -> list[Pairing]:
    """Returns the comparisons in a folder's runs of these names, if they exist."""
    runs = [run for name in names if (run := folder / name / "results.csv").is_file()]
    require_one_origin(*(run.parent for run in runs))
    return pairings(read_run(run.parent) for run in runs)


def figures_of(found: Sequence[Pairing]) -> dict[str, Any]:
    """Returns the groups of scenes by title, with ratios at each resolution, and the counts."""
    best, avx2 = ({one.group.title: one for one in results(found, isa)} for isa in ("best", "avx2"))
    return {
        "groups": best,
        "avx2": avx2,
        "targets": outcomes_in_words(list(best.values())),
        "targets_avx2": outcomes_in_words(list(avx2.values())),
        "marked": marked,
        "with_target": with_target,
    }


def marked(one: Result) -> str:
    """Formats a ratio and its target: bold if missed, in italics if open."""
    mark = {"missed": "**", "open": "*"}.get(one.outcome, "")
    target = "" if one.target is None else f", target {one.target:g}"
    return f"{mark}{brief(one.ratio)}{mark}{target}{' †' * one.is_culled}"


def with_target(one: Result, size: str = "") -> str:
    """Formats a mean with its interval, its target and whether it is met; `size` is added in a
    sentence.
    """
    at = f" at {size}" if size else ""
    target = "" if one.target is None else f", target {one.target:g}: {one.outcome}"
    return f"{interval(one.ratio)}{at}{target}{' †' * one.is_culled}"
