"""A check of skeletons that knows their arrays only, not how they were made."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.label_arrays import Progress
from vorotool.engines.planar_graph import planar_graph
from vorotool.engines.skeleton_exact import ShapeDiagram, kept_edges
from vorotool.errors import VerificationError, VorotoolWarning
from vorotool.geometry.checks import checked_threads
from vorotool.geometry.planar_graph import PlanarGraph
from vorotool.geometry.skeleton import EDGE, EXTERIOR, INTERIOR, Skeleton
from vorotool.geometry.skeleton_tables import connected_roots

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

ULPS = 32
"""Of the largest coordinate: by how much distances may differ. A node is right to 8 ulp of the radius and 2 of its
coordinates, in each of which the radius is at most the extent; placing it rounds once more; the distance is wrong by
four roundings. Inside an arc the control point's error counts half, along the tangents, which changes no distance but
in second order."""

AREA = 1e-9
AREA_ULPS = 8


def verify_skeleton(skeleton: Skeleton, *, threads: int = 0, progress: Progress = None) -> None:
    """Check a skeleton from its arrays alone.

    Nodes and the insides of arcs are as far from the sites on both sides as the radius tells, their feet are on the
    sites, and no site is nearer; no arc is between an edge and its end. For each region inside polygons, or inside a
    hole if the exterior is there: its skeleton is connected, has as many independent cycles as the complement has
    components less one, and one end in each corner under 180 degrees, which nothing else shares; the regions between
    the arcs and their feet sum to its area within 1e-9 of it and 8 ulp of the extent times its perimeter. Outside, all
    is connected with the frame. Branches are chains that end where they should.

    Parameters
    ----------
    skeleton : Skeleton
        However it was made. With a gap only distances are checked.
    threads : int
        0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Raises
    ------
    VerificationError
        Naming the first fault.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 3.2.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from vorotool import skeleton_exact
    >>> skeleton = skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]])
    >>> verify_skeleton(skeleton)
    >>> verify_skeleton(replace(skeleton, radius=skeleton.radius + 1))
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: node 0 at (0.0, 0.0) is 0.0 from site 7, but its radius is 1.0
    """
    threads = checked_threads(threads)
    if not len(skeleton):
        return
    _check_arrays(skeleton)
    _check_branches(skeleton)
    sites = _Sites(skeleton)
    if skeleton.gap:  # the lines that lead to the corners are no bisectors of the shortened edges
        skeleton = _without_portions(skeleton)
    _check_equal_distances(skeleton, sites)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", VorotoolWarning)  # what bounds nothing is still in the rings
        graph = planar_graph(skeleton.polygons, threads=threads, progress=progress)
        _check_nothing_nearer(skeleton, sites, _elements(skeleton, graph, threads), threads, progress)
    if not skeleton.gap:
        _check_regions(_Regions(skeleton, graph, sites))


def verify_exterior(shapes: ShapeDiagram, *, threads: int = 0) -> None:
    """Check the unbounded part of a skeleton before it is clipped, as a graph.

    With one node at infinity it is connected, and has as many independent cycles as the closed shape has components
    less one.

    Parameters
    ----------
    shapes : ShapeDiagram
        However its diagram was computed.
    threads : int
        0 uses all.

    Raises
    ------
    VerificationError
        If it is not so.

    Examples
    --------
    >>> from vorotool.engines.skeleton_exact import shape_diagram
    >>> verify_exterior(shape_diagram([[[0, 0], [2, 0], [0, 2]], [[5, 5], [7, 5], [5, 7]]]))
    """
    graph, diagram = shapes.graph, shapes.diagram
    edges, faces = kept_edges(shapes, threads=threads)
    edges = edges[faces == 0]
    if not len(edges):
        return
    ends = diagram.edges[edges].astype(np.int64)
    infinity = len(diagram)
    ends[ends < 0] = infinity
    corner = (ends < infinity) & (np.append(diagram.radius, 1.0)[ends] == 0)
    ends[corner] = infinity + 1 + np.arange(np.count_nonzero(corner))  # each arc has its own
    nodes = np.unique(ends)
    roots = connected_roots(ends, int(ends.max()) + 1)[nodes]
    if len(np.unique(roots)) > 1:
        _fail(f"the skeleton outside has {len(np.unique(roots))} connected parts, even with a node at infinity")
    lone = np.bincount(graph.segments.reshape(-1), minlength=len(graph.points)) == 0
    sites = np.unique(diagram.edge_sites[edges])
    points = np.count_nonzero(lone[sites[sites < len(graph.points)]])
    expected = _border_components(graph)[0] + points - 1
    cycles = len(edges) - len(nodes) + 1
    if cycles != expected:
        _fail(f"the skeleton outside has {cycles} independent cycles, not {expected}")


def _without_portions(skeleton: Skeleton) -> Skeleton:
    kept = (skeleton.radius[skeleton.arcs] > 0).all(axis=1)
    per_arc = ("arcs", "control", "sites", "polygon", "side", "branch", "length", "error_bound")
    return replace(skeleton, **{name: getattr(skeleton, name)[kept] for name in per_arc})


def _fail(message: str) -> None:
    raise VerificationError(message)


def _first(wrong: NDArray[np.bool_]) -> int | None:
    at = np.flatnonzero(wrong)
    return int(at[0]) if at.size else None


# ---- arrays --------------------------------------------------------------------------------------
def _check_arrays(skeleton: Skeleton) -> None:
    for name, limit in (("arcs", len(skeleton.vertices)), ("sites", len(skeleton.site_table))):
        at = _first(((getattr(skeleton, name) < 0) | (getattr(skeleton, name) >= limit)).any(axis=1))
        if at is not None:
            _fail(f"{name} of arc {at} are {getattr(skeleton, name)[at].tolist()}, beyond {limit - 1}")
    if not (np.isfinite(skeleton.vertices).all() and np.isfinite(skeleton.radius).all()):
        _fail("a node is not finite")
    at = _first((skeleton.degree == 0) | (skeleton.radius < 0))
    if at is not None:
        _fail(f"node {at} has no arcs, or a negative radius")
    inside = skeleton.polygon >= 0
    at = _first((inside != (skeleton.side == INTERIOR)) | (skeleton.polygon >= len(skeleton.polygons)))
    if at is not None:
        _fail(
            f"arc {at} is {'inside' if skeleton.side[at] == INTERIOR else 'outside'}, in polygon {skeleton.polygon[at]}"
        )


def _check_branches(skeleton: Skeleton) -> None:
    step = np.diff(skeleton.branch, prepend=-1)
    at = _first((step < 0) | (step > 1))
    if at is not None:
        _fail(f"the branch of arc {at} is {skeleton.branch[at]}, after {skeleton.branch[at - 1]}")
    joined = np.flatnonzero(step == 0)
    before, after = skeleton.arcs[joined - 1, 1], skeleton.arcs[joined, 0]
    at = _first((before != after) | (skeleton.degree[after] != 2))
    if at is not None:
        _fail(f"arc {joined[at]} does not go on where the arc before, of the same branch, ends")
    first = np.flatnonzero(step)
    last = np.append(first[1:], len(skeleton)) - 1
    ends = np.stack([skeleton.arcs[first, 0], skeleton.arcs[last, 1]])
    at = _first((skeleton.degree[ends] == 2).any(axis=0) & (ends[0] != ends[1]))
    if at is not None:
        _fail(f"branch {at} ends at a node where it could go on")


# ---- distances -----------------------------------------------------------------------------------
class _Sites:
    """The places of sites, and distances from them."""

    def __init__(self, skeleton: Skeleton) -> None:
        self.is_edge = skeleton.site_table.kind == EDGE
        self.ends = skeleton.site_ends
        shown = [skeleton.polygons.xy, skeleton.vertices]
        largest = max((float(np.abs(xy).max()) for xy in shown if len(xy)), default=1.0)
        self.tolerance = ULPS * float(np.spacing(largest))
        if skeleton.gap:  # ends of shortened edges are on the lattice, within 0.71 steps of where they should be
            extent = float(np.ptp(skeleton.polygons.xy, axis=0).max())
            self.tolerance += extent * 2.0**-28

    def feet(self, site: NDArray[np.int32], place: Floats) -> Floats:
        """The nearest place on each closed site."""
        a, way = self.ends[site, 0], self.ends[site, 1] - self.ends[site, 0]
        square = (way * way).sum(axis=1)
        t = np.divide(((place - a) * way).sum(axis=1), square, out=np.zeros(len(site)), where=square > 0)
        feet: Floats = a + np.clip(t, 0, 1)[:, None] * way
        return np.where((t > 1)[:, None], self.ends[site, 1], feet)

    def distances(self, site: NDArray[np.int32], place: Floats) -> Floats:
        way = place - self.feet(site, place)
        return np.asarray(np.sqrt((way * way).sum(axis=1)))


_INSIDE = (0.25, 0.5, 0.75)
"""Where arcs are looked at between their ends, in the parameter of the Bezier curve."""


def _inner_places(skeleton: Skeleton, t: float) -> Floats:
    source, target = skeleton.vertices[skeleton.arcs].swapaxes(0, 1)
    control = np.where(skeleton.is_parabola[:, None], skeleton.control, (source + target) / 2)
    places: Floats = (1 - t) ** 2 * source + 2 * t * (1 - t) * control + t * t * target
    return places


def _check_equal_distances(skeleton: Skeleton, sites: _Sites) -> None:
    for end in (0, 1):
        node = skeleton.arcs[:, end]
        for hand in (0, 1):
            site = skeleton.sites[:, hand]
            distance = sites.distances(site, skeleton.vertices[node])
            at = _first(~(np.abs(distance - skeleton.radius[node]) <= sites.tolerance))
            if at is not None:
                k = int(node[at])
                _fail(
                    f"node {k} at {tuple(skeleton.vertices[k].tolist())} is {distance[at]} from site {site[at]}, "
                    f"but its radius is {skeleton.radius[k]}"
                )
    for t in _INSIDE:
        place = _inner_places(skeleton, t)
        left, right = (sites.distances(skeleton.sites[:, hand], place) for hand in (0, 1))
        # moved along the curve by the rounding of a far control point, a place is still on it
        at = _first(~(np.abs(left - right) <= sites.tolerance * _looseness(skeleton)))
        if at is not None:
            _fail(
                f"arc {at} is {left[at]} from site {skeleton.sites[at, 0]} and {right[at]} from {skeleton.sites[at, 1]}"
            )


def _looseness(skeleton: Skeleton) -> Floats:
    """How much more than at nodes distances may differ inside an arc: a far control point is rounded in its own ulp."""
    source = skeleton.vertices[skeleton.arcs[:, 0]]
    way = np.where(skeleton.is_parabola[:, None], skeleton.control - source, 0)
    largest = max(np.abs(skeleton.vertices).max(initial=0.0), np.abs(skeleton.polygons.xy).max(initial=0.0))
    looseness: Floats = 1 + np.sqrt((way * way).sum(axis=1)) / largest
    return looseness


def _elements(skeleton: Skeleton, graph: PlanarGraph, threads: int) -> PlanarGraph:
    """The points and segments that nothing may be nearer than."""
    if not skeleton.gap:
        return graph
    from vorotool.engines.skeleton_elements import element_diagram

    return element_diagram(skeleton.polygons, skeleton.gap, threads=threads).graph


def _check_nothing_nearer(
    skeleton: Skeleton, sites: _Sites, graph: PlanarGraph, threads: int, progress: Progress
) -> None:
    """Nodes and places inside arcs: no site within their distance from their own."""
    inner = [_inner_places(skeleton, t) for t in _INSIDE]
    nodes = np.unique(skeleton.arcs)
    places = np.concatenate([skeleton.vertices[nodes], *inner])
    distance = np.concatenate(
        [skeleton.radius[nodes], *(sites.distances(skeleton.sites[:, 0], place) for place in inner)]
    )
    lattice = np.ascontiguousarray((places - graph.origin) / graph.scale)
    reach = np.ascontiguousarray(distance / graph.scale)
    nearest = graph.scale * _core.clearances(graph.points, graph.segments, lattice, reach, threads, progress)
    at = _first(nearest < distance - sites.tolerance)
    if at is not None:
        what = f"node {nodes[at]}" if at < len(nodes) else f"arc {(at - len(nodes)) % len(skeleton)}"
        _fail(f"{what}: a site is {nearest[at]} from {tuple(places[at].tolist())}, nearer than {distance[at]}")


# ---- regions -------------------------------------------------------------------------------------
@dataclass(frozen=True)
class _Sectors:
    """Corners under 180 degrees: counter-clockwise from one segment of the graph to the next."""

    point: Indices
    right: Indices  # segments
    left: Indices
    face: Indices


def _sectors(graph: PlanarGraph) -> _Sectors:
    count = len(graph)
    at = graph.segments.T.reshape(-1).astype(np.int64)
    to = graph.segments[:, ::-1].T.reshape(-1)
    segment = np.tile(np.arange(count), 2)
    left_face = graph.segment_faces.T.reshape(-1).astype(np.int64)  # as seen from the point
    way = graph.points[to].astype(np.int64) - graph.points[at]
    order = _by_angle(at, way)
    at, way, segment, left_face = at[order], way[order], segment[order], left_face[order]
    new = np.flatnonzero(np.diff(at, prepend=-1))
    following = np.arange(1, len(at) + 1)
    following[np.append(new[1:], len(at))[: len(new)] - 1] = new
    cross = way[:, 0] * way[following, 1] - way[:, 1] * way[following, 0]
    sharp = (cross > 0) & (following != np.arange(len(at)))
    return _Sectors(at[sharp], segment[sharp], segment[following[sharp]], left_face[sharp])


def _by_angle(at: Indices, way: Indices) -> Indices:
    """Order by point, then counter-clockwise: by halves of the plane, in them exactly by products."""
    half = np.where((way[:, 1] > 0) | ((way[:, 1] == 0) & (way[:, 0] > 0)), 0, 1)
    angle = np.arctan2(way[:, 1].astype(float), way[:, 0].astype(float))
    order = np.lexsort((np.where(half == 0, angle, angle + 7), half, at))
    while True:  # rounded angles of neighbours may be out of order
        a, b = order[:-1], order[1:]
        swap = (at[a] == at[b]) & (half[a] == half[b]) & (way[a, 0] * way[b, 1] - way[a, 1] * way[b, 0] < 0)
        swap[1:] &= ~swap[:-1]
        where = np.flatnonzero(swap)
        if not where.size:
            return order
        order[where], order[where + 1] = order[where + 1].copy(), order[where].copy()


class _Regions:
    """Connected parts of a skeleton, and the faces of the planar graph that they are in."""

    def __init__(self, skeleton: Skeleton, graph: PlanarGraph, sites: _Sites) -> None:
        self.skeleton, self.graph, self.sites = skeleton, graph, sites
        self.lattice_site = self._graph_sites()
        self.sectors = _sectors(graph)
        self.root = connected_roots(skeleton.arcs, len(skeleton.vertices))
        self.face = self._faces()
        framed = np.unique(self.root[skeleton.touches_frame])
        framed = framed[self.face[framed] <= 0]
        if len(framed):  # all that leads to infinity is connected there
            self.root[np.isin(self.root, framed)] = framed[0]
            self.face[framed] = 0

    def _graph_sites(self) -> Indices:
        """The graph's number of each site."""
        graph, skeleton = self.graph, self.skeleton
        points = _Rows(graph.coordinates())
        ends = [points.find(self.sites.ends[:, k]) for k in (0, 1)]
        at = _first((ends[0] < 0) | (ends[1] < 0))
        count = len(graph.points)
        segments = _Rows(np.sort(graph.segments, axis=1).astype(float))
        pair = np.sort(np.stack(ends, axis=1), axis=1)
        number = np.where(self.sites.is_edge, segments.find(pair.astype(float)) + count, ends[0])
        if at is None:
            at = _first(self.sites.is_edge & (number < count))
        if at is not None:
            _fail(f"site {at} is no vertex or edge of the polygons")
        if len(np.unique(number)) != len(number) or len(number) != count + len(graph):
            _fail(f"there are {count + len(graph)} vertices and edges, but {len(np.unique(number))} different sites")
        deleted = self.sites.is_edge[skeleton.sites]
        mixed = np.flatnonzero(deleted[:, 0] != deleted[:, 1])
        edge = np.where(deleted[mixed, 0], skeleton.sites[mixed, 0], skeleton.sites[mixed, 1])
        vertex = np.where(deleted[mixed, 0], skeleton.sites[mixed, 1], skeleton.sites[mixed, 0])
        own = _first((graph.segments[number[edge] - count] == number[vertex][:, None]).any(axis=1))
        if own is not None:
            _fail(f"arc {mixed[own]} is between an edge and its own end")
        return number

    def _faces(self) -> Indices:
        """(v,) at the root of each part its face, from the corners that it ends in; -1 elsewhere."""
        skeleton, sectors = self.skeleton, self.sectors
        count = len(self.graph.points)
        is_corner = skeleton.radius == 0
        arc, end = np.nonzero(is_corner[skeleton.arcs])
        node = skeleton.arcs[arc, end]
        at = _first(skeleton.degree[node] != 1)
        if at is not None:
            _fail(f"node {node[at]} is a corner, but several arcs end there")
        hands = self.lattice_site[skeleton.sites[arc]] - count
        # an arc that leaves a corner has the sector's first segment on its right
        right, left = np.where(end == 0, hands[:, 1], hands[:, 0]), np.where(end == 0, hands[:, 0], hands[:, 1])
        table = _Rows(np.stack([sectors.right, sectors.left, sectors.point], axis=1).astype(float))
        points = _Rows(self.graph.coordinates()).find(skeleton.vertices[node])
        found = table.find(np.stack([right, left, points], axis=1).astype(float))
        at = _first(found < 0)
        if at is not None:
            place = tuple(skeleton.vertices[node[at]].tolist())
            _fail(f"arc {arc[at]} ends at {place}, which is no corner between its sites")
        self.corner_sector = found
        face = np.full(len(skeleton.vertices), -1, dtype=np.int64)
        face[self.root[node]] = sectors.face[found]
        at = _first(face[self.root[node]] != sectors.face[found])
        if at is not None:
            _fail(f"arc {arc[at]} is connected with a skeleton in another region")
        return face


