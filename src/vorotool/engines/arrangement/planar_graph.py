"""Polygons and lines made a planar straight-line graph, the input of the skeleton engines; what is said of it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.arrangement.repaired_polygons import flat_holes, given_shapes, with_flat_shells_as_lines
from vorotool.errors import STRICT, InputError, LimitError, RepairWarning, VerificationError, warn
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, Indices, crosses, divides, dots, mask_of, norms, owners, ranges, starts_of
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.numbers import distinct
from vorotool.numeric.parallel import Progress, Run
from vorotool.products.formats import resolved
from vorotool.types.arguments import check_value
from vorotool.types.box import check_magnitude
from vorotool.types.polygons.planar_graph import REPAIRS, PlanarGraph
from vorotool.types.polygons.polygon_set import LINE, PolygonSet
from vorotool.types.values import counted

if TYPE_CHECKING:
    from vorotool.typing import PolygonsLike

MOST_VERTICES = 2**28
"""Segments are numbered in 31 bits, and crossings make more of them."""
MOST_OVERLAPS = 2**26
"""Polygons of all faces together, as the core has it."""


def planar_graph(
    polygons: PolygonsLike, *, strict: bool = False, threads: int = 0, progress: Progress = None
) -> PlanarGraph:
    """Place polygons and open lines on an integer lattice, and cut them where they meet.

    The step of the lattice is the least power of two for which the extent fits into 31 signed bits, its origin a
    multiple of the step. Whole numbers, and all coordinates that are multiples of the step, do not move; others go to
    the nearest lattice point. From there on everything is exact. Edges are cut where a vertex lies on them and where
    they cross. A crossing that is no lattice point is rounded to one; then edges near it may have to bend by less than
    a step too (snap rounding), others never do. What bounds no polygon is left out. Input that needs no repair is only
    placed.

    Parameters
    ----------
    polygons : PolygonSet, shapely geometry, GeoSeries, GeoDataFrame, GeoJSON, (n, 2) array, …, or a list of these
        An array is the shell of one polygon; a mapping has ``shell`` and ``holes``, or ``line``. Of a list each item is
        one feature, and so is each row.
    strict : bool
        Refuse what would be repaired; a move by placement alone, at most 0.71 of a step, is none.
    threads : int
        Threads for placement; 0 uses all. The sweep runs on one.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    PlanarGraph
        Without points if there are no polygons.

    Raises
    ------
    InputError
        If a coordinate is not finite, or `strict` and something would be repaired: polygon, ring,
        vertex or edge and its coordinates are named.
    LimitError
        If there are more than 2^28 vertices or crossings, or 2^26 entries in `PlanarGraph.face_polygon`.

    Warns
    -----
    RepairWarning
        If something was repaired: what, and how often.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 3.2; Bentley and Ottmann 1979; Hobby, "Practical
    segment intersection with finite precision output", 1999.

    Examples
    --------
    >>> graph = planar_graph([[0, 0], [4, 0], [4, 4], [0, 4]])
    >>> graph.segments.tolist(), graph.segment_faces.tolist()
    ([[0, 1], [1, 2], [2, 3], [3, 0]], [[1, 0], [1, 0], [1, 0], [1, 0]])
    >>> graph.coordinates().tolist(), graph.largest_move
    ([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]], 0.0)
    """
    given = _set_of(polygons)
    if len(given.xy) > MOST_VERTICES:
        raise LimitError(f"the input has {len(given.xy)} vertices, more than {MOST_VERTICES}: split the polygons")
    placement = placed_vertices(given, threads=threads, progress=progress)
    return graph_of_placement(given, placement, strict=strict, progress=progress)


def _set_of(polygons: Any) -> PolygonSet:
    """Give a set of polygons, made of anything else that holds them."""
    if isinstance(polygons, PolygonSet):
        return polygons
    return resolved("convert.polygons:as_polygons")(polygons)


def graph_for_skeletons(polygons: Any, *, strict: bool = False, **run: Unpack[Run]) -> PlanarGraph:
    """Make the planar graph that a skeleton is computed of; arguments, errors and warnings as of `planar_graph`."""
    given = with_flat_shells_as_lines(_set_of(polygons))
    check_magnitude(given.xy)
    return planar_graph(given, strict=strict, **run)


@frozen(eq=False)
class Placement:
    """Vertices of polygons on the lattice."""

    vertices: NDArray[np.int32]  # (n, 2) int32 array: lattice place (x, y) stands for `origin + scale * (x, y)`
    origin: tuple[float, float]  # (float, float): in input units
    exponent: int  # the scale is this power of two
    largest_move: float  # of a vertex, in input units


def placed_vertices(
    polygons: PolygonSet,
    *,
    around: NDArray[np.float64] | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> Placement:
    """Place the vertices of polygons on the lattice, which has room for further places; see `planar_graph`."""
    if around is None:
        return Placement(*_core.arrangement.place_on_lattice(polygons.xy, checked_threads(threads), progress))
    xy = np.concatenate([polygons.xy, around])
    made = Placement(*_core.arrangement.place_on_lattice(xy, checked_threads(threads), progress))
    return replace(made, vertices=made.vertices[: len(polygons.xy)])


@frozen(eq=False)
class Arrangement:
    """The planar graph of polygons, and what was repaired for it, before anybody is told."""

    graph: PlanarGraph  # of the polygons
    # of each kind of repair how often, and where first: an edge, and the vertex or edge that meets it, or -1
    found: dict[str, tuple[int, int, int]]
    is_repaired: NDArray[np.bool_]  # (p,) bool array: whether an edge of a polygon is named by any repair


def arranged(given: PolygonSet, placement: Placement, *, progress: Progress = None) -> Arrangement:
    """Make the planar graph of polygons whose vertices are placed, without a word about repairs."""
    rings = given.ring_starts, given.ring_kind, given.ring_polygon
    try:
        made = _core.arrangement.make_planar_graph(placement.vertices, *rings, progress)
    except _core.arrangement.TooManyCrossingsError:
        raise LimitError(f"the edges meet more than {MOST_VERTICES} times: simplify or split the polygons") from None
    except _core.arrangement.TooManyOverlapsError:
        raise LimitError(f"the polygons overlap or nest more than {MOST_OVERLAPS} times: split them") from None
    found = dict(zip(REPAIRS, made.pop("repairs"), strict=True))
    is_repaired, point_holes = made.pop("is_repaired") != 0, made.pop("point_holes").reshape(-1, 3)
    repairs = {name: count for name, (count, _, _) in found.items()}
    scale, move = math.ldexp(1.0, placement.exponent), placement.largest_move
    if repairs["moved_edges"]:  # within a cell, towards its center: at most half its diagonal
        move = math.nextafter(move + 0.7072 * scale, math.inf)
    graph = PlanarGraph(
        **made,
        origin=placement.origin,
        scale=scale,
        largest_move=move,
        repairs=repairs,
        polygons=given,
        vertices=placement.vertices,
        point_holes=point_holes,
    )
    return Arrangement(graph, found, is_repaired)


def graph_of_placement(
    given: PolygonSet, placement: Placement, *, strict: bool = False, progress: Progress = None
) -> PlanarGraph:
    """Make the planar graph of polygons whose vertices are placed; errors and warnings as of `planar_graph`."""
    made = arranged(given, placement, progress=progress)
    report_repairs(given, made.found, made.is_repaired, made.graph.scale, strict=strict)
    report_small(given, placement, strict=strict)
    return made.graph


def verify_planar_graph(graph: PlanarGraph, *, progress: Progress = None) -> None:
    """Check a planar graph exactly, from its arrays alone.

    Points different and on the lattice, segments between different points, no point inside a segment, no two segments
    with both ends in common or crossing; one face at each corner, and the unbounded one outside everything. With the
    input: the ends of each segment in cells that the edges meet of which it is said to be part; the polygons of its two
    faces differ by polygons of these edges only, and do differ unless it is of a line.

    Parameters
    ----------
    graph : PlanarGraph
        From any source.
    progress : callable, optional
        Called with the fraction done.

    Raises
    ------
    VerificationError
        If a check fails; the message names the first fault.

    Examples
    --------
    >>> from dataclasses import replace
    >>> graph = planar_graph([[0, 0], [4, 0], [4, 4], [0, 4]])
    >>> verify_planar_graph(graph)
    >>> verify_planar_graph(replace(graph, segments=[[0, 2], [1, 3], [2, 3], [3, 0]]))
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: segments 0 and 1 cross near (536870912, -536870912)
    """
    check_value(graph, "graph", "PlanarGraph")
    fault = _core.arrangement.find_fault(graph.points, graph.segments, graph.segment_faces, progress)
    fault = fault or _face_fault(graph) or (_source_fault(graph) if graph.polygons is not None else None)
    if fault is not None:
        raise VerificationError(fault)


def _face_fault(graph: PlanarGraph) -> str | None:
    start, polygon = graph.face_starts, graph.face_polygon
    if not divides(start, len(polygon)):
        return "face_starts does not divide face_polygon"
    faces = graph.segment_faces
    if faces.size and (faces.min() < 0 or faces.max() >= graph.faces):
        return "a segment names a face that does not exist"
    inner = np.ones(len(polygon), dtype=bool)
    inner[start[:-1][start[:-1] < len(polygon)]] = False
    if (np.diff(polygon, prepend=-1)[inner] <= 0).any():
        return "the polygons of a face are not ascending"
    if graph.faces and start[1] != 0:
        return "face 0, which is unbounded, lies in a polygon"
    if len(graph.segments) and _face_left_of_all(graph) != 0:
        return "the face left of all segments is not face 0"
    return None


def _face_left_of_all(graph: PlanarGraph) -> int:
    """Face left of the lexicographically smallest end: that left of the highest of the segments from there."""
    ends = graph.points[graph.segments.ravel()]
    first = graph.segments.ravel()[np.lexsort((ends[:, 1], ends[:, 0]))[0]]
    best: tuple[int, int] | None = None
    face = -1
    for segment, column in np.argwhere(graph.segments == first).tolist():
        x, y = (graph.points[graph.segments[segment, 1 - column]].astype(int) - graph.points[first]).tolist()
        if best is None or best[0] * y - best[1] * x > 0:
            best, face = (x, y), int(graph.segment_faces[segment, column])
    return face


def _source_fault(graph: PlanarGraph) -> str | None:
    """Check what the graph says of the input: each pair of a segment and an edge that it is said to be part of."""
    given, _ = given_shapes(graph)
    vertices, origin, exponent, _ = _core.arrangement.place_on_lattice(given.xy, 0, None)
    if (origin, math.ldexp(1.0, exponent)) != (tuple(graph.origin), graph.scale):
        return "this is not the lattice of the input"
    known = graph.point_vertex >= 0
    if (vertices[graph.point_vertex[known]] != graph.points[known]).any():
        return "a point is not where its vertex is"
    segment = owners(graph.source_count)
    edge = graph.source_edge.astype(np.int64)
    after = np.where(given.ends_line, np.arange(len(given.xy)), given.following)  # a line ends at its last vertex
    a, b = vertices[edge].astype(np.int64), vertices[after[edge]].astype(np.int64)
    d = b - a
    reach = np.abs(d).sum(axis=1) // 2 if graph.repairs["moved_edges"] else 0
    for column in (0, 1):
        c = graph.points[graph.segments[segment, column]].astype(np.int64) - a
        is_off = np.abs(crosses(d, c)) > reach
        is_off |= ((c < np.minimum(d, 0)) | (c > np.maximum(d, 0))).any(axis=1)
        if is_off.any():
            at = int(is_off.argmax())
            return f"segment {segment[at]} is not where edge {edge[at]} runs"
    return _side_fault(graph, given, segment, edge, flat_holes(given, vertices))


def _side_fault(
    graph: PlanarGraph, given: PolygonSet, segment: Any, edge: Any, is_flat_hole: NDArray[np.bool_]
) -> str | None:
    """Check that the polygons of the two sides of a segment differ by polygons whose edges it is part of."""
    count = max(len(given), 1)
    ring_of_edge = np.searchsorted(given.ring_starts, edge, side="right") - 1
    own = segment * count + given.ring_polygon[ring_of_edge]
    pairs, pair = np.unique(graph.segment_faces, axis=0, return_inverse=True)
    sides: list[Any] = []
    for face in pairs.T:
        length = np.diff(graph.face_starts)[face]
        sides.append(owners(length) * count + graph.face_polygon[ranges(graph.face_starts[face], length)])
    differing = np.setxor1d(*sides)  # pair of faces, and polygon
    first = np.searchsorted(differing, np.arange(len(pairs) + 1) * count)
    length = np.diff(first)[pair.ravel()]
    divided = owners(length)
    strange = ~np.isin(divided * count + differing[ranges(first[pair.ravel()], length)] % count, own)
    if strange.any():
        return f"segment {divided[strange][0]} divides a polygon, but is not one of its edges"
    is_border = length > 0
    is_thin = (given.ring_kind == LINE) | is_flat_hole
    is_border[segment[is_thin[ring_of_edge]]] = True
    if not is_border.all():
        return f"segment {is_border.argmin()} is dangling: it bounds no face"
    return None


Found = dict[str, tuple[int, int, int]]

TOUCHING = "touching_vertices"

SMALL = 1 << 10
"""Steps of the lattice: what is smaller has sizes and radii that are wrong by a part in a thousand, or more."""

NAMED = 10
"""Features that a warning names."""


def report_repairs(
    given: PolygonSet, found: Found, is_repaired: NDArray[np.bool_], step: float, *, strict: bool
) -> None:
    """Warn of repairs, if there are any; raise InputError instead if `strict`.

    A vertex on an edge alone is no repair: a hole of a valid polygon may touch its shell there.
    """
    repairs = {name: count for name, (count, _, _) in found.items()}
    if not any(count for name, count in repairs.items() if name != TOUCHING):
        return
    if strict:
        raise InputError(_first_repair(given, found))
    names = features_named(given, is_repaired)
    warn(_summary(repairs, step) + (f", in {names}" if names else ""), RepairWarning)


def report_small(given: PolygonSet, placement: Placement, *, strict: bool) -> None:
    """Warn of polygons and lines for which the lattice is coarse; raise InputError instead if `strict`."""
    step = math.ldexp(1.0, placement.exponent)
    if not placement.largest_move or not len(given):
        return
    small = _are_small(given, placement.origin, step)
    if not small.size:
        return
    is_small = mask_of(small, len(given)) & _are_moved(given, placement, step)
    count = int(np.count_nonzero(is_small))
    if not count:
        return
    what = "1 polygon or line is" if count == 1 else f"{count} polygons or lines are"
    message = (
        f"{what} smaller than {SMALL} steps of the lattice ({step:.3g}) to which all coordinates are rounded: "
        f"{features_named(given, is_small)}; remove features that are far away, or expect rough sizes and radii"
    )
    if strict:
        raise InputError(f"{message}; {STRICT} refuses this")
    warn(message, RepairWarning)


def _are_small(given: PolygonSet, origin: tuple[float, float], step: float) -> Indices:
    """Lines that are shorter and polygons that are narrower than `SMALL`, but not a single place."""
    shell = given.polygon_starts[:-1]
    first, sizes = given.ring_starts[shell], given.ring_starts[shell + 1] - given.ring_starts[shell]
    a, b, c = ((given.xy[first + sizes * third // 3] - origin) / step for third in range(3))
    chosen = np.flatnonzero(~_are_wide(a, b, c, given.is_line) & (sizes > 1))
    if not chosen.size:
        return chosen
    first, sizes, is_line = first[chosen], sizes[chosen], given.is_line[chosen]
    xy, own = (given.xy[ranges(first, sizes)] - origin) / step, owners(sizes)
    begin = starts_of(sizes)[:-1]
    sides = np.maximum.reduceat(xy, begin) - np.minimum.reduceat(xy, begin)
    width = np.where(is_line, sides.max(axis=1), sides.min(axis=1))
    way = np.roll(xy, -1, axis=0) - xy
    way[begin + sizes - 1] = xy[begin] - xy[begin + sizes - 1]
    length = norms(way)
    order = np.lexsort((length, own))[begin + sizes - 1]  # the longest edge of each
    across = way[order][:, ::-1] * (1, -1) / np.where(length[order] > 0, length[order], 1)[:, None]
    level = dots(xy - xy[begin][own], across[own])
    thin = np.maximum.reduceat(level, begin) - np.minimum.reduceat(level, begin)
    width = np.where(is_line, width, np.minimum(width, thin))
    width = np.where(width > 0, width, sides.max(axis=1))
    return chosen[(width > 0) & (width < SMALL)]


def _are_wide(a: Floats, b: Floats, c: Floats, is_line: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(p,) whether three vertices of each show that it is not small, by far: the heights of their triangle do.

    Twice its area is at most the least height times the longest side, which is below three times the largest difference
    of coordinates from the first vertex.
    """
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    longest = np.maximum(np.abs(b - a), np.abs(c - a)).max(axis=1)
    wide: NDArray[np.bool_] = np.abs(ux * vy - uy * vx) > 6 * SMALL * longest
    return wide | (is_line & (longest > 2 * SMALL))


