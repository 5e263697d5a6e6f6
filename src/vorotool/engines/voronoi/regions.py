"""What is shared out: regions between cuts, and the sites that each is shared among."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.arrangement.planar_graph import Placement, arranged
from vorotool.engines.arrangement.repaired_polygons import given_shapes
from vorotool.engines.common import nearest_on_segments
from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi_of_groups
from vorotool.engines.voronoi.borders import Borders, borders_of
from vorotool.engines.voronoi.cut_curves import NO_REGION, CutEdges
from vorotool.engines.voronoi.site_graph import (
    NOBODY,
    JointGraph,
    OwnedGraph,
    diagram_of,
    is_of,
    owners_of,
    rings_at_one_place,
)
from vorotool.errors import Kind, Message, VorotoolWarning, warn
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, Indices, norms, owners, ranges, starts_of
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import distinct, is_among, rows_of
from vorotool.numeric.parallel import Progress
from vorotool.types.box import Extent, bounds
from vorotool.types.polygons.planar_graph import PlanarGraph, packed
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.polygons.shapely_geometry import RingArrays, used_shapes
from vorotool.types.voronoi.voronoi_map import OUTSIDE

Sites = NDArray[np.int32]


@frozen(eq=False)
class Regions:
    """Regions, and which sites each is shared among."""

    edges: CutEdges  # all that is between them
    count: int
    start: Indices  # (count + 1,) int64 array: where the sites of each begin in `site`
    site: Indices  # int64 array: ascending for each region

    def sites_of(self, region: int) -> Indices:
        """The sites that a region is shared among."""
        return self.site[self.start[region] : self.start[region + 1]]


def regions_of(joint: JointGraph, site: NDArray[np.int32], count: int) -> Regions:
    """Find the faces of enclosures, or the whole, within the frame and the clip."""
    graph = joint.graph
    shared = _is_shared_out(joint)
    if count and not shared.any():
        reason = "no area lies both in the frame and in the clip" if joint.of_clip else "the frame is too small"
        warn(VorotoolWarning(Message(f"all {count} cells are empty: {reason}", Kind.EMPTY_RESULT)))
    if len(joint.of_enclosures):
        is_line = (
            np.bincount(
                owners(graph.source_count)[is_of(joint.of_enclosures, joint.source_polygon)], minlength=len(graph)
            )
            > 0
        )
        face = _parted(joint, _faces(graph, is_line), is_line, shared)
        left, right = face[graph.segment_faces].T
        pairs = _meetings(joint, site, face, is_line & (left != right))
        pairs = pairs[np.isin(pairs[:, 0], face[shared])]
        # regions are the faces that a site meets
        met, number = np.unique(pairs[:, 0], return_inverse=True)
        pairs[:, 0] = number.reshape(-1)
        at = np.searchsorted(met, face).clip(max=max(len(met) - 1, 0))
        region = np.where(met[at] == face, at, NO_REGION) if len(met) else np.full(graph.faces, NO_REGION)
    else:
        is_line = np.zeros(len(graph), dtype=bool)
        count = count if shared.any() else 0  # nothing lies both in the frame and in the clip
        met = np.zeros(min(count, 1), dtype=np.int64)
        region = np.full(graph.faces, 0 if len(joint.sites.points) else NO_REGION, dtype=np.int64)
        pairs = np.stack([np.zeros(count, dtype=np.int64), np.arange(count)], axis=1)
    region[~shared] = NO_REGION
    sides = region[graph.segment_faces.astype(np.int64)].reshape(-1, 2)
    cut = np.flatnonzero(sides[:, 0] != sides[:, 1])
    used, ends = np.unique(graph.segments[cut].ravel().astype(np.int64), return_inverse=True)
    edges = CutEdges(
        graph.points[used].astype(np.float64).reshape(-1, 2),
        graph.coordinates(graph.points[used]).reshape(-1, 2),
        _as_given(joint)[used].reshape(-1, 2),
        ends.reshape(-1, 2).astype(np.int64),
        sides[cut],
        is_line[cut],
    )
    sizes = np.bincount(pairs[:, 0], minlength=len(met))
    return Regions(edges, len(met), starts_of(sizes), pairs[np.lexsort((pairs[:, 1], pairs[:, 0])), 1])


def _as_given(joint: JointGraph) -> Floats:
    """(n, 2) coordinates of points in the input; others on an edge along an axis have its coordinate."""
    graph = joint.graph
    given, made = joint.polygons, graph.coordinates_as_given.copy()
    if not graph.largest_move:
        return made
    edge = graph.source_edge.astype(np.int64)
    source, target = given.xy[edge], given.xy[given.following[edge]]
    ends = graph.segments[owners(graph.source_count)].astype(np.int64)
    of_frame = is_of(joint.of_frame, joint.source_polygon)
    for axis in (0, 1):
        along = source[:, axis] == target[:, axis]
        for chosen, may_move in ((along, graph.point_vertex < 0), (along & of_frame, np.ones(len(made), dtype=bool))):
            point, value = ends[chosen].ravel(), np.repeat(source[chosen, axis], 2)
            made[point[may_move[point]], axis] = value[may_move[point]]
    return made


def _faces(graph: PlanarGraph, is_line: NDArray[np.bool_]) -> Indices:
    """(f,) the faces between some segments: the smallest face of the graph in each."""
    joined = graph.segment_faces[~is_line].astype(np.int32)
    return _core.graphs.connected_components(joined, graph.faces).astype(np.int64)


def _parted(joint: JointGraph, face: Indices, is_line: NDArray[np.bool_], shared: NDArray[np.bool_]) -> Indices:
    """(f,) the faces once more, those in parts that a line with open ends divides together with the frame or a clip."""
    graph = joint.graph
    left, right = graph.segment_faces.T
    is_inner = shared[left] & shared[right]
    part = _faces(graph, is_line | ~is_inner)
    is_along = is_line & (shared[left] != shared[right])  # an edge of the frame or the clip
    is_along[is_along] = _run_together(joint, np.flatnonzero(is_along))
    divides = is_line & (face[left] == face[right]) & (is_along | (is_inner & (part[left] != part[right])))
    is_parted = np.isin(face, face[left[divides]])
    return np.where(is_parted, np.where(shared, graph.faces + part, 2 * graph.faces), face)


def _run_together(joint: JointGraph, segments: Indices) -> NDArray[np.bool_]:
    """(k,) whether a line and an edge of the frame or the clip that share a segment may be parallel as they are given.

    Others cross, and are led through one more place of the lattice together.
    """
    graph, (_, vertices) = joint.graph, given_shapes(joint.graph)
    sizes = graph.source_count[segments].astype(np.int64)
    row, source = owners(sizes), ranges(graph.source_starts[segments], sizes)
    own = np.flatnonzero(is_of(joint.of_enclosures, joint.source_polygon[source]))
    pair = ranges(graph.source_starts[segments[row[own]]], sizes[row[own]])  # each line with all on its segment
    row, line = np.repeat(row[own], sizes[row[own]]), np.repeat(source[own], sizes[row[own]])
    is_cut = is_of(range(joint.of_frame.start, joint.of_clip.stop), joint.source_polygon[pair])
    way = vertices[joint.polygons.following].astype(np.int64) - vertices
    (a, b), (c, d) = way[graph.source_edge[line[is_cut]]].T, way[graph.source_edge[pair[is_cut]]].T
    # rounding moves each coordinate of an end by half a step at most, and those of a way between two by a step
    is_parallel = np.abs(a * d - b * c) <= np.abs(a) + np.abs(b) + np.abs(c) + np.abs(d) + 2
    return np.bincount(row[is_cut][is_parallel], minlength=len(segments)) > 0


def _is_shared_out(joint: JointGraph) -> NDArray[np.bool_]:
    """(f,) whether each face is in the frame and in a clip, where they are given."""
    graph = joint.graph
    face = owners(np.diff(graph.face_starts))
    shared = np.ones(graph.faces, dtype=bool)
    for polygons in (joint.of_frame, joint.of_clip):
        if polygons:
            is_in = is_of(polygons, graph.face_polygon)
            shared &= np.bincount(face[is_in], minlength=graph.faces) > 0
    shared[0] = False
    return shared


def _meetings(joint: JointGraph, site: NDArray[np.int32], face: Indices, is_line: NDArray[np.bool_]) -> Indices:
    """(k, 2) faces of enclosures and sites that meet their inside, each pair once."""
    graph = joint.graph
    # what polygons cover
    covered, polygon = face[owners(np.diff(graph.face_starts))], graph.face_polygon
    own = polygon < len(site)
    pairs = [np.stack([covered[own], site[polygon[own]]], axis=1)]
    # what open segments of sites lie in
    polygon, segment = joint.source_polygon, owners(graph.source_count)
    own = (polygon < len(site)) & ~is_line[segment]
    pairs += [np.stack([face[side], site[polygon[own]]], axis=1) for side in graph.segment_faces[segment[own]].T]
    pairs.append(_meetings_of_points(joint, site, face, is_line))
    return np.unique(np.concatenate(pairs).astype(np.int64), axis=0)


def _meetings_of_points(
    joint: JointGraph, site: NDArray[np.int32], face: Indices, is_line: NDArray[np.bool_]
) -> Indices:
    """(k, 2) the same of sites that are places, unless an enclosure runs through these."""
    graph, (given, vertices) = joint.graph, given_shapes(joint.graph)
    lone = rings_at_one_place(graph)
    lone = lone[given.ring_polygon[lone] < len(site)]
    places = vertices[given.ring_starts[lone]]
    is_free = ~is_among(packed(places), distinct(packed(graph.points[graph.segments[is_line].ravel()])))
    lone, places = lone[is_free], places[is_free].astype(np.float64)
    if not lone.size:
        return np.empty((0, 2), dtype=np.int64)
    sides = face[graph.segment_faces].reshape(-1, 2)
    boundary = np.flatnonzero(sides[:, 0] != sides[:, 1])
    sides = sides[boundary]
    names, shapes = faces_of_sides(graph.points[graph.segments[boundary]].astype(np.float64), sides)
    row, at = shapely.STRtree(shapely.points(places)).query(shapes, predicate="intersects")
    # in no face of a shape is around all of them; on an edge of the frame or the clip is in every face there
    around = np.setdiff1d(np.arange(len(lone)), at)
    found = np.concatenate([names[row], np.full(len(around), face[0], dtype=np.int64)])
    return np.stack([found, site[given.ring_polygon[lone[np.concatenate([at, around])]]]], axis=1)


def faces_of_sides(lines: Floats, sides: Indices) -> tuple[Indices, NDArray[Any]]:
    """Give the faces between segments as polygons of shapely, and the region that each is a part of."""
    shapes = np.asarray(shapely.get_parts(shapely.polygonize(shapely.linestrings(lines))))
    if not len(shapes):
        return np.empty(0, dtype=np.int64), shapes
    shells = shapely.get_exterior_ring(shapes)
    places, ring = shapely.get_coordinates(shells, return_index=True)
    first = np.searchsorted(ring, np.arange(len(shapes)))
    wanted = np.stack([places[first], places[first + 1]], axis=1)
    ways = np.concatenate([lines, lines[:, ::-1]])
    key = packed(np.concatenate([ways, wanted]).reshape(-1, 2))
    _, number = np.unique(key, return_inverse=True)
    first, second = number.reshape(-1, 2).T.astype(np.int64)
    pair = first * len(key) + second
    row = rows_of(pair[: len(ways)], pair[len(ways) :])
    is_right = (row >= len(lines)) == shapely.is_ccw(shells)
    names: Indices = sides[row % len(lines), is_right.astype(np.int64)]
    return names, shapes


@frozen(eq=False)
class LocalDiagrams:
    """What belongs to whom in each of several regions, and the borders there."""

    # the graphs of all regions, one after the other, as if they were one: what two of them share is there twice
    owned: OwnedGraph
    point_region: Indices  # int64 array: of points and segments
    segment_region: Indices  # int64 array: of points and segments
    borders: Borders  # in the whole plane, of each region by itself
    polygons: PolygonSet  # of all sites, on the lattice
    site: Sites  # (p,) int32 array: of these

    @property
    def region(self) -> Indices:
        """(b,) the region of each piece of borders."""
        both = np.concatenate([self.point_region, self.segment_region])
        return both[self.borders.elements[:, 0]]


def local_diagrams(
    sites: PlanarGraph,
    site: Sites,
    count: int,
    regions: Regions,
    *,
    limit: float | None = None,
    pieces_of: Callable[..., Borders] = borders_of,
    threads: int = 0,
    progress: Progress = None,
) -> LocalDiagrams:
    """Make the diagram of each region."""
    given, _ = given_shapes(sites)
    level = np.inf if limit is None else limit / sites.scale
    if regions.count == 1 and len(regions.site) == count:
        owned = owners_of(sites, site)
        diagram = diagram_of(owned, is_whole=limit is not None, threads=threads, progress=progress)
        none = np.zeros(len(owned.graph.points), dtype=np.int64), np.zeros(len(owned.graph), dtype=np.int64)
        return LocalDiagrams(owned, *none, pieces_of(owned, diagram, level=level, threads=threads), given, site)
    parts = [*_graphs_of_regions(sites, site, count, regions)]
    points, segments = (
        np.repeat(np.arange(len(parts)), sizes)
        for sizes in ([len(part.graph.points) for part in parts], [len(part.graph) for part in parts])
    )
    owned = _joined(parts, sites)
    diagram = segment_voronoi_of_groups(
        owned.graph.points, owned.graph.segments, np.concatenate([points, segments]), threads=1, progress=progress
    )
    return LocalDiagrams(owned, points, segments, pieces_of(owned, diagram, level=level, threads=threads), given, site)


def _graphs_of_regions(sites: PlanarGraph, site: Sites, count: int, regions: Regions) -> Iterator[OwnedGraph]:
    given, vertices = given_shapes(sites)
    order = np.argsort(site, kind="stable")
    start = np.searchsorted(site[order], np.arange(count + 1))
    above, below = sites.scale.as_integer_ratio()  # a power of two
    for region in range(regions.count):
        own = regions.sites_of(region)
        polygon = np.sort(order[ranges(start[own], np.diff(start)[own])])
        part, _, taken = RingArrays.of(given).taken(polygon)
        placement = Placement(vertices[taken], sites.origin, above.bit_length() - below.bit_length(), 0.0)
        yield owners_of(arranged(part.bare(), placement).graph, site[polygon])


def _joined(parts: list[OwnedGraph], sites: PlanarGraph) -> OwnedGraph:
    """Graphs one after the other, with the numbers of points and faces shifted."""
    graphs = [part.graph for part in parts]
    points = np.cumsum([0, *(len(graph.points) for graph in graphs)])
    faces = np.cumsum([0, *(graph.faces for graph in graphs)])
    none, pairs = np.empty(0, dtype=np.int32), np.empty((0, 2), dtype=np.int32)
    segments = [g.segments + at for g, at in zip(graphs, points, strict=False)]
    sides = [g.segment_faces + at for g, at in zip(graphs, faces, strict=False)]
    elements = [np.split(part.element, [len(part.graph.points)]) for part in parts]
    graph = PlanarGraph(
        np.concatenate([pairs, *(g.points for g in graphs)]),
        np.concatenate([pairs, *segments]),
        np.full(int(points[-1]), -1, dtype=np.int32),
        np.zeros(sum(map(len, segments)) + 1, dtype=np.int32),
        none,
        np.concatenate([pairs, *sides]),
        np.zeros(max(int(faces[-1]), 1) + 1, dtype=np.int32),  # the unbounded one at least
        none,
        origin=sites.origin,
        scale=sites.scale,
    )
    element = np.concatenate([none, *(own for own, _ in elements), *(own for _, own in elements)])
    face = np.concatenate([part.face for part in parts]) if parts else np.full(1, -1, dtype=np.int32)
    return OwnedGraph(graph, element, face)


def frame_of(edges: CutEdges, frame: Extent | None, clip: PolygonSet | None) -> Extent:
    """Give the bounds of what is shared out; of nothing those of what was given."""
    places = edges.given
    if not len(places):
        if frame is not None:
            return frame
        assert clip is not None
        places = clip.xy
    low, high = bounds(places)
    x, y = low.tolist()
    w, h = (high - low).tolist()
    return (x, y, w, h)


class NearestElements:
    """Finds the sites that places of a region are nearest to."""

    def __init__(self, local: LocalDiagrams) -> None:
        self.local = local
        graph = local.owned.graph
        degree = np.bincount(graph.segments.ravel(), minlength=len(graph.points))
        self.lone = np.flatnonzero((degree == 0) | self._has_wedge())

    def _has_wedge(self) -> NDArray[np.bool_]:
        """(n,) whether a site smaller than those of the segments at a point may have what is nearest to the point."""
        owned, graph = self.local.owned, self.local.owned.graph
        count = len(graph.points)
        least = np.full(count, NOBODY, dtype=np.int64)
        for end in graph.segments.T:
            np.minimum.at(least, end, owned.element[count:])
        has_wedge: NDArray[np.bool_] = (least < NOBODY) & (owned.element[:count] < least)
        for point in np.flatnonzero(has_wedge).tolist():
            ends = graph.segments[(graph.segments == point).any(axis=1)]
            x, y = (graph.points[ends].astype(np.int64).sum(axis=1) - 2 * graph.points[point].astype(np.int64)).T
            level = x[:, None] * y == y[:, None] * x
            has_wedge[point] = not (level & (x[:, None] * x + y[:, None] * y < 0)).any()
        return has_wedge

    def sites(self, places: Floats, region: int) -> Indices:
        """(k,) the smallest of the sites that cover each place on the lattice, else of those nearest to it."""
        points = shapely.points(places)
        shapes, of_polygon = self._polygons
        covered = np.full(len(places), NOBODY, dtype=np.int64)
        row, place = shapely.STRtree(points).query(shapes, predicate="contains")
        np.minimum.at(covered, place, of_polygon[row])
        tree, site = self._tree(region)
        (place, row), distance = tree.query_nearest(points, all_matches=True, return_distance=True)
        least = np.full(len(places), NOBODY, dtype=np.int64)
        np.minimum.at(least, place, site[row])
        least[place[distance > self.local.borders.level]] = OUTSIDE
        return np.where(covered < NOBODY, covered, least)

    @cached_property
    def _polygons(self) -> tuple[Any, Indices]:
        """Polygons that have an inside, and the site of each."""
        shapes = used_shapes(self.local.polygons)
        kept = np.flatnonzero(shapely.area(shapes) > 0)
        return shapes[kept], self.local.site[kept].astype(np.int64)

    def _tree(self, region: int) -> tuple[Any, Indices]:
        local, graph = self.local, self.local.owned.graph
        count = len(graph.points)
        points = self.lone[local.point_region[self.lone] == region]
        segments = np.flatnonzero(local.segment_region == region)
        places = graph.points.astype(np.float64)
        shapes = np.concatenate([shapely.points(places[points]), shapely.linestrings(places[graph.segments[segments]])])
        return shapely.STRtree(shapes), local.owned.element[np.concatenate([points, count + segments])].astype(np.int64)


Exact = tuple[Fraction, Fraction]

MARGIN = 2.0**-40
"""Of the largest coordinate, by which rounding may make an element seem nearer or farther than it is."""


def site_at(owned: OwnedGraph, place: tuple[float, float], level: float = np.inf) -> int:
    """Give the site that covers a place in input units, else the one nearest to it, the smallest of several."""
    graph = owned.graph
    first = int(owned.element[0])
    if (owned.element == first).all() and np.isin(owned.face, (first, -1)).all() and not np.isfinite(level):
        return first
    exact = tuple((Fraction(c) - Fraction(o)) / Fraction(graph.scale) for c, o in zip(place, graph.origin, strict=True))
    at: Exact = (exact[0], exact[1])
    covering = int(owned.face[_face_at(owned, at)])
    return covering if covering >= 0 else _nearest(owned, at, level)


def _face_at(owned: OwnedGraph, at: Exact) -> int:
    """The face of the graph that a place is in or at the border of: that below the first segment above it."""
    graph = owned.graph
    if not len(graph):
        return 0
    x = graph.points[:, 0][graph.segments]
    low, high = x.min(axis=1), x.max(axis=1)
    value = float(at[0])
    near = np.flatnonzero((low <= value + 1) & (high >= value - 1))
    best: tuple[Fraction, Fraction, int] | None = None
    for k in near.tolist():
        (ax, ay), (bx, by) = graph.points[graph.segments[k]].tolist()
        is_right = ax < bx
        if not is_right:
            (ax, ay), (bx, by) = (bx, by), (ax, ay)
        if not ax <= at[0] < bx:
            continue
        slope = Fraction(by - ay, bx - ax)
        height = ay + slope * (at[0] - ax)
        # of segments that leave one point to the right the lowest has the lowest slope
        if height >= at[1] and (best is None or (height, slope) < best[:2]):
            best = (height, slope, int(graph.segment_faces[k, 1 if is_right else 0]))
    return 0 if best is None else best[2]


def _nearest(owned: OwnedGraph, at: Exact, level: float) -> int:
    graph, count = owned.graph, len(owned.graph.points)
    place = np.array([float(at[0]), float(at[1])])
    points = graph.points.astype(np.float64)
    feet = nearest_on_segments(place, *points[graph.segments].swapaxes(0, 1))
    distances = np.concatenate([norms(points - place), norms(feet - place)])
    least = float(distances.min())
    margin = MARGIN * (float(np.abs(place).max()) + float(np.abs(points).max()) + 1)
    candidates = np.flatnonzero(distances <= least + margin)
    found = [(_exact_distance(graph, int(k), at), int(owned.element[k])) for k in candidates.tolist()]
    assert count
    squared_distance, site = min(each for each in found if each[1] != NOBODY)
    return OUTSIDE if np.isfinite(level) and squared_distance > Fraction(level) ** 2 else site


def _exact_distance(graph: Any, element: int, at: Exact) -> Fraction:
    """The square of the distance, exactly."""
    count = len(graph.points)
    ends = [element, element] if element < count else graph.segments[element - count]
    (ax, ay), (bx, by) = graph.points[ends].tolist()
    u, v = bx - ax, by - ay
    x, y = at[0] - ax, at[1] - ay
    length = u * u + v * v
    t = min(max(Fraction(x * u + y * v) / length, Fraction(0)), Fraction(1)) if length else Fraction(0)
    dx, dy = x - t * u, y - t * v
    return dx * dx + dy * dy
