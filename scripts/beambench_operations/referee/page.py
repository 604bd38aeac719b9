"""Builds the referee's page from the CSV files and counterexamples in its folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from jinja2 import Environment, StrictUndefined

from beambench_operations.publish.provenance import QUIET
from beambench_operations.referee.findings import (
    Counterexample,
    counterexample,
    place_of,
    read_rows,
    wrong_rays,
)
from beambench_operations.referee.libraries import library, precision, traced
from beambench_operations.referee.speed import read_speed

Rows = list[dict[str, Any]]
PUBLISHED = "results/published/referee"
TEMPLATE = Path(__file__).with_name("page.md.j2")


def share(rows: Rows, query: str) -> str:
    """Returns the share of right results of a query, rounded so that 100% means all."""
    chosen = [row for row in rows if row["query"] == query]
    rays = sum(row["rays"] for row in chosen)
    wrong = sum(map(wrong_rays, chosen))
    if rays == 0:
        return "unsupported"
    if wrong == 0:
        return "100%"
    return f"{min(100 * (1 - wrong / rays), 99.9999):.4f}%"


def families(rows: Rows, chosen: Callable[[dict[str, Any]], bool]) -> str:
    """Returns the names of the families of the chosen rows, each once."""
    return ", ".join(dict.fromkeys(row["family"] for row in rows if chosen(row))) or "-"


def table_row(cells: list[str]) -> str:
    """Returns a line of a table in Markdown."""
    return "| " + " | ".join(cells) + " |"


def library_row(number: int, rows: Rows) -> str:
    """Returns the line of a library in the table."""
    name = rows[0]["library"]
    return table_row(
        [
            str(number),
            name,
            rows[0]["version"].removesuffix(" (times are self-reported)"),
            precision(name),
            f"{sum(row['rays'] for row in rows):,}",
            share(rows, "closest"),
            share(rows, "any"),
            f"{sum(row['structure_error'] for row in rows):,}",
            f"{sum(row['leaks'] for row in rows):,}",
            families(rows, lambda row: row["errors"] > 0),
            families(rows, lambda row: row["unsupported"] > 0),
            traced(name),
        ]
    )


def family_cell(rows: Rows, family: str) -> str:
    """Returns the shares of a library in a family: "99.1 / 98.0", in percent."""

    def cell(row: dict[str, Any]) -> str:
        if row["errors"] == row["cases"]:
            return "fails"
        if row["rays"] == 0:
            return "-"
        exact = 100 * (1 - wrong_rays(row) / row["rays"])
        return "100" if exact == 100 else f"{min(exact, 99.9):.1f}"

    return " / ".join(dict.fromkeys(cell(row) for row in rows if row["family"] == family))


def family_table(libraries: list[Rows]) -> tuple[str, str]:
    """Returns the shares in families where any library is wrong, and the other families."""
    names = list(dict.fromkeys(row["family"] for row in libraries[0]))
    wrong = [
        name
        for name in names
        if any(
            wrong_rays(row) or row["errors"]
            for rows in libraries
            for row in rows
            if row["family"] == name
        )
    ]
    right = [name for name in names if name not in wrong]
    lines = [
        table_row(["family", *(str(i + 1) for i in range(len(libraries)))]),
        "|---|" + "---:|" * len(libraries),
        *(table_row([name, *(family_cell(rows, name) for rows in libraries)]) for name in wrong),
    ]
    return "\n".join(lines), ", ".join(right) or "none"


def repeat_command(name: str, case: Counterexample) -> str:
    """Returns the command that shows a counterexample, from the root of the repository."""
    place = f"{PUBLISHED}/minimal/{case.folder}"
    what = f"{place}/scene.obj --accel {name} --rays {place}/ray.rays"
    return f"beambench --plugin $({library(name).install}) verify {what}"


def case_row(name: str, version: str, case: Counterexample | None) -> str:
    """Returns the line of a counterexample."""
    label = f"{name}, {version.partition(',')[0].removesuffix(' (times are self-reported)')}"
    if case is None:
        return table_row([label, *["-"] * 6])
    return table_row(
        [
            f"[{label}](minimal/{case.folder}/case.json)",
            "leak" if case.leak else "wrong hit",
            str(case.triangles),
            case.reported,
            case.exact,
            "yes" if case.confirmed else "no",
            f"`{repeat_command(name, case)}`",
        ]
    )


def speed_section(rows: list[dict[str, str]]) -> dict[str, str]:
    """Returns the values of the section on speed; empty if speeds were not measured."""
    if not rows:
        return {}
    kinds = list(dict.fromkeys(row["ray_kind"] for row in rows))
    lines = []
    for name in dict.fromkeys(row["contender"] for row in rows):
        cells = []
        for kind in kinds:
            row = next(r for r in rows if r["contender"] == name and r["ray_kind"] == kind)
            interval = f" ({row['mrays_low']} to {row['mrays_high']})" if row["mrays_low"] else ""
            cells.append(f"{row['mrays']}{interval}" if row["mrays"] else row["verdict"])
        lines.append(table_row([f"`{name}`", *cells]))
    first = rows[0]
    beside = float(first["other_work"]) > QUIET
    return {
        "scene": f"`{first['scene']}`",
        "measured": "**Other work ran on the machine at the same time.** " if beside else "",
        "commit": first["commit"],
        "cpu": first["cpu"],
        "other_work": first["other_work"],
        "utc": first["utc"],
        "kinds": " | ".join(kinds),
        "rules": "---:|" * len(kinds),
        "table": "\n".join(lines),
    }


def known_faults(libraries: list[Rows]) -> dict[str, str]:
    """Returns counts that show tinybvh's publicly reported faults; empty without tinybvh."""
    versions: dict[tuple[str, str], Rows] = {}
    for rows in libraries:
        if rows[0]["library"].startswith("tinybvh:layout="):
            layout = rows[0]["library"].removeprefix("tinybvh:layout=").partition(",")[0]
            versions[rows[0]["version"].removeprefix("tinybvh ").partition(" ")[0], layout] = rows
    if not versions:
        return {}

    def wrong(version: str, layout: str, *names: str) -> int:
        rows = versions.get((version, layout), [])
        return sum(wrong_rays(row) for row in rows if row["family"] in names)

    leaks = [
        f"{version} {sum(row['leaks'] for row in rows):,}"
        for (version, layout), rows in versions.items()
        if layout == "bvh2"
    ]
    directions = ("edges and vertices", "rays in planes", "odd directions")
    zeros = [
        f"{version} {wrong(version, layout, *directions):,}"
        for version, layout in versions
        if layout == "bvh8"
    ]
    return {
        "watertight": ", ".join(leaks),
        "parallel": f"{wrong('1.6.7', 'double', *directions):,}",
        "zeros": ", ".join(zeros),
    }


def page(folder: Path) -> str:
    """Returns the page of a folder with referee.csv and, if it was measured, speed.csv."""
    libraries = read_rows(folder / "referee.csv")
    scenes = sum(row["cases"] for row in libraries[0] if row["query"] == "closest")
    table = "\n".join(library_row(number, rows) for number, rows in enumerate(libraries, 1))
    shares, right = family_table(libraries)
    cases = []
    for rows in libraries:
        name, version = rows[0]["library"], rows[0]["version"]
        place = folder / "minimal" / place_of(name, version)
        case = counterexample(place) if (place / "case.json").exists() else None
        cases.append(case_row(name, version, case))
    environment = Environment(
        undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True
    )
    return environment.from_string(TEMPLATE.read_text("utf-8")).render(
        scenes=scenes,
        table=table,
        families=shares,
        right=right,
        cases="\n".join(cases),
        speed=speed_section(read_speed(folder / "speed.csv")),
        known=known_faults(libraries),
    )
