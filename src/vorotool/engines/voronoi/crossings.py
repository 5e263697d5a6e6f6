"""Where borders meet cuts: each place once, in doubles, however many pieces and edges pass through it."""

from __future__ import annotations

from typing import Any

import numpy as np

from vorotool.engines.voronoi.borders import Borders
from vorotool.engines.voronoi.cut_curves import FAR, SLACK, CutCurves, CutEdges, cut_curves
from vorotool.engines.voronoi.regions import LocalDiagrams
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, Indices
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import rows_of
from vorotool.types.polygons.planar_graph import packed
from vorotool.types.voronoi.voronoi_map import OUTSIDE

Pairs = tuple[Indices, Indices]


@frozen(eq=False)
class Drawn:
    """Places of borders, then ends of cut edges, that are known to be at each other or on edges: see `Crossings`."""

    node: Indices  # (v,) int64 array
    edge: Indices  # (v,) int64 array
    far: Floats  # (v,) float64 array

    @classmethod
    def nowhere(cls, count: int) -> Drawn:
        """So many places, each by itself."""
        return cls(np.arange(count), np.full(count, -1), np.zeros(count))


@frozen(eq=False)
class Crossings:
    """The places of a map that is cut: those of borders, then the ends of cut edges, then where both meet inside."""

    # (k,) int64 array: pieces of borders that may be cut, and circular arcs, ascending
    pieces: Indices
    curves: CutCurves  # that these are on
    node: Indices  # (v,) int64 array: of each place that which stands for it: others are at the same place
    edge: Indices  # (v,) int64 array: the cut edge inside which a place lies; -1 of others
    far: Floats  # (v,) float64 array: how far along it, on the lattice
    place: Floats  # (v, 2) float64 array: where it is on the lattice, as far as its border tells
    stop_row: Indices  # (s,) int64 array: where pieces pass through places on cuts: rows of `pieces`,
    stop_node: Indices  # (s,) int64 array: and places,
    stop_t: Floats  # (s,) float64 array: and the parameters there
    radius: Floats  # (v,) float64 array: distances from sites, on the lattice; NaN where no border is


def crossings_between(
    borders: Borders, edges: CutEdges, drawn: Drawn, pieces: Indices, curves: CutCurves, pairs: Pairs
) -> Crossings:
    """Find where pieces of borders meet cut edges, given pairs of these: rows of the pieces, and edges."""
    count = len(borders.places)
    own = curves[pairs[0]]
    stops, anchors = _stops_at_corners(borders.ends[pieces], own, edges, pairs, (drawn, count))
    row, at, t = _roots(own, edges, pairs, anchors)
    place = curves[row].place(t)
    inner = edges.along(at, place)
    beyond = edges.at_ends(at, inner)
    new = np.flatnonzero(~(beyond[0] | beyond[1]))
    number = np.empty(len(row), dtype=np.int64)
    for end, hit in enumerate(beyond):
        number[hit] = count + edges.ends[at[hit], end]
    number[new] = len(drawn.node) + np.arange(len(new))
    node = np.concatenate([drawn.node, number[new]])
    edge, far = np.concatenate([drawn.edge, at[new]]), np.concatenate([drawn.far, inner[new]])
    stop_row, stop_node = np.concatenate([stops[0], row]), np.concatenate([stops[1], number])
    stop_t = np.concatenate([stops[2], t])
    _join_along_edges(node, edge, far, edges.slack)
    radius = np.concatenate([borders.radius, np.full(len(node) - count, np.nan)])
    is_limit = borders.sites[pieces[stop_row], 1] == OUTSIDE
    radius[stop_node] = np.where(is_limit, borders.level, curves[stop_row].radius(stop_t))
    moved = np.flatnonzero(node[:count] != np.arange(count))
    radius[node[moved]] = borders.radius[moved]
    places = np.concatenate([borders.places, edges.points, place[new]])
    return Crossings(pieces, curves, node, edge, far, places, stop_row, node[stop_node], stop_t, radius)


