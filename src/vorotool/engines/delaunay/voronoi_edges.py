"""Lengths of Voronoi edges, whole and inside a frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.types.mesh.triangulation import Triangulation


def voronoi_lengths(
    mesh: Triangulation, centers: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Length of the Voronoi edge of every edge of a triangulation, and of its part inside a rectangle."""
    triangle, corner = np.nonzero(mesh.neighbors < np.arange(len(mesh))[:, None])  # each edge once
    other = mesh.neighbors[triangle, corner]
    a, b = (mesh.triangles[triangle, (corner + k) % 3] for k in (1, 2))
    on_hull = other < 0
    start = centers[triangle]
    along = mesh.points[b] - mesh.points[a]
    outward = np.stack([along[:, 1], -along[:, 0]], axis=1) / hypotenuse(along[:, 0], along[:, 1])[:, None]
    # Far enough to cross the whole rectangle from wherever the ray begins.
    reach = np.abs(start - low).sum(axis=1) + np.abs(start - high).sum(axis=1) + 1
    step = np.where(on_hull[:, None], outward * reach[:, None], centers[other] - start)
    size = hypotenuse(step[:, 0], step[:, 1])
    order = _order_of(mesh, a, b)
    return np.where(on_hull, np.inf, size)[order], (_share_inside(start, step, low, high) * size)[order]


def _order_of(mesh: Triangulation, a: NDArray[np.int32], b: NDArray[np.int32]) -> NDArray[np.intp]:
    """Where each edge of the mesh is among the pairs of ends."""
    count = len(mesh.points)
    ends = np.minimum(a, b).astype(np.int64) * count + np.maximum(a, b)
    sorter = np.argsort(ends, kind="stable")
    wanted = mesh.edges[:, 0].astype(np.int64) * count + mesh.edges[:, 1]
    order: NDArray[np.intp] = sorter[np.searchsorted(ends[sorter], wanted)]
    return order


def _share_inside(
    start: NDArray[np.float64], step: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Share of each segment that lies in a rectangle (Liang and Barsky 1984)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (low - start) / step, (high - start) / step
    within = (start >= low) & (start <= high)
    parallel = step == 0
    enters = np.where(parallel, np.where(within, -np.inf, np.inf), np.minimum(one, other)).max(axis=1)
    leaves = np.where(parallel, np.where(within, np.inf, -np.inf), np.maximum(one, other)).min(axis=1)
    share: NDArray[np.float64] = np.maximum(0.0, np.minimum(leaves, 1.0) - np.maximum(enters, 0.0))
    return share
