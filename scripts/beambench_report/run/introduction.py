"""Introduces a run at the head of its page: what was traced, how much, and the references."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import pandas as pd

from beambench.analysis import MARGIN
from beambench_report.base.analysis import Analysis, Overall, Overhead, Standings
from beambench_report.base.records import REFERENCES, Run, size_of

_MOST_SIZES = 4
_PRIMITIVES = {
    "triangles": "polygons",
    "points": "spheres",
    "callbacks": "cones or spheres seen from the inside",
}
"""Kinds of primitives by the types in which Embree holds them (column `library_geometry`)."""


@dataclass(frozen=True)
class Tile:
    """A figure with its words; `term` is the glossary's entry for the words."""

    figure: str
    words: str
    term: str = ""
    note: str = ""


def tiles(run: Run, overheads: Sequence[Overhead]) -> list[Tile]:
    """Returns the size of the run and the largest share of the harness, as figures."""
    of_references = run.rows["structure"].isin(REFERENCES)
    references = list(dict.fromkeys(run.rows.loc[of_references, "contender"]))
    counted = {
        "view": (run.rows["subject"].nunique(), ""),
        "contender": (run.rows.loc[~of_references, "contender"].nunique(), ""),
        "reference": (len(references), f"({', '.join(references)})"),
    }
    made = [
        Tile(f"{count:,}", _plural(term, count), term, note)
        for term, (count, note) in counted.items()
        if count or term != "reference"
    ]
    for one in overheads[:1]:
        figure = f"{100 * one.part:,.0f}%" if one.part >= 0.1 else f"{100 * one.part:.2g}%"
        made.append(Tile(figure, f"is the harness's largest share of a trace: {one.title}"))
    return made


def headline(analysis: Analysis) -> list[str]:
    """Names the fastest contender and its margin, for each kind of rays, over all its views."""
    # In records of one process, the order of contenders is not a claim.
    verb = "is the fastest" if analysis.has_blocks else "takes the least time"
    sentences = [_over_views(kind, verb) for kind in analysis.means if kind.views > 1]
    if not sentences and len(analysis.views) == 1:
        sentences = [_in_view(analysis.views[0], verb)]
    return [sentence for sentence in sentences if sentence]


def _over_views(kind: Overall, verb: str) -> str:
    everywhere = [mean for mean in kind.means if mean.views == kind.views]
    if len(everywhere) < 2:
        return ""
    first, second = everywhere[:2]
    wins = f"fastest or tied in {first.wins} of {kind.views} views of {kind.ray_kind} rays"
    margin = second.ratio.value / first.ratio.value
    if margin <= 1 + MARGIN:
        return (
            f"{first.contender} and {second.contender} are equally fast on average; "
            f"{first.contender} is {wins}."
        )
    return (
        f"{first.contender} {verb} on average, {_times(margin)} faster than the next, "
        f"{second.contender}; it is {wins}."
    )


def _in_view(view: Standings, verb: str) -> str:
    if not view.fastest or view.undecided or not view.behind:
        return ""
    if view.tied:
        names = _listed(one.name for one in (view.fastest, *view.tied))
        return f"{names} are tied for the fastest."
    return (
        f"{view.fastest.name} {verb}, {_times(view.behind.ratio.value)} faster than the "
        f"next, {view.behind.name}."
    )


def _times(factor: float) -> str:
    return f"{factor:.3g}x"


def traced(rows: pd.DataFrame) -> str:
    """Returns text like `Primary rays · 320x200, 640x480 · 1 sample per pixel · 1 thread`."""
    sized = rows.sort_values("rays").drop_duplicates(["width", "height"])
    sizes = [size_of(row) for _, row in sized.iterrows()]
    if len(sizes) > _MOST_SIZES:
        sizes = [f"{len(sizes)} resolutions from {sizes[0]} to {sizes[-1]}"]
    kinds = _listed(dict.fromkeys(rows["kind"]))
    is_sorted = bool((rows["kind"] != rows["ray_kind"]).any())
    return " · ".join(
        (
            f"{kinds[:1].upper()}{kinds[1:]} rays{', also sorted' * is_sorted}",
            ", ".join(sizes),
            _counts(rows["samples"], "sample", " per pixel"),
            _counts(rows["threads"], "thread"),
        )
    )


def kinds_of_primitives(rows: pd.DataFrame) -> str:
    """Returns the kinds of a scene's primitives; empty unless Embree's rows state them."""
    if "library_geometry" not in rows:
        return ""
    types = {one for text in rows["library_geometry"] for one in str(text).split("+")}
    return _listed(words for name, words in _PRIMITIVES.items() if name in types)


_NULL_DOES = {
    "image-single": "makes every ray one by one",
    "image-simd": "makes the rays in packets by SIMD",
    "list": "reads the rays one by one",
    "list-packed": "reads the rays in packets by SIMD",
}
_BY_SIMD = {"image-simd": "made", "list-packed": "read"}


def about_references(rows: pd.DataFrame) -> list[str]:
    """Explains the references, and for which contenders the time of `null` is not a lower limit."""
    paths = rows["query_path"] if "query_path" in rows else pd.Series("", index=rows.index)
    is_null = rows["structure"] == "null"
    own = set(paths[is_null])
    clauses = []
    if is_null.any():
        does = [words for path, words in _NULL_DOES.items() if path in own]
        clauses.append(f"null {' or '.join(does)}{' and ' if does else ''}finds nothing")
    if (rows["structure"] == "exhaustive").any():
        clauses.append("exhaustive tests every primitive with every ray")
    if not clauses:
        return []
    sentences = [f"References do not compete: {'; '.join(clauses)}."]
    others = rows["structure"][~is_null]
    unbound = []
    if samplers := _listed(dict.fromkeys(others[paths == "image-own"])):
        unbound.append(
            f"for {samplers}, whose own samples replace these rays (query path image-own)"
        )
    packers = _listed(dict.fromkeys(others[paths.isin(_BY_SIMD)]))
    if packers and own.isdisjoint(_BY_SIMD):
        verbs = " or ".join(verb for path, verb in _BY_SIMD.items() if (paths == path).any())
        unbound.append(f"for {packers}, whose rays are {verbs} in packets by SIMD")
    if unbound and is_null.any():
        sentences.append(f"The time of null is not a lower limit {', or '.join(unbound)}.")
    return sentences


def _counts(column: pd.Series, word: str, after: str = "") -> str:
    values = [int(value) for value in sorted(column.dropna().unique())]
    if not values:
        return f"{word}s{after} not recorded"
    figures = _listed(f"{value:,}" for value in values)
    return f"{figures} {_plural(word, values[-1])}{after}"


def _listed(words: Iterable[str]) -> str:
    """Joins words: `a`, `a and b`, `a, b and c`."""
    *first, last = [*words] or [""]
    return f"{', '.join(first)} and {last}" if first else last


def _plural(word: str, count: int) -> str:
    return word if count == 1 else f"{word}s"
