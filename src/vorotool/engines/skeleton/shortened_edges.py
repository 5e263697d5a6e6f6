"""Skeletons by the paper's decomposition: points, and edges shortened at both ends (section 3.2, Figure 10)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.arrangement.planar_graph import Placement, arranged, graph_for_skeletons, placed_vertices
from vorotool.engines.arrangement.repaired_polygons import PlacedShapes, placed_shapes
from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi, segment_voronoi_of_groups
from vorotool.engines.skeleton.exact import (
    ShapeDiagram,
    assembled,
    diagram_of_placed,
    face_groups,
    interior_skeleton,
    of_one_arrangement,
    skeleton_of,
    whole_diagram,
)
from vorotool.errors import InputError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Indices, crosses, dots, following, owners
from vorotool.numeric.curves.inverse_functions import angle_of, hypotenuse
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import is_among
from vorotool.numeric.parallel import Run
from vorotool.types.box import Extent, bounds
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import LINE, PolygonSet
from vorotool.types.skeleton.segment_voronoi import SegmentVoronoiDiagram, SiteTable
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.values import counted

DEVIATION_STEPS = 2.0**-14
"""Of the extent: how finely arcs are flattened to measure how far two skeletons are apart."""


@frozen(eq=False)
class ElementDiagram:
    """Elements of shapes, and their Voronoi diagram."""

    shapes: PlanarGraph  # of the polygons: vertex i is element i, edge j element n + j
    graph: PlanarGraph  # of the elements: the shortened edges' new ends are at the nearest lattice points
    diagram: SegmentVoronoiDiagram
    # (s,) int64 array: the element that each site of the diagram is a part of: a shortened edge is a closed segment,
    # of three sites
    element: NDArray[np.int64]
    placed: PlacedShapes  # the rings as `shapes` has them, and what the elements are there
    gap: float  # by how much edges are shortened at both ends


def element_diagram(polygons: Any, gap: float, *, threads: int = 0) -> ElementDiagram:
    """Decompose polygons, and compute the Voronoi diagram of the elements."""
    return elements_of_graph(graph_for_skeletons(polygons, threads=threads), gap, threads=threads)


def elements_of_graph(shapes: PlanarGraph, gap: float, **run: Unpack[Run]) -> ElementDiagram:
    """Decompose polygons that are placed; errors as of `element_diagram`."""
    placed = placed_shapes(shapes)
    ShortEdges.of(shapes, gap).refuse(placed.polygons, placed.sites, gap)
    return elements_of_shapes(shapes, placed, gap, **run)


def elements_of_shapes(
    shapes: PlanarGraph,
    placed: PlacedShapes,
    gap: float,
    *,
    within: NDArray[np.int32] | None = None,
    feature: NDArray[np.int64] | None = None,
    **run: Unpack[Run],
) -> ElementDiagram:
    """Decompose polygons whose edges are all longer than twice the gap."""
    points = shapes.coordinates()
    a, b = points[shapes.segments].swapaxes(0, 1)
    way = (b - a) * (gap / np.sqrt(np.square(b - a).sum(axis=1, keepdims=True)))
    ends = np.stack([a + way, b - way], axis=1).reshape(-1, 2)
    count = len(points) + len(shapes)
    starts = np.concatenate([np.arange(len(points)), len(points) + 2 * np.arange(len(shapes) + 1)])
    elements = PolygonSet(
        np.concatenate([points, ends]), starts, np.full(count, LINE, np.int8), np.arange(count, dtype=np.int32)
    )
    placement, box = _placed_within(elements, shapes, within, **run)
    # rounded ends may touch: nobody asked about these
    graph = arranged(elements, placement, progress=run.get("progress")).graph
    owner = owners(np.diff(starts))
    vertex = np.concatenate([graph.point_vertex, graph.source_edge[graph.source_starts[:-1]]])
    if feature is None:
        diagram = segment_voronoi(graph.points, graph.segments, within=box, **run)
    else:
        group = np.concatenate([feature, feature[shapes.segments[:, 0]]])[owner[vertex]]
        diagram = segment_voronoi_of_groups(graph.points, graph.segments, group, within=box, **run)
    return ElementDiagram(shapes, graph, diagram, owner[vertex], placed, gap)


def _placed_within(
    elements: PolygonSet, shapes: PlanarGraph, within: NDArray[np.int32] | None, **run: Unpack[Run]
) -> tuple[Placement, tuple[int, int, int, int] | None]:
    """Elements on a lattice over further places too, and the bounds of all there."""
    if within is None:
        return placed_vertices(elements, **run), None
    places = np.concatenate([elements.xy, shapes.coordinates(within)])
    count = len(places)
    alone = PolygonSet(places, np.arange(count + 1), np.full(count, LINE, np.int8), np.arange(count, dtype=np.int32))
    placement = placed_vertices(alone, **run)
    (least_x, least_y), (most_x, most_y) = (bound.tolist() for bound in bounds(placement.vertices))
    own = replace(placement, vertices=placement.vertices[: len(elements.xy)])
    return own, (least_x, most_x, least_y, most_y)


def skeleton_of_elements(
    elements: ElementDiagram,
    *,
    side: str = "interior",
    complete: bool = True,
    frame: Extent | None = None,
    **run: Unpack[Run],
) -> Skeleton:
    """Delete the bisectors of elements with a label in common, and add the missing portions if wanted."""
    kept = np.flatnonzero(~_share_label(elements)).astype(np.int32)
    group = face_groups(elements.placed, side)[_faces_of(elements, kept)]
    diagram = elements.diagram
    if complete:
        portions, sites, faces = _missing_portions(elements, kept)
        own = face_groups(elements.placed, side)[faces]
        diagram, added = _with_portions(elements, portions, sites)
        kept, group = np.concatenate([kept, added]), np.concatenate([group, own])
    on_side = group >= 0
    made = assembled(
        ShapeDiagram(elements.graph, diagram, elements.placed),
        kept[on_side],
        group[on_side].astype(np.int32),
        frame=frame,
        clips=side != "interior",
        **run,
    )
    return _of_elements(made, elements)


def whole_element_diagram(elements: ElementDiagram, *, frame: Extent | None = None, threads: int = 0) -> Skeleton:
    """Give all edges of the diagram of elements; see `vorotool.engines.skeleton.exact.whole_diagram`."""
    shapes = ShapeDiagram(elements.graph, elements.diagram, elements.placed)
    return _of_elements(whole_diagram(shapes, frame=frame, threads=threads), elements)


def _of_elements(made: Skeleton, elements: ElementDiagram) -> Skeleton:
    return replace(
        of_one_arrangement(made),
        sites=elements.element[made.sites].astype(np.int32),
        error_bound=np.full(len(made), np.nan),
        gap=elements.gap,
    )


def _share_label(elements: ElementDiagram) -> NDArray[np.bool_]:
    """(e,) edges between elements with a label in common: an edge has one label, a vertex those of its edges."""
    left, right = np.sort(elements.element[elements.diagram.edge_sites], axis=1).T
    vertices = len(elements.shapes.points)
    share: NDArray[np.bool_] = left == right
    mixed = np.flatnonzero((left < vertices) & (right >= vertices))
    ends = elements.shapes.segments[right[mixed] - vertices]
    share[mixed] = (ends == left[mixed, None]).any(axis=1)
    both = np.flatnonzero((right < vertices) & ~share)  # neighboring vertices have the label of the edge between them
    low, high = np.sort(elements.shapes.segments.astype(np.int64), axis=1).T
    share[both] = is_among(left[both] * vertices + right[both], low * vertices + high)
    return share


def _middles(diagram: SegmentVoronoiDiagram, edges: NDArray[np.int32]) -> NDArray[np.float64]:
    """Places inside edges, or beyond the end of unbounded ones: about half-way between the ends' directions."""
    source, target = diagram.edges[edges].T
    ends = np.where(source >= 0, source, target), np.where(target >= 0, target, source)
    if not len(diagram.vertices):
        return np.zeros((len(edges), 2))
    return diagram.vertices[np.stack(ends)].mean(axis=0)


