"""The sweeps of harness/sweeps/thesis: reading them, counting cells, making them quick."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any

from beambench_report.ledger.comparisons import rays
from beambench_report.problem import Problem

FOLDER = Path(__file__).resolve().parents[3] / "harness/sweeps/thesis"

LEVELS = "levels"
"""The sweep that max_level=auto is judged by; its file lies in the folder above FOLDER."""

_QUICK_RESOLUTIONS = ("320x200", "640x480")
_QUICK_REPETITIONS = {"minimum": 1, "maximum": 3}
_QUICK_SECONDS_A_CELL = 0.25


@dataclass(frozen=True)
class PlannedCell:
    """A cell as a sweep asks for it: parameters that it does not name keep their defaults."""

    scene: str
    structure: str
    parameters: tuple[tuple[str, str], ...]
    resolution: str
    samples: int


@dataclass(frozen=True)
class Sweep:
    """A sweep file: `name` is that of the file and of the folder of its run."""

    name: str
    source: dict[str, Any]

    @property
    def description(self) -> str:
        """What the sweep says of itself."""
        return self.source.get("description", "")

    @property
    def budget_seconds(self) -> float:
        """How long it may take; slow cells that have not their least repetitions may take more."""
        return self.source["budget_seconds"]

    def cells(self) -> list[PlannedCell]:
        """Every cell, in no order that means anything."""
        contenders = list(dict.fromkeys(self._contenders()))
        views = product(
            self.source["scenes"], self.source["resolutions"], self.source.get("samples", [1])
        )
        return [
            PlannedCell(scene, *contender, resolution, samples)
            for scene, resolution, samples in views
            for contender in contenders
            if not self._is_excluded(scene, contender[0], resolution, samples)
        ]

    def _is_excluded(self, scene: str, structure: str, resolution: str, samples: int) -> bool:
        """By the conditions that the thesis's sweeps use; `primitives_above` is none of them."""
        own = {"scene": scene, "structure": structure}
        return any(
            all(entry.get(name, value) == value for name, value in own.items())
            and rays(resolution) * samples > entry.get("rays_above", -1)
            for entry in self.source.get("exclude", [])
        )

    def _contenders(self) -> Iterator[tuple[str, tuple[tuple[str, str], ...]]]:
        for entry in self.source["structures"]:
            if isinstance(entry, str):
                name, _, text = entry.partition(":")
                pairs = [part.partition("=") for part in text.split(",") if part]
                yield name, tuple((key, value) for key, _, value in pairs)
                continue
            given = entry.get("parameters", {})
            lists = [value if isinstance(value, list) else [value] for value in given.values()]
            for values in product(*lists):
                texts = (str(value) for value in values)
                yield entry["structure"], tuple(zip(given, texts, strict=True))


def read_sweep(name: str, folder: Path = FOLDER) -> Sweep:
    """Reads FOLDER/NAME.json. Raises Problem where there is none."""
    path = folder / f"{name}.json"
    try:
        return Sweep(name, json.loads(path.read_text("utf-8")))
    except FileNotFoundError:
        raise Problem(f"{path}: there is no such file; restore it with git") from None
    except ValueError as error:
        raise Problem(f"{path}: cannot be read as JSON: {error}") from None


def quick(sweep: Sweep) -> Sweep | None:
    """The sweep at its low resolutions, in little time; None if it has no low one."""
    resolutions = [size for size in sweep.source["resolutions"] if size in _QUICK_RESOLUTIONS]
    if not resolutions:
        return None
    changes = {
        "name": f"{sweep.source['name']}-quick",
        "resolutions": resolutions,
        "repetitions": _QUICK_REPETITIONS,
        "warm_up_seconds": 0.2,
    }
    smaller = replace(sweep, source=sweep.source | changes)
    budget = max(1.0, _QUICK_SECONDS_A_CELL * len(smaller.cells()))
    return replace(smaller, source=smaller.source | {"budget_seconds": round(budget, 1)})
