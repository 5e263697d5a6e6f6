"""The frame of a Voronoi map as a ring of arcs between the places where borders end on it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby, pairwise, permutations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.voronoi.frame_cut import SIDES, CutBorders
from vorotool.errors import VerificationError
from vorotool.plain import plain

Indices = NDArray[np.int64]
Floats = NDArray[np.float64]
Pair = tuple[int, int]

UNKNOWN = -2
"""Those along a frame that no border meets."""

_FORWARD = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))
"""Along each side, counter-clockwise."""

ROUNDING = 2.0**-48
"""Of the largest coordinate of a frame, by which places along it may be off."""

_MOST_TIES = 6
"""Borders that end at one place of a frame as far as doubles tell, all orders of which are tried."""


@plain(eq=False)
class FrameRing:
    """The arcs of a frame, counter-clockwise."""

    # (k,) int64 array: places along the frame from its smallest corner on, each a place of the cut borders, or a
    # corner where none ends: these come after them
    nodes: Indices
    # (k, 2) int64 array: site and part on the inner side of the arc that leaves each node; `UNKNOWN` if no border
    # ends on the frame
    sides: Indices
    # (c, 2) int64 array: of the source and target of cut borders on the frame: from 1 on counter-clockwise around
    # their node
    rank: Indices
    corners: Floats  # (m, 2) float64 array: places of the corners where no border ends
    # (v, 2) float64 array: those of the cut borders; where rounding has put some along the frame in another order,
    # they are exchanged
    places: Floats


@plain
class _Node:
    """A place on the frame: where it is, and (site, part) along the frame before it and after it."""

    number: int
    position: tuple[int, float]
    before: Pair | None = None
    after: Pair | None = None


def frame_ring(cut: CutBorders, sites: Indices, parts: Indices, order: Indices, corners: Floats) -> FrameRing:
    """Put the ends of borders on a frame in order around it."""
    rank = np.zeros_like(order)
    nodes = [*_nodes_of_borders(cut, sites, parts, order, corners, rank)]
    taken = {node.position for node in nodes}
    free = [k for k in range(SIDES) if _position(corners[k], k, corners) not in taken]
    nodes += [_Node(len(cut.places) + i, _position(corners[k], k, corners)) for i, k in enumerate(free)]
    nodes.sort(key=lambda node: (node.position, node.number))
    ring = _in_order(nodes, ROUNDING * float(np.abs(corners).max()))
    place = {node.position: cut.places[node.number] for node in nodes if node.after is not None}
    places = cut.places.copy()
    for node in ring:
        if node.after is not None:
            places[node.number] = place[node.position]
    return FrameRing(
        np.array([node.number for node in ring], dtype=np.int64),
        np.array(_sides(ring), dtype=np.int64),
        rank,
        corners[free],
        places,
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
        ends = sorted(((int(arc[k]), int(end[k])) for k in group), key=lambda each: int(order[each]))
        # what leaves a node has at its source the left hand on its left, at its target the other way round
        right, left = (
            [(int(sites[each, at ^ hand]), int(parts[each, at ^ hand])) for each, at in ends] for hand in (1, 0)
        )
        begin = _first_from_frame(ends, cut, position[0], _possible_firsts(left, right))
        for k, (each, at) in enumerate(ends[begin:] + ends[:begin]):
            rank[each, at] = k + 1
        yield _Node(number, position, left[begin - 1], right[begin])


def _possible_firsts(left: list[Pair], right: list[Pair]) -> list[int]:
    """Which of those that leave a place counter-clockwise may be the first: between all others sides agree."""
    parted = [k for k in range(len(left)) if left[k - 1] != right[k]]
    return parted if len(parted) == 1 else [*range(len(left))]


def _first_from_frame(ends: list[Pair], cut: CutBorders, side: int, possible: list[int]) -> int:
    """Which end of borders at one place is the first one from the side of the frame that begins or goes on there."""
    if len(possible) == 1:
        return possible[0]
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

    return min(possible, key=lambda k: turned(ends[k]))


def _in_order(nodes: list[_Node], slack: float) -> list[_Node]:
    """Nodes of which those at one position, as far as doubles tell, are put so that the sites between them agree."""
    groups = _together(nodes, slack)
    last = next((group for group in reversed(groups) if any(node.after for node in group)), [])
    rings = [_from(node.after, groups) for node in last] or [nodes]
    return next((ring for ring in rings if _agree(None, [node for node in ring if node.after] * 2)), rings[0])


def _from(before: Pair | None, groups: list[list[_Node]]) -> list[_Node]:
    """Nodes in an order that agrees with what the frame comes from to the first one."""
    ring: list[_Node] = []
    for group in groups:
        bound = [node for node in group if node.after is not None]
        free = [node for node in group if node.after is None]
        if 1 < len(bound) <= _MOST_TIES:
            positions = [node.position for node in bound]
            fitting = next((each for each in permutations(bound) if _agree(before, each)), bound)
            bound = [replace(node, position=at) for node, at in zip(fitting, positions, strict=True)]
        ring += [*free, *bound]
        before = bound[-1].after if bound else before
    return ring


def _together(nodes: list[_Node], slack: float) -> list[list[_Node]]:
    """Nodes along the frame in groups that are nearer to each other than rounding moves them."""
    groups = [[nodes[0]]]
    for last, node in pairwise(nodes):
        (side, at), (next_side, next_at) = last.position, node.position
        if side == next_side and next_at - at <= slack:
            groups[-1].append(node)
        else:
            groups.append([node])
    return groups


def _agree(before: Pair | None, nodes: Sequence[_Node]) -> bool:
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
                raise VerificationError("the frame coincides with a cell border to within rounding: shift it slightly")
            current = node.after
        sides.append(current)
    return sides
