"""Writes the comparison as one page of tables."""

from collections import Counter
from collections.abc import Sequence
from itertools import product
from pathlib import Path

from beambench_report.base.files import write_text
from beambench_report.base.quantities import markdown_table
from beambench_report.havran.comparison import (
    APART,
    QUANTITIES,
    SIZES,
    WITHIN,
    WORK,
    Ratios,
    order,
    ratios,
)
from beambench_report.havran.contenders import SCENES, STRUCTURES
from beambench_report.havran.counts import PUBLISHED, Counts, read_counts

_UNLIKE = "gears"
"""His is another scene: results/havran/README.md."""


def write_report(folder: Path) -> Path:
    """Writes FOLDER/report.md from FOLDER/counts.csv."""
    ours = read_counts(folder / "counts.csv")
    published = read_counts(PUBLISHED)
    parts = (_head(), _orders(ours, published), _means(ours, published), *_tables(ours, published))
    return write_text(folder / "report.md", "\n".join(parts))


def _head() -> str:
    return """# Havran's octrees, measured again

Counts of five octrees on the seven SPD scenes and lattice: 513x513 rays through the corners of
pixels and all rays that follow, `beambench census --rules spd --count`. Every cell is ours / his.
What the quantities mean: [results/havran](../../havran/README.md). Made by
`python -m beambench_report havran`.
"""


def _orders(ours: Counts, published: Counts) -> str:
    others = {case: counts for case, counts in ours.items() if case.scene != _UNLIKE}
    rows = []
    reversals: Counter[tuple[str, str, str]] = Counter()
    for quantity, (where, cases) in product(WORK, (("all", ours), (f"all but {_UNLIKE}", others))):
        found = order(cases, published, quantity)
        share = f"{found.same / found.pairs:.0%}" if found.pairs else "-"
        if cases is others:
            reversals.update((quantity, a.structure, b.structure) for a, b in found.reversed)
        level, reverse = found.level, len(found.reversed)
        rows.append((quantity, where, found.pairs, f"{found.same} ({share})", level, reverse))
    header = ("quantity", "scenes", "pairs", "same order", f"ours within {APART:.0%}", "reversed")
    worst = [(*pair, number) for pair, number in reversals.most_common()]
    return (
        "## Are the structures in the same order?\n"
        f"Each two structures on one scene at one depth whose published counts differ by more than "
        f"{APART:.0%}:\n\n{_markdown(header, rows)}\n"
        f"The reversed ones of all but {_UNLIKE}:\n\n"
        f"{_markdown(('quantity', 'structure', 'structure', 'scenes and depths'), worst)}"
    )


def _means(ours: Counts, published: Counts) -> str:
    others = {case: counts for case, counts in ours.items() if case.scene != _UNLIKE}
    by_structure = [
        (structure, *(_ratio(ratios(others, published, q, structure)) for q in QUANTITIES))
        for structure in STRUCTURES
    ]
    by_scene = [
        (scene, *(_ratio(ratios(ours, published, q, scene=scene)) for q in QUANTITIES))
        for scene in SCENES
    ]
    return (
        f"## Ours over his\nGeometric means, and how many are within {WITHIN:.0%}; by structure "
        f"without {_UNLIKE}.\n\n"
        + _markdown(("structure", *QUANTITIES), by_structure)
        + "\n"
        + _markdown(("scene", *QUANTITIES), by_scene)
    )


def _ratio(found: Ratios | None) -> str:
    return f"{found.mean:.3f} ({found.within}/{len(found.values)})" if found else "-"


def _tables(ours: Counts, published: Counts) -> list[str]:
    parts = []
    for scene in SCENES:
        rows = [
            (
                case.structure,
                case.setting,
                *(_beside(q, ours[case], published[case]) for q in QUANTITIES),
            )
            for case in ours
            if case.scene == scene and case in published
        ]
        if rows:
            table = _markdown(("structure", "setting", *QUANTITIES), rows)
            parts.append(f"## {scene}\n{table}")
    return parts


def _beside(quantity: str, mine: dict[str, float], theirs: dict[str, float]) -> str:
    digits = ",.0f" if quantity in SIZES else ".2f"
    return f"{mine[quantity]:{digits}} / {theirs[quantity]:{digits}}"


def _markdown(header: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    texts = [[str(cell) for cell in row] for row in rows]
    return "\n".join(markdown_table(header, texts)) + "\n"
