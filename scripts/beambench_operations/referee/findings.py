"""The findings for a library: rows by family, and its smallest counterexample."""

from __future__ import annotations

import csv
import json
import re
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any

from beambench_operations.referee.exact_ray import Triangle, closest, vector

COUNTS = ("rays", "agree", "tie", "graze", "structure_error", "embree_error", "leaks")
COLUMNS = ("library", "version", "family", "query", "cases", "unsupported", "errors",
           *(name.replace("embree", "oracle") for name in COUNTS))  # fmt: skip
"""The columns of referee.csv."""


def read_rows(path: Path) -> list[list[dict[str, Any]]]:
    """Returns the rows of referee.csv, a list for each library and version."""
    with path.open(encoding="utf-8", newline="") as file:
        rows = [
            {name: text if name in COLUMNS[:4] else int(text) for name, text in row.items()}
            for row in csv.DictReader(file)
        ]
    return [
        list(group) for _, group in groupby(rows, key=lambda row: (row["library"], row["version"]))
    ]


def place_of(library: str, version: str) -> str:
    """Returns the name of the folder with the counterexample of a version of a library."""
    number = re.search(r"(?<=\s)\d[\w.]*", version)
    return re.sub(r"[^\w.-]+", "-", f"{library}-{number[0] if number else version}")


def rows_of(library: str, version: str, cases: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Returns a row of referee.csv for each family and query."""
    rows: dict[tuple[str, str], dict[str, Any]] = {}
    for case in cases:
        empty = {"library": library, "version": version, "family": case["family"],
                 "query": case["query"], **dict.fromkeys(COLUMNS[4:], 0)}  # fmt: skip
        row = rows.setdefault((case["family"], case["query"]), empty)
        row["cases"] += 1
        row["unsupported"] += case["verdict"] == "unsupported"
        row["errors"] += case["verdict"] == "error"
        for name in COUNTS:
            row[name.replace("embree", "oracle")] += case[name]
    return list(rows.values())


def crashed_case(name: str, family: str, query: str, how: str) -> dict[str, Any]:
    """Returns a case over whose scene the library crashed."""
    return {"name": f"{name}, {query}", "family": family, "query": query, "verdict": "error",
            "message": how, "primitives": 0, **dict.fromkeys(COUNTS, 0)}  # fmt: skip


def wrong_rays(row: dict[str, Any]) -> int:
    """Returns the number of rays with a wrong result: wrong hits, and leaks of closed meshes."""
    return int(row["structure_error"]) + int(row["leaks"])


@dataclass(frozen=True)
class Counterexample:
    """A ray that a library gets wrong, with as few triangles as possible."""

    folder: str
    leak: bool
    """Whether it is a leak out of a closed mesh rather than a wrong hit."""
    triangles: int
    reported: str
    exact: str
    confirmed: bool
    """Whether rational arithmetic gives the judge's answer, and not the library's."""


def read_obj(path: Path) -> list[Triangle]:
    """Returns the triangles of an OBJ file that contains only triangles."""
    lines = [line.split() for line in path.read_text("utf-8").splitlines()]
    vertices = [vector([float(word) for word in line[1:4]]) for line in lines if line[:1] == ["v"]]
    faces = [[int(word) - 1 for word in line[1:4]] for line in lines if line[:1] == ["f"]]
    return [(vertices[a], vertices[b], vertices[c]) for a, b, c in faces]


def _text(t: float | None) -> str:
    return "a miss" if t is None else f"t = {t:.9g}"


def counterexample(folder: Path) -> Counterexample:
    """Reads a case of `verify --minimize`, and checks it exactly."""
    case = json.loads((folder / "case.json").read_text("utf-8"))["wrong"]
    triangles = read_obj(folder / "scene.obj")
    ray = case["ray"]
    exact = closest(triangles, ray["origin"], ray["direction"], ray["t_min"], ray["t_max"])
    reported = case["reported"]
    claimed = reported["t"] if isinstance(reported, dict) else None
    judged = (case["exact"] or {}).get("t")
    same = (exact is None) == (judged is None) and (
        exact is None or abs(float(exact) - judged) <= 1e-6 * abs(judged)
    )
    apart = (exact is None) != (claimed is None) or (
        exact is not None and claimed is not None and float(exact) != claimed
    )
    return Counterexample(
        folder=folder.name,
        leak=case["class"] == "leak",
        triangles=len(triangles),
        reported=_text(claimed),
        exact=_text(None if exact is None else float(exact)),
        confirmed=same and apart,
    )
