"""Checks of approximate skeletons from their arrays: error bounds, clearances, sides, cycles; distances from arcs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.arrangement.planar_graph import planar_graph
from vorotool.engines.common import fail, first_wrong, off_segments
from vorotool.engines.features.batches import BatchShapes, in_batches
from vorotool.engines.skeleton.clearance import clearances
from vorotool.engines.skeleton.diagrams import batch_diagram
from vorotool.engines.skeleton.exact import diagram_of_graph, interior_skeleton, skeleton_of
from vorotool.engines.skeleton.parts import outside_of, with_arcs, with_polygons
from vorotool.engines.skeleton.verify_regions import border_components, with_corners_apart
from vorotool.numeric.arrays import connected_roots, dots, mask_of, norms, owners
from vorotool.numeric.lazy import shapely
from vorotool.numeric.parallel import Run
from vorotool.types.box import widened
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.shapely_geometry import to_shapely
from vorotool.types.skeleton.skeleton import EXTERIOR, INTERIOR, Skeleton

PLACE_ERROR = 2.0**-18
"""Of a lattice step: how far distances of nodes may be wrong. They are rounded to input units, which may be coarser."""
PER_ARC = 5
"""Places on each arc whose distances from the exact skeleton are measured."""


def check_approximation(skeleton: Skeleton, run: Run) -> None:
    """Raise unless an approximate skeleton is where its bounds, radii and sides tell, feature by feature."""
    if (at := first_wrong(skeleton.is_parabola)) is not None:
        fail(f"arc {at} is a parabola, but arcs of approximate skeletons are straight")
    _check_sides(skeleton)
    error, is_inside = place_error(skeleton), skeleton.side == INTERIOR
    if skeleton.features == "together" or not len(skeleton.polygons):
        _check_in_all(skeleton, error, run)
        return
    if not is_inside.all():
        _check_in_all(outside_of(skeleton), error, run)
    own = with_arcs(skeleton, is_inside)

    def check(shapes: BatchShapes, run: Run) -> None:
        of_batch = with_polygons(own, shapes.batch.polygons)
        if len(of_batch):
            exact = interior_skeleton(batch_diagram(shapes, **run), threads=run["threads"])
            _check_in_graph(of_batch, shapes.graph, exact, error, run)

    if is_inside.any():
        in_batches(skeleton.polygons, check, drops=False, **run)


def place_error(skeleton: Skeleton) -> float:
    """How far distances from nodes may be off."""
    largest = max(np.abs(xy).max(initial=0.0) for xy in (skeleton.vertices, skeleton.polygons.xy))
    return PLACE_ERROR * skeleton.scale + 4 * float(np.spacing(largest))


def _check_in_all(skeleton: Skeleton, error: float, run: Run) -> None:
    """Check what is in one arrangement of all polygons."""
    graph = planar_graph(skeleton.polygons, **run)
    sides = np.unique(skeleton.side).tolist()
    side = "both" if len(sides) > 1 else ("interior" if sides == [INTERIOR] else "exterior")
    frame = None if skeleton.frame is None else widened(skeleton.frame)
    threads = run["threads"]
    exact = skeleton_of(diagram_of_graph(graph, threads=threads), side=side, frame=frame, threads=threads)
    _check_in_graph(skeleton, graph, exact, error, run)


def _check_in_graph(skeleton: Skeleton, graph: PlanarGraph, exact: Skeleton, error: float, run: Run) -> None:
    _check_crossings(skeleton, graph, error)
    _check_clearances(skeleton, graph, error, run)
    _check_bounds(skeleton, exact)
    _check_cycles(skeleton, graph)


def _check_crossings(skeleton: Skeleton, graph: PlanarGraph, error: float) -> None:
    """Raise if an arc meets the shapes; those that lead to corners are looked at from their middle on."""
    ends = skeleton.vertices[skeleton.arcs]
    middle = ends.mean(axis=1)
    for end in (0, 1):
        at_corner = skeleton.radius[skeleton.arcs[:, end]] <= error
        ends[at_corner, end] = middle[at_corner]
    edges = shapely.linestrings(graph.coordinates()[graph.segments])
    arc, edge = shapely.STRtree(edges).query(shapely.linestrings(ends), predicate="intersects")
    if len(arc):
        fail(f"arc {arc[0]} meets edge {edge[0]} of the shapes")


def _check_sides(skeleton: Skeleton) -> None:
    """Raise unless each arc is in its polygon, or in none."""
    polygons = skeleton.polygons
    area = np.flatnonzero(~polygons.is_line)
    shapes = np.array(to_shapely(polygons), dtype=object)[area]
    middle = shapely.points(skeleton.vertices[skeleton.arcs].mean(axis=1))
    arc, shape = shapely.STRtree(shapes).query(middle, predicate="intersects")
    inside = mask_of(arc, len(skeleton))
    if (at := first_wrong(inside != (skeleton.side == INTERIOR))) is not None:
        fail(f"arc {at} is {('inside' if inside[at] else 'outside')}, but is listed on the other side")
    own = mask_of(arc[area[shape] == skeleton.polygon[arc]], len(skeleton))
    if (at := first_wrong(~own & (skeleton.side != EXTERIOR))) is not None:
        fail(f"arc {at} is not in polygon {skeleton.polygon[at]}")


def _check_clearances(skeleton: Skeleton, graph: PlanarGraph, error: float, run: Run) -> None:
    """Raise unless the radius of each node is its distance from the shapes."""
    least = clearances(skeleton.vertices, skeleton.radius + 2 * error, graph, run)
    if (at := first_wrong(~(np.abs(skeleton.radius - least) <= error))) is not None:
        place = tuple(skeleton.vertices[at].tolist())
        fail(f"node {at} at {place} is {least[at]} from the shapes, but its radius is {skeleton.radius[at]}")


def _check_bounds(skeleton: Skeleton, exact: Skeleton) -> None:
    """Raise if an arc is farther from the exact skeleton than its bound."""
    proved = np.flatnonzero(~np.isnan(skeleton.error_bound))
    if not len(exact):
        if len(proved):
            fail(f"arc {proved[0]} has an error bound, but the exact skeleton has no arcs on this side")
        return
    places = places_on_arcs(skeleton, np.linspace(0, 1, PER_ARC))
    distance = distances_to(exact, places.reshape(-1, 2)).reshape(len(skeleton), -1).max(axis=1)
    error = 4 * float(np.spacing(np.abs(exact.vertices).max(initial=0.0)))
    if (at := first_wrong(distance > skeleton.error_bound + error)) is not None:
        fail(f"arc {at} is {distance[at]} from the exact skeleton, beyond its bound of {skeleton.error_bound[at]}")


def _check_cycles(skeleton: Skeleton, graph: PlanarGraph) -> None:
    """Raise if there are more cycles in a polygon, or outside, than parts of the boundary that they may go around."""
    skeleton = with_corners_apart(skeleton)
    outside = len(skeleton.polygons)
    group = np.where(skeleton.polygon < 0, outside, skeleton.polygon)
    of_node = np.zeros(len(skeleton.vertices), dtype=np.int64)
    of_node[skeleton.arcs] = group[:, None]
    root = connected_roots(skeleton.arcs, len(skeleton.vertices))
    of_part = of_node[root == np.arange(len(root))]
    arcs, nodes, parts = (np.bincount(owner, minlength=outside + 1) for owner in (group, of_node, of_part))
    cycles, most = arcs - nodes + parts, _most_cycles(graph, outside)
    if (at := first_wrong(cycles > most)) is not None:
        where = "outside" if at == outside else f"in polygon {at}"
        fail(f"the skeleton {where} has {cycles[at]} independent cycles, but at most {most[at]} are possible")


def _most_cycles(graph: PlanarGraph, outside: int) -> NDArray[np.int64]:
    """(p + 1,) the parts of the boundary of each face less one, summed over the faces of each polygon and outside."""
    parts = border_components(graph) + np.bincount(graph.point_holes[:, 1], minlength=graph.faces)
    polygon = np.full(graph.faces, outside)
    inside = np.flatnonzero(graph.is_inside)
    polygon[inside] = graph.face_polygon[graph.face_starts[inside]]
    most = np.zeros(outside + 1, dtype=np.int64)
    np.add.at(most, polygon, np.maximum(parts - 1, 0))
    return most


Places = NDArray[np.float64]

FLATTEN = 2.0**-12
"""Of the extent: how finely arcs are flattened to find those that may be nearest."""
STARTS = 8
"""Parts of a parabola from the ends of which Newton's method starts: on each the distance has one minimum at most."""
NEWTON_STEPS = 40


