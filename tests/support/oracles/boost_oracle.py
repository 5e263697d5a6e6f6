"""Boost's diagram of points and segments, through pyvoronoi, beside ours.

Boost is right for small coordinates, but for one graph in some thousands that has points beside segments. It has
vertices that coincide where more than three sites tie, and edges of length zero between them: vertices are merged by
their places.
"""

from collections import Counter
from dataclasses import dataclass

import numpy as np
from pyvoronoi import Pyvoronoi
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

TOGETHER = 1e-6
"""Vertices that are so near are one."""

SEGMENT_START, SEGMENT_END = 1, 2
"""Of which end of a segment a cell of a point is."""


@dataclass(frozen=True)
class Edges:
    """A diagram as its vertices and edges, sites by our numbers; -1 is infinity."""

    vertices: np.ndarray
    ends: np.ndarray
    sites: np.ndarray
    is_primary: np.ndarray
    """Not between a segment and its own end."""


def boost_edges(points, segments):
    """Boost's diagram of a planar straight-line graph; points that no segment ends at are sites, too."""
    made = Pyvoronoi(1)
    lone = np.setdiff1d(np.arange(len(points)), segments)
    for point in points[lone].tolist():
        made.AddPoint(point)
    for segment in points[segments].tolist():
        made.AddSegment(segment)
    made.Construct()
    site = [_site(cell, points, segments, lone) for cell in made.GetCells()]
    edges = made.GetEdges()
    rows = [(edge.start, edge.end, site[edge.cell], site[edges[edge.twin].cell]) for edge in edges[::2]]
    rows = np.array(rows, dtype=np.int64).reshape(-1, 4)
    vertices = np.array([(vertex.X, vertex.Y) for vertex in made.GetVertices()]).reshape(-1, 2)
    return Edges(vertices, rows[:, :2], rows[:, 2:], np.array([edge.is_primary for edge in edges[::2]], dtype=bool))


def _site(cell, points, segments, lone):
    if cell.contains_segment:
        return len(points) + cell.site - len(lone)
    if cell.source_category in (SEGMENT_START, SEGMENT_END):
        return segments[cell.site - len(lone), cell.source_category - SEGMENT_START]
    return lone[cell.site]


def our_edges(diagram):
    """The same of ours."""
    point, segment = np.sort(diagram.edge_sites, axis=1).T
    count = len(diagram.points)
    ends = np.append(diagram.segments, [[-1, -1]], axis=0)[np.where(segment >= count, segment - count, -1)]
    own = (segment >= count) & (ends == point[:, None]).any(axis=1)
    return Edges(diagram.vertices, diagram.edges, diagram.edge_sites, ~own)


def differences(diagram, boost):
    """What is not the same, in words: vertices with their sites, and edges with theirs, but for length zero."""
    ours = our_edges(diagram)
    if not np.isfinite(boost.vertices).all():
        return [f"Boost has a vertex at {place}" for place in boost.vertices.tolist() if not np.isfinite(place).all()]
    places = _places(np.concatenate([ours.vertices, boost.vertices]))
    described = [
        _described(ours, places[: len(ours.vertices)]),
        _described(boost, places[len(ours.vertices) :]),
    ]
    found = []
    for what, mine, theirs in zip(("vertex", "edge"), *described, strict=True):
        found += [f"{what} {row} is ours only" for row in (mine - theirs).elements()]
        found += [f"{what} {row} is Boost's only" for row in (theirs - mine).elements()]
    return found


def _places(vertices):
    """Number of the place of each vertex."""
    if not len(vertices):
        return np.empty(0, np.int64)
    pairs = cKDTree(vertices).query_pairs(TOGETHER, output_type="ndarray")
    near = coo_array((np.ones(len(pairs)), pairs.T), shape=(len(vertices),) * 2)
    return connected_components(near, directed=False)[1].astype(np.int64)


def _described(edges, places):
    """(place, its sites) of the vertices, and (ends, sites, is primary) of the edges."""
    ends = np.append(places, -1)[edges.ends]
    sites = {place: set() for place in places.tolist()}
    rows = Counter()
    for (source, target), pair, primary in zip(ends.tolist(), edges.sites.tolist(), edges.is_primary, strict=True):
        for place in {source, target} - {-1}:
            sites[place] |= set(pair)
        if source != target or source < 0:
            rows[tuple(sorted((source, target))), tuple(sorted(pair)), bool(primary)] += 1
    return Counter((place, tuple(sorted(around))) for place, around in sites.items()), rows
