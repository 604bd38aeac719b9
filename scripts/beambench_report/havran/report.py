"""Compares our counts with Havran's on one page: ratios, and the order of structures."""

from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.stats import gmean

from beambench_report.base.files import write_text
from beambench_report.base.quantities import markdown_table
from beambench_report.havran.contenders import SCENES, STRUCTURES
from beambench_report.havran.counts import PUBLISHED, read_counts

SIZES = ["N_IN", "N_V", "N_EV", "N_OIV"]
WORK = ["N_IT", "N_TS", "N_ETS", "N_EETS"]
WITHIN = 0.05
"""A relative difference of up to this size needs no explanation."""
APART = 0.02
"""Counts that differ by no more than this fraction are treated as equal."""
_UNLIKE = "gears"
"""Havran's scene of this name differs from ours (results/havran/README.md)."""
_HEAD = """# Havran's octrees, measured again

Counts of five octrees on the seven SPD scenes and lattice, by `beambench census --rules spd
--count`: 513x513 rays through pixel corners, and all rays that follow. In the tables of single
scenes, every cell is our count / Havran's. [results/havran](../../havran/README.md) explains the
quantities. Made by `python -m beambench_report havran`.
"""


def write_report(folder: Path) -> Path:
    """Writes FOLDER/report.md from FOLDER/counts.csv."""
    ours, his = read_counts(folder / "counts.csv"), read_counts(PUBLISHED)
    parts = (_HEAD, _orders(ours, his), _means(ours, his), *_tables(ours, his))
    return write_text(folder / "report.md", "\n".join(parts))


def ratios(ours: pd.DataFrame, his: pd.DataFrame) -> pd.DataFrame:
    """Returns our counts over his, for all common cases; NaN if a count is 0."""
    return (ours / his).where((ours > 0) & (his > 0))[SIZES + WORK].reset_index()


def order(ours: pd.DataFrame, his: pd.DataFrame, quantity: str) -> pd.DataFrame:
    """Returns the pairs of structures, on one scene with one setting, whose counts in `his` differ.

    The columns `ours` and `his` hold the sign of the difference, 0 for equal counts.
    """
    counts = {"ours": ours[quantity], "his": his[quantity]}
    both = pd.concat(counts, axis="columns", join="inner").reset_index()
    both["place"] = both.index
    pairs = both.merge(both, on=["scene", "setting"], suffixes=("", " other"))
    pairs = pairs[pairs["place"] < pairs["place other"]]
    signs = {name: _signs(pairs[name], pairs[f"{name} other"]) for name in counts}
    pairs = pairs[["structure", "structure other"]].assign(**signs)
    return pairs[pairs["his"] != 0]


def _signs(one: pd.Series, other: pd.Series) -> pd.Series:
    differ = (one - other).abs() > APART * np.maximum(one, other)
    return np.sign(one - other).where(differ, 0)


def _orders(ours: pd.DataFrame, his: pd.DataFrame) -> str:
    others = ours.drop(_UNLIKE, level="scene", errors="ignore")
    rows = []
    reversals: Counter[tuple[str, str, str]] = Counter()
    for quantity, (where, cases) in product(WORK, (("all", ours), (f"all but {_UNLIKE}", others))):
        found = order(cases, his, quantity)
        same = (found["ours"] == found["his"]).sum()
        share = f"{same / len(found):.0%}" if len(found) else "-"
        reverse = found[found["ours"] == -found["his"]]
        if cases is others:
            pairs = zip(reverse["structure"], reverse["structure other"], strict=True)
            reversals.update((quantity, *pair) for pair in pairs)
        level = (found["ours"] == 0).sum()
        rows.append((quantity, where, len(found), f"{same} ({share})", level, len(reverse)))
    header = ("quantity", "scenes", "pairs", "same order", f"ours within {APART:.0%}", "reversed")
    worst = [(*pair, number) for pair, number in reversals.most_common()]
    return (
        "## Are the structures in the same order?\n"
        f"Pairs of structures on the same scene at the same depth whose published counts differ by "
        f"more than {APART:.0%}:\n\n{_markdown(header, rows)}\n"
        f"The reversed pairs, on all scenes except {_UNLIKE}:\n\n"
        f"{_markdown(('quantity', 'structure', 'structure', 'scenes and depths'), worst)}"
    )


def _means(ours: pd.DataFrame, his: pd.DataFrame) -> str:
    every = ratios(ours, his)
    tables = [
        _markdown(
            (by, *SIZES, *WORK),
            [
                (name, *(_mean(found.loc[found[by] == name, q]) for q in SIZES + WORK))
                for name in names
            ],
        )
        for by, names, found in (
            ("structure", STRUCTURES, every[every["scene"] != _UNLIKE]),
            ("scene", SCENES, every),
        )
    ]
    return (
        f"## Ours over his\nGeometric means and, in parentheses, how many ratios are within "
        f"{WITHIN:.0%} of 1. The means by structure exclude {_UNLIKE}.\n\n" + "\n".join(tables)
    )


def _mean(values: pd.Series) -> str:
    known = values.dropna()
    within = ((known - 1).abs() <= WITHIN).sum()
    return f"{gmean(known):.3f} ({within}/{len(known)})" if len(known) else "-"


def _tables(ours: pd.DataFrame, his: pd.DataFrame) -> Iterable[str]:
    digits = dict.fromkeys(SIZES, ",.0f") | dict.fromkeys(WORK, ".2f")
    for scene in SCENES:
        rows = [
            (
                *(structure, setting),
                *(f"{mine[q]:{form}} / {theirs[q]:{form}}" for q, form in digits.items()),
            )
            for (structure, where, setting), mine in ours.iterrows()
            if where == scene and (structure, where, setting) in his.index
            for theirs in [his.loc[structure, where, setting]]
        ]
        if rows:
            yield f"## {scene}\n{_markdown(('structure', 'setting', *digits), rows)}"


def _markdown(header: Sequence[str], rows: Iterable[Iterable[object]]) -> str:
    return "\n".join(markdown_table(header, (map(str, row) for row in rows))) + "\n"
