"""Gabriel graph, relative neighborhood graph and minimum spanning tree of points."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import pairwise
from math import pi, sqrt
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.delaunay.cells import voronoi_cells
from vorotool.engines.delaunay.delaunay import core_mesh, triangulated
from vorotool.errors import InputError, UsageError, VerificationError
from vorotool.numeric.arrays import dots, mask_of, norms
from vorotool.numeric.checks import checked_flag, checked_threads, is_choice
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import shown_number
from vorotool.numeric.parallel import Progress, Run, running
from vorotool.products.formats import resolved
from vorotool.types.arguments import check_value
from vorotool.types.images import LabelImage
from vorotool.types.mesh.cells import KINDS, CellSet, ProximityGraph
from vorotool.types.mesh.tables import CellStatistics
from vorotool.types.mesh.triangulation import Triangulation
from vorotool.types.table import Table

if TYPE_CHECKING:
    from vorotool.typing import FrameLike, MeshLike, PolygonsLike, ProximityKind

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


_COLUMNS = ("label", "x", "y", "area", "perimeter", "roundness", "neighbors", "nearest_distance", "whole")


def cell_statistics(
    points: MeshLike | LabelImage,
    *,
    frame: FrameLike | None = None,
    clip: PolygonsLike | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> CellStatistics:
    """Measure the Voronoi cells of points, or the regions of a label image, and summarize the whole ones.

    A cell is whole if nothing cuts it: its point is not on the hull, whose cells are unbounded, it does not touch the
    frame, and it lies inside the polygons of ``clip``. A region of a label image is whole if it does not touch the
    frame. Others have their measures, but do not count in the summary; empty cells and duplicates do not either.

    Parameters
    ----------
    points : LabelImage, Triangulation, PointSet, SeedSet, (n, 2) array, data frame, GeoSeries, …
        A triangulation is used as it is. Of a label image area and perimeter are those of `region_table`, in pixels and
        their sides.
    frame, clip : optional
        As for `voronoi_cells`; not for label images.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    CellStatistics
        ``cells``, a table with one row a point or region, and ``summary``, one with a row a measure. The area that the
        spanning tree is normalized by is that of the frame, the polygons or the image where there are any, else that
        of the convex hull; of a label image that of its regions.

    Raises
    ------
    InputError
        As for `voronoi_cells`.
    UsageError
        If there is a label image and a frame or polygons.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.3; Marcelpoil and Usson 1992; Dussert and
    others 1986.

    Examples
    --------
    >>> import vorotool
    >>> summary = cell_statistics(vorotool.read(vorotool.sample("dots.csv"))).summary
    >>> summary["measure"][3], summary["count"][3], round(summary["mean"][3], 2)
    ('neighbors', np.int64(32), np.float64(5.75))
    """
    run = running(threads, progress)
    if isinstance(points, LabelImage):
        if frame is not None or clip is not None:
            raise UsageError("frame and clip are for points: leave them out with a label image")
        return _of_image(points, run)
    mesh = points if isinstance(points, Triangulation) else triangulated(points, **run)
    cells = voronoi_cells(mesh, frame=frame, clip=clip, **run)
    has_region = frame is not None or clip is not None
    return statistics_of(mesh, cells, has_region=has_region, **run)


def statistics_of(mesh: Triangulation, cells: CellSet, *, has_region: bool, **run: Unpack[Run]) -> CellStatistics:
    """Measure cells that are there already."""
    table = site_table(mesh, cells, properties=False, **run)
    area = np.ma.filled(table["area"], 0.0)
    touches, on_hull = (np.ma.filled(table[name], True).astype(bool) for name in ("touches_frame", "on_hull"))
    whole = (area > 0) & ~touches & ~on_hull
    if cells.polygon_starts is not None:
        uncut = voronoi_cells(mesh, frame=cells.frame, **run)
        whole &= area >= uncut.areas
    tree = proximity_graph(mesh, "mst", **run)
    region = float(area.sum()) if has_region or mesh.frame is not None else float(mesh.areas.sum())
    return CellStatistics(_measured(table, whole), tree.edge_lengths(), region, mesh.properties)


def _of_image(image: LabelImage, run: Run) -> CellStatistics:
    measure = resolved("engines.label_images.regions:region_table")
    table: Table = measure(image, properties=False, **run)
    area = np.ma.filled(table["area"], 0)
    whole = (area > 0) & ~np.ma.filled(table["touches_frame"], True).astype(bool)
    sites = np.stack([table["x"], table["y"]], axis=1)
    sites = np.unique(sites, axis=0)  # objects may have one centroid
    tree = proximity_graph(sites, "mst", **run)
    properties = {} if image.seeds is None else image.seeds.properties
    return CellStatistics(_measured(table, whole), tree.edge_lengths(), float(area.sum()), properties)


def _measured(table: Table, whole: NDArray[np.bool_]) -> Table:
    area, perimeter = (np.ma.asanyarray(table[name]).astype(float) for name in ("area", "perimeter"))
    ratio = np.ma.masked_invalid(np.ma.divide(4 * pi * area, perimeter * perimeter))
    made: dict[str, Any] = {**table, "roundness": ratio, "whole": whole}
    return Table({name: made[name] for name in _COLUMNS})


def site_table(
    mesh: Triangulation,
    cells: CellSet | None = None,
    *,
    frame: FrameLike | None = None,
    properties: bool = True,
    threads: int = 0,
    progress: Progress = None,
) -> Table:
    """Tabulate the points of a triangulation: one row per point, in the order of the input.

    Parameters
    ----------
    mesh : Triangulation
        Of the points.
    cells : CellSet, optional
        Their cells, if they are there already.
    frame : Box or (x, y, width, height), optional
        What to clip the cells to otherwise; by default the image, or the bounds of the points, widened by a tenth.
    properties : bool
        Whether to add the input's own columns.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    Table
        ``label, x, y, area, perimeter, neighbors, nearest_label, nearest_distance, touches_frame, max_distance,
        on_hull, duplicate_of_label``. Area and perimeter are of the clipped cell, 0 of an empty one; `neighbors` are
        the points with an edge to this one in the triangulation; ``nearest_label`` is the nearest point at another
        place, by exact comparison, ties to the smallest label; ``max_distance`` is that of the farthest place of the
        cell. ``touches_frame`` and ``max_distance`` do not exist for empty cells. A point that lies on an earlier one,
        ``duplicate_of_label``, has nothing else but its label and place; of the others only this does not exist.

    Raises
    ------
    InputError
        If the cells are not those of the points, or the frame has no area.

    Examples
    --------
    >>> from vorotool import delaunay
    >>> table = site_table(delaunay([[1, 1], [3, 1]]), frame=(0, 0, 4, 2))
    >>> table["area"].tolist(), table["nearest_label"].tolist(), table["max_distance"].tolist() == [2**0.5] * 2
    ([4.0, 4.0], [2, 1], True)
    """
    check_value(mesh, "mesh", "Triangulation")
    if cells is None:
        cells = voronoi_cells(mesh, frame=frame, threads=threads, progress=progress)
    check_value(cells, "cells", "CellSet")
    if not np.array_equal(cells.sites, mesh.points):
        raise InputError("the cells belong to other points: give cells computed from this triangulation")
    threads = checked_threads(threads)
    labels = np.ascontiguousarray(mesh.label_array, dtype=np.int64)
    nearest, neighbors = _core.delaunay.nearest_neighbors(mesh.points, mesh.edges, labels, progress)
    repeated = mesh.first != np.arange(len(mesh.first))
    alone = nearest < 0
    with np.errstate(over="ignore"):  # beyond the largest double: infinite
        step = mesh.points - mesh.points[nearest]
        distance = hypotenuse(step[:, 0], step[:, 1])
    on_hull = mask_of(mesh.hull, len(mesh.points))
    rings, polygons, of_cells = cells.nesting
    area, perimeter, reach, touches = _core.cells.measure_cells(
        cells.sites, cells.coordinates, rings, polygons[of_cells], cells.frame.sides, threads, progress
    )
    columns: dict[str, Any] = {
        "label": labels,
        "x": np.ascontiguousarray(mesh.points[:, 0]),
        "y": np.ascontiguousarray(mesh.points[:, 1]),
        "area": np.ma.array(area, mask=repeated),
        "perimeter": np.ma.array(perimeter, mask=repeated),
        "neighbors": np.ma.array(neighbors, mask=repeated),
        "nearest_label": np.ma.array(labels[nearest] if len(labels) else labels, mask=alone),
        "nearest_distance": np.ma.array(distance, mask=alone),
        "touches_frame": np.ma.array(touches, mask=cells.is_empty),
        "max_distance": np.ma.array(reach, mask=cells.is_empty),
        "on_hull": np.ma.array(on_hull, mask=repeated),
        "duplicate_of_label": np.ma.array(labels[mesh.first], mask=~repeated),
    }
    table = Table(columns)
    return table.with_properties(mesh.properties) if checked_flag(properties, "properties") else table
