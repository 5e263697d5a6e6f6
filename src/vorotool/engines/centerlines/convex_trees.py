"""The medial axis along chains of edges with convex corners only, as trees.

All places inside a convex chain are nearest to one of its edges, each of which is a part of the border of a half-plane.
So the distance to the chain is the least of linear functions, and its level lines are chains of parallels: as they move
inwards, edges between the first and the last one shrink to a point each, where their neighbors meet. These points are
the nodes, and those between that two neighbors bound are the arcs.
"""

from __future__ import annotations

import math
from heapq import heapify, heappop, heappush

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.ragged import owners
from vorotool.plain import plain

Floats = NDArray[np.float64]
Numbers = NDArray[np.intp]
Line = tuple[float, float, float]


@plain(eq=False)
class Chains:
    """Chains of edges, counterclockwise around what is inside."""

    start: Numbers  # (k + 1,) integer array: chain k has the edges `start[k]` to `start[k + 1] - 1`: two or more
    # (n, 2) float64 array: where edges begin and end; the corner between two is where the first one ends
    source: Floats
    # (n, 2) float64 array: where edges begin and end; the corner between two is where the first one ends
    target: Floats


@plain(eq=False)
class Trees:
    """Nodes and arcs inside chains."""

    chain: Numbers  # (u,) integer array: of each node
    places: Floats  # (u, 2) float64 array: of each node; the origin of its chain where doubles give none
    radius: Floats  # (u,) float64 array: distances from the edges
    # (k,) integer array: the node of each chain that its last edges meet at: the last one made; -1 in chains of two
    # edges
    root: Numbers
    # (a, 2) integer array: from the node nearer to the root, to another: the number of a node, or `-1 - e` for the
    # corner behind edge e
    arcs: Numbers
    edges: Numbers  # (a, 2) integer array: left and right of each arc


def convex_trees(chains: Chains, origins: Floats) -> Trees:
    """Find the trees of chains, in time O(n log n)."""
    sizes = np.diff(chains.start)
    way = chains.target - chains.source
    length = np.sqrt((way * way).sum(axis=1))
    normal = np.stack([-way[:, 1], way[:, 0]], axis=1) / length[:, None]
    offset = (normal * (chains.source - np.repeat(origins, sizes, axis=0))).sum(axis=1)
    lines = list(zip(*normal.T.tolist(), offset.tolist(), strict=True))
    nodes: list[Line] = []
    arcs: list[tuple[int, int, int, int]] = []
    for first, last in zip(chains.start[:-1].tolist(), chains.start[1:].tolist(), strict=True):
        _collapse(lines, first, last, nodes, arcs)
    made = np.array(nodes).reshape(-1, 3)
    found = np.array(arcs, dtype=np.intp).reshape(-1, 4)
    chain = owners(sizes - 2)
    root = np.where(sizes > 2, np.cumsum(sizes - 2) - 1, -1)
    return Trees(chain, made[:, :2] + origins[chain], made[:, 2], root, found[:, :2], found[:, 2:])


def _collapse(
    lines: list[Line], first: int, last: int, nodes: list[Line], arcs: list[tuple[int, int, int, int]]
) -> None:
    """Let the inner edges of a chain shrink to points, in the order of their distances."""
    before = {k: k - 1 for k in range(first + 1, last)}
    behind = {k: k + 1 for k in range(first, last - 1)}
    corner = {k: -1 - k for k in range(first, last - 1)}  # the node where each edge meets that behind it
    heap = [(*_meeting(lines[k - 1], lines[k], lines[k + 1]), k, k - 1, k + 1) for k in range(first + 1, last - 1)]
    heapify(heap)
    while heap:
        distance, x, y, k, one, other = heappop(heap)
        if before.get(k) != one or behind.get(k) != other:  # its neighbors are others since, or it is gone
            continue
        arcs += [(len(nodes), corner[one], k, one), (len(nodes), corner[k], other, k)]
        corner[one] = len(nodes)
        nodes.append((x, y, distance if math.isfinite(distance) else -lines[k][2]))
        del before[k], behind[k]
        behind[one], before[other] = other, one
        for changed in (one, other):
            if first < changed < last - 1:
                near = before[changed], behind[changed]
                meeting = _meeting(lines[near[0]], lines[changed], lines[near[1]])
                heappush(heap, (*meeting, changed, *near))


def _meeting(a: Line, b: Line, c: Line) -> Line:
    """Return how far three lines are from the point that is equally far from all, and that point; else infinity."""
    ux, uy, u = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    vx, vy, v = c[0] - b[0], c[1] - b[1], c[2] - b[2]
    whole = ux * vy - uy * vx
    if whole == 0:
        return math.inf, 0.0, 0.0
    x, y = (u * vy - uy * v) / whole, (ux * v - u * vx) / whole
    distance = b[0] * x + b[1] * y - b[2]
    return (distance, x, y) if distance > 0 else (math.inf, 0.0, 0.0)
