"""The pieces of a skeleton that belong to its ends: forks, hooks, and others into corners of 45 degrees or more.

A piece hangs on a node p if it is all that the skeleton has beyond p. It belongs to an end if its radii fall as fast as
into a corner: no node q of it is farther from p, along the skeleton, than `TIP` times the difference of the radii of p
and q. The stem of a disc with a handle passes this test, too, since the disc is so much larger. But the radius of a
stem stays the same for a while. So a piece is a branch, and is kept, if from some place p' of it a node q beyond p' is
farther than ``(TIP + 1) * r(p') - TIP * r(q)``: where the radius is constant, if it is longer than half its width. It
must be longer than a part of the radius of p, too, or it is a hair of the outline.

Both tests take the largest ``d(p, q) + TIP * r(q)`` beyond each node, which a walk from the leaves inwards finds in
linear time. A tree is rooted at its largest disc.
"""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import numpy as np

from vorotool.engines.pruning.pruning import prune
from vorotool.engines.skeleton.parts import with_arcs
from vorotool.numeric.arrays import Booleans, Numbers
from vorotool.numeric.parallel import Progress
from vorotool.plain import plain
from vorotool.types.skeleton.skeleton import EDGE, INTERIOR, Skeleton
from vorotool.types.skeleton.tables import connected_roots

TIP = sqrt(4 + 2 * sqrt(2))
"""1 over the sine of half of 45 degrees: the way along the bisector of such a corner in which radii fall by 1."""

HAIR = 2.0**-6
"""In radii of the disc that a piece hangs on: branches that are shorter cannot be seen."""


def without_end_pieces(skeleton: Skeleton, *, threads: int = 0, progress: Progress = None) -> Skeleton:
    """Leave out the pieces at the ends of branches."""
    pieces = end_pieces(skeleton, keeps_sides=True)
    lone, roots = pieces.lone_arcs, pieces.lone_roots
    kept, arcs = ~pieces.is_removed, skeleton.arcs.copy()
    length, control = skeleton.length.copy(), skeleton.control.copy()
    kept[lone], length[lone], control[lone] = True, 0, np.nan
    arcs[lone] = np.stack([roots, len(skeleton.vertices) + np.arange(len(roots))], axis=1)
    vertices = np.concatenate([skeleton.vertices, skeleton.vertices[roots]])
    radius = np.concatenate([skeleton.radius, skeleton.radius[roots]])
    made = replace(skeleton, vertices=vertices, radius=radius, arcs=arcs, length=length, control=control)
    # removes nothing, but makes one branch of two that meet
    return prune(with_arcs(made, kept), length=0, threads=threads, progress=progress)


@plain(eq=False)
class EndPieces:
    """Which arcs belong to ends, and the trees of which nothing else is left."""

    is_removed: Booleans  # (a,) bool array: whether each arc belongs to an end
    lone_roots: Numbers  # (k,) integer array: the largest disc of each tree that is all one end, and an arc there
    lone_arcs: Numbers  # (k,) integer array: the largest disc of each tree that is all one end, and an arc there


def end_pieces(skeleton: Skeleton, *, keeps_sides: bool) -> EndPieces:
    """Find the arcs that belong to ends."""
    count = len(skeleton.vertices)
    component = connected_roots(skeleton.arcs, count)
    roots = _roots(skeleton, component)
    is_fixed = skeleton.touches_frame if skeleton.border == "open" else np.zeros(count, dtype=bool)
    is_fixed[roots] = True
    is_removed = _removed(skeleton, is_fixed, keeps_sides)
    is_left = np.zeros(count, dtype=bool)
    is_left[component[skeleton.arcs[~is_removed, 0]]] = True
    lone = roots[~is_left[component[roots]]]
    first = np.full(count, -1, dtype=np.intp)
    first[skeleton.arcs.reshape(-1)[::-1]] = np.repeat(np.arange(len(skeleton)), 2)[::-1]
    return EndPieces(is_removed, lone, first[lone])


def _roots(skeleton: Skeleton, component: Numbers) -> Numbers:
    """The largest disc of each tree, the first of several; trees with ends on an open border have none."""
    count = len(component)
    arcs = np.bincount(component[skeleton.arcs[:, 0]], minlength=count)
    nodes = np.bincount(component, minlength=count)
    is_tree = (arcs == nodes - 1) & (nodes > 1)
    if skeleton.border == "open":
        is_tree[component[skeleton.touches_frame]] = False
    own = np.flatnonzero(is_tree[component])
    own = own[np.lexsort((own, -skeleton.radius[own], component[own]))]
    return own[np.diff(component[own], prepend=-1) > 0]


