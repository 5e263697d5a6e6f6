"""Where the ends of strips begin on lines: the last disc that touches both sides.

A line is followed from its end inwards. At a node all that the skeleton has beyond may be the piece of an end, whose
radii fall as fast as into a corner of 45 degrees (`vorotool.engines.centerlines.end_pieces`). If the discs one and two
radii before are about as large, both sides of the polygon are about parallel there, and this is the end of a strip:
however many corners it has, the line leads into none. If the line goes on for more than the disc is wide, such as into
a corner of less than 60 degrees, the disc three radii before must be as large, too. Of several such nodes the innermost
counts. Nothing is a strip that is shorter: its line leads where the longest path does.

Where lines lead into round ends (`vorotool.engines.centerlines.ends`), that leaf is looked from which is farthest.
"""

from __future__ import annotations

from dataclasses import field, replace
from itertools import pairwise
from math import inf

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.centerlines.end_pieces import TIP, Reaches
from vorotool.engines.centerlines.ends import Unforked
from vorotool.engines.centerlines.path_network import Pieces
from vorotool.numeric.arrays import owners, starts_of
from vorotool.plain import plain
from vorotool.types.skeleton.skeleton import INTERIOR

BUMP = 0.25
"""In radii of the disc that a piece hangs on: what is shorter is no branch beside a line."""

SAME = 0.125
"""As a part of the radius: by how much that of a disc before may differ where sides are parallel."""


def at_strip_ends(
    axis: Unforked, pieces: Pieces, known: int, wanted: tuple[bool, bool]
) -> tuple[Pieces, NDArray[np.bool_]]:
    """Let lines end where the ends of strips begin."""
    strips = _Strips(axis, known)
    ends = axis.skeleton.arcs[pieces.arc].astype(np.intp)
    ends[np.stack([pieces.first != 0, pieces.last != 1], axis=1)] = -1  # no node where an arc is parted
    sources, targets = np.where(pieces.is_turned[:, None], ends[:, ::-1], ends).T.tolist()
    arcs, start = pieces.arc.tolist(), starts_of(np.bincount(pieces.line)).tolist()
    whole = [([sources[begin], *targets[begin:stop]], arcs[begin:stop]) for begin, stop in pairwise(start)]
    walks = [strips.walk(*line) if wanted[0] else _Walk([], []) for line in whole]
    walks += [strips.walk(nodes[::-1], along[::-1]) if wanted[1] else _Walk([], []) for nodes, along in whole]
    found = strips.ends_on(walks)
    index, sizes, added = [], [], []
    for begin, stop, head, tail in zip(start, start[1:], found, found[len(whole) :], strict=False):
        kept = range(begin + head.dropped, stop - tail.dropped)
        sizes.append(len(head.added) + len(kept) + len(tail.added))
        index += [-1] * len(head.added) + list(kept) + [-1] * len(tail.added)
        added += [(arc, outer, True) for arc, outer in head.added]
        added += [(arc, outer, False) for arc, outer in tail.added[::-1]]
    made, new = pieces[np.array(index, dtype=np.intp)], np.flatnonzero(np.array(index) < 0)
    arc, outer, is_head = np.array(added, dtype=np.intp).reshape(-1, 3).T
    made.arc[new], made.first[new], made.last[new] = arc, 0, 1
    made.is_turned[new] = (axis.skeleton.arcs[arc, 0] == outer) != is_head
    is_made = np.array([end != _End() for end in found], dtype=bool).reshape(2, -1).T
    return replace(made, line=owners(np.array(sizes, dtype=np.int64), dtype=np.int32)), is_made


@plain
class _Walk:
    """Nodes and arcs from an end of a line inwards: what the line loses, and what is there instead, is left out."""

    nodes: list[int]  # one node more than arcs; or none
    arcs: list[int]  # one node more than arcs; or none
    dropped: int = 0  # how many arcs at the end of the line are of no walk
    # the arcs that are there instead, with their outer nodes
    added: list[tuple[int, int]] = field(default_factory=list)
    is_lead: bool = False  # whether a lead was at the end


@plain
class _End:
    """What a line loses, from the outside, and what it gets instead: arcs and their outer nodes."""

    dropped: int = 0
    added: tuple[tuple[int, int], ...] = ()


