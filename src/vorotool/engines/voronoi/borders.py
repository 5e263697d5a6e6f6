"""Borders between the places of different sites: edges of the segment Voronoi diagram, and walls."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.segment_voronoi.segment_voronoi import core_diagram
from vorotool.engines.voronoi.site_graph import OwnedGraph
from vorotool.errors import VerificationError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, Indices
from vorotool.numeric.numbers import distinct
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


@frozen(eq=False)
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
    limit = Limit(owned, diagram, whole, level, threads) if np.isfinite(level) else None
    reach = None if limit is None else (limit.is_near().view(np.uint8), limit.vertices().astype(np.int32))
    try:
        made = _core.voronoi.site_borders(whole, owned.element, owned.face, reach, threads, None)
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
        return borders if limit is None else limit.applied(borders, made)
    except RuntimeError as error:
        raise VerificationError(f"internal error in vorotool: {error}; please report it with the input") from None


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
    return np.where(element < points, alias[np.minimum(element, points - 1)], element)


def _parts_of_elements(owned: OwnedGraph, element: Indices, face: NDArray[np.int32]) -> Indices:
    """(k,) the part that elements are in a face: points come first, then left and right sides of segments."""
    graph, count = owned.graph, len(owned.graph.points)
    segment = np.maximum(element - count, 0)
    sides = graph.segment_faces if len(graph) else np.zeros((1, 2), dtype=np.int32)
    is_right = sides[segment, 0] != face
    return np.where(element < count, element, count + 2 * segment + is_right)


def sites_beside_segments(owned: OwnedGraph) -> NDArray[np.int32]:
    """(m, 2) the sites left and right of each segment."""
    covering = owned.face[owned.graph.segment_faces]
    return np.where(covering < 0, owned.element[len(owned.graph.points) :, None], covering)


# ---- the limit of distance --------------------------------------------------------------------------
class Limit:
    """The curves at one distance from all sites, by their crossings with the edges of a diagram."""

    def __init__(
        self,
        owned: OwnedGraph,
        diagram: SegmentVoronoiDiagram,
        whole: _core.segment_voronoi.Diagram,
        level: float,
        threads: int,
    ) -> None:
        self.owned, self.diagram, self.whole, self.level = owned, diagram, whole, level
        faces, is_own, self.alias = _core.voronoi.edge_faces(whole, threads, None)
        edge_face = np.where(is_own.view(bool), -1, faces[:, 0]).astype(np.int32)
        free = np.where(owned.face < 0, -1, 0).astype(np.int32)
        found = _core.offsets.level_crossings(whole, edge_face, free, level, None)
        half_edge = found["half_edge"].astype(np.int64)
        self.number = np.full(2 * len(diagram.edges), -1, dtype=np.int64)
        self.number[half_edge] = np.arange(len(half_edge))
        # of each crossing: its edge, the end that it cuts off, the vertex at the other end, the elements that the curve
        # comes from and goes on to, and their face
        self.edge, self.end = half_edge >> 1, half_edge & 1
        self.vertex = diagram.edges[self.edge, 1 - self.end].astype(np.int64)
        self.behind, self.ahead = (
            diagram.edge_sites[self.edge, end].astype(np.int64) for end in (self.end, 1 - self.end)
        )
        self.face = faces[self.edge, self.end]
        self.across = found["across"].astype(np.int64)  # the crossing where its arc ends
        self.ending, self.middle, self.circles = found["ending"], found["middle"], found["circles"].astype(np.int64)
        self.is_aligned = found["arc"] == _ALIGNED
        self.is_lost = self._lost(found["place"]) | (found["arc"] == _LOST)
        self.place = self._places(found["place"])
        self.cycle = self._joined(np.arange(len(self.across)))
        self.around = self._around_pinholes()

    def _joined(self, chosen: Indices) -> NDArray[np.int32]:
        """(c,) the same number for crossings that arcs from some of them join."""
        pairs = np.stack([chosen, self.across[chosen]], axis=1).astype(np.int32)
        return _core.graphs.connected_components(pairs, len(self.across))

    def _lost(self, places: Floats) -> NDArray[np.bool_]:
        """Of each crossing, whether rounding leaves nothing of the arc from there."""
        step = np.abs(places - places[self.across]).max(axis=1)
        largest = np.maximum(np.abs(places).max(axis=1), np.abs(self.owned.graph.points).max(initial=0))
        return (step <= ROUNDING * largest) & np.isnan(self.middle[:, 0]) & ~self.is_aligned

    def _places(self, places: Floats) -> Floats:
        """Of crossings: both ends of arcs that are lost are at one place, that of a vertex if there is one."""
        group = self._joined(np.flatnonzero(self.is_lost))
        kept = np.arange(len(places))
        fixed = np.flatnonzero(self.ending != _INSIDE)
        kept[group[fixed]] = fixed
        return places[kept[group]]

    def _around_pinholes(self) -> Indices:
        """(c,) the number of each crossing, from 1, around what is far where rounding leaves a place of it; else 0."""
        is_seen = ~(self.is_lost | self.is_aligned) | (self.ending != _INSIDE)
        is_hole = np.bincount(self.cycle, is_seen, minlength=len(self.across)) == 0
        around = np.zeros(len(self.across), dtype=np.int64)
        for first in distinct(self.cycle[is_hole[self.cycle]]).tolist():
            at, number = first, 1
            while not around[at]:
                around[at] = number
                at, number = int(self.across[at]), number + 1
        return around

    def is_near(self) -> NDArray[np.bool_]:
        """(e,) whether more than a place of each edge is within the limit."""
        radius = np.append(self.diagram.radius, np.inf)  # that of -1, at infinity
        near: NDArray[np.bool_] = radius[self.diagram.edges].min(axis=1) <= self.level
        near[self.edge[self.end == 0]] = True
        near[self.edge[self.ending != _INSIDE]] = False
        return near

    def vertices(self) -> Indices:
        """Vertices of the diagram that crossings are at."""
        return distinct(self.vertex[self.ending == _AT_VERTEX])

    def applied(self, borders: Borders, made: dict[str, Any]) -> Borders:
        """Cut borders where they go beyond the limit, edges of the diagram first, and add the arcs along it."""
        node, is_new = self._nodes(len(borders.places))
        ends, order = borders.ends.copy(), STEP * borders.order
        edge, is_whole, is_first = made["edge"].astype(np.int64), made["point"] < 0, made["is_first"].view(bool)
        for end, has_end in enumerate((is_whole | is_first, is_whole | ~is_first)):
            crossing = self.number[2 * edge + end]
            cut = np.flatnonzero(has_end & (crossing >= 0))
            crossing = crossing[cut]
            ends[cut, end] = node[crossing]
            # before the arcs there; of two that come to one place beside the end of a segment, the left one is second
            first_or_second = -1 + self.is_aligned[crossing]
            around = self.around[crossing]  # clockwise
            order[cut, end] = np.where(around > 0, -around, first_or_second)
        cut_borders = replace(borders, ends=ends, order=order)
        arcs = self._arcs(node, len(borders.places), self.place[is_new], made["root"])
        columns: dict[str, Any] = {
            name: np.concatenate([getattr(cut_borders, name), getattr(arcs, name)])
            for name in Borders.__dataclass_fields__
            if name != "level"
        }
        return replace(arcs, **columns)

    def _nodes(self, first: int) -> tuple[Indices, NDArray[np.bool_]]:
        """(c,) the node of each crossing, a vertex or counted from a first number on, and whether it is counted."""
        same = np.arange(len(self.edge))
        touching = self.ending == _TOUCHING
        same[touching] = self.number[2 * self.edge[touching]]
        aligned = np.flatnonzero(self.is_aligned)
        same[self.across[aligned]] = aligned
        same[self.around > 0] = self.cycle[self.around > 0]
        at_vertex = self.ending == _AT_VERTEX
        is_new = (same == np.arange(len(same))) & ~at_vertex
        number = np.cumsum(is_new) - 1 + first
        return np.where(at_vertex, self.vertex, number[same]), is_new

    def _arcs(self, node: Indices, first: int, places: Floats, root: NDArray[np.int32]) -> Borders:
        """Give the arcs between crossings, those over half a circle in two, and the whole circles."""
        is_long = ~np.isnan(self.middle[:, 0])
        kept = np.flatnonzero(~self.is_aligned & (is_long | (node != node[self.across])))
        onward, split = self.across[kept], np.flatnonzero(is_long[kept])
        coming, leaving = self._orders(node)
        ends, order = np.stack([node[kept], node[onward]], axis=1), np.stack([leaving[kept], coming[onward]], axis=1)
        middle = first + len(places) + np.arange(len(split))
        second_ends = np.stack([middle, ends[split, 1]], axis=1)
        second_order = np.stack([np.ones_like(middle), order[split, 1]], axis=1)
        ends[split, 1], order[split, 1] = middle, 0
        right = first + len(places) + len(split) + 2 * np.arange(len(self.circles))
        circles = np.stack([right, right + 1, right + 1, right], axis=1).reshape(-1, 2)
        center = self.owned.graph.points[self.circles].astype(np.float64)
        aside = np.array([[self.level, 0.0], [-self.level, 0.0]])
        own = np.concatenate([kept, kept[split]])
        element = np.concatenate([self.ahead[own], np.repeat(self.circles, 2)])
        face = np.concatenate([self.face[own], np.zeros(len(circles), dtype=np.int32)])
        is_arc = element < len(self.alias)
        is_arc[: len(kept)] &= ~self.is_lost[kept]
        places = np.concatenate([places, self.middle[kept[split]], (center[:, None] + aside).reshape(-1, 2)])
        aliased, beyond = _aliased(element, self.alias), np.full(len(element), OUTSIDE)
        part = root[_parts_of_elements(self.owned, aliased, face)]
        return Borders(
            np.concatenate([ends, second_ends, circles]),
            np.stack([element, element], axis=1),
            np.stack([self.owned.element[aliased], beyond], axis=1).astype(np.int32),
            np.stack([part, beyond], axis=1),
            np.concatenate([order, second_order, np.tile([[0, 1]], (len(circles), 1))]),
            places,
            np.full(len(places), self.level),
            np.where(is_arc[:, None], self.owned.graph.points[np.where(is_arc, element, 0)], np.nan),
            self.level,
        )

    def _orders(self, node: Indices) -> tuple[Indices, Indices]:
        """(c,) the orders around nodes of the arc that comes to each crossing, and of that which leaves it."""
        is_other = (self.ending == _TOUCHING) & (self.end == 1)
        coming, leaving = np.where(is_other, 3, 1), np.where(is_other, 0, 2)
        at = np.flatnonzero(self.ending == _AT_VERTEX)
        far = STEP * (2 * _core.voronoi.ranks_around(self.whole, node[at], self.behind[at]) + 1)
        coming[at], leaving[at] = far - 1, far + 1
        return coming, leaving
