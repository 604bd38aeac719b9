"""Serves beambench's protocol for programs (harness/plugin/README.md) with a library's functions."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

MISS = 0xFFFFFFFF


class Unsupported(Exception):
    """Raised if the library does not support a query or its rays."""


@dataclass(frozen=True)
class Mesh:
    """The triangles of a scene."""

    vertices: NDArray[np.float32]
    """Shape (V, 3)."""
    triangles: NDArray[np.uint32]
    """Shape (T, 3): indices of vertices."""
    primitives: NDArray[np.uint32]
    """Shape (T,): the primitive to return for a hit on each triangle."""


@dataclass(frozen=True)
class Library:
    """A library as a contender; functions get rays of shape (N, 8): origin, t_min, direction, t_max."""

    name: str
    description: str
    version: str
    build: Callable[[Mesh], Any]
    closest: Callable[[Any, NDArray[np.float32]], tuple[NDArray[Any], NDArray[Any]]]
    """Returns t (infinity for a miss) and the triangle of each ray."""
    occluded: Callable[[Any, NDArray[np.float32]], NDArray[Any]]


def without_t_min(rays: NDArray[np.float32]) -> None:
    """Declines rays whose t_min is not 0."""
    if (rays[:, 3] > 0).any():
        raise Unsupported("rays begin at their origin, without t_min")


def without_interval(rays: NDArray[np.float32]) -> None:
    """Declines rays with t_min or t_max."""
    without_t_min(rays)
    if np.isfinite(rays[:, 7]).any():
        raise Unsupported("rays are infinite, without t_max")


def read_mesh(path: str) -> Mesh:
    """Returns the triangles of a scene in shared memory."""
    memory = np.fromfile(path, np.uint8)
    _, vertices, triangles, _, _ = (int(count) for count in memory[8:48].view("<u8"))
    split, end = 48 + 12 * vertices, 48 + 12 * vertices + 16 * triangles
    rows = memory[split:end].view("<u4").reshape(-1, 4)
    corners = memory[48:split].view("<f4").reshape(-1, 3)
    return Mesh(corners, np.ascontiguousarray(rows[:, :3]), rows[:, 3].copy())


def answer(library: Library, state: dict[str, Any], verb: str, path: str, count: int) -> float:
    """Carries out a request; returns its seconds, including the conversion of rays and results."""
    if verb == "build":
        state["mesh"] = read_mesh(path)
        begin = time.perf_counter()
        state["built"] = library.build(state["mesh"])
        return time.perf_counter() - begin
    memory = np.memmap(path, np.uint8, mode="r+")
    rays = np.array(memory[: 32 * count].view("<f4").reshape(-1, 8))
    begin = time.perf_counter()
    if verb == "closest":
        t, triangles = library.closest(state["built"], rays)
        t = np.asarray(t, "<f4")
        hit = np.isfinite(t)
        primitives = np.full(count, MISS, "<u4")
        primitives[hit] = state["mesh"].primitives[np.asarray(triangles)[hit]]
        results = t.tobytes() + primitives.tobytes()
    else:
        results = np.asarray(library.occluded(state["built"], rays), np.uint8).tobytes()
    seconds = time.perf_counter() - begin
    memory[32 * count : 32 * count + len(results)] = np.frombuffer(results, np.uint8)
    return seconds


def serve(library: Library) -> None:
    """Carries out requests until the input ends."""
    state: dict[str, Any] = {}
    for line in sys.stdin:
        verb, *words = line.split()
        if verb == "describe":
            text = json.dumps({"name": library.name, "description": library.description,
                               "version": library.version})  # fmt: skip
        else:
            try:
                seconds = answer(library, state, verb, words[0], int((*words, 0, 0)[1]))
                text = f"ok {seconds:.9f}"
            except Unsupported as reason:
                text = f"unsupported {reason}"
        print(text, flush=True)
