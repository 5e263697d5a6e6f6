"""The segment Voronoi diagram of all sites, where it is needed."""

from __future__ import annotations

from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi
from vorotool.engines.voronoi.borders import unwanted_of
from vorotool.engines.voronoi.elements import OwnedGraph
from vorotool.geometry.progress import Progress
from vorotool.geometry.skeleton.segment_voronoi import SegmentVoronoiDiagram


def diagram_of(
    owned: OwnedGraph, *, is_whole: bool = False, threads: int = 0, progress: Progress = None
) -> SegmentVoronoiDiagram:
    """Make the diagram of the points and segments of a graph.

    Parameters
    ----------
    owned : OwnedGraph
        Of all sites.
    is_whole : bool
        With all vertices; else those in covered faces may be left out.
    threads, progress
        As of `vorotool.voronoi`.
    """
    graph, unwanted = owned.graph, None if is_whole else unwanted_of(owned)
    return segment_voronoi(graph.points, graph.segments, unwanted=unwanted, threads=threads, progress=progress)
