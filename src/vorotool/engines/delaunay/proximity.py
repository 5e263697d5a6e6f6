"""Gabriel graph, relative neighborhood graph and minimum spanning tree of points."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import pairwise
from math import sqrt
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.delaunay.delaunay import core_mesh, triangulated
from vorotool.errors import InputError, UsageError, VerificationError
from vorotool.numeric.arrays import dots, mask_of, norms
from vorotool.numeric.checks import checked_threads, is_choice
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import shown_number
from vorotool.numeric.parallel import Progress
from vorotool.types.arguments import check_value
from vorotool.types.mesh.cells import KINDS, ProximityGraph
from vorotool.types.mesh.triangulation import Triangulation

if TYPE_CHECKING:
    from vorotool.typing import MeshLike, ProximityKind

_CORE_KINDS = dict(zip(KINDS, ("gabriel", "relative", "spanning_tree"), strict=True))


def proximity_graph(
    points: MeshLike,
    kind: ProximityKind = "gabriel",
    *,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> ProximityGraph:
    """Compute a proximity graph of points, a subgraph of their Delaunay triangulation.

    Every decision is exact, and the graph is one of the points alone: which diagonals the triangulation has in
    cocircular polygons changes nothing.

    Parameters
    ----------
    points : Triangulation, PointSet, SeedSet, (n, 2) array, data frame, GeoSeries, …
        A triangulation is used as it is. A point that lies on an earlier one has no edge.
    kind : {"gabriel", "relative", "mst"}
        The Gabriel graph joins two points if no other is inside or on the circle with the edge as diameter. The
        relative neighborhood graph joins them if no other is nearer to both than they are to each other. The minimum
        spanning tree joins all points by edges of the least total length; of equal lengths the edge that comes first
        in the triangulation is taken first. Each is part of the one before.
    strict : bool
        Refuse duplicate points.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    ProximityGraph
        Its edges, in the order of the triangulation.

    Raises
    ------
    InputError
        If a coordinate is not finite, the triangulation is none, or `strict` and a point lies on another.
    UsageError
        If the kind is unknown.

    References
    ----------
    Gabriel and Sokal 1969; Toussaint 1980; Kruskal 1956.

    Examples
    --------
    The corner of a square is on the circle over its diagonal:

    >>> square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    >>> [len(proximity_graph(square, kind)) for kind in ("gabriel", "relative", "mst")]
    [4, 4, 3]
    """
    if not is_choice(kind, KINDS):
        raise UsageError(f"kind is {shown_number(kind)}: use {', '.join(KINDS[:-1])} or {KINDS[-1]}")
    threads = checked_threads(threads)
    if isinstance(points, Triangulation):
        mesh = points
    else:
        mesh = triangulated(points, strict=strict, threads=threads, progress=progress)
    rule = _core.proximity.ProximityKind[_CORE_KINDS[kind]]
    try:
        index = _core.proximity.proximity_edges(core_mesh(mesh), rule, threads, progress)
    except ValueError as error:
        raise InputError(f"{error}: give a Delaunay triangulation, such as delaunay() returns") from None
    return ProximityGraph(mesh, kind, index)


_NEAR, _NEARER = 1 + 2.0**-30, 2.0**-50
"""What distances are taken larger by, so that rounding leaves out no point: a factor for their own, and of coordinates
up to 1 what middles are off by."""
_CHUNK = 1 << 16
_LEAST = 2.0**-900
"""Below this, products of floating-point numbers tell nothing."""

Places = NDArray[np.float64]
Ends = NDArray[np.int32]
Test = Callable[[Places, Ends, NDArray[np.intp]], NDArray[np.bool_]]


def verify_proximity_graph(graph: ProximityGraph) -> None:
    """Check that a graph has exactly the edges of its triangulation that its rule requires.

    The triangulation itself is taken as it is: `verify_triangulation` checks that.

    Parameters
    ----------
    graph : ProximityGraph
        From any source.

    Raises
    ------
    VerificationError
        If an edge is wrong; the message names the first.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from vorotool import proximity_graph
    >>> graph = proximity_graph([[0, 0], [4, 0], [0, 3], [1, 1]], "gabriel")
    >>> verify_proximity_graph(graph)
    >>> verify_proximity_graph(replace(graph, edge_index=graph.edge_index[1:]))
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: the edge from point 1 to point 4 is missing in the Gabriel graph
    """
    check_value(graph, "graph", "ProximityGraph")
    names = dict(zip(KINDS, ("Gabriel graph", "graph of relative neighbors", "minimum spanning tree"), strict=True))
    count, index = len(graph.mesh.edges), graph.edge_index
    if graph.kind not in names:
        raise VerificationError(f"the kind {shown_number(graph.kind)} is not one of {', '.join(KINDS)}")
    if len(index) and not (index[0] >= 0 and index[-1] < count and (np.diff(index) > 0).all()):
        raise VerificationError("the indices of edges are not increasing, or out of range")
    kept = mask_of(index, count)
    wrong = np.flatnonzero(kept != (_tree(graph) if graph.kind == "mst" else _by_rule(graph)))
    if len(wrong):
        a, b = (graph.mesh.edges[wrong[0]] + 1).tolist()
        what = "does not belong to" if kept[wrong[0]] else "is missing in"
        raise VerificationError(f"the edge from point {a} to point {b} {what} the {names[graph.kind]}")


# ---- empty discs and lunes ---------------------------------------------------------------------------------


def _by_rule(graph: ProximityGraph) -> NDArray[np.bool_]:
    """Which edges of the triangulation have nothing in their disc or lune."""
    mesh, is_relative = graph.mesh, graph.kind == "relative"
    exponent = int(np.frexp(np.abs(mesh.points).max(initial=0.0))[1])
    scaled = np.ldexp(mesh.points, -exponent)
    own = np.unique(mesh.edges)
    tree = shapely.STRtree(shapely.points(scaled[own]))
    holds, reach = (_lune_holds, sqrt(0.75)) if is_relative else (_disc_holds, 0.5)
    kept = np.ones(len(mesh.edges), dtype=bool)
    for start in range(0, len(kept), _CHUNK):
        rows = np.arange(start, min(start + _CHUNK, len(kept)))
        a, b = (scaled[mesh.edges[rows, side]] for side in (0, 1))
        middle, length = a / 2 + b / 2, norms(b - a)
        nearest = own[tree.nearest(shapely.points(middle))]
        kept[rows[_held(mesh.points, mesh.edges[rows], nearest, holds)]] = False
        open_rows = kept[rows]  # nearly all of these have empty discs: few points are near
        which, point = tree.query(
            shapely.points(middle[open_rows]), predicate="dwithin", distance=length[open_rows] * reach * _NEAR + _NEARER
        )
        which = rows[open_rows][which]
        kept[which[_held(mesh.points, mesh.edges[which], own[point], holds)]] = False
    return kept


def _held(points: Places, edges: Ends, numbers: NDArray[Any], holds: Test) -> NDArray[np.bool_]:
    """Whether points that are no ends of their edges are inside what belongs to these."""
    found: NDArray[np.bool_] = (numbers != edges[:, 0]) & (numbers != edges[:, 1])
    found[found] = holds(points, edges[found], numbers[found])
    return found


def _disc_holds(points: Places, edges: Ends, numbers: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Whether a point is in the closed disc over an edge: whether the dot product of the ways to its ends is ≤ 0."""

    def exactly(a: list[Fraction], b: list[Fraction], p: list[Fraction]) -> bool:
        return (a[0] - p[0]) * (b[0] - p[0]) + (a[1] - p[1]) * (b[1] - p[1]) <= 0

    a, b, p = points[edges[:, 0]], points[edges[:, 1]], points[numbers]
    with np.errstate(all="ignore"):
        terms = (a - p) * (b - p)
        return _decided(terms.sum(axis=1), np.abs(terms).sum(axis=1), exactly, (a, b, p))


