"""The table of points in space: neighbors, cells and the nearest other point."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np

from vorotool.numeric.arrays import Booleans, Floats, Indices
from vorotool.numeric.numbers import difference, product
from vorotool.types.mesh.tetrahedralization import FACES, Tetrahedralization, cross, dot, norms
from vorotool.types.table import Table

_CLOSE = 1 + 2.0**-48
"""Squares of distances that differ by less may be in the other order, or equal."""


def space_table(mesh: Tetrahedralization) -> Table:
    """Tabulate the points: neighbors, the volume of the Voronoi cell, the nearest other point, hull and duplicates."""
    labels, is_duplicate = mesh.label_array, mesh.is_duplicate
    degree = np.bincount(mesh.edges.reshape(-1), minlength=len(labels))
    on_hull = np.ones(len(labels), dtype=bool)
    if len(mesh):
        on_hull[:] = False
        on_hull[mesh.hull] = True
    nearest = nearest_points(mesh.points, mesh.edges, labels)
    alone = nearest < 0
    x, y, z = np.ascontiguousarray(mesh.points.T)
    columns: dict[str, Any] = {
        "label": labels,
        "x": x,
        "y": y,
        "z": z,
        "neighbors": np.ma.array(degree, mask=is_duplicate),
        "cell_volume": np.ma.array(cell_volumes(mesh), mask=is_duplicate | on_hull),
        "nearest_label": np.ma.array(labels[nearest] if len(labels) else labels, mask=alone),
        "nearest_distance": np.ma.array(_distances(mesh.points, nearest), mask=alone),
        "on_hull": np.ma.array(on_hull, mask=is_duplicate),
        "duplicate_of_label": np.ma.array(labels[mesh.first], mask=~is_duplicate),
    }
    return Table(columns).with_properties(mesh.properties)


# ---- cells ---------------------------------------------------------------------------------------
def cell_volumes(mesh: Tetrahedralization) -> Floats:
    """Volumes of the Voronoi cells, which are those of points inside the hull: sums of signed parts of tetrahedra.

    The part of a corner is bounded by its edges, the planes half-way along these, and its faces. Beside a face it is
    twice a sixth of a determinant, which is negative where the center of the sphere lies beyond the face.
    """
    parts = np.zeros((len(mesh), 4))
    with np.errstate(all="ignore"):
        for rows in mesh.blocks():
            corners = np.moveaxis(mesh.points[mesh.tetrahedra[rows]], 0, 2)
            for i in range(4):
                a, (b, c, d) = corners[i], FACES[i]  # counter-clockwise as seen from outside
                center = mesh.ways_to_centers[rows].T - (a - corners[0])
                for j, k in ((b, c), (c, d), (d, b)):
                    u, v = corners[j] - a, corners[k] - a
                    normal = cross(u, v)
                    height = dot(center, normal) / dot(normal, normal)
                    parts[rows, i] += height * dot(v - u, cross(normal, center)) / 12
    return np.bincount(mesh.tetrahedra.reshape(-1), parts.reshape(-1), len(mesh.points)).astype(np.float64)


# ---- nearest points ------------------------------------------------------------------------------
def nearest_points(points: Floats, edges: Any, labels: Indices) -> Indices:
    """Index of the nearest point at another place, by exact comparison, ties to the smallest label; -1 for none.

    It shares an edge with the point.
    """
    found = np.full(len(points), -1, dtype=np.int64)
    if not len(edges):
        return found
    source = np.concatenate([edges[:, 0], edges[:, 1]])
    target = np.concatenate([edges[:, 1], edges[:, 0]])
    square, is_exact = _squares(points[edges[:, 0]], points[edges[:, 1]])
    square, is_exact = np.tile(square, 2), np.tile(is_exact, 2)
    least = np.full(len(points), np.inf)
    np.minimum.at(least, source, square)
    with np.errstate(over="ignore"):
        close = np.flatnonzero(square <= least[source] * _CLOSE)
    order = close[np.lexsort([labels[target[close]], square[close], source[close]])]
    owner = source[order]
    begins = np.flatnonzero(np.diff(owner, prepend=-1))
    found[owner[begins]] = target[order[begins]]
    ends = np.append(begins[1:], len(order))
    is_clear = np.logical_and.reduceat(is_exact[order], begins) | (ends - begins == 1)
    for begin, end in zip(begins[~is_clear].tolist(), ends[~is_clear].tolist(), strict=True):
        point = int(owner[begin])
        rivals = target[order[begin:end]].tolist()
        found[point] = min(rivals, key=lambda rival: (_exact_square(points[point], points[rival]), labels[rival]))
    return found


def _squares(p: Floats, q: Floats) -> tuple[Floats, Booleans]:
    """Squares of distances, and whether they are exact."""
    with np.errstate(all="ignore"):
        way, lost = difference(p, q)
        parts, missing = product(way, way)
        first, low = difference(parts[:, 0], -parts[:, 1])
        square, last = difference(first, -parts[:, 2])
        is_exact = (lost == 0).all(axis=1) & (missing == 0).all(axis=1) & (low == 0) & (last == 0)
    return square, is_exact & (square > 2.0**-900) & (square < np.inf)


def _exact_square(p: Floats, q: Floats) -> Fraction:
    return sum(((Fraction(x) - Fraction(y)) ** 2 for x, y in zip(p.tolist(), q.tolist(), strict=True)), Fraction(0))


def _distances(points: Floats, nearest: Indices) -> Floats:
    return norms(points[nearest] - points) if len(points) else np.zeros(0)
