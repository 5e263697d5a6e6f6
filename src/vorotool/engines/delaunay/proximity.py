"""Gabriel graph, relative neighborhood graph and minimum spanning tree of points."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vorotool import _core
from vorotool.engines.delaunay.delaunay import core_mesh, triangulated
from vorotool.errors import InputError, UsageError
from vorotool.numeric.checks import checked_threads, is_choice
from vorotool.numeric.parallel import Progress
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
        raise UsageError(f"kind is {kind!r}: use {', '.join(KINDS[:-1])} or {KINDS[-1]}")
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