def _lune_holds(points: Places, edges: Ends, numbers: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Whether a point is nearer to both ends of an edge than these are to each other."""

    def exactly(a: list[Fraction], b: list[Fraction], p: list[Fraction]) -> bool:
        return _square(a, p) < _square(a, b) and _square(b, p) < _square(a, b)

    a, b, p = points[edges[:, 0]], points[edges[:, 1]], points[numbers]
    with np.errstate(all="ignore"):
        side, one, other = (dots(u - v, u - v) for u, v in ((a, b), (a, p), (b, p)))
        most = np.maximum(one, other)
        return _decided(most - side, most + side, exactly, (a, b, p))


def _decided(
    value: NDArray[np.float64], size: NDArray[np.float64], exactly: Callable[..., bool], places: tuple[Places, ...]
) -> NDArray[np.bool_]:
    """Whether values are negative, or what is true where the error of a sum of such size leaves a doubt."""
    found = value < 0
    for row in np.flatnonzero(~(np.abs(value) > 2.0**-48 * size + _LEAST)).tolist():
        found[row] = exactly(*([Fraction(x) for x in each[row].tolist()] for each in places))
    return found


def _square(a: list[Fraction], b: list[Fraction]) -> Fraction:
    x, y = a[0] - b[0], a[1] - b[1]
    return x * x + y * y


# ---- the tree ----------------------------------------------------------------------------------------------


def _tree(graph: ProximityGraph) -> NDArray[np.bool_]:
    """Kruskal's algorithm on all edges of the triangulation, in the order of their exact lengths."""
    edges, parent = graph.mesh.edges, list(range(len(graph.points)))
    kept = np.zeros(len(edges), dtype=bool)
    ends = edges.tolist()
    for number in _by_length(graph):
        a, b = ends[number]
        while parent[a] != a:
            parent[a] = a = parent[parent[a]]
        while parent[b] != b:
            parent[b] = b = parent[parent[b]]
        if a != b:
            parent[max(a, b)] = min(a, b)
            kept[number] = True
    return kept


def _by_length(graph: ProximityGraph) -> list[int]:
    """Edges by length, equal ones by place; where rounded lengths are too near to tell, by rational numbers."""
    points, edges = graph.points, graph.mesh.edges
    lengths = graph.mesh.edge_lengths()
    order = np.argsort(lengths, kind="stable")
    ordered = lengths[order]
    with np.errstate(invalid="ignore"):
        apart = np.diff(ordered) > 2.0**-48 * ordered[1:]
    starts = [0, *(np.flatnonzero(apart) + 1).tolist(), len(order)]
    for start, end in pairwise(starts):
        if end - start > 1:
            run = np.sort(order[start:end]).tolist()
            order[start:end] = sorted(run, key=lambda e: _square(*([*map(Fraction, points[v])] for v in edges[e])))
    return order.tolist()
