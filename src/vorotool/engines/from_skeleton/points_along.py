"""Places at equal steps along skeletons or centerlines, sections across them, and rays to the boundary."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.common import fail, first_wrong
from vorotool.engines.skeleton.clearance import SitePlaces
from vorotool.engines.skeleton.parts import core_skeleton
from vorotool.errors import LimitError, UsageError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Booleans, Floats, Indices, norms, owners, ranges, starts_of, within
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.numeric.numbers import finite_double
from vorotool.numeric.parallel import Progress
from vorotool.types.arguments import check_value
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.polygons.shapely_geometry import to_shapely
from vorotool.types.skeleton.lines import LedOn
from vorotool.types.skeleton.points_along import SkeletonPoints
from vorotool.types.skeleton.skeleton import Skeleton

MOST_POINTS = 1 << 27
"""Some 10 GB of arrays."""


def points_along(
    skeleton: Skeleton | LedOn, *, every: float, threads: int = 0, progress: Progress = None
) -> SkeletonPoints:
    """Return points along each branch or centerline at equal steps of true arc length from its beginning.

    Parameters
    ----------
    skeleton : Skeleton, Centerlines or ExtendedSkeleton
        Pruned or not. Along the latter two the way goes on through junctions and along what leads on to the outline,
        and feet are where the straight line across meets the outline, or an island in it, first.
    every : float
        The step, in input units.
    threads : int
        Number of threads; 0 uses all. The result does not depend on it.
    progress : callable, optional
        Called with the fraction that is done; returning False stops with KeyboardInterrupt.

    Returns
    -------
    SkeletonPoints
        At 0, 1, 2, … steps from the beginning of each branch, as far as it reaches; with radii and feet.

    Raises
    ------
    UsageError
        If the step is not positive and finite.
    LimitError
        If there would be more than 2^27 points.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> points = points_along(skeleton_exact([[0, 0], [8, 0], [8, 2], [0, 2]]), every=2)
    >>> points.xy[points.radius == 1].tolist(), points.along[points.radius == 1].tolist()
    ([[1.0, 1.0], [3.0, 1.0], [5.0, 1.0], [7.0, 1.0]], [0.0, 2.0, 4.0, 6.0])
    """
    check_value(skeleton, "skeleton", "Skeleton", "Centerlines", "ExtendedSkeleton")
    every = finite_double(every, "the step")
    check_step(every)
    threads = checked_threads(threads)
    if isinstance(skeleton, LedOn):
        return sections_along(skeleton, _counts(skeleton.length, every), every)
    start = skeleton.branch_starts
    counts = _counts(np.add.reduceat(skeleton.length, start) if len(start) else np.zeros(0), every)
    core = core_skeleton(skeleton, threads=threads)
    made = _core.skeleton.steps_along(core, start, counts, every, threads, progress)
    return SkeletonPoints(skeleton, **made)


def check_step(every: float) -> None:
    """Raise UsageError for what is no step."""
    if not 0 < every < np.inf:
        raise UsageError(f"the step is {every}: use a length above 0")


def _counts(length: NDArray[np.float64], every: float) -> NDArray[np.int64]:
    """Points on each line."""
    with np.errstate(over="ignore"):
        counts = np.floor(length / every) + 1
    if not counts.sum() <= MOST_POINTS:
        raise LimitError(
            f"steps of {every:g} along a length of {length.sum():.6g} give more than {MOST_POINTS} points: use longer "
            "steps"
        )
    return counts.astype(np.int64)


_TOUCH = 8
"""Ulp of the largest coordinate: discs that are smaller are on the outline, but for rounding."""


def sections_along(lines: LedOn, counts: Indices, every: float) -> SkeletonPoints:
    """Give places at 0, 1, 2, … steps from where each line begins, and the ends of the section across it there."""
    pieces = _pieces(lines)
    line: Indices = owners(counts)
    along: Floats = np.asarray(every * within(counts), dtype=np.float64)
    piece, reached = _found(pieces, line, along)
    xy, way = _places(lines, pieces, piece, reached)
    radius, given = _radii(lines, pieces, piece, reached, xy, line), lines.as_given
    for at, is_end in enumerate((along == 0, along >= lines.length[line])):
        led_on, nodes = given.ends[line, at][is_end], lines.end_nodes[line, at][is_end]
        is_led_on = ~np.isnan(led_on[:, :1])
        xy[is_end] = np.where(is_led_on, led_on, given.path.vertices[nodes])
        radius[is_end] = np.where(is_led_on[:, 0], 0, lines.path.radius[nodes])
    polygons = given.path.polygons
    inside = (radius > _TOUCH * np.spacing(np.abs(polygons.xy).max(initial=0.0))) & way.any(axis=1)
    feet, rings = np.repeat(xy[:, None], 2, axis=1), np.full((len(xy), 2), -1, dtype=np.int32)
    own = None if lines.path.features == "together" else lines.polygon[line][inside]
    feet[inside], rings[inside] = section_ends(polygons, own, xy[inside], way[inside], radius[inside])
    arc = pieces.nearest_arc[piece]
    return SkeletonPoints(lines.path, arc, along, xy, radius, feet, rings)


@frozen(eq=False)
class _Pieces:
    """Arcs of lines and the straight lines that lead on, line by line."""

    arc: Indices  # (p,) int64 array: -1 for what leads on; the first or the last arc of its line
    nearest_arc: Indices  # (p,) int64 array: -1 for what leads on; the first or the last arc of its line
    ends: Floats  # (p, 2, 2) float64 array: where each begins and ends
    length: Floats  # (p,) float64 array: and how far from the beginning of its line it begins
    begin: Floats  # (p,) float64 array: and how far from the beginning of its line it begins
    line: Indices  # (p,) int64 array: not decreasing


def _pieces(lines: LedOn) -> _Pieces:
    path, (first, last) = lines.path, lines.extended
    arcs = np.arange(len(path))
    start = lines.arc_starts
    nodes = path.vertices[lines.end_nodes]
    of_first = np.stack([lines.ends[first, 0], nodes[first, 0]], axis=1)
    of_last = np.stack([nodes[last, 1], lines.ends[last, 1]], axis=1)
    line = lines.line_of_row
    arc = lines.in_rows(np.full(len(first), -1), arcs, np.full(len(last), -1))
    nearest = lines.in_rows(start[:-1][first], arcs, start[1:][last] - 1)
    ends = lines.in_rows(of_first, path.vertices[path.arcs], of_last)
    extension = lines.extension_length
    length = lines.in_rows(extension[first, 0], path.length, extension[last, 1])
    whole = np.concatenate([[0.0], np.cumsum(length)])
    begin = whole[:-1] - whole[np.searchsorted(line, line)]
    return _Pieces(arc, nearest, ends, length, begin, line)


def _found(pieces: _Pieces, line: Indices, along: Floats) -> tuple[Indices, Floats]:
    """The piece that each place is on, the last that begins there or before, and how far along it."""
    count = len(pieces.line)
    keys = np.concatenate([pieces.begin, along]), np.concatenate([pieces.line, line])
    order = np.lexsort(keys)  # stable: pieces come before the places where they begin
    piece = np.empty(len(order), dtype=np.int64)
    piece[order] = np.maximum.accumulate(np.where(order < count, order, -1))
    found = piece[count:]
    return found, np.minimum(along - pieces.begin[found], pieces.length[found])


def _places(lines: LedOn, pieces: _Pieces, piece: Indices, reached: Floats) -> tuple[Floats, Floats]:
    """Places, and the directions of their lines; where two pieces meet half-way between theirs."""
    arc = pieces.arc[piece]
    length = pieces.length[piece]
    u = np.divide(reached, length, out=np.zeros(len(piece)), where=length > 0)
    a, b = pieces.ends[piece].swapaxes(0, 1)
    xy = a + u[:, None] * (b - a)
    on_arc = np.flatnonzero(arc >= 0)
    measures = lines.path.measures(arc[on_arc])
    u[on_arc] = measures.parameter(reached[on_arc])
    xy[on_arc] = measures.place(u[on_arc])
    way = _directions(lines, pieces, piece, u)
    before = piece - 1
    meets = np.flatnonzero((reached == 0) & (pieces.line[np.maximum(before, 0)] == pieces.line[piece]) & (before >= 0))
    both = way[meets] + _directions(lines, pieces, before[meets], np.ones(len(meets)))
    way[meets] = np.where((both == 0).all(axis=1)[:, None], way[meets], both)  # a way that turns back has no middle
    return xy, way


def _directions(lines: LedOn, pieces: _Pieces, piece: Indices, u: Floats) -> Floats:
    """Unit vectors along pieces; where a curve has none, along its chord."""
    a, b = pieces.ends[piece].swapaxes(0, 1)
    arc = pieces.arc[piece]
    control = np.where(arc[:, None] >= 0, lines.path.control[arc], np.nan)
    v = u[:, None]
    bent = (1 - v) * (control - a) + v * (b - control)
    way = np.where(np.isnan(control) | ~bent.any(axis=1)[:, None], b - a, bent)
    length = hypotenuse(*way.T)[:, None]
    return np.divide(way, length, out=np.zeros_like(way), where=length > 0)


def _radii(lines: LedOn, pieces: _Pieces, piece: Indices, reached: Floats, xy: Floats, line: Indices) -> Floats:
    """Clearances: of the arcs, and on what leads on the distances from the outline."""
    arc, polygons = pieces.arc[piece], lines.path.polygons
    radius = np.empty(len(arc))
    on_arc, off = np.flatnonzero(arc >= 0), np.flatnonzero(arc < 0)
    measures = lines.path.measures(arc[on_arc])
    radius[on_arc] = measures.radius(measures.parameter(reached[on_arc]))
    outlines, own = shapely.boundary(to_shapely(polygons)), lines.polygon[line[off]]
    if lines.path.features == "together":
        outlines, own = np.array([shapely.GeometryCollection(list(outlines))]), np.zeros_like(own)
    radius[off] = shapely.distance(shapely.points(xy[off]), outlines[own])
    return radius


_GROWTH = 4
"""By how much a ray is made longer that meets no edge yet."""


def section_ends(
    polygons: PolygonSet, own: NDArray[np.integer] | None, xy: Floats, way: Floats, radius: Floats
) -> tuple[Floats, NDArray[np.int32]]:
    """Find where straight lines across some ways meet the outline first, left and right."""
    left = np.stack([-way[:, 1], way[:, 0]], axis=1)
    across = np.stack([left, -left], axis=1).reshape(-1, 2)
    polygon = None if own is None else np.repeat(own, 2)
    places, vertices = _first_hits(polygons, polygon, np.repeat(xy, 2, axis=0), across, np.repeat(radius, 2))
    ring = np.searchsorted(polygons.ring_starts, vertices, side="right") - 1
    rings = np.where(vertices < 0, -1, ring - polygons.polygon_starts[polygons.ring_polygon[ring]])
    return places.reshape(-1, 2, 2), rings.reshape(-1, 2).astype(np.int32)


def _first_hits(
    polygons: PolygonSet, polygon: NDArray[np.integer] | None, origin: Floats, way: Floats, reach: Floats
) -> tuple[Floats, Indices]:
    """Where each ray meets an edge first, and where that edge begins: edges near the ray are looked at first."""
    way = way / hypotenuse(*way.T)[:, None]
    edges = np.stack([polygons.xy, polygons.xy[polygons.following]], axis=1)
    of_edge = polygons.ring_polygon[owners(np.diff(polygons.ring_starts))]
    tree = shapely.STRtree(shapely.linestrings(edges))
    most = 2 * float(np.abs(polygons.xy - polygons.xy[:1]).sum(axis=1).max(initial=0.0))
    places, vertices = origin.copy(), np.full(len(origin), -1, dtype=np.int64)
    left, reach = np.arange(len(origin)), 2 * reach
    while left.size:
        ends = np.stack([origin[left], origin[left] + reach[left, None] * way[left]], axis=1)
        ray, edge = tree.query(shapely.linestrings(ends))
        if polygon is not None:
            is_own = of_edge[edge] == polygon[left[ray]]
            ray, edge = ray[is_own], edge[is_own]
        order = np.lexsort((edge, ray))  # of equally near ones the first is met
        ray, edge = ray[order], edge[order]
        begin, end = (edges[edge, side] - origin[left[ray]] for side in (0, 1))
        ahead, met = first_crossings(ray, begin, end, way[left])
        # what is farther may be behind an edge that was not looked at
        found = np.flatnonzero((met >= 0) & (hypotenuse(*ahead.T) <= reach[left]))
        of, hit = left[found], edge[met[found]]
        vertices[of] = hit
        a, b = edges[hit].swapaxes(0, 1)
        places[of] = np.where(a == b, a, origin[of] + ahead[found])  # exactly on edges along an axis
        left = left[(vertices[left] < 0) & (reach[left] <= most)]
        reach[left] *= _GROWTH
    return places, vertices


PART = 1 << 18
"""Edges that are looked at together, or those of one polygon."""


def first_hits(
    polygons: PolygonSet, polygon: NDArray[np.integer], origin: Floats, way: Floats
) -> tuple[Floats, NDArray[np.intp]]:
    """Find where each ray meets an edge of its own polygon first, in time linear in the edges of these."""
    first = polygons.ring_starts[polygons.polygon_starts]
    size = np.diff(first)[polygon]
    places, vertices = np.full((len(polygon), 2), np.nan), np.full(len(polygon), -1, dtype=np.intp)
    ends = np.cumsum(size)
    begin = 0
    while begin < len(polygon):
        most = ends[begin] - size[begin] + PART
        end = max(int(np.searchsorted(ends, most, side="right")), begin + 1)
        rays = slice(begin, end)
        places[rays], vertices[rays] = _hits(polygons, first[polygon[rays]], size[rays], origin[rays], way[rays])
        begin = end
    return places, vertices


def _hits(
    polygons: PolygonSet, first: NDArray[np.int64], size: NDArray[np.int64], origin: Floats, way: Floats
) -> tuple[Floats, NDArray[np.intp]]:
    """Of rays with the edges of vertices from `first` on, which are not none."""
    ray, vertex = owners(size), ranges(first, size)
    a, b = (polygons.xy[of] - origin[ray] for of in (vertex, polygons.following[vertex]))
    ahead, met = first_crossings(ray, a, b, way)
    places, vertices = np.full((len(size), 2), np.nan), np.full(len(size), -1, dtype=np.intp)
    found = np.flatnonzero(met >= 0)
    vertices[found] = vertex[met[found]]
    a, b = polygons.xy[vertices[found]], polygons.xy[polygons.following[vertices[found]]]
    places[found] = np.where(a == b, a, origin[found] + ahead[found])  # exactly on edges along an axis
    return places, vertices


def first_crossings(ray: NDArray[np.integer], a: Floats, b: Floats, way: Floats) -> tuple[Floats, NDArray[np.intp]]:
    """Find which of its edges each ray meets first."""
    length = norms(way)[:, None]
    way = np.divide(way, length, out=np.zeros(way.shape), where=length > 0)  # a ray that goes nowhere meets nothing
    (ax, ay), (bx, by) = a.T, b.T
    dx, dy = way[ray].T
    met = np.flatnonzero((dx * ay - dy * ax >= 0) != (dx * by - dy * bx >= 0))
    ax, ay, dx, dy = (values[met] for values in (ax, ay, dx, dy))
    ex, ey = (b[met] - a[met]).T
    across = dx * ey - dy * ex
    distance = np.divide(ax * ey - ay * ex, across, out=np.full(len(met), np.inf), where=across != 0)
    distance[~(distance > 0)] = np.inf
    order = np.lexsort((met, distance, ray[met]))
    order = order[np.diff(ray[met][order], prepend=-1) > 0]
    order = order[np.isfinite(distance[order])]
    places, edges = np.full((len(way), 2), np.nan), np.full(len(way), -1, dtype=np.intp)
    found = ray[met][order]
    edges[found] = met[order]
    places[found] = distance[order][:, None] * way[found]
    return places, edges


_ROUNDING = 2.0**-26
"""Part of the extent that places may be off: the lattice has 31 bits, and lines are cut into chords."""
_LENGTHENED = 2.0**-16
"""Part of a way by which a curve may be longer than its chords."""
_SHORTENED = 2.0**-10
"""Part of a section that is left out at its ends where it is to be inside."""


def verify_sections(points: SkeletonPoints, lines: LedOn, every: float) -> None:
    """Check that places are at equal steps on their lines, and sections straight across from outline to outline."""
    polygons = lines.path.polygons.as_given
    tolerance = _ROUNDING * float(np.ptp(polygons.xy, axis=0).max(initial=0.0) or 1.0)
    line = points.skeleton.branch[points.arc].astype(np.int64)
    counts = np.bincount(line, minlength=len(lines))
    if (counts != np.floor(lines.length / every) + 1).any():
        fail("a line has more or fewer points than steps")
    _refuse(points.along != every * (np.arange(len(line)) - starts_of(counts)[line]), "is not at its step")
    xy, start = lines.as_given.flattened(tolerance / 4)
    paths = shapely.linestrings(xy, indices=owners(np.diff(start)))
    shapely.prepare(paths)
    _refuse(~shapely.dwithin(paths[line], shapely.points(points.xy), tolerance), "is off its line")
    way = points.xy - _interpolated(xy, start, line, points.along)
    _refuse(hypotenuse(*way.T) > tolerance + _LENGTHENED * points.along, "is at another distance along its line")
    _check_across(points, lines, line, tolerance)
    _check_ends(points, line, to_shapely(polygons), tolerance)


def _interpolated(xy: Floats, start: NDArray[np.int64], line: NDArray[np.int64], along: Floats) -> Floats:
    """Places along polylines, which end where these do."""
    steps = hypotenuse(*np.diff(xy, axis=0, append=xy[-1:]).T)
    steps[start[1:] - 1] = 0
    reached = np.concatenate([[0.0], np.cumsum(steps)])[:-1]
    wanted = np.minimum(along + reached[start[:-1]][line], reached[start[1:] - 1][line])
    at = np.clip(np.searchsorted(reached, wanted, side="right") - 1, start[line], start[line + 1] - 1)
    part = np.divide(wanted - reached[at], steps[at], out=np.zeros(len(at)), where=steps[at] > 0)
    return xy[at] + part[:, None] * (xy[np.minimum(at + 1, len(xy) - 1)] - xy[at])


def _check_across(points: SkeletonPoints, lines: LedOn, line: NDArray[np.int64], tolerance: float) -> None:
    """Sections go the way from foot to foot of the discs; where arcs meet, half-way between two of these ways."""
    path, (begin, end) = lines.path, lines.extension_length[line].T
    inside = (points.along > begin) & (points.along < lines.length[line] - end) & points.spans
    reached = np.concatenate([[0.0], np.cumsum(path.length)])
    along = points.along - begin + reached[lines.arc_starts[line]]
    nearest = np.clip(np.searchsorted(reached, along) - 1, 0, len(path) - 1)
    meets = np.minimum(np.abs(along - reached[nearest]), np.abs(along - reached[nearest + 1])) <= tolerance
    on_arc = np.flatnonzero(inside & ~meets)
    (ux, uy), (vx, vy) = _across(path, points, on_arc).T, (points.feet[on_arc, 0] - points.feet[on_arc, 1]).T
    lengths, radius = hypotenuse(ux, uy) * hypotenuse(vx, vy), points.radius[on_arc]
    off = np.zeros(len(points), dtype=bool)
    off[on_arc] = ~((ux * vy - uy * vx) * radius <= tolerance * lengths) | (ux * vx + uy * vy <= 0)
    _refuse(off, "has a section that is not straight across")


def _across(path: Skeleton, points: SkeletonPoints, chosen: NDArray[np.int64]) -> Floats:
    """From the foot on the right site to that on the left one; approximate arcs, which are straight, turned left."""
    arc, sites, places = points.arc[chosen], SitePlaces(path), points.xy[chosen]
    left, right = (sites.feet(site, places) for site in path.sites[arc].T)
    source, target = path.vertices[path.arcs[arc]].swapaxes(0, 1)
    turned = np.stack([source[:, 1] - target[:, 1], target[:, 0] - source[:, 0]], axis=1)
    is_exact = path.error_bound[arc] == 0
    return np.where(is_exact[:, None], left - right, turned)


def _check_ends(points: SkeletonPoints, line: NDArray[np.int64], shapes: NDArray[Any], tolerance: float) -> None:
    """Feet are on the outline, on different sides of the place, and nothing of it is between."""
    assert points.rings is not None
    polygon, spans = points.skeleton.polygon[points.arc], points.spans
    outlines = shapely.boundary(shapes)
    if points.skeleton.features == "together":
        outlines = np.full(len(shapes), shapely.GeometryCollection(list(outlines)))
    shapely.prepare(outlines)
    shapely.prepare(shapes)
    for side in (0, 1):
        far = ~shapely.dwithin(outlines[polygon], shapely.points(points.feet[:, side]), tolerance)
        _refuse(far & spans, "has a foot off the outline")
    a, b = (points.xy + (1 - _SHORTENED) * (points.feet[:, side] - points.xy) for side in (0, 1))
    whole = shapely.linestrings(np.stack([a, b], axis=1))
    met = np.flatnonzero(spans & shapely.intersects(outlines[polygon], whole))
    crossed = np.zeros(len(points), dtype=bool)  # what is touched only is not left
    crossed[met] = ~shapely.covers(shapes[polygon[met]], whole[met]) & shapely.crosses(
        whole[met], outlines[polygon[met]]
    )
    _refuse(crossed, "has a section that leaves its polygon")


def _refuse(wrong: Booleans, what: str) -> None:
    if (at := first_wrong(wrong)) is not None:
        fail(f"point {at} {what}")