def _faces_of(elements: ElementDiagram, kept: NDArray[np.int32]) -> NDArray[np.int32]:
    """The face of the shapes that each edge is in: of an edge that leaves it through a gap, its middle's."""
    diagram, shapes = elements.diagram, elements.shapes
    middle = _middles(diagram, kept)
    sites = elements.element[diagram.edge_sites[kept]]
    face = np.zeros(len(kept), dtype=np.int32)
    unbounded = (diagram.edges[kept] < 0).any(axis=1)
    vertices = len(shapes.points)
    nearest = sites.max(axis=1)  # an edge of the shapes, if one of the two is
    by_edge = np.flatnonzero((nearest >= vertices) & ~unbounded)
    segment = nearest[by_edge] - vertices
    a, b = elements.shapes.points[shapes.segments[segment]].astype(np.float64).swapaxes(0, 1)
    place = _in_shapes(elements, middle[by_edge])
    left = crosses(b - a, place - a) > 0
    face[by_edge] = shapes.segment_faces[segment, np.where(left, 0, 1)]
    by_vertex = np.flatnonzero((nearest < vertices) & ~unbounded)
    face[by_vertex] = _sector_faces(shapes, nearest[by_vertex], _in_shapes(elements, middle[by_vertex]))
    return face


def _in_shapes(elements: ElementDiagram, places: NDArray[np.float64]) -> NDArray[np.float64]:
    """From the lattice of the elements to that of the shapes."""
    return (elements.graph.coordinates(places) - elements.shapes.origin) / elements.shapes.scale


