"""The page of the referee's table."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from beambench_operations.referee.findings import Counterexample, wrong_rays

HEADER = """# Hits of other projects' libraries

Every library traced the same rays over the same scenes of triangles: beambench's
[conformance kit](../../../harness/verify/README.md#the-conformance-kit), {scenes} scenes, closest
and any hits. A `wrong` hit is beyond the tolerance of float arithmetic (K u, 16 units in the last
place), by exact arithmetic. A `leak` is a miss at an edge of a closed mesh, seen from inside.
Other grazes, where a ray passes an edge within K u, count as right. [referee.csv](referee.csv) has
the counts of each family and query.

"Right" is the share of rays with a right result, of those that the library traces. The families
under "wrong in" have at least one wrong or leaked ray; in those under "fails in" the library
crashed or did not return in time; it declines those under "declines". The
[adapters](../../../harness/plugin/outside) state the precision, and what a call does besides
tracing.

| library | version | rays | right: closest | any | wrong | leaks | wrong in | fails in | declines |
|---|---|---:|---:|---:|---:|---:|---|---|---|
"""

CASES = """
## The smallest counterexample of each

Each folder has the scene, the ray and `case.json`. The exact answer was computed again in rational
numbers, by code that the judge does not use
([exact_ray.py](../../../scripts/beambench_operations/referee/exact_ray.py)).

| library | triangles | reported | exact | confirmed | repeat |
|---|---:|---|---|---|---|
"""

REPEAT = """
Repeat all of it: `scripts/outside NAME` prints the plug-in of a library, and

```
beambench selftest --export kit --scenes {random} --rays {rays}
PYTHONPATH=scripts python3 -m beambench_operations.referee NAME=PLUGIN ... --kit kit \\
    --output results/published/referee
```
"""


def share(rows: list[dict[str, Any]], query: str) -> str:
    """Returns the share of right results of a query, rounded so that only all are 100%."""
    chosen = [row for row in rows if row["query"] == query]
    rays = sum(row["rays"] for row in chosen)
    wrong = sum(map(wrong_rays, chosen))
    if rays == 0:
        return "unsupported"
    if wrong == 0:
        return "100%"
    return f"{min(100 * (1 - wrong / rays), 99.9999):.4f}%"


def families(rows: list[dict[str, Any]], chosen: Callable[[dict[str, Any]], bool]) -> str:
    """Returns the names of the families of the rows that are chosen, each once."""
    return ", ".join(dict.fromkeys(row["family"] for row in rows if chosen(row))) or "-"


def library_row(name: str, rows: list[dict[str, Any]]) -> str:
    """Returns the line of a library in the table."""
    cells = [
        name,
        rows[0]["version"],
        f"{sum(row['rays'] for row in rows):,}",
        share(rows, "closest"),
        share(rows, "any"),
        f"{sum(row['structure_error'] for row in rows):,}",
        f"{sum(row['leaks'] for row in rows):,}",
        families(rows, lambda row: wrong_rays(row) > 0),
        families(rows, lambda row: row["errors"] > 0),
        families(rows, lambda row: row["unsupported"] > 0),
    ]
    return "| " + " | ".join(cells) + " |\n"


def page(
    rows: dict[str, list[dict[str, Any]]],
    found: dict[str, Counterexample | None],
    kit: dict[str, int],
) -> str:
    """Returns the page; `rows` and `found` are by library."""
    text = HEADER.format(**kit) + "".join(library_row(name, rows[name]) for name in rows)
    text += CASES
    for name, case in found.items():
        if case is None:
            text += f"| {name} | - | - | - | - | - |\n"
            continue
        place = f"minimal/{case.folder}"
        files = f"{place}/scene.obj --accel {name} --rays {place}/ray.rays"
        command = f"`beambench --plugin PLUGIN verify {files}`"
        text += (
            f"| [{name}]({place}/case.json) | {case.triangles} | {case.reported} | {case.exact} | "
            f"{'yes' if case.confirmed else 'no'} | {command} |\n"
        )
    return text + REPEAT.format(**kit)
