#!/usr/bin/env python3
"""A contender in Python that tests all triangles; replace these tests with your library's calls."""

import json
import sys
import time

import numpy as np

DESCRIPTION = {"name": "mine-in-python", "description": "tests all triangles, with NumPy",
               "version": "mine 1.0", "primitives": ["polygons"]}  # fmt: skip


def read_scene(path: str) -> tuple[np.ndarray, np.ndarray]:
    """Returns the corners of all triangles, and the primitive of each."""
    memory = np.memmap(path, np.uint8, mode="r")
    _, vertices, triangles, _, _ = memory[8:48].view("<u8")
    split, end = 48 + 12 * vertices, 48 + 12 * vertices + 16 * triangles
    corners = memory[48:split].view("<f4").reshape(-1, 3).astype(np.float64)
    rows = memory[split:end].view("<u4").reshape(-1, 4)
    return corners[rows[:, :3]], rows[:, 3].copy()


def trace(scene: tuple[np.ndarray, np.ndarray], rays: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns t and the primitive of the closest hit of each ray."""
    closest = np.full(len(rays), np.inf, np.float32)
    primitives = np.full(len(rays), 0xFFFFFFFF, np.uint32)
    direction = rays[:, 4:7].astype(np.float64)
    for corners, primitive in zip(*scene, strict=True):
        a, b, c = corners[:, None] - rays[:, :3]
        u, v, w = (np.einsum("ij,ij->i", direction, np.cross(*sides))
                   for sides in ((b, c), (c, a), (a, b)))  # fmt: skip
        inside = ((u >= 0) & (v >= 0) & (w >= 0)) | ((u <= 0) & (v <= 0) & (w <= 0))
        t = (np.einsum("ij,ij->i", a, np.cross(b, c)) / (u + v + w)).astype(np.float32)
        hit = inside & (t >= rays[:, 3]) & (t <= rays[:, 7]) & (t < closest)
        closest[hit], primitives[hit] = t[hit], primitive
    return closest, primitives


np.seterr(all="ignore")  # parallel rays divide by zero
scene = None
for line in sys.stdin:
    verb, *words = line.split()
    begin = time.perf_counter()
    if verb == "describe":
        print(json.dumps(DESCRIPTION), flush=True)
        continue
    if verb == "build":
        scene = read_scene(words[0])
    else:
        count = int(words[1])
        memory = np.memmap(words[0], np.uint8, mode="r+")
        t, primitives = trace(scene, memory[: 32 * count].view("<f4").reshape(-1, 8))
        results = [t, primitives] if verb == "closest" else [primitives != 0xFFFFFFFF]
        written = b"".join(array.tobytes() for array in results)
        memory[32 * count : 32 * count + len(written)] = np.frombuffer(written, np.uint8)
    print("ok", time.perf_counter() - begin, flush=True)