class _Strips:
    """A skeleton to look for ends in, as lists."""

    def __init__(self, axis: Unforked, known: int) -> None:
        skeleton = axis.skeleton
        self.radius, self.length = skeleton.radius, skeleton.length
        is_plain = ~(axis.is_round | axis.is_lead)
        is_plain[known:] = False
        self.is_plain, self.is_round, self.is_lead = is_plain.tolist(), axis.is_round.tolist(), axis.is_lead.tolist()
        self.reaches = Reaches(skeleton)
        ends = skeleton.arcs[:known].astype(np.intp)
        ends[skeleton.side[:known] != INTERIOR] = len(skeleton.vertices)
        self.both = ends.sum(axis=1).tolist()
        self.beside: list[int] = (np.argsort(ends.reshape(-1), kind="stable") // 2).tolist()
        self.start = starts_of(np.bincount(ends.reshape(-1), minlength=len(skeleton.vertices))).tolist()

    def at(self, node: int) -> list[int]:
        """Its arcs."""
        return self.beside[self.start[node] : self.start[node + 1]]

    def walk(self, nodes: list[int], arcs: list[int]) -> _Walk:
        """Follow a line from its end; in a round end, from its farthest leaf."""
        first = next((k for k, arc in enumerate(arcs) if self.is_plain[arc]), len(arcs))
        stop = len(nodes) - (nodes[-1] < 0 or not self.is_plain[arcs[-1]])
        if first + 1 >= stop or nodes[first] < 0:
            return _Walk([], [])
        is_round = any(self.is_round[arc] for arc in arcs[:first])
        added = self._farthest(nodes[first], arcs[first]) if is_round else []
        return _Walk(
            [node for _, node in added] + nodes[first:stop],
            [arc for arc, _ in added] + arcs[first : stop - 1],
            first,
            added,
            first > 0 and self.is_lead[arcs[first - 1]],
        )

    def ends_on(self, walks: list[_Walk]) -> list[_End]:
        """What lines lose and get at the end of each walk."""
        found = []
        for walk, strips in zip(walks, self._strips(walks), strict=True):
            at = self._place(walk, strips)
            if at < 0 or (at == 0 and not walk.added and (walk.is_lead or not walk.dropped)):
                found.append(_End())  # the middle of a fork is an end
            else:
                found.append(_End(walk.dropped + max(at - len(walk.added), 0), tuple(walk.added[at:])))
        return found

    def _strips(self, walks: list[_Walk]) -> list[list[int]]:
        """Where the discs one and two radii on, and three if it is long before, are about as large."""
        sizes = np.array([len(walk.nodes) for walk in walks], dtype=np.int64)
        start, walk = starts_of(sizes), owners(sizes)
        if not len(walk):
            return [[]] * len(walks)
        nodes = np.concatenate([np.array(walk.nodes, dtype=np.intp) for walk in walks])
        arcs = np.concatenate([np.array([*walk.arcs, -1][: len(walk.nodes)], dtype=np.intp) for walk in walks])
        radius = self.radius[nodes]
        some = np.flatnonzero(sizes)
        unit = np.repeat(np.maximum.reduceat(radius, start[some]), sizes[some])  # far from other walks nothing is lost
        radius, ways = radius / unit, np.where(arcs < 0, 8.0, self.length[arcs] / unit)
        depth = np.concatenate([[0.0], np.cumsum(ways)[:-1]])
        begin, end = depth[start[walk]], depth[start[walk + 1] - 1]
        found = (radius > 0) & (depth + 2 * radius <= end)
        for far in (1, 2, 3):
            place = depth + far * radius
            after = np.clip(np.searchsorted(depth, place), 1, len(depth) - 1)
            step = depth[after] - depth[after - 1]
            part = np.divide(place - depth[after - 1], step, out=np.zeros_like(step), where=step > 0)
            off = np.abs(radius[after - 1] + part * (radius[after] - radius[after - 1]) - radius)
            found &= (off <= SAME * radius) | ((far > 2) & (depth - begin <= 2 * radius))
        at = np.flatnonzero(found)
        return [part.tolist() for part in np.split(at - start[walk[at]], np.searchsorted(at, start[1:-1]))]

    def _farthest(self, node: int, inner: int) -> list[tuple[int, int]]:
        """The way to the farthest leaf beyond a node, from there: arcs and their outer nodes."""
        order, todo = {}, [(arc, node, 0.0) for arc in self.at(node) if arc != inner]
        far = {node: 0.0}
        while todo:
            arc, before, way = todo.pop()
            outer = self.both[arc] - before
            if outer in far:
                continue
            far[outer], order[outer] = way + self.reaches.length[arc], (arc, before)
            todo += [(to, outer, far[outer]) for to in self.at(outer) if to != arc]
        at, found = max(far, key=lambda k: far[k]), []
        while at != node:
            found.append((order[at][0], at))
            at = order[at][1]
        return found

    def _place(self, walk: _Walk, strips: list[int]) -> int:
        """Which of some nodes of a walk is the innermost one that has all of an end beyond, or -1."""
        nodes, arcs, own, found = walk.nodes, walk.arcs, self.reaches.own, -1
        most = max((own[nodes[at]] for at in strips), default=0.0)
        farthest, branch, bump = 0.0, 0.0, BUMP / TIP
        is_strip = set(strips)
        for at in range(strips[-1] + 1 if strips else 0):
            node, inner, outer = nodes[at], arcs[at], arcs[at - 1] if at else -1
            if at:
                farthest, branch = self.reaches.over(outer, nodes[at - 1], farthest, branch)
            farthest = max(farthest, own[node])
            for arc in self.at(node):
                if arc not in (inner, outer):
                    reach, beyond = self._beyond(arc, node, most)
                    farthest, branch = max(farthest, reach), max(branch, beyond)
            if farthest > most or branch > bump * most:
                break
            if farthest <= own[node] and branch <= bump * own[node] and at in is_strip:
                found = at
        return found

    def _beyond(self, arc: int, node: int, most: float) -> tuple[float, float]:
        """The reach of what hangs on a node, and the longest branch there; infinite where it is no piece."""
        leaf = self.both[arc] - node
        if self.start[leaf + 1] - self.start[leaf] == 1:  # most are
            return self.reaches.over(arc, leaf, self.reaches.own[leaf], 0.0)
        order, todo, seen = [], [(arc, node, 0.0)], {node}
        while todo:
            arc, inner, before = todo.pop()
            outer, far = self.both[arc] - inner, before + self.reaches.length[arc]
            if outer in seen or far + self.reaches.own[outer] > most:
                return inf, inf
            seen.add(outer)
            order.append((arc, outer, inner))
            todo += [(to, outer, far) for to in self.at(outer) if to != arc]
        found: dict[int, tuple[float, float]] = {}
        for arc, outer, inner in reversed(order):
            reach, beyond = self.reaches.over(arc, outer, *found.get(outer, (self.reaches.own[outer], 0.0)))
            far, branch = found.get(inner, (0.0, 0.0) if inner == node else (self.reaches.own[inner], 0.0))
            found[inner] = max(far, reach), max(branch, beyond)
        return found[node]
