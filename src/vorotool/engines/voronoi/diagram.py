"""The segment Voronoi diagram of all sites, where it is needed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi, unwanted_sides
from vorotool.engines.voronoi.elements import OwnedGraph
from vorotool.numeric.parallel import Progress
from vorotool.types.skeleton.segment_voronoi import SegmentVoronoiDiagram


def diagram_of(
    owned: OwnedGraph, *, is_whole: bool = False, threads: int = 0, progress: Progress = None
) -> SegmentVoronoiDiagram:
    """Make the diagram of the points and segments of a graph."""
    graph, unwanted = owned.graph, None if is_whole else _unwanted(owned)
    return segment_voronoi(graph.points, graph.segments, unwanted=unwanted, threads=threads, progress=progress)


def _unwanted(owned: OwnedGraph) -> NDArray[np.uint8] | None:
    """Tell where the diagram is not needed: in covered faces; None where all of it is."""
    graph, count = owned.graph, len(owned.graph.points)
    degree = np.bincount(graph.segments.ravel(), minlength=count)
    if (owned.face < 0).all() or (degree == 0).any():
        return None
    least, most = _core.voronoi.owners_at_points(graph.segments, owned.element[count:], count)
    if ((degree == 2) & (least != most)).any():
        return None
    return unwanted_sides(graph, owned.face < 0)
