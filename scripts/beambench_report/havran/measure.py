"""Measures Havran's octrees again: sizes, and the work of all rays of whole pictures."""

from pathlib import Path

from beambench_report.base.files import say
from beambench_report.havran.census import Census, census_of
from beambench_report.havran.contenders import STRUCTURES, contender_of
from beambench_report.havran.counts import PUBLISHED, Case, read_counts, write_counts


def quantities_of(census: Census) -> dict[str, float]:
    """His quantities; steps and tests are as he counts them (results/havran/README.md)."""
    size, work = census["size"], census["work"]
    rays = work["rays"]
    return {
        "N_IN": size["nodes"] - size["leaves"],
        "N_V": size["leaves"],
        "N_EV": size["empty_leaves"],
        "N_OIV": size["references"],
        "N_IT": work["primitive_tests"] / work["rays_that_hit"],
        "N_TS": (work["traversal_steps"] + work.get("last_climb", 0)) / rays,
        "N_ETS": work["leaves"] / rays,
        "N_EETS": work["empty_leaves"] / rays,
    }


def measure(folder: Path, program: Path, scenes: list[str]) -> list[Path]:
    """Counts on these scenes into FOLDER/counts.csv; skips what FOLDER/census has already."""
    folder.joinpath("census").mkdir(parents=True, exist_ok=True)
    published = read_counts(PUBLISHED)
    cases = [
        case
        for structure in STRUCTURES
        for case in published
        if case.structure == structure and case.scene in scenes
    ]
    counted = []
    for number, case in enumerate(cases, start=1):
        contender = contender_of(case.structure, case.setting)
        say(f"{number} of {len(cases)}: {case.scene}, {contender}")
        file = folder / "census" / f"{_file_name(case)}.json"
        census = census_of(file, program, case.scene, contender)
        counted.append((case, contender, quantities_of(census)))
    return [write_counts(folder / "counts.csv", counted)]


def _file_name(case: Case) -> str:
    return "-".join((case.scene, *case.setting.split(), str(STRUCTURES.index(case.structure))))
