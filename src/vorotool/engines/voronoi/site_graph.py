"""What belongs to which site: points, open segments and faces of the planar graph of all sites."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.arrangement.planar_graph import (
    MOST_VERTICES,
    Placement,
    arranged,
    placed_vertices,
    report_repairs,
    report_small,
)
from vorotool.engines.arrangement.repaired_polygons import flat_holes, given_shapes, with_flat_shells_as_lines
from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi, unwanted_sides
from vorotool.errors import InputError, LimitError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Indices, dots, owners, ranges, starts_of
from vorotool.numeric.crs import crs_name, same_crs
from vorotool.numeric.parallel import Progress, Run
from vorotool.products.formats import resolved
from vorotool.types.box import Extent, Sides, bounds, check_magnitude, default_frame, extent_sides
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import LINE, SHELL, PolygonSet, set_of_rings
from vorotool.types.polygons.shapely_geometry import RingArrays
from vorotool.types.skeleton.segment_voronoi import SegmentVoronoiDiagram

Sites = NDArray[np.int32]

NOBODY = np.int32(2**31 - 1)
"""A site after all others, while the smallest is looked for."""

_FAULTS = ("repeated_vertices", "idle_segments", "empty_polygons")


@frozen(eq=False)
class OwnedGraph:
    """A planar graph, and the site that has each of its elements."""

    graph: PlanarGraph  # of all sites together
    element: Sites  # (n + m,) int32 array: the site on whose boundary each point and open segment is
    face: Sites  # (f,) int32 array: the site that covers each face; -1 where none does


def owned_graph(polygons: PolygonSet, site: Sites, *, threads: int = 0, progress: Progress = None) -> OwnedGraph:
    """Put polygons and lines into one planar graph, and tell whose its elements are."""
    given = with_flat_shells_as_lines(polygons)
    check_magnitude(given.xy)
    if len(given.xy) > MOST_VERTICES:
        raise LimitError(f"the input has {len(given.xy)} vertices, more than {MOST_VERTICES}: split the polygons")
    placement = placed_vertices(given, threads=threads, progress=progress)
    return owners_of(graph_of_sites(given, placement, progress=progress), site)


def owners_of(graph: PlanarGraph, site: Sites) -> OwnedGraph:
    """Tell whose the elements of a graph are."""
    return OwnedGraph(graph, _element_owners(graph, site), _face_owners(graph, site))


def shared_elements(owned: OwnedGraph, site: Sites) -> tuple[int, int, int]:
    """Count the points, segments and faces that several sites have, of which the smallest was given each."""
    graph = owned.graph
    points = [_lone_places(graph)]
    segments = faces = 0
    if len(graph):
        is_part, polygon = _bounding_sources(graph)
        segment = np.repeat(np.arange(len(graph)), graph.source_count)[is_part]
        segments = _with_several(segment, site[polygon[is_part]], len(graph))
        points += [(graph.segments[segment, end], polygon[is_part]) for end in (0, 1)]
    if len(graph.face_polygon):
        faces = _with_several(owners(np.diff(graph.face_starts)), site[graph.face_polygon], graph.faces)
    at, of = (np.concatenate(each) for each in zip(*points, strict=True))
    return _with_several(at, site[of], len(graph.points)), segments, faces


def _with_several(element: NDArray[np.integer], site: Sites, count: int) -> int:
    """How many of so many elements have more than one site."""
    least, most = np.full(count, NOBODY), np.full(count, -1, dtype=np.int32)
    np.minimum.at(least, element, site)
    np.maximum.at(most, element, site)
    return int((least < most).sum())


def graph_of_sites(given: PolygonSet, placement: Placement, *, progress: Progress = None) -> PlanarGraph:
    """Make the graph of polygons and lines that are placed on a lattice; a polygon without inside there is a line."""
    made = arranged(given, placement, progress=progress)
    found = {name: each if name in _FAULTS else (0, -1, -1) for name, each in made.found.items()}
    is_empty = ~given.is_line
    is_empty[made.graph.face_polygon] = False
    found["idle_segments"] = _with_hidden_spikes(found["idle_segments"], made.graph, is_empty)
    if any(count for count, _, _ in found.values()):
        report_repairs(given, found, is_empty | _lacking(made.graph), made.graph.scale, strict=False)
    report_small(given, placement, strict=False)
    if is_empty.any():
        given, taken = _as_lines(given, is_empty)
        made = arranged(given, replace(placement, vertices=placement.vertices[taken]), progress=progress)
    return made.graph


def _with_hidden_spikes(
    found: tuple[int, int, int], graph: PlanarGraph, is_empty: NDArray[np.bool_]
) -> tuple[int, int, int]:
    """Count segments that bound nothing of their polygon among those that are there, since others lie on them, too."""
    if _are_of_single_edges(graph):
        return found
    is_part, polygon = _bounding_sources(graph)
    hidden = np.flatnonzero(~is_part & ~is_empty[polygon])
    if not hidden.size:
        return found
    count, edge, other = found
    return (count + hidden.size, int(graph.source_edge[hidden].min()) if count == 0 else edge, other)


def _lacking(graph: PlanarGraph) -> NDArray[np.bool_]:
    """(p,) whether a polygon has an edge that is not, or not as a whole, a part of what bounds it, or a point."""
    given, vertices = given_shapes(graph)
    places = vertices.astype(np.int64)
    whole = np.abs(places[given.following] - places).sum(axis=1)
    own = owners(np.diff(given.ring_starts))
    of_vertex = given.ring_polygon[own]
    there = np.zeros(len(own), dtype=np.int64)
    if len(graph):
        is_part, _ = _bounding_sources(graph)
        ends = graph.points[graph.segments].astype(np.int64)
        length = np.repeat(np.abs(ends[:, 1] - ends[:, 0]).sum(axis=1), graph.source_count)
        np.add.at(there, graph.source_edge[is_part], length[is_part])  # along an edge both coordinates are monotone
    lacks = ~given.ends_line & ((there != whole) | (whole == 0)) & (np.diff(given.ring_starts)[own] > 1)
    return np.bincount(of_vertex, lacks, minlength=len(given)) > 0


def _as_lines(polygons: PolygonSet, chosen: NDArray[np.bool_]) -> tuple[PolygonSet, NDArray[np.int64]]:
    """Take the shells of some polygons for closed lines, without their holes; give their vertices too."""
    is_first = np.diff(polygons.ring_polygon, prepend=-1) > 0
    ring = np.flatnonzero(is_first | ~chosen[polygons.ring_polygon])
    polygon = polygons.ring_polygon[ring]
    size = np.diff(polygons.ring_starts)[ring] + chosen[polygon]
    taken = ranges(polygons.ring_starts[ring], size)
    ends = np.cumsum(size) - 1
    closed = chosen[polygon]
    taken[ends[closed]] = polygons.ring_starts[ring[closed]]
    kind = np.where(closed, LINE, polygons.ring_kind[ring])
    lines = replace(polygons, xy=polygons.xy[taken], ring_starts=starts_of(size), ring_kind=kind, ring_polygon=polygon)
    return lines, taken


def _face_owners(graph: PlanarGraph, site: Sites) -> Sites:
    owner = np.full(graph.faces, -1, dtype=np.int32)
    if len(graph.face_polygon):
        covered = np.flatnonzero(graph.is_inside)
        owner[covered] = np.minimum.reduceat(site[graph.face_polygon], graph.face_starts[covered])
    return owner


def _element_owners(graph: PlanarGraph, site: Sites) -> Sites:
    count = len(graph.points)
    owner = np.full(count + len(graph), NOBODY, dtype=np.int32)
    if len(graph):
        is_part, polygon = _bounding_sources(graph)
        least = np.where(is_part, site[polygon], NOBODY)
        owner[count:] = np.minimum.reduceat(least, graph.source_starts[:-1])
        owner[:count], _ = _core.voronoi.owners_at_points(graph.segments, owner[count:], count)
    point, of_polygon = _lone_places(graph)
    np.minimum.at(owner, point, site[of_polygon])
    return owner


def _bounding_sources(graph: PlanarGraph) -> tuple[NDArray[np.bool_], NDArray[np.int32]]:
    """Of each source edge of a segment, whether its polygon is bounded there, and the polygon."""
    given, vertices = given_shapes(graph)
    ring = owners(np.diff(given.ring_starts))[graph.source_edge]
    polygon = given.ring_polygon[ring]
    is_part = np.ones(len(ring), dtype=bool)
    if not _are_of_single_edges(graph):
        doubtful = np.flatnonzero(np.repeat(graph.source_count > 1, graph.source_count))
        is_thin = np.equal(given.ring_kind, LINE) | flat_holes(given, vertices)
        doubtful = doubtful[~is_thin[ring[doubtful]]]
        segment = np.repeat(np.arange(len(graph)), graph.source_count)[doubtful]
        polygons = max(len(given), 1)
        inside = owners(np.diff(graph.face_starts)) * polygons + graph.face_polygon
        left, right = (face.astype(np.int64) * polygons + polygon[doubtful] for face in graph.segment_faces[segment].T)
        is_part[doubtful] = np.isin(left, inside) | np.isin(right, inside)
    return is_part, polygon


def _are_of_single_edges(graph: PlanarGraph) -> bool:
    """Whether no segment is a part of two edges: each then bounds the polygon of its edge."""
    return len(graph.source_edge) == len(graph)


def _lone_places(graph: PlanarGraph) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    """Points that are a whole line or hole, and the polygons that these are of."""
    given, vertices = given_shapes(graph)
    ring = rings_at_one_place(graph)
    ring = ring[given.ring_kind[ring] == LINE]
    point = np.concatenate([graph.points_at(vertices[given.ring_starts[ring]]), graph.point_holes[:, 0]])
    return point, np.concatenate([given.ring_polygon[ring], graph.point_holes[:, 2]])


def rings_at_one_place(graph: PlanarGraph) -> Indices:
    """Find the rings of which all vertices are at one place of the lattice."""
    given, vertices = given_shapes(graph)
    first, sizes = given.ring_starts[:-1], np.diff(given.ring_starts)
    ring = np.flatnonzero((vertices[first] == vertices[first + sizes // 2]).all(axis=1))
    first, sizes = first[ring], sizes[ring]
    is_other = (vertices[ranges(first, sizes)] != np.repeat(vertices[first], sizes, axis=0)).any(axis=1)
    return ring[np.bincount(owners(sizes)[is_other], minlength=len(sizes)) == 0]


def diagram_of(owned: OwnedGraph, *, is_whole: bool = False, **run: Unpack[Run]) -> SegmentVoronoiDiagram:
    """Make the diagram of the points and segments of a graph."""
    graph, unwanted = owned.graph, None if is_whole else _unwanted(owned)
    return segment_voronoi(graph.points, graph.segments, unwanted=unwanted, **run)


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


@frozen(eq=False)
class JointGraph:
    """The planar graph of sites, a frame, clips and enclosures together."""

    graph: PlanarGraph  # of all
    polygons: PolygonSet  # those of the sites first, then the frame, the clips and the enclosures
    of_frame: range  # its polygon; none without a frame
    of_clip: range  # their polygons; none without a clip
    of_enclosures: range
    sites: PlanarGraph  # of the sites alone, on the same lattice, with a vertex wherever one of the others meets them

    @cached_property
    def source_polygon(self) -> NDArray[np.int32]:
        """(k,) the polygon of each edge that segments are part of."""
        ring = np.searchsorted(self.polygons.ring_starts, self.graph.source_edge, side="right") - 1
        return self.polygons.ring_polygon[ring]

    @property
    def clips(self) -> bool:
        """Whether a clip covers any face."""
        return bool(is_of(self.of_clip, self.graph.face_polygon).any())


def is_of(polygons: range, number: NDArray[np.int32]) -> NDArray[np.bool_]:
    """(k,) whether each is the number of one of some polygons."""
    return (number >= polygons.start) & (number < polygons.stop)


def joint_graph(
    polygons: PolygonSet,
    sides: Sides | None,
    clip: PolygonSet | None,
    enclosures: PolygonSet | None,
    *,
    threads: int = 0,
    progress: Progress = None,
) -> JointGraph:
    """Put sites, the sides of a frame and cuts on one lattice, and cut all where they meet."""
    given = with_flat_shells_as_lines(polygons)
    parts = [RingArrays.of(given)]
    parts.append(_no_rings() if sides is None else _box(sides))
    parts.append(_no_rings() if clip is None else RingArrays.of(clip).taken(np.flatnonzero(~clip.is_line))[0])
    parts.append(_no_rings() if enclosures is None else _as_closed_lines(enclosures))
    joined = RingArrays.joined(parts).bare()
    _, frame, first, second, _ = np.cumsum([0, *(len(part.rings) for part in parts)]).tolist()
    check_magnitude(joined.xy)
    if len(joined.xy) > MOST_VERTICES:
        raise LimitError(f"there are {len(joined.xy)} vertices, more than {MOST_VERTICES}: split the polygons")
    placement = placed_vertices(joined, threads=threads, progress=progress)
    graph = arranged(joined, placement, progress=progress).graph
    noded, vertices = _noded(given, graph)
    of_sites = Placement(vertices, placement.origin, placement.exponent, placement.largest_move)
    return JointGraph(
        graph,
        joined,
        range(frame, first),
        range(first, second),
        range(second, len(joined)),
        graph_of_sites(noded, of_sites, progress=progress),
    )


def _box(sides: Sides) -> RingArrays:
    left, bottom, right, top = sides
    corners = np.array([[left, bottom], [right, bottom], [right, top], [left, top]])
    return RingArrays(corners, np.array([4]), np.array([SHELL], dtype=np.int8), np.array([1]))


def _no_rings() -> RingArrays:
    none = np.empty(0, dtype=np.int64)
    return RingArrays(np.empty((0, 2)), none, none.astype(np.int8), none)


def _as_closed_lines(enclosures: PolygonSet) -> RingArrays:
    """Each ring of polygons and lines as a line of its own."""
    closes = (np.asarray(enclosures.ring_kind) != LINE).astype(np.int64)
    own = np.diff(enclosures.ring_starts)
    sizes = own + closes
    taken = ranges(enclosures.ring_starts[:-1], sizes)
    ends = np.cumsum(sizes) - 1
    taken[ends[closes > 0]] = enclosures.ring_starts[:-1][closes > 0]
    return RingArrays(enclosures.xy[taken], sizes, np.full(len(own), LINE, dtype=np.int8), np.ones(len(own), np.int64))


def _noded(given: PolygonSet, graph: PlanarGraph) -> tuple[PolygonSet, NDArray[np.int32]]:
    """Polygons with a vertex wherever a graph cuts their edges, and all vertices on its lattice."""
    (_, vertices), count = given_shapes(graph), len(given.xy)
    segment = owners(graph.source_count)
    of_sites = graph.source_edge < count
    edge = np.repeat(graph.source_edge[of_sites].astype(np.int64), 2)
    place = graph.points[graph.segments[segment[of_sites]].ravel()].astype(np.int64)
    a = vertices[:count].astype(np.int64)
    after = given.following
    along = a[after] - a
    inner = (place != a[edge]).any(axis=1) & (place != a[after[edge]]).any(axis=1)
    edge, place = edge[inner], place[inner]
    far = dots(place - a[edge], along[edge])
    edge, _, *xy = np.unique(np.column_stack([edge, far, place]), axis=0).T
    order = np.argsort(np.concatenate([np.arange(count), edge]), kind="stable")
    places = np.concatenate([a, np.stack(xy, axis=1)])[order].astype(np.int32)
    ring = np.searchsorted(given.ring_starts, edge, side="right") - 1
    sizes = np.diff(given.ring_starts) + np.bincount(ring, minlength=len(given.ring_kind))
    noded = PolygonSet(places.astype(np.float64), starts_of(sizes), given.ring_kind, given.ring_polygon)
    return noded, places


FARTHEST = 8.0
"""Margin of the frame at most, in extents of what is in it: the frame is on the lattice, whose step grows with it."""


@frozen(eq=False)
class GivenCuts:
    """What cells are cut by, beside a frame."""

    clip: PolygonSet | None  # each in the coordinate reference system of the sites
    enclosures: PolygonSet | None  # each in the coordinate reference system of the sites

    @property
    def are_there(self) -> bool:
        """Whether there is one of them."""
        return self.clip is not None or self.enclosures is not None

    def frame_for(self, sites: PolygonSet, frame: Extent | None, limit: float | None) -> Extent | None:
        """Return the frame that was given, else that of an image; without a clip that around sites and enclosures."""
        if frame is None and sites.frame is not None:
            return sites.frame.extent
        if frame is not None or self.clip is not None:
            return frame
        if self.enclosures is None or not len(self.enclosures.xy):
            return default_frame(sites, limit)
        xy = np.concatenate([sites.xy, self.enclosures.xy])
        if limit is not None:
            low, high = bounds(xy)
            limit = min(limit, FARTHEST * float((high - low).max()))
        return default_frame(set_of_rings(xy, [len(xy)], [LINE], [0]), limit)

    def sides_near(self, frame: Extent | None) -> Sides | None:
        """Draw far sides of a frame near the clip, or leave out all: the step of the lattice grows with them."""
        if frame is None or self.clip is None or not len(self.clip.xy):
            return None if frame is None else extent_sides(frame)
        sides = np.array(extent_sides(frame)).reshape(2, 2)
        low, high = bounds(self.clip.xy)
        if (sides[0] <= low).all() and (high <= sides[1]).all():
            return None
        if (sides[0] < high).all() and (low < sides[1]).all():
            margin = (high - low).max()
            sides = np.array([np.maximum(sides[0], low - margin), np.minimum(sides[1], high + margin)])
        left, bottom, right, top = sides.ravel().tolist()
        return left, bottom, right, top


def given_cuts(clip: Any, enclosures: Any, crs: Any) -> GivenCuts:
    """Take polygons to clip by, and lines and polygons that enclose."""
    made = []
    for name, source in (("clip", clip), ("enclosures", enclosures)):
        given = None if source is None else resolved("convert.polygons:as_polygons")(source, name)
        if given is not None:
            given = _in_crs(given, crs, name)
        made.append(given)
    if made[0] is not None and made[0].is_line.all():
        raise InputError("the clip has no polygon: give polygons that have an area")
    return GivenCuts(*made)


def _in_crs(given: PolygonSet, crs: Any, name: str) -> PolygonSet:
    """The same in a system; what names none is taken to be in it."""
    if crs is None or given.crs is None:
        return given if crs is None or given.crs is crs else replace(given, crs=crs)
    if not same_crs(given.crs, crs):
        raise InputError(
            f"the {name} and the sites are in different coordinate reference systems, {crs_name(given.crs)} and "
            f"{crs_name(crs)}: reproject one of them"
        )
    return given
