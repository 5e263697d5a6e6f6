"""Tables of a skeleton: its arcs, its branches, one row a polygon; and its graph."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import connected_roots, crosses, mask_of, norms
from vorotool.numeric.checks import described, is_choice
from vorotool.numeric.curves.flatten import chained
from vorotool.numeric.numbers import distinct, shown_number
from vorotool.numeric.parallel import in_chunks
from vorotool.types.arguments import check_value
from vorotool.types.features import Lines, Rows, of_polygons
from vorotool.types.identity import names_of, part_table
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.polygons.shapely_geometry import to_shapely
from vorotool.types.skeleton.segment_voronoi import EDGE
from vorotool.types.skeleton.skeleton import INTERIOR, KINDS, Skeleton
from vorotool.types.table import Lookup, Table

BRANCH_TYPES = ("end-end", "junction-end", "junction-junction", "cycle")
"""As skan has them, by their numbers there."""

BRANCH_COLUMNS = (
    *("branch", "kind", "length", "chord", "r_min", "r_max", "r_mean"),
    *("type", "tortuosity"),
)


def arc_table(skeleton: Skeleton) -> Table:
    """Tabulate the arcs: feature, ends with radii, control point of a parabola, sites, length.

    Parameters
    ----------
    skeleton : Skeleton
        Rows are in the order of its arcs. Arcs and branches are counted from 0, labels from 1.

    Returns
    -------
    Table
        ``label, id, arc, source_index, target_index, x0, y0, r0, x1, y1, r1, kind, cx, cy, site_a_index,
        site_b_index, side, length, error_bound, branch``. Site a is left of the arc. Outside there is no label, on a
        straight line no control point.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> arc_table(skeleton_exact([[0, 0], [4, 0], [0, 3]]))["r1"].tolist()
    [1.0, 1.0, 1.0]
    """
    check_value(skeleton, "skeleton", "Skeleton")
    source, target = np.ascontiguousarray(skeleton.arcs.T)
    x, y = np.ascontiguousarray(skeleton.as_given.vertices.T)
    cx, cy = np.ascontiguousarray(skeleton.control.T)
    site_a, site_b = np.ascontiguousarray(skeleton.sites.T)
    return part_table(
        {
            **names_of(skeleton.polygons, skeleton.polygon),
            "arc": np.arange(len(skeleton)),
            "source_index": source,
            "target_index": target,
            "x0": Lookup(x, source),
            "y0": Lookup(y, source),
            "r0": Lookup(skeleton.radius, source),
            "x1": Lookup(x, target),
            "y1": Lookup(y, target),
            "r1": Lookup(skeleton.radius, target),
            "kind": Lookup(list(KINDS), skeleton.is_parabola.astype(np.int32)),
            "cx": cx,
            "cy": cy,
            "site_a_index": site_a,
            "site_b_index": site_b,
            "side": skeleton.side_names(),
            "length": skeleton.length,
            "error_bound": skeleton.error_bound,
            "branch": skeleton.branch,
        },
        skeleton.polygons,
        skeleton.polygon,
    )


def skeleton_rows(skeleton: Skeleton, what: str | None) -> Rows:
    """Return the rows of a part, by default of the arcs."""
    makers: dict[str | None, Callable[[Skeleton], Table]] = {
        "elements": element_table,
        "branches": branch_table,
        "table": polygon_table,
    }
    if what in makers:
        return Rows(makers[what](skeleton))
    return Rows(arc_table(skeleton), source=skeleton.polygons, item=skeleton.polygon)


def element_table(skeleton: Skeleton) -> Table:
    """Tabulate the sites: vertices and edges, as the paper decomposes shapes (Figure 10).

    Parameters
    ----------
    skeleton : Skeleton
        Rows are in the order of its sites. With a gap, edges are as they were shortened.

    Returns
    -------
    Table
        ``element, kind, label, id, ring, vertex_index, x0, y0, x1, y1, label_a, label_b``: a vertex has no second
        place. The labels are the paper's, numbers of edges from 1: an edge has its own, a vertex those of its edges
        (the first two of more), and bisectors between elements with a label in common are deleted.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> table = element_table(skeleton_exact([[0, 0], [4, 0], [0, 3]]))
    >>> table["label_a"].tolist(), table["label_b"].tolist()
    ([1, 1, 2, 1, 2, 3], [3, 2, 3, None, None, None])
    """
    check_value(skeleton, "skeleton", "Skeleton")
    sites = skeleton.site_table
    is_edge = sites.kind == EDGE
    ends = skeleton.as_given.site_ends
    labels = site_labels(skeleton)
    return part_table(
        {
            "element": np.arange(len(sites)),
            "kind": Lookup(["vertex", "edge"], sites.kind.astype(np.int32)),
            **names_of(skeleton.polygons, sites.polygon),
            "ring": sites.ring,
            "vertex_index": sites.index,
            "x0": ends[:, 0, 0],
            "y0": ends[:, 0, 1],
            "x1": np.ma.array(ends[:, 1, 0], mask=~is_edge),
            "y1": np.ma.array(ends[:, 1, 1], mask=~is_edge),
            "label_a": np.ma.array(labels[:, 0], mask=labels[:, 0] == 0),
            "label_b": np.ma.array(labels[:, 1], mask=labels[:, 1] == 0),
        },
        skeleton.polygons,
        sites.polygon,
    )


def site_labels(skeleton: Skeleton) -> NDArray[np.int64]:
    """(s, 2) the first two labels of each site, numbers of edges from 1; 0 for none."""
    is_edge = skeleton.site_table.kind == EDGE
    points, edges = np.flatnonzero(~is_edge), np.flatnonzero(is_edge)
    labels = np.zeros((len(is_edge), 2), dtype=np.int64)
    labels[edges, 0] = np.arange(1, len(edges) + 1)
    ends = replace(skeleton, gap=0.0).site_ends
    places = np.concatenate([ends[points, 0], ends[edges].reshape(-1, 2)])
    _, place = np.unique(places, axis=0, return_inverse=True)
    place = place.reshape(-1)
    owner = np.zeros(int(place.max(initial=-1)) + 1, dtype=np.int64)
    owner[place[: len(points)]] = points
    at = owner[place[len(points) :]]
    label = np.repeat(np.arange(1, len(edges) + 1), 2)
    order = np.argsort(at, kind="stable")
    at, label = at[order], label[order]
    nth = np.arange(len(at)) - np.searchsorted(at, at)
    labels[at[nth < 2], nth[nth < 2]] = label[nth < 2]
    return labels


def branch_table(skeleton: Skeleton, *, threads: int = 0) -> Table:
    """Tabulate the branches, chains of arcs between nodes with one arc or more than two.

    Parameters
    ----------
    skeleton : Skeleton
        Rows are in the order of its branches.
    threads : int
        Number of threads; 0 uses all.

    Returns
    -------
    Table
        ``label, id, branch, kind, length, chord, r_min, r_max, r_mean, type, tortuosity``. The kind is ``end`` (it
        has an end of its own), ``inner`` (it joins junctions), ``closed`` or ``frame`` (it leads from a junction, or
        the frame, to the frame). The chord is the distance between the ends of the branch. The mean of the radius is
        over the length. The type is that of skan: ``end-end``, ``junction-end``, ``junction-junction`` (also of a loop
        at a junction) or ``cycle`` (a closed branch without junctions). The tortuosity is the length over the chord;
        there is none where the branch ends where it begins.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> table = branch_table(skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]]))
    >>> table["kind"].tolist().count("inner"), table["type"].tolist().count("junction-end")
    (1, 4)
    """
    check_value(skeleton, "skeleton", "Skeleton")
    polygon = skeleton.polygon[skeleton.branch_starts]
    columns = {**names_of(skeleton.polygons, polygon), **branch_columns(skeleton, threads=threads)}
    return part_table(columns, skeleton.polygons, polygon)


def branch_columns(skeleton: Skeleton, *, threads: int = 0) -> dict[str, Any]:
    """Return the columns of the table of branches without those that name polygons."""
    start = skeleton.branch_starts
    if not len(start):
        empty: NDArray[Any] = np.empty(0)
        return dict.fromkeys(BRANCH_COLUMNS, empty)
    a, b = both = skeleton.branch_ends
    least, most, integral = skeleton.arc_radii_on(threads)
    length = np.add.reduceat(skeleton.length, start)
    integral = np.add.reduceat(integral, start)
    mean = np.divide(integral, length, out=skeleton.radius[a].copy(), where=length > 0)
    framed = skeleton.on_frame[both]
    has_end = ((skeleton.degree[both] == 1) & ~framed).any(axis=0)
    kind = np.select([a == b, has_end, framed.any(axis=0)], [2, 0, 3], 1).astype(np.int32)
    chord = norms(skeleton.vertices[b] - skeleton.vertices[a])
    tortuosity = np.maximum(np.divide(length, chord, out=np.ones(len(chord)), where=chord > 0), 1.0)
    return {
        "branch": skeleton.branch[start],
        "kind": Lookup(["end", "inner", "closed", "frame"], kind),
        "length": length,
        "chord": chord,
        "r_min": np.minimum.reduceat(least, start),
        "r_max": np.maximum.reduceat(most, start),
        "r_mean": mean,
        "type": Lookup(list(BRANCH_TYPES), _branch_types(skeleton, both)),
        "tortuosity": np.ma.array(tortuosity, mask=chord == 0),
    }


def _branch_types(skeleton: Skeleton, ends: NDArray[np.int32]) -> NDArray[np.int32]:
    """(b,) how many ends of each branch are junctions, or the number of ``cycle``."""
    is_junction = skeleton.degree[ends] > 2
    is_cycle = (ends[0] == ends[1]) & ~is_junction[0]
    return np.where(is_cycle, 3, is_junction.sum(axis=0)).astype(np.int32)


def polygon_table(skeleton: Skeleton, *, columns: Mapping[str, Any] | None = None, threads: int = 0) -> Table:
    """Tabulate the polygons, with the measures of their interior skeletons.

    Parameters
    ----------
    skeleton : Skeleton
        Its polygons' properties are the last columns.
    columns : mapping of str to array, optional
        Columns before these, one value a polygon, such as lengths and mean widths of centerlines.
    threads : int
        Number of threads; 0 uses all.

    Returns
    -------
    Table
        ``label, id, area, perimeter, holes, length, branches, ends, junctions, cycles, width_max, width_mean``: of
        the polygons as they were used; width is twice the radius, its mean over the length of the skeleton. Open lines
        have no area and no width.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> table = polygon_table(skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]]))
    >>> [table[name].tolist() for name in ("area", "ends", "junctions", "cycles", "width_max")]
    [[8.0], [4], [2], [0], [2.0]]
    """
    check_value(skeleton, "skeleton", "Skeleton")
    further = _mapping(columns)
    polygons, count = skeleton.polygons, len(skeleton.polygons)
    is_inside = skeleton.side == INTERIOR
    inside: Any = slice(None) if is_inside.all() else np.flatnonzero(is_inside)
    of_arc = skeleton.polygon[inside]
    node_polygon = np.full(len(skeleton.vertices), -1)
    for ends in skeleton.arcs[inside].T:
        node_polygon[ends] = of_arc
    own = node_polygon >= 0

    def counted(nodes: NDArray[np.bool_]) -> NDArray[np.int64]:
        return np.bincount(node_polygon[own & nodes], minlength=count)

    arcs = np.bincount(of_arc, minlength=count)
    length = np.bincount(of_arc, skeleton.length[inside], count)
    _, most, integral = skeleton.arc_radii_on(threads)
    widest = np.zeros(count)
    np.maximum.at(widest, of_arc, 2 * most[inside])
    integrals = np.bincount(of_arc, integral[inside], count)
    mean = np.divide(2 * integrals, length, out=widest.copy(), where=length > 0)  # a single place has one width
    starts = skeleton.branch_starts
    cycles = arcs - counted(own) + _components(skeleton, starts, node_polygon, count)
    area, perimeter = _measures(polygons.as_given, threads)
    empty = arcs == 0
    table = Table(
        {
            **names_of(polygons, np.arange(count)),
            "area": np.ma.array(area, mask=polygons.is_line),
            "perimeter": perimeter,
            "holes": np.where(polygons.is_line, 0, np.diff(polygons.polygon_starts) - 1),
            "length": length,
            "branches": np.bincount(skeleton.polygon[starts[skeleton.side[starts] == INTERIOR]], minlength=count),
            "ends": counted(skeleton.degree == 1),
            "junctions": counted(skeleton.degree > 2),
            "cycles": cycles,
            "width_max": np.ma.array(widest, mask=empty),
            "width_mean": np.ma.array(mean, mask=empty),
            **further,
        }
    )
    return table.with_properties(polygons.other_columns)


def _mapping(columns: Any) -> dict[str, Any]:
    """Return further columns by their names."""
    if columns is None:
        return {}
    if not isinstance(columns, Mapping | Table) or not all(isinstance(name, str) for name in columns):
        raise InputError(f"invalid columns: expected a mapping from names to values, but got {described(columns)}")
    return {name: columns[name] for name in columns}


def _components(
    skeleton: Skeleton, starts: NDArray[np.int64], node_polygon: NDArray[np.int64], count: int
) -> NDArray[np.int64]:
    """Connected components of the skeleton in each polygon: of its branches, each counted at its first node."""
    inner = skeleton.side[starts] == INTERIOR
    ends = skeleton.branch_ends[:, inner]
    is_end = mask_of(ends, len(skeleton.vertices))
    number = np.cumsum(is_end) - 1
    nodes = np.flatnonzero(is_end)
    root = connected_roots(number[ends].T, len(nodes))
    np.minimum.at(nodes, root[number[ends[0]]], np.minimum.reduceat(skeleton.arcs.reshape(-1), 2 * starts)[inner])
    return np.bincount(node_polygon[nodes[root == np.arange(len(root))]], minlength=count)


def _measures(polygons: PolygonSet, threads: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Areas and perimeters; an area by the even-odd rule."""
    count = len(polygons)
    if not count:
        return np.zeros(0), np.zeros(0)
    first = polygons.ring_starts[:-1]
    length, products = np.empty((2, len(polygons.xy)))

    def fill(part: slice) -> None:
        length[part], products[part] = _edge_measures(polygons, part)

    in_chunks(len(length), fill, threads=threads)
    length[polygons.ends_line] = 0
    perimeter = np.add.reduceat(np.add.reduceat(length, first), polygons.polygon_starts[:-1])
    twice = np.abs(np.add.reduceat(products, first))
    twice = np.where(polygons.ring_kind == 1, -twice, twice)
    area = np.add.reduceat(twice, polygons.polygon_starts[:-1]) / 2
    area[polygons.is_line] = 0
    # crack outlines touch themselves, but never cross
    return area if polygons.connectivity is not None else _with_valid_areas(polygons, area), perimeter


