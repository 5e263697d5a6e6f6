"""The frame of a Voronoi map as a ring of arcs between the places where borders end on it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby, permutations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.voronoi.frame_cut import SIDES, CutBorders
from vorotool.errors import VerificationError

Indices = NDArray[np.int64]
Floats = NDArray[np.float64]
Pair = tuple[int, int]

UNKNOWN = -2
"""Those along a frame that no border meets."""

_FORWARD = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))
"""Along each side, counter-clockwise."""

_MOST_TIES = 6
"""Borders that end at one place of a frame as far as doubles tell, all orders of which are tried."""


@dataclass(frozen=True, eq=False)
class FrameRing:
    """The arcs of a frame, counter-clockwise.

    Parameters
    ----------
    nodes : (k,) int64 array
        Places along the frame from its smallest corner on, each a place of the cut borders, or a corner where none
        ends: these come after them.
    sides : (k, 2) int64 array
        Site and part on the inner side of the arc that leaves each node; `UNKNOWN` if no border ends on the frame.
    rank : (c, 2) int64 array
        Of the source and target of cut borders on the frame: from 1 on counter-clockwise around their node.
    corners : (m, 2) float64 array
        Places of the corners where no border ends.
    """

    nodes: Indices
    sides: Indices
    rank: Indices
    corners: Floats


@dataclass(frozen=True)
class _Node:
    """A place on the frame: where it is, and (site, part) along the frame before it and after it."""

    number: int
    position: tuple[int, float]
    before: Pair | None = None
    after: Pair | None = None


def frame_ring(cut: CutBorders, sites: Indices, parts: Indices, order: Indices, corners: Floats) -> FrameRing:
    """Put the ends of borders on a frame in order around it.

    Where several end at one place, as far as doubles tell, each order is tried until the sites between them agree.

    Parameters
    ----------
    cut : CutBorders
        In the frame.
    sites, parts, order : (c, 2) int64 array
        Of these borders: sites and parts left and right, order around source and target.
    corners : (4, 2) float64 array
        Of the frame, counter-clockwise from the smallest.

    Raises
    ------
    VerificationError
        If they agree in no order.
    """
    rank = np.zeros_like(order)
    nodes = [*_nodes_of_borders(cut, sites, parts, order, corners, rank)]
    taken = {node.position for node in nodes}
    free = [k for k in range(SIDES) if _position(corners[k], k, corners) not in taken]
    nodes += [_Node(len(cut.places) + i, _position(corners[k], k, corners)) for i, k in enumerate(free)]
    nodes.sort(key=lambda node: (node.position, node.number))
    ring = _in_order(nodes)
    return FrameRing(
        np.array([node.number for node in ring], dtype=np.int64),
        np.array(_sides(ring), dtype=np.int64),
        rank,
        corners[free],
    )


def _position(place: Floats, side: int, corners: Floats) -> tuple[int, float]:
    """Where a place is along the frame; a corner is the beginning of a side."""
    for k in range(SIDES):
        if (place == corners[k]).all():
            side = k
    x, y = _FORWARD[side]
    return side, float(x * place[0] + y * place[1])


def _nodes_of_borders(
    cut: CutBorders, sites: Indices, parts: Indices, order: Indices, corners: Floats, rank: Indices
) -> Iterator[_Node]:
    """The places where borders end on the frame; writes their ranks there."""
    arc, end = np.nonzero(cut.side[cut.ends] >= 0)
    node = cut.ends[arc, end]
    sorting = np.argsort(node, kind="stable")
    for number, group in groupby(sorting.tolist(), key=lambda k: int(node[k])):
        position = _position(cut.places[number], int(cut.side[number]), corners)
        around = _counter_clockwise([(int(arc[k]), int(end[k])) for k in group], cut, order, position[0])
        for k, (each, at) in enumerate(around):
            rank[each, at] = k + 1
        (first, at_first), (last, at_last) = around[0], around[-1]
        # what leaves a node has at its source the left hand on its left, at its target the other way round
        after = int(sites[first, 1 - at_first]), int(parts[first, 1 - at_first])
        before = int(sites[last, at_last]), int(parts[last, at_last])
        yield _Node(number, position, before, after)


def _counter_clockwise(ends: list[Pair], cut: CutBorders, order: Indices, side: int) -> list[Pair]:
    """Ends of borders at one place in order, from the side of the frame that begins or goes on there."""
    if len(ends) == 1:
        return ends
    ends = sorted(ends, key=lambda each: int(order[each]))
    forward = _FORWARD[side]

    def turned(each: Pair) -> float:
        arc, at = each
        here, there = cut.places[cut.ends[arc, at]], cut.places[cut.ends[arc, 1 - at]]
        x, y = (there - here).tolist()
        if not np.isnan(cut.control[arc, 0]):
            x, y = (cut.control[arc] - here).tolist()
        elif not np.isnan(cut.center[arc, 0]):  # counter-clockwise from its source
            u, v = (here - cut.center[arc]).tolist()
            x, y = (-v, u) if at == 0 else (v, -u)
        return -float(x * forward[0] + y * forward[1]) / float(np.sqrt(x * x + y * y))

    first = min(range(len(ends)), key=lambda k: turned(ends[k]))
    return ends[first:] + ends[:first]


def _in_order(nodes: list[_Node]) -> list[_Node]:
    """Nodes of which those at one position are put so that the sites between them agree."""
    groups = [[*group] for _, group in groupby(nodes, key=lambda node: node.position)]
    ring: list[_Node] = []
    for group in groups:
        bound = [node for node in group if node.after is not None]
        free = [node for node in group if node.after is None]
        if 1 < len(bound) <= _MOST_TIES:
            before = next((node.after for node in reversed(ring) if node.after is not None), None)
            fitting = [each for each in permutations(bound) if _agree(before, each)]
            bound = [*fitting[0]] if fitting else bound
        ring += [*free, *bound]
    return ring


def _agree(before: Pair | None, nodes: tuple[_Node, ...]) -> bool:
    for node in nodes:
        if before is not None and node.before != before:
            return False
        before = node.after
    return True


def _sides(ring: list[_Node]) -> list[Pair]:
    """Site and part after each node."""
    current = next((node.after for node in reversed(ring) if node.after is not None), None)
    if current is None:
        return [(UNKNOWN, UNKNOWN)] * len(ring)
    sides = []
    for node in ring:
        if node.after is not None:
            if node.before != current:
                raise VerificationError("the frame runs along a border as far as doubles tell: choose another frame")
            current = node.after
        sides.append(current)
    return sides
