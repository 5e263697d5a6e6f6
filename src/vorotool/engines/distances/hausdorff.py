"""The Hausdorff distance and the smallest distance of points, lines and polygons."""

from __future__ import annotations

import warnings
from functools import cached_property
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.sites import as_sites
from vorotool.engines.arrangement.planar_graph import features_named, graph_for_skeletons
from vorotool.engines.arrangement.repaired_polygons import given_shapes
from vorotool.engines.common import fail
from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi, unwanted_sides
from vorotool.errors import InputError, RepairWarning, option, warn
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, Indices, crosses, dots, norms, ranges
from vorotool.numeric.checks import checked_flag, checked_threads
from vorotool.numeric.crs import crs_name, same_crs
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.numeric.lazy import shapely
from vorotool.numeric.parallel import Progress
from vorotool.types.arguments import check_value
from vorotool.types.box import check_magnitude
from vorotool.types.distances.distances import FROM_A, FROM_B, SMALLEST, Distances, PlacePair
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import HOLE, LINE, PolygonSet
from vorotool.types.polygons.shapely_geometry import used_shapes, with_used_rings
from vorotool.types.skeleton.segment_voronoi import SegmentVoronoiDiagram


def hausdorff(
    a: Any,
    b: Any,
    *,
    boundary: bool = False,
    directed: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Distances:
    """Compute the Hausdorff distance between two shapes.

    All places count, inside edges and polygons as well: nothing is sampled. Candidates on edges are the places where
    the nearest edge changes; inside polygons, the vertices of the Voronoi diagram of the other shape.

    Parameters
    ----------
    a, b : object
        Points, lines and polygons, mixed as they come, as `vorotool.voronoi` takes them: an (n, 2) array is n points.
        Each argument is one shape.
    boundary : bool
        Whether polygons stand for their outlines, as in `shapely.hausdorff_distance`; by default they are filled.
    directed : bool
        Compute only the distance from a to b: `Distances.from_b` is None.
    threads : int
        Number of threads; 0 uses all. The result does not depend on it.
    progress : callable, optional
        Called with the fraction done of each part of the work.

    Returns
    -------
    Distances
        The `distance`, and for both directions the farthest place with the nearest place of the other shape. Distances
        and places are right to a few ulp of the coordinates. Of several equally far places the first vertex is taken,
        if one is a vertex; a place on an edge is taken before one inside a polygon.

    Raises
    ------
    InputError
        If a shape is empty, the coordinate reference systems differ, or coordinates are out of range.

    See Also
    --------
    distance : The smallest distance.

    Notes
    -----
    `shapely.hausdorff_distance` measures from vertices only: for the two lines below it gives 1. All that lies inside a
    shell and in none of its holes, each by the even-odd rule, and all edges belong to a polygon.

    Examples
    --------
    >>> import vorotool
    >>> found = vorotool.hausdorff(["LINESTRING (0 0, 8 0)"], ["LINESTRING (0 0, 0 1, 8 1, 8 0)"])
    >>> found.distance, found.from_a.on_a, found.from_a.on_b
    (1.0, (4.0, 0.0), (4.0, 1.0))
    >>> ring = "POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0), (1 1, 8 1, 8 8, 1 8, 1 1))"
    >>> vorotool.hausdorff(["POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0))"], [ring]).from_a
    PlacePair(distance=3.5, on_a=(4.5, 4.5), on_b=(4.5, 1.0))
    """
    threads = checked_threads(threads)
    first, second = measured_shapes(a, b, boundary=boundary, progress=progress)
    there = farthest(first, second, threads, progress)
    back = None
    if not checked_flag(directed, "directed"):
        far = farthest(second, first, threads, progress)
        back = PlacePair(far.distance, far.on_b, far.on_a)
    return Distances(there, back, None, (first.polygons, second.polygons), boundary)


def farthest(of: MeasuredShape, other: MeasuredShape, threads: int, progress: Progress = None) -> PlacePair:
    """Find the place of a shape that is farthest from another one: that place, and the nearest one of the other."""
    found = PlacePair(*_core.distances.farthest_place(of.core, other.core, threads, progress))
    inner = farthest_inner_place(of, other, found.distance, threads) if of.is_filled else None
    return inner or found


def distance(a: Any, b: Any, *, boundary: bool = False, threads: int = 0, progress: Progress = None) -> Distances:
    """Compute the smallest distance between two shapes, and the closest pair of points.

    Parameters
    ----------
    a, b, boundary, threads, progress : optional
        As for `vorotool.hausdorff`.

    Returns
    -------
    Distances
        Result with `Distances.smallest`. A distance of 0, where the shapes meet, is decided exactly; others are right
        to a few ulp of the coordinates. The first of several equally close pairs of edges is taken.

    Raises
    ------
    InputError
        As for `vorotool.hausdorff`.

    See Also
    --------
    hausdorff : The largest distance from a place of one to the other.

    Examples
    --------
    >>> import vorotool
    >>> found = vorotool.distance(["LINESTRING (0 0, 8 0)"], ["LINESTRING (3 4, 6 2)", "POINT (1 5)"])
    >>> found.smallest
    PlacePair(distance=2.0, on_a=(6.0, 0.0), on_b=(6.0, 2.0))
    """
    first, second = measured_shapes(a, b, boundary=boundary, progress=progress)
    found = _core.distances.closest_places(first.core, second.core, checked_threads(threads), progress)
    return Distances(None, None, PlacePair(*found), (first.polygons, second.polygons), boundary)


SLACK = 4
"""Steps of the lattice, and moves onto it: what is rounded there changes a radius by less than two of both."""
NEWTON_STEPS = 5
MOST_SITES = 6
"""Of one vertex, of which all threes are tried."""


def farthest_inner_place(of: MeasuredShape, other: MeasuredShape, least: float, threads: int) -> PlacePair | None:
    """Find the place inside the polygons of a shape that is farthest from another shape."""
    if not _core.distances.may_go_farther_inside(of.core, other.core, least, None):
        return None
    with warnings.catch_warnings(action="ignore", category=RepairWarning):
        graph = graph_for_skeletons(other.polygons, threads=threads)
    sides = _sides_inside(graph) if other.is_filled else None
    diagram = segment_voronoi(graph.points, graph.segments, unwanted=sides, threads=threads)
    slack = SLACK * graph.largest_move + 2.0**-40 * graph.scale * float(np.abs(graph.points).max(initial=1))
    chosen = np.flatnonzero((diagram.radius > 0) & (diagram.radius * graph.scale + slack > least))
    if not len(chosen):
        return None
    places = _candidates(graph, diagram, chosen)
    inside = of.core.contained(places, threads, None).view(bool)
    places = places[inside]
    if not len(places):
        return None
    distance, on = other.core.reached(places, threads, None)
    at = int(distance.argmax())
    if distance[at] <= least:
        return None
    (x, y), (to_x, to_y) = places[at].tolist(), on[at].tolist()
    return PlacePair(float(distance[at]), (x, y), (to_x, to_y))


def _sides_inside(graph: PlanarGraph) -> NDArray[np.uint8]:
    """Sides of points and segments on which the diagram is not asked for, since they are inside polygons."""
    sides = unwanted_sides(graph, ~graph.is_inside)
    is_lone = np.ones(len(graph.points), dtype=bool)
    is_lone[graph.segments.ravel()] = False
    sides[: len(graph.points)][is_lone] = 0  # of these the graph does not say where they are
    return sides


def _candidates(graph: PlanarGraph, diagram: SegmentVoronoiDiagram, chosen: Indices) -> Floats:
    """Vertices of the diagram in input units, and where each three of their sites, as they were given, are as far."""
    about = np.array(graph.origin) + graph.scale * diagram.vertices[chosen]
    if graph.largest_move == 0:  # the lattice has the input as it is
        return about
    owner, triples = _triples(diagram, chosen)
    radius = graph.scale * diagram.radius[chosen[owner]]
    made = _equally_far(about[owner], radius, *_sites_as_given(graph, triples))
    return np.concatenate([about, made[np.isfinite(made).all(axis=1)]])


def _triples(diagram: SegmentVoronoiDiagram, chosen: Indices) -> tuple[Indices, Indices]:
    """All threes of the sites of each vertex, or of some of them: which of the vertices, and (t, 3) sites."""
    first = diagram.vertex_starts[chosen].astype(np.int64)
    count = np.diff(diagram.vertex_starts)[chosen].astype(np.int64)
    owners, triples = [], []
    for k in np.unique(count).tolist():
        own = np.flatnonzero(count == k)
        sites = diagram.vertex_sites[ranges(first[own], np.full(len(own), k))].reshape(-1, k)
        taken = np.unique(np.linspace(0, k - 1, min(k, MOST_SITES)).astype(np.int64))
        for three in combinations(taken.tolist(), 3):
            owners.append(own)
            triples.append(sites[:, list(three)])
    return np.concatenate(owners).astype(np.int64), np.concatenate(triples).astype(np.int64)


def _sites_as_given(graph: PlanarGraph, sites: Indices) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Give one end of sites where the input has it, unit normals of segments, and which sites are points."""
    given, _ = given_shapes(graph)
    count = len(graph.points)
    is_point = sites < count
    place = np.array(graph.origin) + graph.scale * graph.points
    known = graph.point_vertex >= 0
    place[known] = given.xy[graph.point_vertex[known]]
    edge = graph.source_edge[graph.source_starts[:-1]].astype(np.int64)
    segment = np.where(is_point, 0, sites - count)
    point = np.where(is_point, sites, 0)
    if not len(edge):
        return place[point], np.zeros((*sites.shape, 2)), is_point
    start, end = given.xy[edge[segment]], given.xy[given.following[edge[segment]]]
    way = end - start
    length = np.sqrt((way * way).sum(axis=-1, keepdims=True))
    normal = np.divide(way[..., ::-1] * (-1, 1), length, out=np.zeros_like(way), where=length > 0)
    return np.where(is_point[..., None], place[point], start), normal, is_point


def _equally_far(about: Floats, radius: Floats, at: Floats, normal: Floats, is_point: NDArray[np.bool_]) -> Floats:
    """Places near others that are equally far from three sites each, by Newton's method; NaN where it fails."""
    p, r = about.copy(), radius.copy()
    side = np.where(dots(p[:, None] - at, normal) < 0, -1.0, 1.0)
    for _ in range(NEWTON_STEPS):
        away = p[:, None] - at
        length = norms(away)
        with np.errstate(all="ignore"):
            slope = np.where(is_point[..., None], away / length[..., None], normal * side[..., None])
            value = np.where(is_point, length, dots(away, slope)) - r[:, None]
            # the differences of the equations have no radius in them
            u, v = slope[:, 1] - slope[:, 0], slope[:, 2] - slope[:, 0]
            f, g = value[:, 0] - value[:, 1], value[:, 0] - value[:, 2]
            whole = crosses(u, v)
            step = np.stack([f * v[:, 1] - g * u[:, 1], u[:, 0] * g - v[:, 0] * f], axis=1) / whole[:, None]
            r += value[:, 0] + dots(slope[:, 0], step)
            p += step
    return p


@frozen(eq=False)
class MeasuredShape:
    """A shape, and the same in the core."""

    polygons: PolygonSet  # what it consists of; points are lines of one vertex
    core: _core.distances.Shape
    is_filled: bool  # whether there is anything inside


def measured_shapes(
    a: Any, b: Any, *, boundary: bool = False, progress: Progress = None
) -> tuple[MeasuredShape, MeasuredShape]:
    """Give two shapes as they are measured; arguments as of `vorotool.hausdorff`."""
    boundary = checked_flag(boundary, "boundary")
    given = [as_sites(source, name=name).polygons for source, name in ((a, "a"), (b, "b"))]
    for name, polygons in zip("ab", given, strict=True):
        if not len(polygons):
            raise InputError(
                f"invalid {name}: the shape is empty, so no distance to it exists; give a shape with geometry"
            )
    _check_crs(*given)
    check_magnitude(np.concatenate([polygons.xy for polygons in given]))
    used = (_repaired(polygons, name) for name, polygons in zip("ab", given, strict=True))
    first, second = (_measured(polygons, boundary, progress) for polygons in used)
    return first, second


def _repaired(polygons: PolygonSet, name: str) -> PolygonSet:
    """Replace invalid polygons by what their edges bound, with a warning."""
    used, invalid = with_used_rings(polygons)
    invalid = invalid[np.isin(polygons.feature[invalid], used.feature[~used.is_line])]  # the rest are points and lines
    if len(invalid):
        named = features_named(polygons, np.isin(np.arange(len(polygons)), invalid))
        shape = option(name.upper(), name)
        warn(f"{named} of {shape}: edges cross or overlap, and only what they bound counts", RepairWarning)
    return used


def _check_crs(a: PolygonSet, b: PolygonSet) -> None:
    if a.crs is not None and b.crs is not None and not same_crs(a.crs, b.crs):
        raise InputError(
            f"a and b are in different coordinate reference systems, {crs_name(a.crs)} and {crs_name(b.crs)}: "
            "reproject one of them"
        )


def _measured(polygons: PolygonSet, boundary: bool, progress: Progress) -> MeasuredShape:
    start = polygons.edge_starts
    elements = np.stack([polygons.xy[start], polygons.xy[polygons.following[start]]], axis=1)
    ring = np.searchsorted(polygons.ring_starts, start, side="right") - 1
    bounds = (polygons.ring_kind != LINE) & (not boundary)
    ring_of = np.where(bounds[ring], ring, -1).astype(np.int32)
    is_hole = (polygons.ring_kind == HOLE).astype(np.int32)
    rings = np.stack([polygons.ring_polygon, is_hole], axis=1) if bounds.any() else np.empty((0, 2), np.int32)
    core = _core.distances.Shape(elements.reshape(-1, 4), ring_of, np.ascontiguousarray(rings), progress)
    return MeasuredShape(polygons, core, bool(bounds.any()))


TOLERANCE = 1e-9
"""Of the extent: shapely computes in floating point, and parts of edges are halved until they are as short."""
INNER_PARTS = 256
"""Of the extent: how large the squares are that are not divided further inside polygons."""


def verify_distances(found: Distances) -> None:
    """Check the distances between two shapes independently of their computation.

    Both places are on their shapes, and as far apart as is said, and so is the one from the other shape. None is
    beyond: edges are halved until the distance from what is nearest at both ends, which is convex, leaves no room for
    more; what is inside polygons is divided into squares in the same way, to 1/256 of the extent. The smallest distance
    is compared with that between all edges, and no polygon may meet the other shape where it is not 0.

    Parameters
    ----------
    found : Distances
        Result of `vorotool.hausdorff` or `vorotool.distance`.

    Raises
    ------
    VerificationError
        If something is wrong; the message says what and where.

    Examples
    --------
    >>> from vorotool import hausdorff
    >>> verify_distances(hausdorff([[0, 0], [4, 0]], ["LINESTRING (0 1, 4 1)"]))
    """
    check_value(found, "found", "Distances")
    a, b = (_Checked(polygons, found.is_boundary) for polygons in found.shapes)
    places = np.concatenate([a.ends, b.ends]).reshape(-1, 2)
    extent = float(np.ptp(places, axis=0).max()) or 1.0
    tolerance = TOLERANCE * extent + 8 * float(np.spacing(np.abs(places).max()))
    for name, pair in ((FROM_A, found.from_a), (FROM_B, found.from_b), (SMALLEST, found.smallest)):
        if pair is not None:
            _check_places(name, pair, a, b, tolerance)
    if found.from_a is not None:
        _check_nothing_farther(FROM_A, found.from_a.distance, a, b, tolerance, extent)
        _check_is_from(FROM_A, found.from_a.on_a, found.from_a.distance, b, tolerance)
    if found.from_b is not None:
        _check_nothing_farther(FROM_B, found.from_b.distance, b, a, tolerance, extent)
        _check_is_from(FROM_B, found.from_b.on_b, found.from_b.distance, a, tolerance)
    if found.smallest is not None:
        _check_nothing_closer(found.smallest.distance, a, b, tolerance)


class _Checked:
    """A shape as shapely has it."""

    def __init__(self, polygons: PolygonSet, is_boundary: bool) -> None:
        start = polygons.edge_starts
        self.ends = np.stack([polygons.xy[start], polygons.xy[polygons.following[start]]], axis=1)
        is_point = (self.ends[:, 0] == self.ends[:, 1]).all(axis=1)
        self.edges = np.empty(len(self.ends), dtype=object)
        self.edges[is_point] = shapely.points(self.ends[is_point, 0])
        self.edges[~is_point] = shapely.linestrings(self.ends[~is_point])
        self.tree = shapely.STRtree(self.edges)
        self.polygons, self.is_boundary = polygons, is_boundary

    @cached_property
    def regions(self) -> Any:
        """Polygons that are filled."""
        shapes = used_shapes(self.polygons)[~self.polygons.is_line]
        shapes = shapes[:0] if self.is_boundary else shapes
        return shapes[shapely.area(shapes) > 0]

    @cached_property
    def region_tree(self) -> Any:
        """Of these."""
        return shapely.STRtree(self.regions)

    def contains(self, places: Floats) -> NDArray[np.bool_]:
        """Whether places are inside polygons."""
        found = np.zeros(len(places), dtype=bool)
        if len(self.regions):
            found[self.region_tree.query(shapely.points(places), predicate="intersects")[0]] = True
        return found

    def nearest(self, places: Floats) -> NDArray[np.int64]:
        """The nearest edge to each place."""
        return np.asarray(self.tree.nearest(shapely.points(places)), dtype=np.int64)

    def from_edge(self, edge: NDArray[np.int64], places: Floats) -> Floats:
        """The distance of each place from an edge."""
        return np.asarray(shapely.distance(self.edges[edge], shapely.points(places)))

    def distance(self, places: Floats) -> Floats:
        """The distance of each place from the shape."""
        found = self.from_edge(self.nearest(places), places)
        found[self.contains(places)] = 0
        return found


def _check_places(name: str, pair: PlacePair, a: _Checked, b: _Checked, tolerance: float) -> None:
    for which, place, shape in (("a", pair.on_a, a), ("b", pair.on_b, b)):
        off = float(shape.distance(np.array([place]))[0])
        if not off <= tolerance:
            fail(f"{name}: the point {place} is not on {which}, but {off:g} away from it")
    apart = float(hypotenuse(*np.subtract(pair.on_a, pair.on_b)))
    if not abs(apart - pair.distance) <= tolerance:
        fail(f"{name}: the points are {apart!r} apart, but the distance is {pair.distance!r}")


def _check_is_from(name: str, place: tuple[float, float], distance: float, other: _Checked, tolerance: float) -> None:
    own = float(other.distance(np.array([place]))[0])
    if not abs(own - distance) <= tolerance:
        fail(f"{name}: the point {place} is {own!r} away from the other shape, not {distance!r}")


def _check_nothing_farther(
    name: str, distance: float, of: _Checked, other: _Checked, tolerance: float, extent: float
) -> None:
    _check_edges(name, distance, of, other, tolerance)
    if len(of.regions):
        _check_inside(name, distance, of, other, tolerance, extent)


def _check_edges(name: str, distance: float, of: _Checked, other: _Checked, tolerance: float) -> None:
    s, t = of.ends[:, 0], of.ends[:, 1]
    while len(s):
        _check_none_of(name, np.concatenate([s, t]), distance, other, tolerance)
        at_s, at_t = other.nearest(s), other.nearest(t)
        bound = np.minimum(
            np.maximum(other.from_edge(at_s, s), other.from_edge(at_s, t)),
            np.maximum(other.from_edge(at_t, s), other.from_edge(at_t, t)),
        )
        middle = (s + t) / 2
        half = norms(t - s) / 2
        open_ = np.flatnonzero((bound > distance + tolerance) & (half > tolerance))
        reach = other.from_edge(other.nearest(middle[open_]), middle[open_])
        open_ = open_[~(other.contains(middle[open_]) & (reach > half[open_]))]
        s, t = np.concatenate([s[open_], middle[open_]]), np.concatenate([middle[open_], t[open_]])


def _check_none_of(name: str, places: Floats, distance: float, other: _Checked, tolerance: float) -> None:
    own = other.distance(places)
    at = int(own.argmax())
    if own[at] > distance + tolerance:
        fail(f"{name}: the point {tuple(places[at].tolist())} is {own[at]!r} away, farther than {distance!r}")


def _check_inside(name: str, distance: float, of: _Checked, other: _Checked, tolerance: float, extent: float) -> None:
    corners = of.ends.reshape(-1, 2)
    half = float(np.ptp(corners, axis=0).max()) / 2
    middle = ((corners.min(axis=0) + corners.max(axis=0)) / 2)[None]
    around = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    while len(middle):
        reach = half * np.sqrt(2)
        nearest = other.nearest(middle)
        is_in_other = other.contains(middle) & (other.from_edge(nearest, middle) > reach)
        is_inside = of.contains(middle)
        is_outside = ~is_inside & (of.from_edge(of.nearest(middle), middle) > reach)
        if is_inside.any():
            _check_none_of(name, middle[is_inside], distance, other, tolerance)
        places = (middle[:, None] + half * around).reshape(-1, 2)
        farthest = other.from_edge(np.repeat(nearest, 4), places).reshape(-1, 4).max(axis=1)
        middle = middle[(farthest > distance + tolerance) & ~is_in_other & ~is_outside]
        half /= 2
        if half < extent / INNER_PARTS:
            return
        middle = (middle[:, None] + half * around).reshape(-1, 2)


def _check_nothing_closer(distance: float, a: _Checked, b: _Checked, tolerance: float) -> None:
    (of, at), apart = b.tree.query_nearest(a.edges, return_distance=True, all_matches=False)
    least = int(apart.argmin())
    if apart[least] < distance - tolerance:
        fail(f"smallest: edge {of[least]} of a and {at[least]} of b are {apart[least]!r} apart, less than {distance!r}")
    if distance <= tolerance:
        return
    for which, filled, other in (("a", a, b), ("b", b, a)):
        if len(filled.regions) and filled.region_tree.query(other.edges, predicate="intersects").size:
            fail(f"smallest: a polygon of {which} meets the other shape, but the distance is {distance!r}")