def _sector_faces(shapes: PlanarGraph, vertex: NDArray[np.int64], place: NDArray[np.float64]) -> NDArray[np.int32]:
    """The faces in which places lie as seen from vertices; face 0 where a vertex has no edges."""
    at = np.concatenate([shapes.segments[:, 0], shapes.segments[:, 1]]).astype(np.int64)
    to = np.concatenate([shapes.segments[:, 1], shapes.segments[:, 0]])
    left = np.concatenate([shapes.segment_faces[:, 0], shapes.segment_faces[:, 1]])
    if not len(at):
        return np.zeros(len(vertex), dtype=np.int32)
    way = (shapes.points[to].astype(np.float64) - shapes.points[at]).T
    angle = angle_of(*way)
    order = np.lexsort((angle, at))
    at, angle, left = at[order], angle[order], left[order]
    seen = (place - shapes.points[vertex]).T
    wanted = angle_of(*seen)
    first, stop = np.searchsorted(at, vertex), np.searchsorted(at, vertex, side="right")
    # by their ranks among all angles: a vertex sees the same whatever its number is
    _, ranks = np.unique(np.concatenate([angle, wanted]), return_inverse=True)
    known, sought = np.split(ranks.reshape(-1), [len(at)])
    rank = np.searchsorted(at * len(ranks) + known, vertex * len(ranks) + sought, side="right") - 1
    rank = np.where(rank < first, stop - 1, rank)
    return np.where(stop > first, left[np.clip(rank, 0, len(left) - 1)], 0).astype(np.int32)


def _missing_portions(
    elements: ElementDiagram, kept: NDArray[np.int32]
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]:
    """Vertices of the diagram and corners to join, (k, 2), the sites beside the lines between, and their faces."""
    diagram, corners = elements.diagram, len(elements.shapes.points)
    degree = np.bincount(diagram.edges[kept][diagram.edges[kept] >= 0], minlength=len(diagram))
    start = diagram.vertex_starts
    vertex = np.repeat(np.arange(len(diagram)), np.diff(start))
    at = np.flatnonzero((degree[vertex] == 1) & (elements.element[diagram.vertex_sites] < corners))
    vertex, corner = vertex[at], elements.element[diagram.vertex_sites[at]]
    before = diagram.vertex_sites[np.where(at == start[vertex], start[vertex + 1], at) - 1]
    after = diagram.vertex_sites[np.where(at + 1 == start[vertex + 1], start[vertex], at + 1)]
    edges = elements.element[np.stack([before, after])] - corners
    is_end = (elements.shapes.segments[edges] == corner[:, None]).any(axis=2)
    beside = ((edges >= 0) & is_end).all(axis=0)
    portions = list(zip(vertex[beside].tolist(), corner[beside].tolist(), strict=True))
    sites = list(zip(after[beside].tolist(), before[beside].tolist(), strict=True))
    done = elements.element[np.array(sites, dtype=np.int64).reshape(-1, 2)]
    for portion, beside in _portions_to_arcs(elements, kept, set(map(tuple, done.tolist()))):
        portions.append(portion)
        sites.append(beside)
    pairs = np.array(portions, dtype=np.int32).reshape(-1, 2)
    places = _in_shapes(elements, diagram.vertices[pairs[:, 0]])
    faces = _sector_faces(elements.shapes, pairs[:, 1].astype(np.int64), places)
    return pairs, np.array(sites, dtype=np.int32).reshape(-1, 2), faces


def _portions_to_arcs(
    elements: ElementDiagram, kept: NDArray[np.int32], done: set[tuple[int, ...]]
) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
    """For corners between edges that are not done yet: vertex and corner, and the sites left and right of the line."""
    shapes, diagram = elements.shapes, elements.diagram
    corners = len(shapes.points)
    sectors = corner_sectors(shapes)
    first_site = len(diagram.points)
    site_of = dict(zip(elements.element[first_site:].tolist(), range(first_site, len(elements.element)), strict=True))
    ends = diagram.edges[kept]
    beside = elements.element[diagram.edge_sites[kept]]
    for point, right, left in zip(sectors.point.tolist(), sectors.right.tolist(), sectors.left.tolist(), strict=True):
        if (corners + right, corners + left) in done:
            continue
        around = np.unique(ends[(beside == point).any(axis=1)])
        around = around[around >= 0]
        way = _in_shapes(elements, diagram.vertices[around]) - shapes.points[point]
        a, b = (_way_from(shapes, point, segment) for segment in (right, left))
        inside = (a[0] * way[:, 1] > a[1] * way[:, 0]) & (b[0] * way[:, 1] < b[1] * way[:, 0])
        if inside.any():
            middle = a / hypotenuse(*a) + b / hypotenuse(*b)
            towards = dots(way, middle) / hypotenuse(*way.T)
            vertex = int(around[np.where(inside, towards, -np.inf).argmax()])
            yield (vertex, point), (site_of[corners + right], site_of[corners + left])


