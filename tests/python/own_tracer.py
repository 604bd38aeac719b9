"""A ray tracer in double that uses beambench's files; its arguments: OBJ RAYS HITS FAULT."""

import json
import sys
from pathlib import Path

import numpy as np

obj, rays, hits, fault = sys.argv[1:]
lines = [line.split() for line in Path(obj).read_text().splitlines()]
vertices = np.array([line[1:] for line in lines if line[0] == "v"], "f8")
faces = np.array([line[1:] for line in lines if line[0] == "f"], int) - 1
with Path(rays).open("rb") as file:
    file.readline()
    header = json.loads(file.readline())
    rays = np.fromfile(file, "<f4").reshape(-1, 8).astype("f8")
origin, near, direction, far = rays[:, :3], rays[:, 3], rays[:, 4:7], rays[:, 7]
best = np.full(len(rays), np.inf)
found = np.full(len(rays), 0xFFFFFFFF, "u4")
for number, corners in enumerate(vertices[faces]):
    # Neighbors compute the same numbers for the edge that they share, so no ray leaks.
    a, b, c = corners[:, None] - origin
    u, v, w = ((direction * np.cross(*edge)).sum(1) for edge in ((b, c), (c, a), (a, b)))
    volume = u + v + w
    with np.errstate(all="ignore"):
        t = ((a * np.cross(b, c)).sum(1) / volume).astype("f4")
    inside = ((u >= 0) & (v >= 0) & (w >= 0)) | ((u <= 0) & (v <= 0) & (w <= 0))
    inside &= (t >= near) & (t <= far) & (t < best)
    if fault == "leak":
        inside &= np.min(np.abs([u, v, w]), axis=0) > 1e-9 * np.abs(volume)
    if fault == "epsilon":
        inside &= np.abs(volume) > 1e-8
    best[inside], found[inside] = t[inside], number
any_hit = header["query"] == "any"
columns = ["occluded"] if any_hit else ["t", "triangle"]
kind = [("occluded", "u1")] if any_hit else [("t", "<f4"), ("triangle", "<u4")]
table = np.zeros(len(rays), kind)
if any_hit:
    table["occluded"] = found != 0xFFFFFFFF
else:
    table["t"], table["triangle"] = best, found
with Path(hits).open("wb") as file:
    file.write(b"beambench-hits 1\n")
    file.write(json.dumps({"hits": len(table), "columns": columns}).encode() + b"\n")
    table.tofile(file)