def crossings_of(local: LocalDiagrams, edges: CutEdges) -> Crossings:
    """Find where borders meet the cut edges of their region, on whose lattice walls are cut already."""
    borders = local.borders
    drawn = Drawn.nowhere(len(borders.places) + len(edges.points))
    tree = shapely.STRtree(shapely.linestrings(edges.lines))
    region = local.region
    _draw_places(local, edges, tree, region, drawn)
    is_wall = (borders.elements[:, 0] == borders.elements[:, 1]) & (borders.sites[:, 1] != OUTSIDE)
    *pairs, pieces, curves = _pairs(local, edges, tree, np.flatnonzero(~is_wall), region)
    return crossings_between(borders, edges, drawn, pieces, curves, (pairs[0], pairs[1]))


def _draw_places(local: LocalDiagrams, edges: CutEdges, tree: Any, region: Indices, drawn: Drawn) -> None:
    """Tell which places of borders are at ends of cut edges or on these; places of sites are so exactly or not."""
    node, edge, far = drawn.node, drawn.edge, drawn.far
    borders = local.borders
    count = len(borders.places)
    of_place = np.full(count, -1, dtype=np.int64)
    for end in borders.ends.T:
        of_place[end[end >= 0]] = region[end >= 0]
    is_site = (borders.radius == 0) & (of_place >= 0)
    sites = np.flatnonzero(is_site)
    corner = rows_of(packed(edges.points), packed(borders.places[sites]))
    node[sites[corner >= 0]] = count + corner[corner >= 0]
    free = np.flatnonzero((of_place >= 0) & ~is_site & (np.abs(borders.places) < FAR).all(axis=1))
    point, near = tree.query(shapely.points(borders.places[free]), predicate="dwithin", distance=SLACK)
    point = free[point]
    own = (edges.regions[near] == of_place[point][:, None]).any(axis=1)
    point, near = point[own], near[own]
    along = edges.along(near, borders.places[point])
    miss = edges.beside(near, borders.places[point])
    sorting = np.argsort(-miss, kind="stable")  # the nearest comes last, and stays
    edge[point[sorting]], far[point[sorting]] = near[sorting], along[sorting]
    for end, is_at in enumerate(edges.at_ends(near, along)):
        node[point[is_at]] = count + edges.ends[near[is_at], end]
    edge[:count][node[:count] >= count] = -1


def _pairs(
    local: LocalDiagrams, edges: CutEdges, tree: Any, pieces: Indices, region: Indices
) -> tuple[Indices, Indices, Indices, CutCurves]:
    """Pieces and the cut edges of their region that they come near to, and the curves of all such pieces."""
    curves = cut_curves(local.borders, local.owned.graph, pieces)
    low, high = curves.between(*_boxes(edges, region[pieces]))
    held = np.flatnonzero(low <= high)
    low, high, bent = low[held], high[held], curves.height[held] > 0
    ends = [curves[held].place(low), curves[held].place(high)]
    shapes = shapely.linestrings(np.stack(ends, axis=1))
    hull = np.stack([ends[0], curves[held].control(low, high), ends[1], ends[0]], axis=1)
    shapes[bent] = shapely.polygons(hull[bent])
    is_round = curves.round[held] > 0
    shapes[is_round] = shapely.polygons(curves[held[is_round]].hull(low[is_round], high[is_round]))
    row, edge = tree.query(shapes, predicate="dwithin", distance=4 * SLACK)
    row = held[row]
    own = (edges.regions[edge] == region[pieces[row]][:, None]).any(axis=1)
    row, edge = row[own], edge[own]
    used = np.union1d(row, np.flatnonzero(curves.round > 0))
    return np.searchsorted(used, row), edge, pieces[used], curves[used]


def _boxes(edges: CutEdges, region: Indices) -> tuple[Floats, Floats]:
    """(k, 2) least and most coordinates of cut edges around regions."""
    edge, hand = np.nonzero(edges.regions >= 0)
    number = edges.regions[edge, hand]
    count = int(max(number.max(initial=0), region.max(initial=0))) + 1
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    for end in (0, 1):
        places = edges.points[edges.ends[edge, end]]
        np.minimum.at(low, number, places)
        np.maximum.at(high, number, places)
    return low[region] - 1, high[region] + 1