class _Rows:
    """Finds rows of numbers among others."""

    def __init__(self, rows: NDArray[np.float64]) -> None:
        self._keys = self._packed(rows)
        self._order = np.argsort(self._keys, kind="stable")

    @staticmethod
    def _packed(rows: NDArray[np.float64]) -> NDArray[np.void]:
        whole = np.ascontiguousarray(rows + 0.0)  # no -0
        return whole.view([("", whole.dtype)] * whole.shape[1]).reshape(-1)

    def find(self, rows: NDArray[np.float64]) -> Indices:
        """The number of each row, or -1."""
        if not len(self._keys):
            return np.full(len(rows), -1, dtype=np.int64)
        wanted = self._packed(rows)
        rank = np.minimum(np.searchsorted(self._keys, wanted, sorter=self._order), len(self._keys) - 1)
        return np.where(self._keys[self._order[rank]] == wanted, self._order[rank], -1)


def _check_regions(regions: _Regions) -> None:
    skeleton, graph = regions.skeleton, regions.graph
    inside = graph.is_inside
    wanted = np.zeros(graph.faces, dtype=bool)
    for side, of_side in ((INTERIOR, inside), (EXTERIOR, ~inside)):
        if (skeleton.side == side).any():
            wanted |= of_side & (_uncut_faces(skeleton, graph) | (side == INTERIOR))
    _check_ends(regions, wanted)
    roots = np.flatnonzero(regions.root == np.arange(len(regions.root)))
    face = regions.face[roots]
    _check_sides(regions, inside)
    bounded = np.flatnonzero(face > 0)
    parts = np.bincount(face[bounded], minlength=graph.faces)
    at = _first(wanted[1:] & (parts[1:] != 1))
    if at is not None:
        _fail(f"the skeleton of region {at + 1} has {parts[at + 1]} connected parts")
    if np.count_nonzero(face <= 0) > 1:
        _fail("the skeleton outside has parts that are not connected, even by the frame")
    _check_cycles(regions, roots, face)
    _check_areas(regions, wanted)


