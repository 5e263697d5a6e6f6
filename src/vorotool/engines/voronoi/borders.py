"""Borders between the places of different sites: edges of the segment Voronoi diagram, and walls."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.segment_voronoi.segment_voronoi import core_diagram
from vorotool.engines.voronoi.elements import OwnedGraph
from vorotool.errors import VerificationError
from vorotool.numeric.arrays import Floats, Indices
from vorotool.numeric.numbers import distinct
from vorotool.plain import plain
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.segment_voronoi import SegmentVoronoiDiagram
from vorotool.types.voronoi.voronoi_map import OUTSIDE

_INSIDE, _AT_VERTEX, _TOUCHING = range(3)
"""Where the core says that a crossing is: inside an edge, at its lower end, where two parts only touch each other."""

_ALIGNED, _LOST = 1, 2
"""What the core says of arcs about points: between two segments in one line, or rounded away."""

ROUNDING = 2.0**-48
"""Of coordinates on the lattice, by which places may be off."""

STEP = 4
"""By which orders around places are apart, so that arcs of the limit come in between."""


@plain(eq=False)
class Borders:
    """Pieces of borders in the plane, before a frame cuts them."""

    ends: Indices  # (b, 2) int64 array: source and target, numbers of `places`; -1 at infinity
    # (b, 2) int64 array: elements of the graph left and right, which the piece is equally far from; a wall has itself
    # twice
    elements: Indices
    sites: NDArray[np.int32]  # (b, 2) int32 array: left and right
    parts: Indices  # (b, 2) int64 array: left and right
    # (b, 2) int64 array: of the piece among those that leave its source, and its target: rising counter-clockwise
    order: Indices
    # (v, 2) float64 array: on the lattice: vertices of the diagram, then points that are none, then nodes of the
    # limit
    places: NDArray[np.float64]
    radius: NDArray[np.float64]  # (v,) float64 array: there
    # (b, 2) float64 array: of circular arcs along the limit, on the lattice; NaN of other pieces
    center: NDArray[np.float64]
    level: float  # the limit on the lattice; infinity without one


def borders_of(
    owned: OwnedGraph, diagram: SegmentVoronoiDiagram, *, level: float = np.inf, threads: int = 0
) -> Borders:
    """Choose the borders among the edges of a diagram and the segments of its graph."""
    whole = core_diagram(diagram, owned.graph.segment_faces)
    limit = None
    if np.isfinite(level):
        faces, is_own, alias = _core.voronoi.edge_faces(whole, threads, None)
        limit = Limit(owned.graph, diagram, level, faces, is_own.view(bool), owned.face < 0)
    try:
        made = _core.voronoi.site_borders(whole, owned.element, owned.face, _reach(limit), threads, None)
        added = made["added"]
        borders = Borders(
            made["ends"],
            made["elements"],
            made["sites"],
            made["parts"],
            made["order"],
            np.concatenate([diagram.vertices, owned.graph.points[added].astype(np.float64)]),
            np.concatenate([diagram.radius, np.zeros(len(added))]),
            np.full(made["ends"].shape, np.nan),
            level,
        )
        return borders if limit is None else _limited(borders, owned, limit, made | {"alias": alias}, whole)
    except RuntimeError as error:
        raise VerificationError(f"internal error in vorotool: {error}; please report it with the input") from None


# ---- the limit of distance --------------------------------------------------------------------------
def _reach(limit: Limit | None) -> tuple[NDArray[np.uint8], NDArray[np.int32]] | None:
    """Of each edge whether it is within the limit, and the vertices that ends of other pieces are at."""
    if limit is None:
        return None
    count = len(limit.diagram.edges)
    is_near = limit.is_near(np.arange(count), np.zeros(count, dtype=bool))
    return is_near.view(np.uint8), limit.vertices().astype(np.int32)


def _limited(
    borders: Borders, owned: OwnedGraph, limit: Limit, made: dict[str, Any], whole: _core.segment_voronoi.Diagram
) -> Borders:
    """Borders up to a limit, edges first, and the arcs along it."""
    edges, first = len(made["edge"]), len(borders.places)
    arcs = limit.arcs(first, lambda vertex, element: _core.voronoi.ranks_around(whole, vertex, element))
    is_first = made["is_first"].view(bool)
    is_half = made["point"] >= 0
    has_end = np.stack([~is_half | is_first, ~is_half | ~is_first], axis=1)
    ends, order = borders.ends.copy(), STEP * borders.order
    ends[:edges], order[:edges] = limit.cut(ends[:edges], order[:edges], made["edge"].astype(np.int64), has_end, first)
    element = _aliased(arcs.element, made["alias"])
    beyond = np.full(len(element), OUTSIDE)
    part = made["root"][_parts_of_elements(owned, element, arcs.face)]
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
    """Choose the edges between elements of one site, in the open: the distance from it has its maxima along these."""
    graph = owned.graph
    faces, is_own, alias = _core.voronoi.edge_faces(core_diagram(diagram, graph.segment_faces), threads, None)
    edge = np.flatnonzero(~is_own.view(bool))
    elements = diagram.edge_sites[edge].astype(np.int64)
    sites = owned.element[_aliased(elements, alias)]
    chosen = (sites[:, 0] == sites[:, 1]) & (owned.face[faces[edge, 0]] < 0)
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


# ---- parts -----------------------------------------------------------------------------------------
def _aliased(element: Indices, alias: NDArray[np.int32]) -> Indices:
    """Elements, but for points whose cells have no area their aliases, segments beside them."""
    points = len(alias)
    aliased: Indices = np.where(element < points, alias[np.minimum(element, points - 1)], element)
    return aliased


def _parts_of_elements(owned: OwnedGraph, element: Indices, face: NDArray[np.int32]) -> Indices:
    """(k,) the part that elements are in a face: points come first, then left and right sides of segments."""
    graph, count = owned.graph, len(owned.graph.points)
    segment = np.maximum(element - count, 0)
    sides = graph.segment_faces if len(graph) else np.zeros((1, 2), dtype=np.int32)
    is_right = sides[segment, 0] != face
    parts: Indices = np.where(element < count, element, count + 2 * segment + is_right)
    return parts


def sides_of_segments(owned: OwnedGraph) -> tuple[NDArray[np.bool_], NDArray[np.int32], Indices]:
    """Of each segment whether it is a border, and left and right its sites and parts."""
    graph, count = owned.graph, len(owned.graph.points)
    covering = owned.face[graph.segment_faces]
    is_free = covering < 0
    sites = np.where(is_free, owned.element[count:, None], covering)
    side = count + 2 * np.arange(len(graph))[:, None] + np.arange(2)
    parts = np.where(is_free, side, count + 2 * len(graph) + graph.segment_faces.astype(np.int64))
    return sites[:, 0] != sites[:, 1], sites, parts


# ---- the curves of a limit ---------------------------------------------------------------------------
@plain(eq=False)
class LimitArcs:
    """Arcs of a limit, each in the cell of an element of the graph, which is on its left."""

    ends: Indices  # (k, 2) int64 array: source and target: nodes
    element: Indices  # (k,) int64 array: the point or segment that they are at the distance from
    # (k,) int32 array: of the graph, which they are in; that of circles around points is not told
    face: NDArray[np.int32]
    order: Indices  # (k, 2) int64 array: around source and target
    # (k, 2) float64 array: on the lattice; NaN of straight lines. Circular arcs are at most half a circle
    center: Floats
    places: Floats  # (n, 2) float64 array: those of new nodes


class Limit:
    """The curves at one distance from all sites, by their crossings with the edges of a diagram."""

    def __init__(
        self,
        graph: PlanarGraph,
        diagram: SegmentVoronoiDiagram,
        level: float,
        edge_faces: NDArray[np.int32],
        is_own: NDArray[np.bool_],
        is_free: NDArray[np.bool_],
    ) -> None:
        self.graph, self.diagram, self.level, self.edge_faces = graph, diagram, level, edge_faces
        found = _core.offsets.level_crossings(
            core_diagram(diagram, graph.segment_faces),
            np.where(is_own, -1, edge_faces[:, 0]).astype(np.int32),
            np.where(is_free, -1, 0).astype(np.int32),
            level,
            None,
        )
        self.half_edge = found["half_edge"].astype(np.int64)
        self.across = found["across"].astype(np.int64)
        self.ending, self.arc, self.middle = found["ending"], found["arc"], found["middle"]
        self.is_lost = self._lost(found["place"])
        self.place = self._places(found["place"])
        self.cycle = _core.graphs.connected_components(self._onward(np.arange(len(self.across))), len(self.across))
        self.around = self._around_pinholes()
        self.circles = found["circles"].astype(np.int64)
        self.number = np.full(2 * len(diagram.edges), -1, dtype=np.int64)
        self.number[self.half_edge] = np.arange(len(self.half_edge))

    def _onward(self, chosen: Indices) -> NDArray[np.int32]:
        """(k, 2) crossings, and those that arcs from there lead to."""
        return np.stack([chosen, self.across[chosen]], axis=1).astype(np.int32)

    def _lost(self, places: Floats) -> NDArray[np.bool_]:
        """Of each crossing, whether rounding leaves nothing of the arc from there."""
        step = np.abs(places - places[self.across]).max(axis=1)
        largest = np.maximum(np.abs(places).max(axis=1), np.abs(self.graph.points).max(initial=0))
        is_short = (step <= ROUNDING * largest) & np.isnan(self.middle[:, 0]) & (self.arc != _ALIGNED)
        lost: NDArray[np.bool_] = is_short | (self.arc == _LOST)
        return lost

    def _places(self, places: Floats) -> Floats:
        """Of crossings: both ends of arcs that are lost are at one place, that of a vertex if there is one."""
        group = _core.graphs.connected_components(self._onward(np.flatnonzero(self.is_lost)), len(places))
        kept = np.arange(len(places))
        fixed = np.flatnonzero(self.ending != _INSIDE)
        kept[group[fixed]] = fixed
        return places[kept[group]]

    def _around_pinholes(self) -> Indices:
        """(c,) the number of each crossing, from 1, around what is far where rounding leaves a place of it; else 0."""
        is_seen = ~(self.is_lost | (self.arc == _ALIGNED)) | (self.ending != _INSIDE)
        is_hole = np.bincount(self.cycle, is_seen, minlength=len(self.across)) == 0
        around = np.zeros(len(self.across), dtype=np.int64)
        for first in distinct(self.cycle[is_hole[self.cycle]]).tolist():
            at, number = first, 1
            while not around[at]:
                around[at] = number
                at, number = int(self.across[at]), number + 1
        return around

    # ---- borders -----------------------------------------------------------------------------------
    def is_near(self, edge: Indices, is_half: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """(k,) whether more than a place of edges is within the limit; halves that end at a point always are."""
        radius = np.append(self.diagram.radius, np.inf)  # that of -1, at infinity
        is_far = (radius[self.diagram.edges[edge]] > self.level).all(axis=1) & (self.number[2 * edge] < 0)
        ending = np.append(self.ending, _INSIDE)  # that of -1, no crossing
        for hand in (0, 1):
            is_far |= ending[self.number[2 * edge + hand]] != _INSIDE
        near: NDArray[np.bool_] = ~is_far | is_half
        return near

    def nodes(self, first: int) -> tuple[Indices, Floats]:
        """(c,) the node of each crossing, a vertex or counted from a first number on, and the places of the latter."""
        edge, hand = self.half_edge >> 1, self.half_edge & 1
        same = np.arange(len(edge))
        touching = self.ending == _TOUCHING
        same[touching] = self.number[2 * edge[touching]]
        aligned = np.flatnonzero(self.arc == _ALIGNED)
        same[self.across[aligned]] = aligned
        same[self.around > 0] = self.cycle[self.around > 0]
        at_vertex = self.ending == _AT_VERTEX
        is_new = (same == np.arange(len(same))) & ~at_vertex
        number = np.cumsum(is_new) - 1 + first
        node = np.where(at_vertex, self.diagram.edges[edge, 1 - hand], number[same])
        return node.astype(np.int64), self.place[is_new]

    def vertices(self) -> Indices:
        """Vertices of the diagram that crossings are at."""
        edge, hand = self.half_edge >> 1, self.half_edge & 1
        at = self.ending == _AT_VERTEX
        return distinct(self.diagram.edges[edge[at], 1 - hand[at]]).astype(np.int64)

    def cut(
        self, ends: Indices, order: Indices, edge: Indices, has_end: NDArray[np.bool_], first: int
    ) -> tuple[Indices, Indices]:
        """Move ends of pieces of edges from beyond the limit to their crossings."""
        node, _ = self.nodes(first)
        ends, order = ends.copy(), order.copy()
        for hand in (0, 1):
            crossing = self.number[2 * edge + hand]
            cut = np.flatnonzero(has_end[:, hand] & (crossing >= 0))
            ends[cut, hand] = node[crossing[cut]]
            # before the arcs there; of two that come to one place beside the end of a segment, the left one is second
            first_or_second = -1 + (self.arc[crossing[cut]] == _ALIGNED)
            around = self.around[crossing[cut]]  # clockwise
            order[cut, hand] = np.where(around > 0, -around, first_or_second)
        return ends, order

    # ---- arcs --------------------------------------------------------------------------------------
    def arcs(self, first: int, rank: Callable[[Indices, Indices], Indices]) -> LimitArcs:
        """Give the arcs between crossings, those over half a circle in two, and the whole circles."""
        node, places = self.nodes(first)
        edge, hand = self.half_edge >> 1, self.half_edge & 1
        coming, leaving = self._orders(node, rank)
        is_long = ~np.isnan(self.middle[:, 0])
        kept = np.flatnonzero((self.arc != _ALIGNED) & (is_long | (node != node[self.across])))
        onward = self.across[kept]
        element = self.diagram.edge_sites[edge, 1 - hand].astype(np.int64)[kept]
        ends = np.stack([node[kept], node[onward]], axis=1)
        order = np.stack([leaving[kept], coming[onward]], axis=1)
        split = np.flatnonzero(is_long[kept])
        middle = first + len(places) + np.arange(len(split))
        second = np.stack([middle, ends[split, 1]], axis=1), np.stack([np.full(len(split), 1), order[split, 1]], axis=1)
        ends[split, 1], order[split, 1] = middle, 0
        around, of_circles = self._circles(first + len(places) + len(split))
        element = np.concatenate([element, element[split], np.repeat(self.circles, 2)])
        is_lost = np.zeros(len(element), dtype=bool)
        is_lost[: len(kept)] = self.is_lost[kept]
        is_arc = (element < len(self.graph.points)) & ~is_lost
        face = self.edge_faces[edge, hand][kept]
        return LimitArcs(
            np.concatenate([ends, second[0], around]),
            element,
            np.concatenate([face, face[split], np.zeros(len(around), dtype=np.int32)]),
            np.concatenate([order, second[1], np.tile([[0, 1]], (len(around), 1))]),
            np.where(is_arc[:, None], self.graph.points[np.where(is_arc, element, 0)], np.nan),
            np.concatenate([places, self.middle[kept[split]], of_circles]),
        )

    def _orders(self, node: Indices, rank: Callable[[Indices, Indices], Indices]) -> tuple[Indices, Indices]:
        """(c,) the orders around nodes of the arc that comes to each crossing, and of that which leaves it."""
        edge, hand = self.half_edge >> 1, self.half_edge & 1
        is_other = (self.ending == _TOUCHING) & (hand == 1)
        coming, leaving = np.where(is_other, 3, 1), np.where(is_other, 0, 2)
        at = np.flatnonzero(self.ending == _AT_VERTEX)
        far = STEP * (2 * rank(node[at], self.diagram.edge_sites[edge[at], hand[at]].astype(np.int64)) + 1)
        coming[at], leaving[at] = far - 1, far + 1
        return coming, leaving

    def _circles(self, first: int) -> tuple[Indices, Floats]:
        """(2 k, 2) ends of the halves of whole circles, and (2 k, 2) places of their nodes."""
        right = first + 2 * np.arange(len(self.circles))
        ends = np.stack([right, right + 1, right + 1, right], axis=1).reshape(-1, 2)
        center = self.graph.points[self.circles].astype(np.float64)
        aside = np.array([[self.level, 0.0], [-self.level, 0.0]])
        return ends, (center[:, None] + aside).reshape(-1, 2)
