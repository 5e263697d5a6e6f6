"""Borders between the places of different sites: edges of the segment Voronoi diagram, and walls."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.segment_voronoi.segment_voronoi import core_diagram, unwanted_sides
from vorotool.engines.voronoi.elements import OwnedGraph
from vorotool.engines.voronoi.limits import STEP, Limit
from vorotool.errors import VerificationError
from vorotool.geometry.polygons.planar_graph import PlanarGraph
from vorotool.geometry.ragged import ranges, within
from vorotool.geometry.skeleton.segment_voronoi import SegmentVoronoiDiagram
from vorotool.geometry.voronoi.voronoi_map import OUTSIDE

Indices = NDArray[np.int64]

_FEW = 6
"""Sites around a vertex that are gone through one by one: there are three of most."""


@dataclass(frozen=True, eq=False)
class Borders:
    """Pieces of borders in the plane, before a frame cuts them.

    A cell of an element, one side of it, or a covered face is a part. Parts between which there is no border are
    joined; all that is joined has one number.

    Parameters
    ----------
    ends : (b, 2) int64 array
        Source and target, numbers of `places`; -1 at infinity.
    elements : (b, 2) int64 array
        Elements of the graph left and right, which the piece is equally far from; a wall has itself twice.
    sites : (b, 2) int32 array
        Left and right.
    parts : (b, 2) int64 array
        Left and right.
    order : (b, 2) int64 array
        Of the piece among those that leave its source, and its target: rising counter-clockwise.
    places : (v, 2) float64 array
        On the lattice: vertices of the diagram, then points that are none, then nodes of the limit.
    radius : (v,) float64 array
        There.
    center : (b, 2) float64 array
        Of circular arcs along the limit, on the lattice; NaN of other pieces.
    level : float
        The limit on the lattice; infinity without one.
    """

    ends: Indices
    elements: Indices
    sites: NDArray[np.int32]
    parts: Indices
    order: Indices
    places: NDArray[np.float64]
    radius: NDArray[np.float64]
    center: NDArray[np.float64]
    level: float


def borders_of(
    owned: OwnedGraph, diagram: SegmentVoronoiDiagram, *, level: float = np.inf, threads: int = 0
) -> Borders:
    """Choose the borders among the edges of a diagram and the segments of its graph.

    Nothing is decided by coordinates but where a point lies on a straight line between two others, which is exact.

    Parameters
    ----------
    owned : OwnedGraph
        Of all sites.
    diagram : SegmentVoronoiDiagram
        Of its points and segments; vertices in covered faces may be left out if there is no limit.
    level : float
        The limit of distance on the lattice: pieces end there, and others run along it.
    threads : int
        0 uses all.
    """
    graph, element = owned.graph, owned.element
    own = _own_ends(graph, diagram)
    pieces, faces = _edges_with_faces(graph, diagram, own, threads)
    limit = _limit(owned, diagram, own, pieces, faces, level) if np.isfinite(level) else None
    alike = own.alias[diagram.edge_sites[pieces.edge]]
    is_kept = owned.face[faces] < 0
    if limit is not None:
        is_kept &= limit.is_near(pieces.edge, pieces.point >= 0)
    sites = element[alike]
    parts = _parts_of_elements(graph, alike, faces)
    is_border = is_kept & (sites[:, 0] != sites[:, 1])
    walls, wall_sites, wall_parts = sides_of_segments(owned)
    count = len(graph.points) + 2 * len(graph) + graph.faces
    joined = np.concatenate([parts[is_kept & ~is_border], wall_parts[~walls]]).astype(np.int32)
    root = _core.graphs.connected_components(joined, count)
    chosen, wall = pieces[is_border], np.flatnonzero(walls)
    middles = chosen.point[chosen.point >= 0]
    nodes = _Nodes(graph, diagram, np.concatenate([middles, graph.segments[wall].ravel()]))
    ends = np.concatenate([nodes.ends_of_edges(chosen), nodes.of_point[graph.segments[wall]]])
    pairs = diagram.edge_sites[chosen.edge].astype(np.int64)
    elements = np.concatenate([pairs, np.repeat(wall[:, None] + len(graph.points), 2, axis=1)])
    borders = Borders(
        ends,
        elements,
        np.concatenate([sites[is_border], wall_sites[wall]]),
        root[np.concatenate([parts[is_border], wall_parts[wall]])].astype(np.int64),
        nodes.order(ends, elements, None if limit is None else limit.vertices()),
        nodes.places,
        nodes.radius,
        np.full(ends.shape, np.nan),
        level,
    )
    return borders if limit is None else _limited(borders, owned, limit, chosen, own, nodes, root)


# ---- the limit of distance --------------------------------------------------------------------------
def _limit(
    owned: OwnedGraph,
    diagram: SegmentVoronoiDiagram,
    own: _OwnEnds,
    pieces: _Pieces,
    faces: NDArray[np.int32],
    level: float,
) -> Limit:
    edge_faces = np.empty((len(diagram.edges), 2), dtype=np.int32)
    edge_faces[pieces.edge] = faces[:, None]
    edge_faces[own.edge] = own.faces
    is_own = np.zeros(len(diagram.edges), dtype=bool)
    is_own[own.edge] = True
    return Limit(owned.graph, diagram, level, edge_faces, is_own, owned.face < 0)


def _limited(
    borders: Borders,
    owned: OwnedGraph,
    limit: Limit,
    pieces: _Pieces,
    own: _OwnEnds,
    nodes: _Nodes,
    root: NDArray[np.int32],
) -> Borders:
    """Borders up to a limit, edges first, and the arcs along it."""
    edges, first = len(pieces.edge), len(borders.places)
    arcs = limit.arcs(first, nodes.ranks)
    is_half = pieces.point >= 0
    has_end = np.stack([~is_half | pieces.is_first, ~is_half | ~pieces.is_first], axis=1)
    ends, order = borders.ends.copy(), STEP * borders.order
    ends[:edges], order[:edges] = limit.cut(ends[:edges], order[:edges], pieces.edge, has_end, first)
    element = own.alias[arcs.element]
    beyond = np.full(len(element), OUTSIDE)
    part = root[_parts_of_elements(owned.graph, element[:, None], arcs.face)[:, 0]]
    return Borders(
        np.concatenate([ends, arcs.ends]),
        np.concatenate([borders.elements, np.repeat(arcs.element[:, None], 2, axis=1)]),
        np.concatenate([borders.sites, np.stack([owned.element[element], beyond], axis=1)]).astype(np.int32),
        np.concatenate([borders.parts, np.stack([part, beyond], axis=1)]),
        np.concatenate([order, arcs.order]),
        np.concatenate([borders.places, arcs.places]),
        np.concatenate([borders.radius, np.full(len(arcs.places), limit.level)]),
        np.concatenate([borders.center, arcs.center]),
        limit.level,
    )


def ridges_of(owned: OwnedGraph, diagram: SegmentVoronoiDiagram, *, level: float = np.inf, threads: int = 0) -> Borders:
    """Choose the edges between elements of one site, in the open: the distance from it has its maxima along these.

    Edges between a segment and its own end are none: across these the distance is smooth.

    Parameters
    ----------
    owned, diagram, level, threads
        As of `borders_of`; the level cuts none of them.

    Returns
    -------
    Borders
        With one site on both sides; parts and order are 0.
    """
    graph = owned.graph
    edge, faces = _core.skeleton.skeleton_edges(core_diagram(diagram, graph.segment_faces), threads, None)
    elements = diagram.edge_sites[edge].astype(np.int64)
    sites = owned.element[_own_ends(graph, diagram).alias[elements]]
    chosen = (sites[:, 0] == sites[:, 1]) & (owned.face[faces] < 0)
    none = np.zeros((np.count_nonzero(chosen), 2), dtype=np.int64)
    return Borders(
        diagram.edges[edge[chosen]].astype(np.int64),
        elements[chosen],
        sites[chosen],
        none,
        none,
        diagram.vertices,
        diagram.radius,
        np.full(none.shape, np.nan),
        level,
    )


def unwanted_of(owned: OwnedGraph) -> NDArray[np.uint8] | None:
    """Tell where the diagram is not needed: in covered faces; None where all of it is.

    It is where a point without segments may be in any face, and where two sites part in the middle of a straight line:
    the edge between them there may lead through the line.
    """
    graph, count = owned.graph, len(owned.graph.points)
    degree = np.bincount(graph.segments.ravel(), minlength=count)
    if (owned.face < 0).all() or (degree == 0).any():
        return None
    least, most = np.full(count, count + len(graph)), np.full(count, -1)
    for end in graph.segments.T:
        np.minimum.at(least, end, owned.element[count:])
        np.maximum.at(most, end, owned.element[count:])
    if ((degree == 2) & (least != most)).any():
        return None
    return unwanted_sides(graph, owned.face < 0)


# ---- edges between a segment and its own end --------------------------------------------------------
@dataclass(frozen=True, eq=False)
class _OwnEnds:
    """Edges between a segment and its own end.

    Parameters
    ----------
    edge : (k,) int64 array
        Numbers of the edges.
    faces : (k, 2) int32 array
        In which face each lies towards its source, and towards its target: they differ where it passes through the end.
    is_through : (k,) bool array
        Whether it passes through the end, between two segments in one line. All others begin there, or have one face.
    point : (k,) int64 array
        The end.
    alias : (n + m,) int64 array
        Of each element itself; of a point whose cell has no area one of the segments beside it.
    """

    edge: Indices
    faces: NDArray[np.int32]
    is_through: NDArray[np.bool_]
    point: Indices
    alias: Indices


def _own_ends(graph: PlanarGraph, diagram: SegmentVoronoiDiagram) -> _OwnEnds:
    count = len(graph.points)
    low, high = np.sort(diagram.edge_sites, axis=1).T
    mixed = np.flatnonzero((low < count) & (high >= count))
    point, segment = low[mixed].astype(np.int64), high[mixed].astype(np.int64) - count
    is_own = (graph.segments[segment] == point[:, None]).any(axis=1)
    edge, point, segment = mixed[is_own], point[is_own], segment[is_own]
    is_first = graph.segments[segment, 0] == point
    left = np.where(is_first, graph.segment_faces[segment, 0], graph.segment_faces[segment, 1])
    right = np.where(is_first, graph.segment_faces[segment, 1], graph.segment_faces[segment, 0])
    # along an edge that leads away from the end, a segment on its left has it on its own right
    has_left = diagram.edge_sites[edge, 0] == segment + count
    forth, back = np.where(has_left, right, left), np.where(has_left, left, right)
    source, target = diagram.edges[edge].T
    radius = np.append(diagram.radius, np.inf)  # that of -1, at infinity
    begins, ends = radius[source] == 0, radius[target] == 0
    faces = np.stack([np.where(begins, forth, back), np.where(ends, back, forth)], axis=1)
    degree = np.bincount(graph.segments.ravel(), minlength=count)
    is_through = ~begins & ~ends & (degree[point] > 1)
    return _OwnEnds(edge, faces, is_through, point, _aliases(graph, degree, point, segment))


def _aliases(graph: PlanarGraph, degree: NDArray[np.int64], point: Indices, segment: Indices) -> Indices:
    """For a point between two segments in one line, with nothing on one side, the first of them; else itself."""
    alias = np.arange(len(graph.points) + len(graph), dtype=np.int64)
    several = np.flatnonzero(degree[point] > 1)
    order = several[np.lexsort((segment[several], point[several]))]
    first = order[:-1][point[order[1:]] == point[order[:-1]]]
    second = order[1:][point[order[1:]] == point[order[:-1]]]
    ways = []
    for each in (first, second):
        ends, at = graph.segments[segment[each]], point[each]
        other = np.where(ends[:, 0] == at, ends[:, 1], ends[:, 0])
        ways.append(graph.points[other].astype(np.int64) - graph.points[at])
    a, b = ways
    is_straight = (a[:, 0] * b[:, 1] == a[:, 1] * b[:, 0]) & (segment[first] != segment[second])
    alias[point[first[is_straight]]] = segment[first[is_straight]] + len(graph.points)
    return alias


# ---- edges in faces --------------------------------------------------------------------------------
@dataclass(frozen=True, eq=False)
class _Pieces:
    """Edges of a diagram, or halves of edges that pass through a point.

    Parameters
    ----------
    edge : (k,) int64 array
        Of the diagram.
    point : (k,) int64 array
        That a half ends in; -1 of a whole edge.
    is_first : (k,) bool array
        Whether it is the half towards the source.
    """

    edge: Indices
    point: Indices
    is_first: NDArray[np.bool_]

    def __getitem__(self, chosen: NDArray[Any]) -> _Pieces:
        return _Pieces(self.edge[chosen], self.point[chosen], self.is_first[chosen])


def _edges_with_faces(
    graph: PlanarGraph, diagram: SegmentVoronoiDiagram, own: _OwnEnds, threads: int
) -> tuple[_Pieces, NDArray[np.int32]]:
    """All edges, those through a point in two halves, and the face of the graph that each lies in."""
    between, faces = _core.skeleton.skeleton_edges(core_diagram(diagram, graph.segment_faces), threads, None)
    whole, through = ~own.is_through, own.is_through
    edge = np.concatenate([between, own.edge[whole], own.edge[through], own.edge[through]]).astype(np.int64)
    halves = int(np.count_nonzero(through))
    point = np.full(len(edge), -1, dtype=np.int64)
    point[len(edge) - 2 * halves :] = np.tile(own.point[through], 2)
    is_first = np.zeros(len(edge), dtype=bool)
    is_first[len(edge) - 2 * halves : len(edge) - halves] = True
    of_own = [own.faces[whole, 0], own.faces[through, 0], own.faces[through, 1]]
    return _Pieces(edge, point, is_first), np.concatenate([faces, *of_own])


# ---- parts -----------------------------------------------------------------------------------------
def _parts_of_elements(graph: PlanarGraph, element: Indices, face: NDArray[np.int32]) -> Indices:
    """(k, 2) the part of each of two elements on whose cells' border an edge in a face is.

    Points come first, then the left and the right sides of segments, then covered faces.
    """
    count = len(graph.points)
    segment = np.maximum(element - count, 0)
    sides = graph.segment_faces if len(graph) else np.zeros((1, 2), dtype=np.int32)
    is_right = sides[segment, 0] != face[:, None]
    parts: Indices = np.where(element < count, element, count + 2 * segment + is_right)
    return parts


def sides_of_segments(owned: OwnedGraph) -> tuple[NDArray[np.bool_], NDArray[np.int32], Indices]:
    """Of each segment whether it is a border, and left and right its sites and parts.

    Parameters
    ----------
    owned : OwnedGraph
        Of all sites.
    """
    graph, count = owned.graph, len(owned.graph.points)
    covering = owned.face[graph.segment_faces]
    is_free = covering < 0
    sites = np.where(is_free, owned.element[count:, None], covering)
    side = count + 2 * np.arange(len(graph))[:, None] + np.arange(2)
    parts = np.where(is_free, side, count + 2 * len(graph) + graph.segment_faces.astype(np.int64))
    return sites[:, 0] != sites[:, 1], sites, parts


# ---- places ----------------------------------------------------------------------------------------
class _Nodes:
    """Where borders end: vertices of the diagram, and points in the middle of straight lines, which are none.

    Parameters
    ----------
    graph, diagram : PlanarGraph, SegmentVoronoiDiagram
        The points and the vertices.
    needed : int array
        Points that borders end in.
    """

    def __init__(self, graph: PlanarGraph, diagram: SegmentVoronoiDiagram, needed: NDArray[Any]) -> None:
        self.graph, self.diagram = graph, diagram
        count = len(diagram)
        self.of_point = _vertices_of_points(graph, diagram)
        is_needed = np.zeros(len(graph.points), dtype=bool)
        is_needed[needed] = True
        added = np.flatnonzero(is_needed & (self.of_point < 0))
        added = added[np.lexsort(graph.points[added].T[::-1])]  # by place, however they are numbered
        self.of_point[added] = count + np.arange(len(added))
        self.added = added
        self.places = np.concatenate([diagram.vertices, graph.points[added].astype(np.float64)])
        self.radius = np.concatenate([diagram.radius, np.zeros(len(added))])

    def ends_of_edges(self, pieces: _Pieces) -> Indices:
        """(k, 2) source and target of edges and halves."""
        ends = self.diagram.edges[pieces.edge].astype(np.int64)
        half = pieces.point >= 0
        middle = self.of_point[pieces.point[half]]
        first = pieces.is_first[half]
        ends[half, 0] = np.where(first, ends[half, 0], middle)
        ends[half, 1] = np.where(first, middle, ends[half, 1])
        return ends

    def order(self, ends: Indices, elements: Indices, crowded: Indices | None = None) -> Indices:
        """(b, 2) numbers that rise counter-clockwise among the pieces that leave a place.

        Around a vertex of the diagram its sites follow each other counter-clockwise: a piece between two of them comes
        after the one on its right, and a segment lies in the middle of its own sector.
        """
        order = np.zeros((len(ends), 2), dtype=np.int64)
        vertices = len(self.diagram)
        busy = np.append(np.bincount(ends[ends >= 0], minlength=len(self.places)) > 2, False)  # none at infinity
        if crowded is not None:  # others end there as well
            busy[crowded] = True
        for end in (0, 1):
            at = ends[:, end]
            is_wall = elements[:, 0] == elements[:, 1]
            right = elements[:, 1 - end]
            chosen = np.flatnonzero((at >= 0) & (at < vertices) & busy[at])
            rank = self.ranks(at[chosen], right[chosen])
            order[chosen, end] = 2 * rank + ~is_wall[chosen]
            chosen = np.flatnonzero((at >= vertices) & busy[at])
            order[chosen, end] = self._order_in_line(at[chosen], elements[chosen, end], right[chosen], is_wall[chosen])
        return order

    def ranks(self, vertex: Indices, element: Indices) -> Indices:
        """The place of elements among the sites of vertices."""
        start, sites = self.diagram.vertex_start, self.diagram.vertex_sites
        rank = np.full(len(vertex), -1, dtype=np.int64)
        left = np.arange(len(vertex))
        for k in range(_FEW):
            left = left[k < start[vertex[left] + 1] - start[vertex[left]]]
            found = sites[start[vertex[left]] + k] == element[left]
            rank[left[found]] = k
            left = left[~found]
        if left.size:
            rank[left] = self._ranks_among_many(vertex[left], element[left])
        if (rank < 0).any():
            raise VerificationError("a border ends at a vertex that its element does not touch: please report it")
        return rank

    def _ranks_among_many(self, vertex: Indices, element: Indices) -> Indices:
        """The same by one search for all, where many sites meet; -1 of what is not there."""
        diagram = self.diagram
        vertices = np.unique(vertex)
        sizes = np.diff(diagram.vertex_start)[vertices]
        elements = len(self.graph.points) + len(self.graph)
        entries = ranges(diagram.vertex_start[vertices], sizes)
        key = np.repeat(vertices, sizes) * elements + diagram.vertex_sites[entries]
        sorting = np.argsort(key, kind="stable")
        wanted = vertex * elements + element
        found = sorting[np.searchsorted(key, wanted, sorter=sorting).clip(max=len(key) - 1)]
        ranks: Indices = np.where(key[found] == wanted, within(sizes)[found], -1)
        return ranks

    def _order_in_line(self, node: Indices, left: Indices, right: Indices, is_wall: NDArray[np.bool_]) -> Indices:
        """Around a point between two segments: the first one, what is left of it, the second one, what is right."""
        point = self.added[node - len(self.diagram)]
        first = self._first_segments()[point] + len(self.graph.points)
        # a half beside the first segment has that on its right where it is left of it
        is_left = np.where(right >= len(self.graph.points), right == first, left != first)
        order: Indices = np.where(is_wall, np.where(left == first, 0, 2), np.where(is_left, 1, 3))
        return order

    def _first_segments(self) -> Indices:
        """(n,) the smallest segment at each point."""
        first = np.full(len(self.graph.points), len(self.graph), dtype=np.int64)
        for end in self.graph.segments.T:
            np.minimum.at(first, end, np.arange(len(self.graph)))
        return first


def _vertices_of_points(graph: PlanarGraph, diagram: SegmentVoronoiDiagram) -> Indices:
    """(n,) the vertex of the diagram at each point, where three of its elements meet; else -1."""
    count = len(graph.points)
    of_point = np.full(count, -1, dtype=np.int64)
    corner = np.flatnonzero(diagram.radius == 0)
    if corner.size:
        first, second = (diagram.vertex_sites[diagram.vertex_start[corner] + k].astype(np.int64) for k in (0, 1))
        one, other = (graph.segments[np.maximum(each - count, 0)] for each in (first, second))
        is_common = (one[:, 0] == other[:, 0]) | (one[:, 0] == other[:, 1])
        of_point[np.where(first < count, first, np.where(is_common, one[:, 0], one[:, 1]))] = corner
    return of_point
