"""Polygons as an engine uses them: after repair and placement."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vorotool.geometry.polygons.polygon_set import PolygonSet


@dataclass(frozen=True, eq=False)
class RepairedPolygons:
    """The rings of a planar graph, and where each vertex and edge is in it.

    A polygon of the input that falls apart gives several, one that has no inside none; they follow one another, with
    the id and the properties of theirs. Shells are counter-clockwise, holes clockwise, and no ring visits a point
    twice. Open lines are as they run, with what they meet as further vertices.

    Parameters
    ----------
    polygons : PolygonSet
        Coordinates after placement, in input units; `PolygonSet.part` counts the parts of a feature of the input.
    source : (p,) int32 array
        The polygon of the input that each comes from.
    point : (n,) int32 array
        The point of the graph at each vertex.
    segment : (n,) int32 array
        The segment of the graph from each vertex to the next one of its ring; -1 at the end of a line.
    """

    polygons: PolygonSet
    source: NDArray[np.int32]
    point: NDArray[np.int32]
    segment: NDArray[np.int32]