def _uncut_faces(skeleton: Skeleton, graph: PlanarGraph) -> NDArray[np.bool_]:
    """(f,) faces that are within the frame as a whole, and the unbounded one."""
    uncut = np.ones(graph.faces, dtype=bool)
    if skeleton.frame is not None:
        x, y, w, h = skeleton.frame
        places = graph.coordinates()[graph.segments].reshape(-1, 2)
        beyond = ((places < [x, y]) | (places > [x + w, y + h])).any(axis=1).reshape(-1, 2).any(axis=1)
        uncut[graph.segment_faces[beyond]] = False
        uncut[0] = True
    return uncut


def _check_ends(regions: _Regions, wanted: NDArray[np.bool_]) -> None:
    """One arc ends in each corner under 180 degrees, and nowhere else but on the frame."""
    skeleton, sectors = regions.skeleton, regions.sectors
    at = _first((skeleton.degree == 1) & (skeleton.radius > 0) & ~skeleton.on_frame)
    if at is not None:
        _fail(f"the skeleton ends at node {at}, {tuple(skeleton.vertices[at].tolist())}, which is no corner")
    times = np.bincount(regions.corner_sector, minlength=len(sectors.face))
    expected = wanted[sectors.face]
    if skeleton.frame is not None:
        x, y, w, h = skeleton.frame
        places = regions.graph.coordinates()[sectors.point]
        in_frame = ((places > [x, y]) & (places < [x + w, y + h])).all(axis=1)
        expected &= in_frame | regions.graph.is_inside[sectors.face]
    at = _first(expected & (times != 1) | (times > 1))
    if at is not None:
        place = tuple(regions.graph.coordinates()[sectors.point[at]].tolist())
        _fail(f"{times[at]} arcs end in the corner at {place}, which should be one")


