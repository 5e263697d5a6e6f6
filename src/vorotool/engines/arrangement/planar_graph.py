"""Polygons and lines made a planar straight-line graph: the input of the skeleton engines."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.polygons import as_polygons
from vorotool.engines.arrangement.repaired_polygons import flat_holes, with_flat_shells_as_lines
from vorotool.engines.arrangement.reports import report_repairs, report_small
from vorotool.errors import LimitError, VerificationError
from vorotool.numeric.arrays import divides, owners, ranges
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.parallel import Progress
from vorotool.plain import plain
from vorotool.types.arguments import check_value
from vorotool.types.box import check_magnitude
from vorotool.types.polygons.planar_graph import REPAIRS, PlanarGraph
from vorotool.types.polygons.polygon_set import LINE, PolygonSet

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
    given = as_polygons(polygons)
    if len(given.xy) > MOST_VERTICES:
        raise LimitError(f"the input has {len(given.xy)} vertices, more than {MOST_VERTICES}: split the polygons")
    placement = placed_vertices(given, threads=threads, progress=progress)
    return graph_of_placement(given, placement, strict=strict, progress=progress)


def graph_for_skeletons(
    polygons: Any, *, strict: bool = False, threads: int = 0, progress: Progress = None
) -> PlanarGraph:
    """Make the planar graph that a skeleton is computed of; arguments, errors and warnings as of `planar_graph`."""
    given = with_flat_shells_as_lines(as_polygons(polygons))
    check_magnitude(given.xy)
    return planar_graph(given, strict=strict, threads=threads, progress=progress)


@plain(eq=False)
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


@plain(eq=False)
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
    given = graph.polygons
    assert given is not None
    vertices, origin, exponent, _ = _core.arrangement.place_on_lattice(given.xy, 0, None)
    if (origin, math.ldexp(1.0, exponent)) != (tuple(graph.origin), graph.scale):
        return "this is not the lattice of the input"
    known = graph.point_vertex >= 0
    if (vertices[graph.point_vertex[known]] != graph.points[known]).any():
        return "a point is not where its vertex is"
    segment = owners(graph.source_count)
    edge = graph.source_edge.astype(np.int64)
    a, b = vertices[edge].astype(np.int64), vertices[_next_vertices(given)[edge]].astype(np.int64)
    d = b - a
    reach = np.abs(d).sum(axis=1) // 2 if graph.repairs["moved_edges"] else 0
    for column in (0, 1):
        c = graph.points[graph.segments[segment, column]].astype(np.int64) - a
        is_off = np.abs(d[:, 0] * c[:, 1] - d[:, 1] * c[:, 0]) > reach
        is_off |= ((c < np.minimum(d, 0)) | (c > np.maximum(d, 0))).any(axis=1)
        if is_off.any():
            at = int(is_off.argmax())
            return f"segment {segment[at]} is not where edge {edge[at]} runs"
    return _side_fault(graph, given, segment, edge, flat_holes(given, vertices))


def _next_vertices(polygons: PolygonSet) -> Any:
    """The vertex after each one around its ring; a line ends at its last one."""
    last = (polygons.ring_starts[1:] - 1)[polygons.ring_kind == LINE]
    after = polygons.following.copy()
    after[last] = last
    return after


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
