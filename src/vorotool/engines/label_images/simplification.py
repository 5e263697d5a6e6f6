"""Polygons and lines with fewer vertices, that meet where they met.

shapely's `coverage_simplify` is faster, but goes by areas: for a tolerance of 1 pixel borders move by 1.11, and keep
twice as many vertices (`tests/benchmarks/libraries.py simplify`). It takes no lines.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError
from vorotool.numeric.arrays import Indices, owners, ranges, starts_of, within
from vorotool.numeric.numbers import distinct, finite_double, shown_number
from vorotool.plain import plain
from vorotool.types.polygons.polygon_set import LINE, PolygonSet


def simplified_polygons(polygons: PolygonSet, tolerance: float) -> PolygonSet:
    """Leave out vertices of polygons and lines that touch each other in vertices and along whole edges only."""
    tolerance = finite_double(tolerance, "the tolerance of a simplification")
    if tolerance < 0:
        raise UsageError(
            f"the tolerance of a simplification is {shown_number(tolerance)}: it must be a length of 0 or more"
        )
    if not len(polygons.xy) or not tolerance:
        return polygons
    chains = _chains(polygons)
    points, start = _simplified_chains(chains, tolerance)
    index, sizes = _along_rings(polygons, chains, start)
    last = polygons.xy[polygons.ring_starts[1:][np.equal(polygons.ring_kind, LINE)] - 1]
    xy = np.concatenate([points, last])[index]
    return _turned_as(replace(polygons, xy=xy, ring_starts=starts_of(sizes)), polygons)


@plain
class _Chains:
    """Chains of edges, and the stretches of rings along them."""

    places: NDArray[np.float64]
    point: Indices  # places along each chain, its ends included
    start: Indices  # where each chain begins among these, and their number
    used: Indices  # the chain of each stretch, ring after ring
    is_back: NDArray[np.bool_]  # whether the ring runs along it the other way
    ring: Indices  # of each stretch


def _chains(polygons: PolygonSet) -> _Chains:
    places, point = np.unique(polygons.xy, axis=0, return_inverse=True)
    point = point.reshape(-1)
    node = _nodes(polygons, point, len(places))
    walk, ring = _closed_walks(polygons, node[point])
    along = point[walk]
    stops = np.flatnonzero(node[along])
    is_begin = ring[stops[:-1]] == ring[stops[1:]]
    begin, end = stops[:-1][is_begin], stops[1:][is_begin]
    edge = _edge_keys(along[:-1], along[1:], len(places))
    edge[ring[:-1] != ring[1:]] = np.iinfo(np.int64).max
    key = np.minimum.reduceat(edge, begin) if len(begin) else edge[:0]
    _, first, used = np.unique(key, return_index=True, return_inverse=True)
    steps = end - begin
    stretch = owners(steps)
    position = ranges(begin, steps)
    at = position[edge[position] == key[stretch]]  # where each stretch has the edge that names its chain
    is_up = along[at] < along[at + 1]
    sizes = steps[first] + 1
    return _Chains(
        places,
        along[ranges(begin[first], sizes)],
        starts_of(sizes),
        used,
        is_up != is_up[first][used],
        ring[begin],
    )


def _edge_keys(a: Indices, b: Indices, count: int) -> Indices:
    return np.minimum(a, b) * count + np.maximum(a, b)


def _nodes(polygons: PolygonSet, point: Indices, count: int) -> NDArray[np.bool_]:
    """(p,) places where chains end."""
    start = polygons.ring_starts
    is_line = np.equal(polygons.ring_kind, LINE)
    last = (start[1:] - 1)[is_line]
    after = polygons.following.copy()
    after[last] = last
    edges = distinct(_edge_keys(point, point[after], count))
    a, b = edges // count, edges % count
    a, b = a[a != b], b[a != b]
    degree = np.bincount(a, minlength=count) + np.bincount(b, minlength=count)
    node: NDArray[np.bool_] = degree != 2
    node[b[degree[a] >= 4]] = node[a[degree[b] >= 4]] = True
    node[point[start[:-1][is_line]]] = node[point[start[1:][is_line] - 1]] = True
    is_free = ~np.logical_or.reduceat(node[point], start[:-1])
    node[np.minimum.reduceat(point, start[:-1])[is_free]] = True
    return node


def _closed_walks(polygons: PolygonSet, is_node: NDArray[np.bool_]) -> tuple[Indices, Indices]:
    """Vertices around each ring, from one node to the same one again, or along a line; and the ring of each."""
    start, sizes = polygons.ring_starts[:-1], np.diff(polygons.ring_starts)
    first = np.minimum.reduceat(np.where(is_node, np.arange(len(is_node)), len(is_node)), start)
    lengths = sizes + ~np.equal(polygons.ring_kind, LINE)
    ring = owners(lengths)
    return start[ring] + (first[ring] - start[ring] + within(lengths)) % sizes[ring], ring


def _simplified_chains(chains: _Chains, tolerance: float) -> tuple[NDArray[np.float64], Indices]:
    """Places along each chain that are left, and where each begins."""
    import shapely

    owner = owners(np.diff(chains.start))
    lines = shapely.linestrings(chains.places[chains.point], indices=owner)
    parts = shapely.get_parts(shapely.simplify(shapely.multilinestrings(lines), tolerance, preserve_topology=True))
    assert len(parts) == len(lines)  # a chain keeps its ends
    points, index = shapely.get_coordinates(parts, return_index=True)
    return points, np.searchsorted(index, np.arange(len(parts) + 1))


def _along_rings(polygons: PolygonSet, chains: _Chains, start: Indices) -> tuple[Indices, Indices]:
    """The places along each ring, as numbers of the simplified ones, and how many each ring has."""
    steps = np.diff(start)[chains.used] - 1
    back = np.repeat(chains.is_back, steps)
    along = within(steps)
    begin, end = np.repeat(start[chains.used], steps), np.repeat(start[chains.used + 1] - 1, steps)
    lines = np.flatnonzero(np.equal(polygons.ring_kind, LINE))
    ring = np.concatenate([np.repeat(chains.ring, steps), lines])
    index = np.concatenate([np.where(back, end - along, begin + along), start[-1] + np.arange(len(lines))])
    order = np.argsort(ring, kind="stable")
    return index[order], np.bincount(ring, minlength=len(polygons.ring_kind))


def _turned_as(made: PolygonSet, given: PolygonSet) -> PolygonSet:
    """Turn rings round that have been folded over, so that shells and holes keep their directions."""
    start, sizes = made.ring_starts[:-1], np.diff(made.ring_starts)
    turned = (_area_signs(made) * _area_signs(given) < 0) & ~np.equal(made.ring_kind, LINE)
    if not turned.any():
        return made
    ring, place = owners(sizes), within(sizes)
    index = start[ring] + np.where(turned[ring], -place % sizes[ring], place)
    return replace(made, xy=made.xy[index])


def _area_signs(polygons: PolygonSet) -> NDArray[np.float64]:
    start, after = polygons.ring_starts[:-1], polygons.following
    own = polygons.xy - np.repeat(polygons.xy[start], np.diff(polygons.ring_starts), axis=0)
    return np.sign(np.add.reduceat(own[:, 0] * own[after, 1] - own[:, 1] * own[after, 0], start))