def _stops_at_corners(
    ends: Indices,
    curves: CutCurves,  # of the pairs
    edges: CutEdges,
    pairs: Pairs,
    known: tuple[Drawn, int],
) -> tuple[tuple[Indices, Indices, Floats], tuple[Indices, Floats]]:
    """Where pieces pass through ends of cut edges, and for pairs where they are known to meet: number, parameter."""
    (row, cut), (drawn, count) = pairs, known
    own = np.where(ends >= 0, drawn.node[ends], -1)[row]
    low, high = np.minimum(curves.first, curves.last), np.maximum(curves.first, curves.last)
    anchors: list[tuple[Indices, Floats]] = []
    stops: list[tuple[Indices, Indices, Floats]] = []
    for end, t in ((0, curves.first), (1, curves.last)):
        at = own[:, end]
        on_edge = (at >= 0) & (drawn.edge[at] == cut)
        is_corner = (at[:, None] == count + edges.ends[cut]).any(axis=1)
        hit = np.flatnonzero(on_edge | is_corner)
        anchors.append((hit, t[hit]))
    for end in (0, 1):
        t, miss = curves.nearest(edges.lines[cut, end])
        at = count + edges.ends[cut, end]
        is_own = (own == at[:, None]).any(axis=1)
        hit = np.flatnonzero((miss <= edges.end_slack[cut, end]) & (t > low) & (t < high) & ~is_own)
        anchors.append((hit, t[hit]))
        stops.append((row[hit], at[hit], t[hit]))
    found = tuple(np.concatenate(each) for each in zip(*stops, strict=True))
    order = np.lexsort((found[1], found[0]))
    is_new = np.ones(len(order), dtype=bool)
    is_new[1:] = (found[0][order[1:]] != found[0][order[:-1]]) | (found[1][order[1:]] != found[1][order[:-1]])
    first = order[is_new]
    joined = tuple(np.concatenate(each) for each in zip(*anchors, strict=True))
    return tuple(each[first] for each in found), joined  # type: ignore[return-value]


def _roots(
    own: CutCurves, edges: CutEdges, pairs: Pairs, anchors: tuple[Indices, Floats]
) -> tuple[Indices, Indices, Floats]:
    """Where else pieces meet edges, given the curves of the pairs: rows, edges and parameters."""
    row, cut = pairs
    if not len(row):
        return row, cut, np.empty(0)
    roots = own.meets(edges.lines[cut, 0], edges.normal[cut], edges.slack[cut])
    order = np.argsort(anchors[0], kind="stable")
    pair, t = anchors[0][order], anchors[1][order]
    while pair.size:  # one anchor of each pair at a time takes the root nearest to it
        is_first = np.diff(pair, prepend=-1) != 0
        at = pair[is_first]
        gap = np.abs(roots[at] - t[is_first][:, None])
        gap[np.isnan(gap)] = np.inf
        roots[at, gap.argmin(axis=1)] = np.nan
        pair, t = pair[~is_first], t[~is_first]
    low, high = np.minimum(own.first, own.last), np.maximum(own.first, own.last)
    found, which = np.nonzero((roots > low[:, None]) & (roots < high[:, None]))
    t = roots[found, which]
    far = edges.along(cut[found], own[found].place(t))
    slack = edges.end_slack[cut[found]].T
    is_on = (far > -slack[0]) & (far < edges.length[cut[found]] + slack[1])
    return row[found[is_on]], cut[found[is_on]], t[is_on]


def _join_along_edges(node: Indices, edge: Indices, far: Floats, slack: Floats) -> None:
    """Let one place stand for all that follow each other within the slack along an edge."""
    inner = np.flatnonzero(edge >= 0)
    order = inner[np.lexsort((inner, far[inner], edge[inner]))]
    if not order.size:
        return
    follows = np.zeros(len(order), dtype=bool)
    follows[1:] = (edge[order[1:]] == edge[order[:-1]]) & (np.diff(far[order]) <= slack[edge[order[1:]]])
    group = np.cumsum(~follows) - 1
    least = np.full(int(group[-1]) + 1, len(node), dtype=np.int64)
    np.minimum.at(least, group, order)
    node[order] = least[group]
