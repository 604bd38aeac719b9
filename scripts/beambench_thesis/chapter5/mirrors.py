"""Beams reflected by planar mirrors, the thesis's future work (`beambench mirrors --json`)."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from beambench_report.base.files import load_json
from beambench_report.base.published import rays
from beambench_report.base.quantities import number
from beambench_thesis.paper.printed import title_of
from beambench_thesis.paper.section import Section, section_table


@dataclass(frozen=True)
class MirrorRun:
    """The reflections in all mirrors of a picture, by single rays and by beams in one octree."""

    scene: str
    structure: str
    resolution: str
    mirrors: int
    """The number of visible mirrors."""
    samples: int
    different: int
    """The number of hits that differ between beams and rays."""
    rays_ms: float
    beams_ms: float

    @property
    def ratio(self) -> float:
        """Returns the time of single rays over that of beams."""
        return self.rays_ms / self.beams_ms


def read_mirrors(files: Iterable[Path]) -> tuple[list[MirrorRun], list[str]]:
    """Returns the readable runs, and a sentence for each file that cannot be shown."""
    found, unread = [], []
    for file in files:
        try:
            found.append(_run_of(load_json(file)))
        except (ValueError, KeyError, TypeError, OSError) as error:
            unread.append(f"{file}: is not what `beambench mirrors --json` prints ({error})")
    return found, unread


def mirrors_section(runs: Sequence[MirrorRun]) -> Section | None:
    """Returns the section, scene by scene; None if there are no runs."""
    if not runs:
        return None
    words = (
        "All rays reflected by a planar mirror seem to come from one point, the mirror image of "
        "the eye (Heckbert and Hanrahan 1984). The thesis proposes to trace them as beams (section "
        "7.3). `beam` does this in whole pictures (`render --shade whitted --accel beam`) and in "
        "this table, which has the time of single rays relative to that of beams through the same "
        "octree. The hits are those of single rays, bit for bit."
    )
    ordered = sorted(runs, key=lambda run: (run.scene, rays(run.resolution), run.structure))
    rows = [
        (
            title_of(run.scene),
            run.resolution,
            f"`{run.structure}`",
            f"{run.mirrors}",
            f"{run.samples:,}",
            number(run.rays_ms),
            number(run.beams_ms),
            number(run.ratio),
        )
        for run in ordered
    ]
    table = section_table(
        "Reflections in planar mirrors",
        ("scene", "resolution", "structure"),
        ("mirrors seen", "rays", "rays, ms", "beams, ms", "rays over beams"),
        rows,
    )
    return Section("mirrors", "Beams reflected by mirrors", (words,), (table,), (), _findings(runs))


def _findings(runs: Sequence[MirrorRun]) -> tuple[str, ...]:
    faster = sum(run.ratio > 1 for run in runs)
    ratios = sorted(run.ratio for run in runs)
    wrong = sum(run.different for run in runs)
    return (
        f"Beams take less time than single rays in {faster} of {len(runs)} rows "
        f"({number(ratios[0])} to {number(ratios[-1])} times as fast; medians without intervals).",
        f"Hits that differ: {wrong:,} of {sum(run.samples for run in runs):,}.",
    )


def _run_of(source: dict[str, Any]) -> MirrorRun:
    seen = source["seen"]
    sums = {name: sum(part[name] for part in seen) for name in ("rays_ms", "beams_ms")}
    if not all(time > 0 for time in sums.values()):
        raise ValueError("times must be positive")
    return MirrorRun(
        *(str(source[name]) for name in ("scene", "structure", "resolution")),
        len(seen),
        sum(int(part["samples"]) for part in seen),
        sum(int(part["different"]) for part in seen),
        **sums,
    )