def _removed(skeleton: Skeleton, is_fixed: Booleans, keeps_sides: bool) -> Booleans:
    """Find the arcs that belong to ends, by a walk from the leaves to nodes that are beyond no other."""
    arcs, count = skeleton.arcs.astype(np.intp), len(skeleton.vertices)
    degree = np.bincount(arcs.reshape(-1), minlength=count)
    joined = np.zeros(count, dtype=np.intp)  # the sum of the numbers of the arcs at each node that are left
    np.add.at(joined, arcs.reshape(-1), np.repeat(np.arange(len(arcs)), 2))
    order, is_end, is_long = _peeled(
        np.flatnonzero((degree == 1) & ~is_fixed).tolist(),
        (degree + 2 * is_fixed).tolist(),  # never 1
        joined.tolist(),
        arcs.sum(axis=1).tolist(),
        Reaches(skeleton),
    )
    arms = degree.tolist()  # how many arcs at each node are of no piece that hangs there
    for (_, _, inner), is_piece in zip(order, is_end, strict=True):
        arms[inner] -= is_piece
    gone, whole, is_removed = bytearray(count), bytearray(count), np.zeros(len(arcs), dtype=bool)
    for (arc, outer, inner), is_piece, is_side in zip(order[::-1], is_end[::-1], is_long[::-1], strict=True):
        whole[outer] = whole[inner] or (keeps_sides and is_piece and is_side and arms[inner] > 1 and not gone[inner])
        gone[outer] = is_removed[arc] = not whole[outer] and (is_piece or gone[inner])
    return is_removed


def _peeled(
    leaves: list[int], degree: list[int], joined: list[int], both: list[int], reaches: Reaches
) -> tuple[list[tuple[int, int, int]], list[bool], list[bool]]:
    """Take leaves off, as long as there are any."""
    own, radius, length = reaches.own, reaches.radius, reaches.length
    farthest, branch, longest = list(own), [0.0] * len(own), [0.0] * len(own)
    order, is_end, is_long = [], [], []
    while leaves:
        outer = leaves.pop()
        arc = joined[outer]
        inner = both[arc] - outer
        reach, beyond = reaches.over(arc, outer, farthest[outer], branch[outer])
        order.append((arc, outer, inner))
        is_end.append(beyond <= HAIR * radius[inner] and reach <= own[inner])
        path = longest[outer] + length[arc]
        is_long.append(path > 2 * radius[inner])
        longest[inner] = max(longest[inner], path)
        farthest[inner] = max(farthest[inner], reach)
        branch[inner] = max(branch[inner], beyond)
        joined[inner] -= arc
        degree[inner] -= 1
        if degree[inner] == 1:
            leaves.append(inner)
    return order, is_end, is_long


class Reaches:
    """How far pieces go on, and for how long their branches, on walks from leaves inwards."""

    def __init__(self, skeleton: Skeleton) -> None:
        self.radius, self.length = skeleton.radius.tolist(), skeleton.length.tolist()
        self.own = (TIP * skeleton.radius).tolist()
        self.necks = _necks(skeleton)

    def over(self, arc: int, outer: int, farthest: float, branch: float) -> tuple[float, float]:
        """The largest ``d(p, q) + TIP * r(q)`` and the longest branch as far as the inner end of an arc."""
        own = self.own[outer]
        if farthest > own + self.radius[outer] and farthest - own > branch:
            branch = farthest - own
        if arc in self.necks:
            source, to_neck, radius = self.necks[arc]
            at_neck = farthest + (to_neck if source == outer else self.length[arc] - to_neck)
            if at_neck > (TIP + 1) * radius:
                branch = max(branch, at_neck - TIP * radius)
        return farthest + self.length[arc], branch


def _necks(skeleton: Skeleton) -> dict[int, tuple[int, float, float]]:
    """Find the arcs inside whose radius is smallest between their ends: the source, the way from there, that radius."""
    is_curved = (skeleton.site_table.kind[skeleton.sites] != EDGE).any(axis=1)
    maybe = np.flatnonzero(is_curved & (skeleton.side == INTERIOR))
    measures = skeleton.measures(maybe)
    inside = np.flatnonzero((measures.slope0 < 0) & (measures.slope1 > 0))
    measures, arcs = measures[inside], maybe[inside]
    at = measures.slope0 / (measures.slope0 - measures.slope1)
    ways = zip(skeleton.arcs[arcs, 0].tolist(), (at * measures.length).tolist(), strict=True)
    radii = measures.radius(at).tolist()
    return {arc: (*way, radius) for arc, way, radius in zip(arcs.tolist(), ways, radii, strict=True)}