def _are_moved(given: PolygonSet, placement: Placement, step: float) -> NDArray[np.bool_]:
    """(p,) whether the lattice has a vertex of each elsewhere than it was given."""
    moved = (np.asarray(placement.origin) + step * placement.vertices.astype(np.float64) != given.xy).any(axis=1)
    of_vertex = np.repeat(given.ring_polygon, np.diff(given.ring_starts))
    return np.bincount(of_vertex, moved, minlength=len(given)) > 0


def features_named(given: PolygonSet, chosen: NDArray[np.bool_]) -> str:
    """Name the features of some polygons, counted from 1: the first ten."""
    labels = distinct(given.labels[chosen]).tolist()
    if not labels:
        return ""
    more = f" and {len(labels) - NAMED} more" if len(labels) > NAMED else ""
    return f"feature{'s' * (len(labels) > 1)} {', '.join(map(str, labels[:NAMED]))}{more}"


_WORDS = {
    "repeated_vertices": ("repeated vertex dropped", "repeated vertices dropped"),
    TOUCHING: ("edge cut at a vertex on it", "edges cut at a vertex on them"),
    "crossings": ("crossing of edges cut", "crossings of edges cut"),
    "moved_edges": ("edge bent by less than {step:.2g}", "edges bent by less than {step:.2g}"),
    "idle_segments": ("dangling segment dropped", "dangling segments dropped"),
    "empty_polygons": ("polygon without area", "polygons without area"),
}


