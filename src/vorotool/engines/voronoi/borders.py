"""Borders between the places of different sites: edges of the segment Voronoi diagram, and walls."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.segment_voronoi.segment_voronoi import core_diagram
from vorotool.engines.voronoi.elements import OwnedGraph
from vorotool.engines.voronoi.limits import STEP, Limit
from vorotool.errors import VerificationError
from vorotool.plain import plain
from vorotool.types.skeleton.segment_voronoi import SegmentVoronoiDiagram
from vorotool.types.voronoi.voronoi_map import OUTSIDE

Indices = NDArray[np.int64]


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