def _edge_measures(polygons: PolygonSet, part: slice) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Of the edges from some vertices on: lengths, and twice the areas of triangles with the first vertex of a ring."""
    xy, start = polygons.xy, polygons.ring_starts
    here = xy[part]
    begin, end = part.start, part.start + len(here)
    rings = slice(np.searchsorted(start, begin, side="right") - 1, np.searchsorted(start, end))
    inner = start[rings.start : rings.stop + 1].clip(begin, end)
    first = xy[start[rings]]
    following = np.concatenate([here[1:], xy[end : end + 1] if end < len(xy) else first[-1:]])
    closing = inner[1:] - 1 - begin
    closing = closing if start[rings.stop] <= end else closing[:-1]
    following[closing] = first[: len(closing)]
    way = following - here
    first = np.repeat(first, np.diff(inner), axis=0)
    a, b = here - first, following - first
    return norms(way), crosses(a, b)


def _with_valid_areas(polygons: PolygonSet, area: NDArray[np.float64]) -> NDArray[np.float64]:
    """Measure again what touches or crosses itself."""
    import shapely

    shapes = to_shapely(polygons)
    for index in np.flatnonzero(~shapely.is_valid(shapes) & ~polygons.is_line):
        area[index] = shapely.make_valid(shapes[index]).area
    return area


BY = ("branch", "arc")


@frozen(eq=False)
class SkeletonGraph:
    """Nodes and edges of a skeleton; several edges may join the same nodes, and one may join a node with itself."""

    skeleton: Skeleton
    nodes: NDArray[np.int64]  # (n,) int64 array: its vertices that are nodes, ascending
    source: NDArray[np.int64]  # (e,) int64 array: the vertices at the ends of each edge
    target: NDArray[np.int64]  # (e,) int64 array: the vertices at the ends of each edge
    polygon: NDArray[np.int32]  # (e,) int32 array: the polygon of each edge; -1 outside
    # `branch` or `arc`, `side`, `kind`, `length`, `r_min`, `r_max`, `r_mean`; of branches `type` and `tortuosity`, too
    columns: dict[str, Any]
    # (k, 2) float64 array: places along the edges, from source to target, the ends included
    points: NDArray[np.float64]
    start: NDArray[np.int64]  # (e + 1,) int64 array: where those of each edge begin

    @property
    def edges(self) -> Table:
        """The columns, with those that name polygons and those that are wanted of these."""
        polygons = self.skeleton.polygons
        return part_table({**names_of(polygons, self.polygon), **self.columns}, polygons, self.polygon)


def skeleton_graph(skeleton: Skeleton, *, by: str = "branch", flatten: float | None = None) -> SkeletonGraph:
    """Return the graph of a skeleton."""
    if not is_choice(by, BY):
        raise UsageError(f"by is {shown_number(by)}: use {' or '.join(BY)}")
    points, start = skeleton.as_given.flattened(flatten)
    first, ends = skeleton.branch_starts, skeleton.branch_ends
    if by == "arc":
        first, ends = np.arange(len(skeleton)), skeleton.arcs.T
    source, target = ends.astype(np.int64)
    return SkeletonGraph(
        skeleton,
        distinct(np.concatenate([source, target])),
        source,
        target,
        skeleton.polygon[first],
        _branches(skeleton, first) if by == "branch" else _arcs(skeleton),
        *chained(points, start, first),
    )


def skeleton_features(skeleton: Skeleton, what: str | None, flatten: float | None) -> Rows:
    """Return each branch as a line, or each arc."""
    graph = skeleton_graph(skeleton, by="branch" if what in (None, "skeleton", "diagram") else what, flatten=flatten)
    geometry = Lines(graph.points, graph.start)
    return of_polygons(graph.columns, skeleton.polygons, graph.polygon, geometry=geometry, is_part=True)


def _branches(skeleton: Skeleton, first: NDArray[np.int64]) -> dict[str, Any]:
    columns = branch_columns(skeleton, threads=1)
    del columns["chord"]
    return {"branch": columns.pop("branch"), "side": skeleton.side_names(first), **columns}


def _arcs(skeleton: Skeleton) -> dict[str, Any]:
    least, most, integral = skeleton.arc_radii
    radius = skeleton.radius[skeleton.arcs[:, 0]]
    mean = np.divide(integral, skeleton.length, out=radius, where=skeleton.length > 0)
    return {
        "arc": np.arange(len(skeleton)),
        "branch": skeleton.branch,
        "side": skeleton.side_names(),
        "kind": Lookup(list(KINDS), skeleton.is_parabola.astype(np.int32)),
        "length": skeleton.length,
        "r_min": least,
        "r_max": most,
        "r_mean": mean,
    }
