"""VTK's vtkStaticCellLocator, in double: one call for each ray, which is a segment."""

from importlib.metadata import version

import contender_program as program
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray


def build(mesh):
    points, cells, data = vtk.vtkPoints(), vtk.vtkCellArray(), vtk.vtkPolyData()
    points.SetData(numpy_to_vtk(mesh.vertices, deep=True))
    count = len(mesh.triangles)
    rows = np.column_stack([np.full(count, 3), mesh.triangles]).astype(np.int64)
    cells.SetCells(count, numpy_to_vtkIdTypeArray(rows.ravel(), deep=True))
    data.SetPoints(points)
    data.SetPolys(cells)
    locator = vtk.vtkStaticCellLocator()
    locator.SetDataSet(data)
    locator.BuildLocator()
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    return locator, low.astype("f8"), high.astype("f8"), data


def closest(built, rays):
    """Traces segments; an infinite ray ends behind the box of the scene."""
    locator, low, high, _ = built
    origin, direction = rays[:, :3].astype("f8"), rays[:, 4:7].astype("f8")
    reach = np.linalg.norm(np.maximum(np.abs(origin - low), np.abs(origin - high)), axis=1)
    far = np.minimum(rays[:, 7], 1.01 * reach / np.linalg.norm(direction, axis=1))
    begin, end = origin + rays[:, 3:4] * direction, origin + far[:, None] * direction
    t, found = np.full(len(rays), np.inf), np.zeros(len(rays), np.int64)
    part, place, local = vtk.reference(0.0), [0.0] * 3, [0.0] * 3
    side, cell = vtk.reference(0), vtk.reference(0)
    for i in range(len(rays)):
        if far[i] < rays[i, 3]:
            continue
        if locator.IntersectWithLine(begin[i], end[i], 0.0, part, place, local, side, cell):
            t[i] = rays[i, 3] + float(part) * (far[i] - rays[i, 3])
            found[i] = int(cell)
    return t, found


def occluded(built, rays):
    return np.isfinite(closest(built, rays)[0])  # VTK has no any-hit query


program.serve(
    program.Library(
        "vtk",
        "VTK of PyPI: vtkStaticCellLocator, double, a call for each ray",
        f"vtk {version('vtk')}",
        build,
        closest,
        occluded,
    )
)