def _summary(repairs: dict[str, int], step: float) -> str:
    parts = [f"{count} {_WORDS[name][count != 1].format(step=step)}" for name, count in repairs.items() if count]
    return f"repaired: {', '.join(parts)}"


def _first_repair(polygons: PolygonSet, found: Found) -> str:
    """Name the place of the first repair along the input."""
    names = [name for name in REPAIRS if found[name][0] and name not in (TOUCHING, "moved_edges")]
    name = min(names, key=lambda each: (found[each][1], REPAIRS.index(each)))
    count, edge, other = found[name]
    ends = " to ".join(_position(polygons, vertex) for vertex in (edge, int(polygons.following[edge])))
    where = f"{_edge(polygons, edge)} from {ends}"
    what = {
        "repeated_vertices": f"{polygons.place(edge)} at {_position(polygons, edge)} is repeated by the next one",
        "crossings": f"{where} crosses {_edge(polygons, other)}",
        "idle_segments": f"{where} is dangling, or a part of it is: a spike or an overlap",
        "empty_polygons": f"{polygons.place(edge).split(',')[0]} at {_position(polygons, edge)} has no area",
    }[name]
    return f"{what} ({counted(count, 'such place')}): correct it, or leave out {STRICT}"


def _edge(polygons: PolygonSet, edge: int) -> str:
    return polygons.place(edge).replace("vertex", "edge")


def _position(polygons: PolygonSet, vertex: int) -> str:
    x, y = polygons.xy[vertex].tolist()
    return f"({x!r}, {y!r})"
