"""Traces a mesh with a custom ray tracer, verifies the hits and plots their classes.

The ray tracer tests every triangle against every ray in numpy, by Möller and Trumbore's test in
float32. The module verifies its hits, and the plot shows the class of each pixel. An epsilon that
is too large for the mesh, a common mistake, loses hits on triangles seen edge-on:

    python verify_mesh.py                    # ok
    python verify_mesh.py --epsilon 0.001    # mismatch

Exit codes: 0: the hits are correct; 1: they are not; 2: invalid arguments.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
from numpy.typing import NDArray

import beambench as bb

mpl.use("Agg")
import matplotlib.pyplot as plt

Floats = NDArray[np.float32]
Ids = NDArray[np.int64]

# In the order of bb.CLASSES; distinguishable for the color-blind (Okabe and Ito).
COLORS = ["#0072B2", "#56B4E9", "#F0E442", "#D55E00", "#CC79A7"]
RAYS_AT_ONCE = 512


def torus(around: int, along: int) -> tuple[Floats, Ids]:
    """Returns vertices and triangles of a torus about the z axis, with radii 1 and 0.4."""
    u, v = np.meshgrid(
        np.linspace(0, 2 * np.pi, around, endpoint=False),
        np.linspace(0, 2 * np.pi, along, endpoint=False),
        indexing="ij",
    )
    radius = 1 + 0.4 * np.cos(v)
    vertices = np.stack([radius * np.cos(u), radius * np.sin(u), 0.4 * np.sin(v)], axis=-1)
    i, j = np.meshgrid(np.arange(around), np.arange(along), indexing="ij")
    a = i * along + j
    b = (i + 1) % around * along + j
    c = (i + 1) % around * along + (j + 1) % along
    d = i * along + (j + 1) % along
    triangles = np.stack([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)], axis=2)
    return vertices.reshape(-1, 3).astype(np.float32), triangles.reshape(-1, 3)


def trace(vertices: Floats, triangles: Ids, rays: Floats, epsilon: float) -> tuple[Floats, Ids]:
    """Returns t (infinity for a miss) and triangle (-1 for a miss) of each ray's closest hit.

    Möller and Trumbore, "Fast, minimum storage ray-triangle intersection", 1997.
    """
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    edge_1, edge_2 = b - a, c - a
    t = np.full(len(rays), np.inf, np.float32)
    ids = np.full(len(rays), -1)
    for first in range(0, len(rays), RAYS_AT_ONCE):
        part = rays[first : first + RAYS_AT_ONCE, None, :]  # against all triangles at once
        origin, t_min, direction, t_max = part[..., 0:3], part[..., 3], part[..., 4:7], part[..., 7]
        p = np.cross(direction, edge_2)
        determinant = (edge_1 * p).sum(axis=-1)
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = 1 / determinant
            s = origin - a
            u = (s * p).sum(axis=-1) * inverse
            q = np.cross(s, edge_1)
            v = (direction * q).sum(axis=-1) * inverse
            found = (edge_2 * q).sum(axis=-1) * inverse
            inside = (u >= 0) & (v >= 0) & (u + v <= 1) & (found >= t_min) & (found <= t_max)
        found[~inside | (np.abs(determinant) <= epsilon)] = np.inf
        nearest = found.argmin(axis=1)
        rows = slice(first, first + len(part))
        t[rows] = found[np.arange(len(part)), nearest]
        ids[rows] = np.where(np.isfinite(t[rows]), nearest, -1)
    return t, ids


def plot(report: bb.Report, t: Floats, size: int, file: Path) -> None:
    """Plots the depth of the image, and the class of each pixel."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 5), layout="constrained")
    left.imshow(np.where(np.isfinite(t), t, np.nan).reshape(size, size), cmap="viridis_r")
    left.set_title("t of the claimed hits")
    colors = mpl.colors.ListedColormap(COLORS)
    right.imshow(report.classes.reshape(size, size), cmap=colors, vmin=-0.5, vmax=4.5)
    right.set_title(f"classes; the verdict is {report.verdict}")
    entries = [
        mpl.patches.Patch(color=color, label=f"{name}: {report.counts[name]}")
        for name, color in zip(bb.CLASSES, COLORS, strict=True)
        if report.counts[name] > 0
    ]
    right.legend(handles=entries, loc="lower right")
    for axes in (left, right):
        axes.set_axis_off()
    figure.savefig(file, dpi=120)


def main() -> int:
    """Traces the scene, verifies the hits, prints the report and plots the classes."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--epsilon", type=float, default=0.0, help="smallest determinant of a hit (default: 0)"
    )
    parser.add_argument(
        "--size", type=int, default=128, help="side of the image in pixels (default: 128)"
    )
    parser.add_argument(
        "--scene", help="trace the triangles of this scene or mesh file instead of a torus"
    )
    parser.add_argument("-o", dest="output", type=Path, default=Path("verify_mesh.png"))
    arguments = parser.parse_args()
    try:
        if arguments.scene:
            scene = bb.Scene(arguments.scene)
        else:
            scene = bb.Scene.from_triangles(*torus(48, 24), name="torus")
        rays = scene.rays(resolution=(arguments.size, arguments.size))
    except bb.InputError as error:
        print(f"verify_mesh.py: {error}", file=sys.stderr)
        return 2
    t, ids = trace(scene.vertices, scene.triangles.astype(np.int64), rays, arguments.epsilon)
    report = bb.verify(scene, rays, t=t, triangle=ids)
    print(report)
    plot(report, t, arguments.size, arguments.output)
    print(arguments.output)
    return 0 if report.ok else 1


if __name__ == "__main__":
    sys.exit(main())