def _check_sides(regions: _Regions, inside: NDArray[np.bool_]) -> None:
    skeleton, graph = regions.skeleton, regions.graph
    face = np.maximum(regions.face[regions.root[skeleton.arcs[:, 0]]], 0)
    at = _first(inside[face] != (skeleton.side == INTERIOR))
    if at is not None:
        _fail(f"arc {at} is in region {face[at]}, which is on the other side")
    first = (
        np.where(inside[face], graph.face_polygon[np.minimum(graph.face_start[face], len(graph.face_polygon) - 1)], -1)
        if len(graph.face_polygon)
        else np.full(len(face), -1)
    )
    at = _first(first != skeleton.polygon)
    if at is not None:
        _fail(f"arc {at} is said to be in polygon {skeleton.polygon[at]}, but is in {first[at]}")


def _check_cycles(regions: _Regions, roots: Indices, face: Indices) -> None:
    """Independent cycles of each part: components of the complement of its region less one."""
    skeleton, graph = regions.skeleton, regions.graph
    nodes = np.bincount(regions.root, minlength=len(regions.root))
    arcs = np.bincount(regions.root[skeleton.arcs[:, 0]], minlength=len(regions.root))
    cycles = (arcs - nodes + 1)[roots]
    borders = _border_components(graph)
    lone = np.bincount(graph.segments.reshape(-1), minlength=len(graph.points)) == 0
    numbers = regions.lattice_site[skeleton.sites]
    is_lone = np.concatenate([lone, np.zeros(len(graph), dtype=bool)])[numbers]
    arc, hand = np.nonzero(is_lone)
    pairs = np.unique(np.stack([regions.root[skeleton.arcs[arc, 0]], numbers[arc, hand]], axis=1), axis=0)
    points = np.bincount(pairs[:, 0], minlength=len(regions.root))[roots]
    expected = np.where(face > 0, borders[np.maximum(face, 0)], borders[0]) + points - 1
    cut = (face <= 0) & skeleton.touches_frame.any()  # what is beyond the frame is unknown: see verify_exterior
    uncut = _uncut_faces(skeleton, graph)[np.maximum(face, 0)] | graph.is_inside[np.maximum(face, 0)]
    at = _first(~cut & uncut & (cycles != expected))
    if at is not None:
        _fail(f"the skeleton of region {max(face[at], 0)} has {cycles[at]} independent cycles, not {expected[at]}")