def _way_from(shapes: PlanarGraph, point: int, segment: int) -> NDArray[np.float64]:
    a, b = shapes.segments[segment]
    return shapes.points[b if a == point else a].astype(np.float64) - shapes.points[point]


def _with_portions(
    elements: ElementDiagram, portions: NDArray[np.int32], sites: NDArray[np.int32]
) -> tuple[SegmentVoronoiDiagram, NDArray[np.int32]]:
    """Add straight edges that end in corners; gives their numbers too."""
    diagram, corners = elements.diagram, portions[:, 1]
    site_of = np.full(len(elements.shapes.points), -1)
    own = np.flatnonzero(elements.element[: len(diagram.points)] < len(site_of))
    site_of[elements.element[own]] = own
    ends = np.stack([portions[:, 0], len(diagram) + np.arange(len(corners))], axis=1)
    extended = replace(
        diagram,
        vertices=np.concatenate([diagram.vertices, diagram.points[site_of[corners]].astype(np.float64)]),
        radius=np.concatenate([diagram.radius, np.zeros(len(corners))]),
        vertex_starts=np.concatenate([diagram.vertex_starts, np.full(len(corners), diagram.vertex_starts[-1])]),
        edges=np.concatenate([diagram.edges, ends.astype(np.int32)]),
        edge_sites=np.concatenate([diagram.edge_sites, sites]),
    )
    return extended, np.arange(len(diagram.edges), len(extended.edges), dtype=np.int32)


def gap_deviation(skeleton: Skeleton, exact: Skeleton) -> float:
    """Measure how far places on a skeleton with a gap are at most from the exact one."""
    if not len(skeleton) or not len(exact):
        return 0.0
    tolerance = DEVIATION_STEPS * float(np.ptp(exact.polygons.xy, axis=0).max())
    places = shapely.points(skeleton.flattened(tolerance)[0])
    points, start = exact.flattened(tolerance / 16)
    lines = shapely.linestrings(points, indices=owners(np.diff(start)))
    _, distance = shapely.STRtree(lines).query_nearest(places, return_distance=True, all_matches=False)
    return float(distance.max())


def exact_for(elements: ElementDiagram, side: str, *, frame: Extent | None = None, threads: int = 0) -> Skeleton:
    """Compute the exact skeleton of the shapes that were decomposed."""
    whole = diagram_of_placed(elements.shapes, elements.placed, threads=threads)
    return skeleton_of(whole, side=side, frame=frame, threads=threads)


def exact_inside(elements: ElementDiagram) -> Skeleton:
    """Compute what is inside the shapes that were decomposed exactly, and say no word if there is nothing."""
    return interior_skeleton(diagram_of_placed(elements.shapes, elements.placed, threads=1), threads=1)


@frozen(eq=False)
class ShortEdges:
    """Segments that are not longer than twice a gap."""

    site: NDArray[np.int64]  # (k,) int array: their numbers among the sites
    ends: NDArray[np.float64]  # (k, 2, 2) float64 array: where they begin and end
    length: NDArray[np.float64]  # (k,) float64 array: how long they are

    @classmethod
    def of(cls, graph: PlanarGraph, gap: float) -> ShortEdges:
        """Find those of a graph."""
        ends = graph.coordinates()[graph.segments]
        length = hypotenuse(*(ends[:, 1] - ends[:, 0]).T)
        short = np.flatnonzero(~(length > 2 * gap))
        return cls(len(graph.points) + short, ends[short], length[short])

    def __len__(self) -> int:
        return len(self.site)

    def refuse(self, polygons: PolygonSet, sites: SiteTable, gap: float) -> None:
        """Raise InputError if there are any, naming the first along the input."""
        if not len(self):
            return
        first = int(self.site.argmin())
        site = self.site[first]
        ring = int(sites.rings(polygons, site))
        (ax, ay), (bx, by) = self.ends[first].tolist()
        raise InputError(
            f"{polygons.ring_place(ring)}, edge {int(sites.index[site]) + 1} from ({ax!r}, {ay!r}) to ({bx!r}, {by!r}) "
            f"is {self.length[first]:.6g} long, and a gap of {gap:g} at both ends leaves nothing of it "
            f"({counted(len(self), 'such edge')}): use a gap below {self.length.min() / 2:.6g}"
        )


@frozen
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
