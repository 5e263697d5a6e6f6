"""Polygons as an engine uses them: after repair and placement."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.plain import plain
from vorotool.types.polygons.polygon_set import PolygonSet


@plain(eq=False)
class RepairedPolygons:
    """The rings of a planar graph, and where each vertex and edge is in it."""

    # coordinates after placement, in input units; `PolygonSet.part` counts the parts of a feature of the input
    polygons: PolygonSet
    source: NDArray[np.int32]  # (p,) int32 array: the polygon of the input that each comes from
    point: NDArray[np.int32]  # (n,) int32 array: the point of the graph at each vertex
    # (n,) int32 array: the segment of the graph from each vertex to the next one of its ring; -1 at the end of a line
    segment: NDArray[np.int32]
