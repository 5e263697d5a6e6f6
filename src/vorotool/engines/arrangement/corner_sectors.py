"""Corners of a planar graph."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.curves.inverse_functions import angle_of
from vorotool.numeric.ragged import following
from vorotool.plain import plain
from vorotool.types.polygons.planar_graph import PlanarGraph

Indices = NDArray[np.int64]


@plain
class CornerSectors:
    """Corners under 180 degrees: counter-clockwise from one segment of the graph to the next."""

    point: Indices
    right: Indices  # segments
    left: Indices
    face: Indices


def corner_sectors(graph: PlanarGraph) -> CornerSectors:
    """Find the corners under 180 degrees, exactly."""
    count = len(graph)
    at = graph.segments.T.reshape(-1).astype(np.int64)
    to = graph.segments[:, ::-1].T.reshape(-1)
    segment = np.tile(np.arange(count), 2)
    left_face = graph.segment_faces.T.reshape(-1).astype(np.int64)  # as seen from the point
    way = graph.points[to].astype(np.int64) - graph.points[at]
    order = _by_angle(at, way)
    at, way, segment, left_face = at[order], way[order], segment[order], left_face[order]
    new = np.flatnonzero(np.diff(at, prepend=-1))
    after = following(np.append(new, len(at)))
    cross = way[:, 0] * way[after, 1] - way[:, 1] * way[after, 0]
    sharp = (cross > 0) & (after != np.arange(len(at)))
    return CornerSectors(at[sharp], segment[sharp], segment[after[sharp]], left_face[sharp])


def _by_angle(at: Indices, way: Indices) -> Indices:
    """Order by point, then counter-clockwise: by halves of the plane, in them exactly by products."""
    half = np.where((way[:, 1] > 0) | ((way[:, 1] == 0) & (way[:, 0] > 0)), 0, 1)
    angle = angle_of(*way.T)
    order = np.lexsort((np.where(half == 0, angle, angle + 7), half, at))
    while True:  # rounded angles of neighbors may be out of order
        a, b = order[:-1], order[1:]
        swap = (at[a] == at[b]) & (half[a] == half[b]) & (way[a, 0] * way[b, 1] - way[a, 1] * way[b, 0] < 0)
        swap[1:] &= ~swap[:-1]
        where = np.flatnonzero(swap)
        if not where.size:
            return order
        order[where], order[where + 1] = order[where + 1].copy(), order[where].copy()
