"""Nights made of the raw samples of quiet runs, for calibration.

A run keeps every repetition in its cells/*.json, a published one in repetitions.csv, with the round
in which it had its turn. A made-up
night is a block of consecutive rounds, the same for all contenders of a view, and each contender's
median of it. What two processes differ by is in no single run; PROCESS is added for it.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from math import log, sqrt
from pathlib import Path

import numpy as np

from beambench_report.nightly.calibration import Noise
from beambench_report.page.cell_files import (
    REPETITIONS,
    Repetition,
    Row,
    published_repetitions,
)
from beambench_report.problem import Problem

PROCESS = 0.004
"""Standard deviation of a ratio from one process to the next: results/published/repeated against
repeated-again, 96 cells of the same commit."""

_ROUNDS = 9  # the least repetitions of a nightly cell
_NIGHTS = 200


def noise_of_samples(folders: Iterable[Path], seed: int = 1999) -> Noise:
    """Noise from the raw samples of runs. Raises Problem where none has enough of them."""
    random = np.random.default_rng(seed)
    scenes: dict[str, list[np.ndarray]] = {}
    for folder in folders:
        for scene, contenders in _views(folder):
            nights = _nights(contenders, random)
            scenes.setdefault(f"{folder}/{scene}", []).append(nights)
    if not scenes:
        raise Problem(
            f"no run has a view with Embree, others, and {_ROUNDS} repetitions in cells/*.json "
            f"or {REPETITIONS}; give runs whose raw samples were not pruned"
        )
    parts = []
    for views in scenes.values():
        # A scene's resolutions are judged together; what a process differs by is in all of them,
        # and half of it is the reference's, which all contenders share.
        noise = np.mean([one for one in views if one.shape == views[0].shape], axis=0)
        size = PROCESS / sqrt(2)
        noise += random.normal(0, size, noise.shape) + random.normal(0, size, (_NIGHTS, 1))
        parts.append(noise)
    return Noise(tuple(parts), _NIGHTS)


def _views(folder: Path) -> Iterable[tuple[str, list[dict[int, float]]]]:
    """Scene and contenders of each view, Embree's single rays first."""
    views: dict[tuple, list[tuple[bool, dict[int, float]]]] = {}
    scenes: dict[tuple, str] = {}
    for place, row, repetitions in _cells(folder):
        try:
            if len(repetitions) < _ROUNDS or row["structure"] == "null":
                continue
            view = tuple(row[name] for name in "scene camera width height samples ray_kind".split())
            logs = {one["round"]: log(_cycles(one)) for one in repetitions}
        except (ValueError, KeyError, TypeError) as error:
            raise Problem(f"{place}: is not a cell of a run ({error}); remove it") from None
        is_reference = row["structure"] == "embree" and "mode=single" in row["parameters"]
        views.setdefault(view, []).append((is_reference, logs))
        scenes[view] = row["scene"]
    for view, cells in views.items():
        cells.sort(key=lambda cell: not cell[0])
        if cells[0][0] and len(cells) > 1:
            yield scenes[view], [logs for _, logs in cells]


def _cells(folder: Path) -> Iterable[tuple[Path, Row, list[Repetition]]]:
    """The file, row and repetitions of each cell."""
    paths = sorted(folder.glob("cells/*.json"))
    for path in paths:
        try:
            cell = json.loads(path.read_text("utf-8"))
            yield path, cell["row"], cell["repetitions"]
        except (ValueError, KeyError, TypeError) as error:
            raise Problem(f"{path}: is not a cell of a run ({error}); remove it") from None
    if not paths:
        for row, repetitions in published_repetitions(folder):
            yield folder / REPETITIONS, row, repetitions


def _cycles(repetition: dict) -> float:
    return (repetition["build_cpu_ms"] + repetition["trace_cpu_ms"]) * repetition["clock_ghz"]


def _nights(contenders: Sequence[dict[int, float]], random: np.random.Generator) -> np.ndarray:
    rounds = max(max(logs) for logs in contenders) + 1
    starts = random.integers(0, rounds, _NIGHTS)
    medians = np.empty((_NIGHTS, len(contenders)))
    for place, logs in enumerate(contenders):
        order = np.array(sorted(logs))
        values = np.array([logs[number] for number in order])
        first = np.searchsorted(order, starts) % len(order)
        medians[:, place] = np.median(
            values[(first[:, None] + np.arange(_ROUNDS)) % len(order)], axis=1
        )
    ratios = medians[:, 1:] - medians[:, :1]
    return ratios - np.median(ratios, axis=0)
