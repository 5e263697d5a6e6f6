"""Measures of triangulations of space: the table of points, and spheres."""

from __future__ import annotations

from typing import Any

import numpy as np

from vorotool import _core
from vorotool.numeric.arrays import Floats
from vorotool.types.mesh.tetrahedralization import Tetrahedralization, norms
from vorotool.types.table import Table


def space_table(mesh: Tetrahedralization) -> Table:
    """Tabulate the points: neighbors, the volume of the Voronoi cell, the nearest other point, hull and duplicates."""
    labels, is_duplicate, found = mesh.label_array, mesh.is_duplicate, _found(mesh)
    nearest, on_hull = found["nearest"], found["on_hull"].astype(bool)
    alone = nearest < 0
    x, y, z = np.ascontiguousarray(mesh.points.T)
    columns: dict[str, Any] = {
        "label": labels,
        "x": x,
        "y": y,
        "z": z,
        "neighbors": np.ma.array(found["neighbors"], mask=is_duplicate),
        "cell_volume": np.ma.array(found["cell_volume"], mask=is_duplicate | on_hull),
        "nearest_label": np.ma.array(labels[nearest], mask=alone),
        "nearest_distance": np.ma.array(norms(mesh.points[nearest] - mesh.points), mask=alone),
        "on_hull": np.ma.array(on_hull, mask=is_duplicate),
        "duplicate_of_label": np.ma.array(labels[mesh.first], mask=~is_duplicate),
    }
    return Table(columns).with_properties(mesh.properties)


def _found(mesh: Tetrahedralization) -> dict[str, Any]:
    """Count the neighbors, and find the volume of the cell, the nearest point, and what is on the hull."""
    labels = mesh.label_array
    if len(mesh):
        return _core.tetrahedra.point_table(mesh.points, mesh.tetrahedra, mesh.neighbors, labels, 0, None)
    simplices = mesh.planar if len(mesh.planar) else mesh.edges
    return {
        "neighbors": np.bincount(mesh.edges.reshape(-1), minlength=len(labels)),
        "cell_volume": np.full(len(labels), np.inf),
        "nearest": _core.tetrahedra.nearest_corners(mesh.points, simplices, labels, 0, None),
        "on_hull": np.ones(len(labels), dtype=bool),
    }


def spheres(mesh: Tetrahedralization) -> tuple[Floats, Floats]:
    """Vectors from the first corner of each tetrahedron to the center of its sphere, and volumes of tetrahedra."""
    return _core.tetrahedra.spheres(mesh.points, mesh.tetrahedra, 0, None)
