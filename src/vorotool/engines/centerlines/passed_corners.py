"""Corners of polygons with holes that a centerline passes: a plate with holes has no end in its corners."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.centerlines.corner_twigs import Branches, Twigs
from vorotool.engines.centerlines.edge_comparisons import is_blunt
from vorotool.types.skeleton.skeleton import Skeleton

Numbers = NDArray[np.intp]
Booleans = NDArray[np.bool_]


def are_passed(skeleton: Skeleton, branches: Branches, twigs: Twigs) -> Booleans:
    """Tell which twigs hang on a cycle, or between two, and lead into a corner much like both beside it."""
    polygons, table = skeleton.polygons, skeleton.site_table
    has_holes = np.diff(polygons.polygon_starts) > 1
    own = np.flatnonzero(has_holes[skeleton.polygon[branches.first]])
    is_passed = _left_without_trees(branches, own)[twigs.node]
    edges = twigs.edges[is_passed]
    ring = polygons.polygon_starts[table.polygon[edges]] + table.ring[edges]
    start = polygons.ring_starts[ring] + table.index[edges]
    before = np.empty(len(polygons.xy), dtype=np.intp)
    before[polygons.following] = np.arange(len(before))
    end = polygons.following[start]
    around = polygons.xy[np.stack([before[start], start, end, polygons.following[end]], axis=-1)].reshape(-1, 4, 2)
    (ux, uy), (vx, vy), (wx, wy) = np.diff(around, axis=1).transpose(1, 2, 0)
    is_like = is_blunt(around) & ((ux * vy - uy * vx > 0) == (vx * wy - vy * wx > 0))
    is_passed[is_passed] = is_like.reshape(-1, 2).all(axis=1)
    return is_passed


def _left_without_trees(branches: Branches, own: Numbers) -> Booleans:
    """(v,) which nodes are left when branches that end there are taken off, of some, as long as there are any."""
    nodes = len(branches.degree)
    if not len(own):
        return np.zeros(nodes, dtype=bool)
    degree = np.bincount(branches.ends[own].reshape(-1), minlength=nodes)
    joined = np.zeros(nodes, dtype=np.intp)  # of all branches at a node: of the last one its number
    np.bitwise_xor.at(joined, branches.ends[own].reshape(-1), np.repeat(own, 2))
    leaves = np.flatnonzero(degree == 1).tolist()
    one, other = branches.ends.T.tolist()
    degrees, numbers = degree.tolist(), joined.tolist()
    while leaves:
        node = leaves.pop()
        if degrees[node] != 1:
            continue
        branch = numbers[node]
        near = one[branch] + other[branch] - node
        degrees[node] = 0
        degrees[near] -= 1
        numbers[near] ^= branch
        if degrees[near] == 1:
            leaves.append(near)
    left: Booleans = np.array(degrees) > 0
    return left
