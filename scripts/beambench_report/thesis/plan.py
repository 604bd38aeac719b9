"""Which sweeps are to be run for what a user asked for, kept beside them for --resume."""

from __future__ import annotations

import json
from collections.abc import Sequence, Set
from dataclasses import dataclass, replace
from pathlib import Path

from beambench_report.files import write_text
from beambench_report.problem import Problem
from beambench_report.thesis import sweeps as sweep_files
from beambench_report.thesis.catalogue import FIGURES, SWEEPS, TABLES
from beambench_report.thesis.sweeps import LEVELS, Sweep, quick, read_sweep

_PLAN = "thesis.json"


@dataclass(frozen=True)
class Plan:
    """What is shown and what has to be measured for it."""

    tables: tuple[str, ...]
    figures: tuple[str, ...]
    is_quick: bool
    sweeps: tuple[Sweep, ...]

    @property
    def is_everything(self) -> bool:
        """Nothing of chapter 5 is left out."""
        return len(self.tables) == len(TABLES) and len(self.figures) == len(FIGURES)


def make_plan(
    tables: Sequence[str],
    figures: Sequence[str],
    is_quick: bool,
    folder: Path | None = None,
    *,
    with_levels: bool = False,
) -> Plan:
    """The sweeps for some tables and figures, or for all. Raises Problem for one there is not.

    `with_levels` adds the sweep that max_level=auto is judged by.
    """
    known_tables, known_figures = [t.number for t in TABLES], [f.number for f in FIGURES]
    _require_known("table", tables, known_tables)
    _require_known("figure", figures, known_figures)
    if not tables and not figures:
        tables, figures = known_tables, known_figures
    chosen_tables = [table for table in TABLES if table.number in tables]
    wanted = {name for table in chosen_tables for name in (*table.first, *table.best)}
    wanted |= {name for figure in FIGURES if figure.number in figures for name in figure.sweeps}
    shown = _figures_of(wanted)
    read = [read_sweep(name, folder or sweep_files.FOLDER) for name in SWEEPS if name in wanted]
    made = [quick(sweep) if is_quick else sweep for sweep in read]
    plan = Plan(
        tuple(table.number for table in chosen_tables),
        tuple(shown),
        is_quick,
        tuple(sweep for sweep in made if sweep is not None),
    )
    return add_levels(plan, folder) if with_levels else plan


def add_levels(plan: Plan, folder: Path | None = None) -> Plan:
    """The same plan with the sweep that max_level=auto is judged by, if it was without."""
    if any(sweep.name == LEVELS for sweep in plan.sweeps):
        return plan
    levels = read_sweep(LEVELS, (folder or sweep_files.FOLDER).parent)
    made = quick(levels) if plan.is_quick else levels
    return replace(plan, sweeps=(*plan.sweeps, made)) if made else plan


def keep_plan(plan: Plan, directory: Path) -> None:
    """Writes DIRECTORY/thesis.json, from which a run that was cut off goes on."""
    document = {
        "tables": plan.tables,
        "figures": plan.figures,
        "quick": plan.is_quick,
        "sweeps": [{"name": sweep.name, "sweep": sweep.source} for sweep in plan.sweeps],
    }
    write_text(directory / _PLAN, json.dumps(document, indent=2) + "\n")


def read_plan(directory: Path) -> Plan:
    """Reads what `keep_plan` wrote. Raises Problem where that is not to be had."""
    path = directory / _PLAN
    try:
        source = json.loads(path.read_text("utf-8"))
        sweeps = tuple(Sweep(entry["name"], entry["sweep"]) for entry in source["sweeps"])
        shown = set(source["figures"]) | set(_figures_of({sweep.name for sweep in sweeps}))
        return Plan(
            tuple(source["tables"]),
            tuple(figure.number for figure in FIGURES if figure.number in shown),
            source["quick"],
            sweeps,
        )
    except FileNotFoundError:
        raise Problem(
            f"{path}: there is no such file; give the folder that an earlier scripts/thesis wrote"
        ) from None
    except (ValueError, KeyError, TypeError) as error:
        raise Problem(f"{path}: is not the plan of a run ({error}); begin anew with -o") from None


def _figures_of(sweeps: Set[str]) -> list[str]:
    """Those that some sweeps are enough for: they cost nothing more."""
    return [figure.number for figure in FIGURES if sweeps >= set(figure.sweeps)]


def _require_known(kind: str, given: Sequence[str], known: Sequence[str]) -> None:
    for number in given:
        if number not in known:
            raise Problem(f"there is no {kind} '{number}'; there are {', '.join(known)}")
