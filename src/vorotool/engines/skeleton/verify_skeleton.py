"""A check of skeletons that knows their arrays only, not how they were made."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.arrangement.planar_graph import planar_graph
from vorotool.engines.common import fail, first_wrong, nearest_on_segments
from vorotool.engines.features.batches import BatchShapes, in_batches
from vorotool.engines.skeleton.clearance import SitePlaces, clearances
from vorotool.engines.skeleton.exact import ShapeDiagram, kept_edges
from vorotool.engines.skeleton.parts import PER_ARC, outside_of, with_arcs, with_polygons
from vorotool.engines.skeleton.verify_bounds import check_approximation, places_on_arcs
from vorotool.engines.skeleton.verify_regions import (
    AREA,
    AREA_ULPS,
    SkeletonRegions,
    areas_beside,
    border_components,
    check_regions,
    face_measures,
    with_corners_apart,
)
from vorotool.errors import silent
from vorotool.numeric.arrays import Floats, Indices, connected_roots, crosses, norms
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import distinct
from vorotool.numeric.parallel import Progress, Run, running
from vorotool.types.arguments import check_value
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton


def _is_on_border(skeleton: Skeleton, graph: PlanarGraph) -> tuple[NDArray[np.bool_], Indices]:
    """(m,) which segments are on a side of the frame, and (m,) the axis that this side is across."""
    assert skeleton.frame is not None
    x, y, w, h = skeleton.frame
    ends = graph.coordinates()[graph.segments]
    on_side = [(ends[:, :, axis] == value).all(axis=1) for axis, value in ((0, x), (0, x + w), (1, y), (1, y + h))]
    return np.logical_or.reduce(on_side), np.where(on_side[0] | on_side[1], 0, 1)


def without_border(skeleton: Skeleton, graph: PlanarGraph) -> PlanarGraph:
    """Give what is left of a planar graph without the segments on the border, and points where only these end."""
    is_cut, _ = _is_on_border(skeleton, graph)
    count = len(graph.points)
    kept = np.bincount(graph.segments[~is_cut].ravel(), minlength=count) > 0
    kept |= np.bincount(graph.segments[is_cut].ravel(), minlength=count) == 0
    number = np.cumsum(kept) - 1
    return replace(
        graph,
        points=graph.points[kept],
        segments=number[graph.segments[~is_cut]].astype(np.int32),
        point_vertex=graph.point_vertex[kept],
        source_starts=np.zeros(np.count_nonzero(~is_cut) + 1, dtype=np.int32),
        source_edge=graph.source_edge[:0],
        segment_faces=graph.segment_faces[~is_cut],
        point_holes=graph.point_holes[:0],
    )


def check_cut_regions(skeleton: Skeleton, graph: PlanarGraph, left: PlanarGraph, sites: SitePlaces) -> None:
    """Raise unless arcs end in corners or on the border, and all area is between the axis and its feet."""
    if (at := first_wrong((skeleton.degree == 1) & (skeleton.radius > 0) & ~skeleton.on_frame)) is not None:
        fail(
            f"the skeleton ends at node {at}, {tuple(skeleton.vertices[at].tolist())}, which is neither a corner nor "
            "on the border"
        )
    count = len(skeleton.polygons)
    summed = np.bincount(skeleton.polygon, areas_beside(skeleton, sites), count)
    summed += np.bincount(*_areas_at_border(skeleton, graph, left), count)
    first = np.full(graph.faces, -1)
    first[graph.is_inside] = graph.face_polygon[graph.face_starts[:-1][graph.is_inside]]
    of_face, around = face_measures(graph)
    inner = first >= 0
    area, perimeter = (np.bincount(first[inner], values[inner], count) for values in (of_face, around))
    allowed = AREA * area + AREA_ULPS * np.spacing(sites.largest) * perimeter
    reaches = np.zeros(count, dtype=bool)  # what has no outline but the border has no feet
    beside = first[np.unique(left.segment_faces)]
    reaches[beside[beside >= 0]] = True
    if (at := first_wrong(reaches & ~(np.abs(summed - area) <= allowed))) is not None:
        fail(f"the regions around the arcs and the border in polygon {at} sum to {summed[at]}, not to {area[at]}")


def _areas_at_border(skeleton: Skeleton, graph: PlanarGraph, left: PlanarGraph) -> tuple[Indices, Floats]:
    """Of stretches of the border in polygons, between cuts, the polygon and the area to the nearest site."""
    rows = _stretches(skeleton, graph, left)
    if not len(rows) or not len(left.points):
        return np.zeros(0, dtype=np.int64), np.zeros(0)
    polygon, a, b = rows[:, 0].astype(np.int64), rows[:, 1:3], rows[:, 3:5]
    places = left.coordinates()
    lone = np.flatnonzero(np.bincount(left.segments.ravel(), minlength=len(places)) == 0)
    shapes = [*shapely.linestrings(places[left.segments]), *shapely.points(places[lone])]
    ends = np.concatenate([places[left.segments], np.repeat(places[lone][:, None], 2, axis=1)])
    tree = shapely.STRtree(shapes)
    _, near = tree.query_nearest(shapely.points((a + b) / 2), all_matches=False)
    feet = [nearest_on_segments(place, *ends[near].swapaxes(0, 1)) for place in (a, b)]
    one, other = feet[1] - a, feet[0] - b  # diagonals
    return polygon, np.abs(crosses(one, other)) / 2


def _stretches(skeleton: Skeleton, graph: PlanarGraph, left: PlanarGraph) -> Floats:
    """(k, 5) the polygon and both ends: segments on the border, cut where the nearest site may change."""
    is_cut, axis = _is_on_border(skeleton, graph)
    coordinates, inside = graph.coordinates(), graph.is_inside
    nodes = np.flatnonzero(skeleton.touches_frame)
    ways = left.coordinates()[left.segments]
    rows = []
    for segment in np.flatnonzero(is_cut).tolist():
        faces = graph.segment_faces[segment]
        inner = faces[inside[faces]]
        if not len(inner):
            continue
        a, b = coordinates[graph.segments[segment]]
        along = 1 - int(axis[segment])
        low, high = sorted((float(a[along]), float(b[along])))
        own = (left.segment_faces == inner[0]).any(axis=1)
        cuts = np.concatenate([skeleton.vertices[nodes, along], _across_ends(ways[own], float(a[1 - along]), along)])
        ticks = np.unique(np.concatenate([[low, high], cuts[(cuts > low) & (cuts < high)]]))
        ends = np.repeat(a[None], len(ticks), axis=0)
        ends[:, along] = ticks
        polygon = int(graph.face_polygon[graph.face_starts[inner[0]]])
        rows.append(np.column_stack([np.full(len(ticks) - 1, polygon), ends[:-1], ends[1:]]))
    return np.concatenate([np.zeros((0, 5)), *rows])


def _across_ends(edges: Floats, level: float, along: int) -> Floats:
    """Where lines across edges at their ends meet a side of the frame, which is at a level of the other axis."""
    way = edges[:, 1] - edges[:, 0]
    found = []
    for end in (0, 1):
        rise = (edges[:, end, 1 - along] - level) * way[:, 1 - along]
        slope = way[:, along]
        found.append((edges[:, end, along] + rise / np.where(slope == 0, np.inf, slope))[slope != 0])
    return np.concatenate(found)


_INSIDE = (0.25, 0.5, 0.75)
"""Where arcs are looked at between their ends, in the parameter of the Bezier curve."""


def check_equal_distances(skeleton: Skeleton, sites: SitePlaces) -> None:
    """Raise unless nodes are as far from the sites of their arcs as they say, and the insides of arcs from both."""
    for end in (0, 1):
        node = skeleton.arcs[:, end]
        for hand in (0, 1):
            site = skeleton.sites[:, hand]
            distance = sites.distances(site, skeleton.vertices[node])
            if (at := first_wrong(~(np.abs(distance - skeleton.radius[node]) <= sites.tolerance))) is not None:
                k = int(node[at])
                fail(
                    f"node {k} at {tuple(skeleton.vertices[k].tolist())} is {distance[at]} from site {site[at]}, "
                    f"but its radius is {skeleton.radius[k]}"
                )
    for t in _INSIDE:
        place = places_on_arcs(skeleton, np.array([t]))[:, 0]
        left, right = (sites.distances(skeleton.sites[:, hand], place) for hand in (0, 1))
        # moved along the curve by the rounding of a far control point, a place is still on it
        if (at := first_wrong(~(np.abs(left - right) <= sites.tolerance * _looseness(skeleton, sites)))) is not None:
            fail(
                f"arc {at} is {left[at]} from site {skeleton.sites[at, 0]} and {right[at]} from {skeleton.sites[at, 1]}"
            )


def _looseness(skeleton: Skeleton, sites: SitePlaces) -> Floats:
    """How much more than at nodes distances may differ inside an arc: a far control point is rounded in its own ulp."""
    source = skeleton.vertices[skeleton.arcs[:, 0]]
    return 1 + norms(np.where(skeleton.is_parabola[:, None], skeleton.control - source, 0)) / sites.largest


def check_nothing_nearer(skeleton: Skeleton, sites: SitePlaces, graph: PlanarGraph, run: Run) -> None:
    """Nodes and places inside arcs: no site within their distance from their own."""
    inner = [places_on_arcs(skeleton, np.array([t]))[:, 0] for t in _INSIDE]
    nodes = distinct(skeleton.arcs)
    places = np.concatenate([skeleton.vertices[nodes], *inner])
    distance = np.concatenate(
        [skeleton.radius[nodes], *(sites.distances(skeleton.sites[:, 0], place) for place in inner)]
    )
    nearest = clearances(places, distance, graph, run)
    if (at := first_wrong(nearest < distance - sites.tolerance)) is not None:
        what = f"node {nodes[at]}" if at < len(nodes) else f"arc {(at - len(nodes)) % len(skeleton)}"
        fail(f"{what}: a site is {nearest[at]} from {tuple(places[at].tolist())}, nearer than {distance[at]}")


def verify_skeleton(skeleton: Skeleton, *, threads: int = 0, progress: Progress = None) -> None:
    """Check a skeleton from its arrays alone.

    Nodes and the insides of arcs are as far from the sites on both sides as the radius tells, their feet are on the
    sites, and no site is nearer; no arc is between an edge and its end. For each region inside polygons, or inside a
    hole if the exterior is there: its skeleton is connected, has as many independent cycles as the complement has
    components less one, and one end in each corner under 180 degrees, which nothing else shares; the regions between
    the arcs and their feet sum to its area within 1e-9 of it and 8 ulp of the extent times its perimeter. Outside, all
    is connected with the frame. With an open border, what is left of the outlines is looked at: ends are in corners or
    on the border, and the regions sum to the areas with those between the border and its nearest places.
    Branches are chains that end where they should. Where pixels hang together at corners (`PolygonSet.connectivity`),
    arcs of one polygon, or outside, share a node there; all else is as if they did not.
    Unless features are together (`Skeleton.features`), each is looked at as if there were no others.

    An approximate skeleton, which has error bounds, is checked otherwise: places on its arcs are no farther from the
    exact skeleton, computed anew, than the bounds; radii are distances from the boundary; no arc meets this but in a
    corner, and each is in its polygon, or outside all; and there are no more cycles than parts of the boundary that
    they may go around. It need not be connected, and its sites are not compared.

    Parameters
    ----------
    skeleton : Skeleton
        From any source. With a gap only distances are checked.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Raises
    ------
    VerificationError
        If a check fails; the message names the first fault.

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
    >>> from vorotool import skeleton_approx
    >>> verify_skeleton(skeleton_approx([[0, 0], [4, 0], [4, 2], [0, 2]], tolerance=0.1))
    """
    check_value(skeleton, "skeleton", "Skeleton")
    run = running(threads, progress)
    if not len(skeleton):
        return
    check_arrays(skeleton)
    check_branches(skeleton)
    if skeleton.gap:  # the lines that lead to the corners are no bisectors of the shortened edges
        skeleton = _without_portions(skeleton)
    elif skeleton.error_bound.any():
        with silent():
            check_approximation(skeleton, run)
        return
    check_equal_distances(skeleton, SitePlaces(skeleton))
    with silent():  # what bounds nothing is still in the rings
        if skeleton.features == "together" or not len(skeleton.polygons):
            graph = planar_graph(skeleton.polygons, **run)
            _check_in_graph(skeleton, graph, run)
        else:
            _check_sides(skeleton, run)


def _check_sides(skeleton: Skeleton, run: Run) -> None:
    """Check what is inside each feature by itself, and what is outside in the arrangement of all."""
    inside = skeleton.side == INTERIOR
    if not inside.all():
        graph = planar_graph(skeleton.polygons, **run)
        _check_in_graph(outside_of(skeleton), graph, run)
    if inside.any():
        _check_own(skeleton)
        own, whole = with_arcs(skeleton, inside), SitePlaces(skeleton)

        def check(shapes: BatchShapes, run: Run) -> None:
            of_batch = with_polygons(own, shapes.batch.polygons)
            if len(of_batch):
                _check_in_graph(of_batch, shapes.graph, run, whole=whole)

        in_batches(skeleton.polygons, check, alone=bool(skeleton.gap), drops=False, **run)


def _check_own(skeleton: Skeleton) -> None:
    """Raise if an arc inside is between sites of another feature, or shares a corner with arcs in another polygon."""
    polygons = skeleton.polygons
    inside = np.flatnonzero(skeleton.side == INTERIOR)
    polygon = skeleton.polygon[inside]
    of_sites = polygons.feature[skeleton.site_table.polygon][skeleton.sites[inside]]
    if (at := first_wrong((of_sites != polygons.feature[polygon][:, None]).any(axis=1))) is not None:
        fail(f"arc {inside[at]} is listed in polygon {polygon[at]}, but is between sites of another feature")
    owner = np.full(len(skeleton.vertices), -1)
    for end in (0, 1):
        owner[skeleton.arcs[inside, end]] = polygon
    for end in (0, 1):
        node = skeleton.arcs[inside, end]
        if (at := first_wrong((skeleton.radius[node] == 0) & (owner[node] != polygon))) is not None:
            fail(f"node {node[at]} is a corner that arcs in different polygons share")


def _check_in_graph(skeleton: Skeleton, graph: PlanarGraph, run: Run, *, whole: SitePlaces | None = None) -> None:
    sites = SitePlaces(skeleton, whole)
    if skeleton.border == "open":
        graph_left = without_border(skeleton, graph)
        check_nothing_nearer(skeleton, sites, graph_left, run)
        check_cut_regions(skeleton, graph, graph_left, sites)
        return
    check_nothing_nearer(skeleton, sites, _elements(skeleton, graph, run), run)
    if not skeleton.gap:
        check_regions(SkeletonRegions(with_corners_apart(skeleton), graph, sites))


def verify_exterior(shapes: ShapeDiagram, *, threads: int = 0) -> None:
    """Check the unbounded part of a skeleton before it is clipped, as a graph."""
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
    nodes = distinct(ends)
    roots = connected_roots(ends, int(ends.max()) + 1)[nodes]
    if len(distinct(roots)) > 1:
        fail(f"the skeleton outside has {len(distinct(roots))} connected parts, even with a node at infinity")
    lone = np.bincount(graph.segments.reshape(-1), minlength=len(graph.points)) == 0
    sites = distinct(diagram.edge_sites[edges])
    points = np.count_nonzero(lone[sites[sites < len(graph.points)]])
    expected = border_components(graph)[0] + points - 1
    cycles = len(edges) - len(nodes) + 1
    if cycles != expected:
        fail(f"the skeleton outside has {cycles} independent cycles, not {expected}")


def _without_portions(skeleton: Skeleton) -> Skeleton:
    kept = (skeleton.radius[skeleton.arcs] > 0).all(axis=1)
    return replace(skeleton, **{name: getattr(skeleton, name)[kept] for name in PER_ARC})


def _elements(skeleton: Skeleton, graph: PlanarGraph, run: Run) -> PlanarGraph:
    """The points and segments that nothing may be nearer than."""
    if not skeleton.gap:
        return graph
    from vorotool.engines.skeleton.shortened_edges import element_diagram

    return element_diagram(skeleton.polygons, skeleton.gap, threads=run["threads"]).graph


def check_arrays(skeleton: Skeleton) -> None:
    """Raise unless indices exist, nodes are finite and used, and sides go with polygons."""
    for name, limit in (("arcs", len(skeleton.vertices)), ("sites", len(skeleton.site_table))):
        at = first_wrong(((getattr(skeleton, name) < 0) | (getattr(skeleton, name) >= limit)).any(axis=1))
        if at is not None:
            fail(f"{name} of arc {at} are {getattr(skeleton, name)[at].tolist()}, beyond {limit - 1}")
    if not (np.isfinite(skeleton.vertices).all() and np.isfinite(skeleton.radius).all()):
        fail("a node is not finite")
    if (at := first_wrong((skeleton.degree == 0) | (skeleton.radius < 0))) is not None:
        fail(f"node {at} has no arcs, or a negative radius")
    inside = skeleton.polygon >= 0
    at = first_wrong((inside != (skeleton.side == INTERIOR)) | (skeleton.polygon >= len(skeleton.polygons)))
    if at is not None:
        fail(
            f"arc {at} is {'inside' if skeleton.side[at] == INTERIOR else 'outside'}, in polygon {skeleton.polygon[at]}"
        )


def check_branches(skeleton: Skeleton) -> None:
    """Raise unless branches are chains that end where they should."""
    step = np.diff(skeleton.branch, prepend=-1)
    if (at := first_wrong((step < 0) | (step > 1))) is not None:
        fail(f"the branch of arc {at} is {skeleton.branch[at]}, after {skeleton.branch[at - 1]}")
    joined = np.flatnonzero(step == 0)
    before, after = skeleton.arcs[joined - 1, 1], skeleton.arcs[joined, 0]
    if (at := first_wrong((before != after) | (skeleton.degree[after] != 2))) is not None:
        fail(f"arc {joined[at]} does not start where the previous arc of its branch ends")
    first = np.flatnonzero(step)
    last = np.append(first[1:], len(skeleton)) - 1
    ends = np.stack([skeleton.arcs[first, 0], skeleton.arcs[last, 1]])
    if (at := first_wrong((skeleton.degree[ends] == 2).any(axis=0) & (ends[0] != ends[1]))) is not None:
        fail(f"branch {at} ends at a node where it could continue")