def places_on_arcs(skeleton: Skeleton, parameters: NDArray[np.float64]) -> Places:
    """(a, k, 2) places on each arc, by the parameter of the Bezier curve that it is."""
    source, control, target = (corner[:, None] for corner in _bezier(skeleton))
    t = parameters[None, :, None]
    return np.square(1 - t) * source + 2 * t * (1 - t) * control + t * t * target


def distances_to(skeleton: Skeleton, places: Places) -> NDArray[np.float64]:
    """(n,) distances of places from the nearest arc, right to a few ulp of the coordinates."""
    tolerance = FLATTEN * float(np.ptp(np.concatenate([skeleton.vertices, places]), axis=0).max() or 1.0)
    points, start = skeleton.flattened(tolerance)
    lines = shapely.linestrings(points, indices=owners(np.diff(start)))
    tree = shapely.STRtree(lines)
    geometry = shapely.points(places)
    _, about = tree.query_nearest(geometry, return_distance=True, all_matches=False)
    row, arc = tree.query(geometry, predicate="dwithin", distance=about + 2 * tolerance)
    nearest = np.full(len(places), np.inf)
    source, control, target = _bezier(skeleton)
    for is_bent in (False, True):
        own = skeleton.is_parabola[arc] == is_bent
        r, a = row[own], arc[own]
        curve = source[a], control[a], target[a]
        found = _from_parabola(places[r], *curve) if is_bent else off_segments(places[r], curve[0], curve[2])
        np.minimum.at(nearest, r, found)
    return nearest


def _bezier(skeleton: Skeleton) -> tuple[Places, Places, Places]:
    source, target = skeleton.vertices[skeleton.arcs].swapaxes(0, 1)
    return source, np.where(skeleton.is_parabola[:, None], skeleton.control, (source + target) / 2), target


def _from_parabola(x: Places, source: Places, control: Places, target: Places) -> NDArray[np.float64]:
    """The least of the distances at minima that Newton's method finds from several places."""
    first, bend = 2 * (control - source), source - 2 * control + target
    offset = source - x

    def away(t: NDArray[np.float64]) -> Places:
        return offset + t[:, None] * (first + t[:, None] * bend)

    best = np.full(len(x), np.inf)
    for start in np.linspace(0, 1, STARTS + 1):
        t = np.full(len(x), start)
        for _ in range(NEWTON_STEPS):
            from_x, tangent = away(t), first + 2 * t[:, None] * bend
            slope = dots(from_x, tangent)
            curvature = dots(tangent, tangent) + 2 * dots(from_x, bend)
            step = np.divide(slope, np.abs(curvature), out=np.zeros(len(x)), where=curvature != 0)
            moved = np.clip(t - step, 0, 1)
            if np.array_equal(moved, t):
                break
            t = moved
        best = np.minimum(best, norms(away(t)))
    return best