def _border_components(graph: PlanarGraph) -> Indices:
    """(f,) connected components of the segments around each face."""
    component = connected_roots(graph.segments, len(graph.points))[graph.segments[:, 0]]
    pairs = np.stack([graph.segment_faces.reshape(-1).astype(np.int64), np.repeat(component, 2)], axis=1)
    return np.bincount(np.unique(pairs, axis=0)[:, 0], minlength=graph.faces)


def _check_areas(regions: _Regions, wanted: NDArray[np.bool_]) -> None:
    """Regions between arcs and their feet on both sides sum to the area of each bounded face."""
    skeleton, graph, sites = regions.skeleton, regions.graph, regions.sites
    source, target = skeleton.vertices[skeleton.arcs].swapaxes(0, 1)
    total = np.zeros(len(skeleton))
    for hand, sign in ((0, 0.5), (1, -0.5)):
        site = skeleton.sites[:, hand]
        from_source, from_target = sites.feet(site, source), sites.feet(site, target)
        a, b = from_target - source, from_source - target  # diagonals
        total += sign * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    face = np.maximum(regions.face[regions.root[skeleton.arcs[:, 0]]], 0)
    summed = np.bincount(face, total, graph.faces)
    area, perimeter = _face_measures(graph)
    extent = float(np.abs(skeleton.polygons.xy).max(initial=0.0))
    allowed = AREA * np.abs(area) + AREA_ULPS * np.spacing(extent) * perimeter
    wrong = wanted & ~(np.abs(summed - area) <= allowed)
    wrong[0] = False
    at = _first(wrong)
    if at is not None:
        _fail(f"the regions around the arcs in region {at} sum to {summed[at]}, but its area is {area[at]}")


def _face_measures(graph: PlanarGraph) -> tuple[Floats, Floats]:
    """Areas and perimeters of faces; the unbounded one's means nothing."""
    way = graph.coordinates()[graph.segments]
    length = np.sqrt(((way[:, 1] - way[:, 0]) ** 2).sum(axis=1))
    ends = graph.points[graph.segments].astype(np.float64)
    # relative to a corner of each face, so that products stay small
    first = np.full(graph.faces, len(graph), dtype=np.int64)
    np.minimum.at(first, graph.segment_faces, np.repeat(np.arange(len(graph))[:, None], 2, axis=1))
    corner = ends[np.minimum(first, len(graph) - 1), 0] if len(graph) else np.zeros((graph.faces, 2))
    area, perimeter = np.zeros(graph.faces), np.zeros(graph.faces)
    for hand, sign in ((0, 0.5), (1, -0.5)):
        face = graph.segment_faces[:, hand]
        a, b = (ends[:, k] - corner[face] for k in (0, 1))
        np.add.at(area, face, sign * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]))
        np.add.at(perimeter, face, length)
    return area * graph.scale**2, perimeter
