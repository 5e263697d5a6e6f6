"""Lines extended from ends inside a polygon to its boundary: to the middle of the end ahead, or straight on."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt
from typing import Unpack

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.common import nearest_on_segments, twice_areas
from vorotool.engines.from_skeleton.points_along import first_crossings, first_hits
from vorotool.engines.pruning.pruning import prune
from vorotool.engines.skeleton.parts import with_arcs
from vorotool.frozen import frozen
from vorotool.numeric.arrays import (
    Booleans,
    Floats,
    Numbers,
    connected_roots,
    crosses,
    dots,
    mask_of,
    norms,
    owners,
    starts_of,
    within,
)
from vorotool.numeric.parallel import Progress, Run
from vorotool.types.arguments import check_value
from vorotool.types.skeleton.lines import ExtendedSkeleton, LedOn
from vorotool.types.skeleton.segment_voronoi import EDGE
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton

TIP = sqrt(4 + 2 * sqrt(2))
"""1 over the sine of half of 45 degrees: the way along the bisector of such a corner in which radii fall by 1."""

HAIR = 2.0**-6
"""In radii of the disc that a piece hangs on: branches that are shorter cannot be seen."""


def without_end_pieces(skeleton: Skeleton, **run: Unpack[Run]) -> Skeleton:
    """Leave out the pieces at the ends of branches."""
    is_removed, roots, lone = _end_pieces(skeleton)
    kept, arcs = ~is_removed, skeleton.arcs.copy()
    length, control = skeleton.length.copy(), skeleton.control.copy()
    kept[lone], length[lone], control[lone] = True, 0, np.nan
    arcs[lone] = np.stack([roots, len(skeleton.vertices) + np.arange(len(roots))], axis=1)
    vertices = np.concatenate([skeleton.vertices, skeleton.vertices[roots]])
    radius = np.concatenate([skeleton.radius, skeleton.radius[roots]])
    made = replace(skeleton, vertices=vertices, radius=radius, arcs=arcs, length=length, control=control)
    # removes nothing, but makes one branch of two that meet
    return prune(with_arcs(made, kept), length=0, **run)


def _end_pieces(skeleton: Skeleton) -> tuple[Booleans, Numbers, Numbers]:
    """Find which arcs belong to ends; and the largest disc of each tree that is all one end, and an arc there."""
    count = len(skeleton.vertices)
    component = connected_roots(skeleton.arcs, count)
    roots = _roots(skeleton, component)
    is_fixed = skeleton.touches_frame if skeleton.border == "open" else np.zeros(count, dtype=bool)
    is_fixed[roots] = True
    is_removed = _removed(skeleton, is_fixed)
    is_left = mask_of(component[skeleton.arcs[~is_removed, 0]], count)
    lone = roots[~is_left[component[roots]]]
    first = np.full(count, -1, dtype=np.intp)
    first[skeleton.arcs.reshape(-1)[::-1]] = np.repeat(np.arange(len(skeleton)), 2)[::-1]
    return is_removed, lone, first[lone]


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


def _removed(skeleton: Skeleton, is_fixed: Booleans) -> Booleans:
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
        whole[outer] = whole[inner] or (is_piece and is_side and arms[inner] > 1 and not gone[inner])
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


def led_on(lines: LedOn, wanted: NDArray[np.bool_], *, to_middles: bool | NDArray[np.bool_]) -> Floats:
    """Lead ends of lines that are inside to the middle of the end ahead, or straight on."""
    path, ends = lines.path, lines.ends.copy()
    origin = path.vertices[lines.end_nodes]
    wanted = wanted & (path.radius[lines.end_nodes] > 0)
    if not wanted.any():
        return ends
    places = np.full((np.count_nonzero(wanted), 2), np.nan)
    is_led = (wanted & to_middles)[wanted]
    places[is_led] = end_middles(path, lines.end_nodes[wanted][is_led].astype(np.intp))
    rest = np.isnan(places[:, 0])
    way, origin = (origin - _places_before(lines))[wanted], origin[wanted]
    polygon = np.stack([lines.polygon] * 2, axis=1)[wanted]
    places[rest], _ = first_hits(path.polygons, polygon[rest], origin[rest], way[rest])
    ends[wanted] = places
    return ends


def _places_before(lines: LedOn) -> Floats:
    """(k, 2, 2) places on each path, one radius after its start and before its end, or its other end."""
    path, start = lines.path, lines.arc_starts
    along = np.concatenate([[0], np.cumsum(path.length)])
    first, last = along[start[:-1]], along[start[1:]]
    radius = path.radius[lines.end_nodes]
    position = np.stack([np.minimum(first + radius[:, 0], last), np.maximum(last - radius[:, 1], first)], axis=1)
    arc = np.clip(np.searchsorted(along, position, side="right") - 1, start[:-1, None], start[1:, None] - 1).reshape(-1)
    measures = path.measures(arc)
    places: Floats = measures.place(measures.parameter(position.reshape(-1) - along[arc]))
    return places.reshape(-1, 2, 2)


def rounded(lines: LedOn) -> tuple[Floats, Floats]:
    """Give nodes and ends to as many binary places as doubles have at the largest coordinate of their polygon."""
    polygons, path = lines.path.polygons, lines.path
    if not len(lines):
        return path.vertices, lines.ends
    largest = np.maximum.reduceat(np.abs(polygons.xy), polygons.ring_starts[polygons.polygon_starts[:-1]], axis=0)
    shift = 53 - np.frexp(largest.max(axis=1))[1]  # 53 binary places: the largest coordinates are what they were
    of_nodes = np.zeros(len(path.vertices), dtype=np.int64)
    of_nodes[path.arcs] = shift[path.polygon][:, None]

    def to_places(values: Floats, by: NDArray[np.integer]) -> Floats:
        return np.asarray(np.ldexp(np.rint(np.ldexp(values, by)), -by) + 0.0)

    return to_places(path.vertices, of_nodes[:, None]), to_places(lines.ends, shift[lines.polygon][:, None, None])


def extend_ends(skeleton: Skeleton, *, threads: int = 0, progress: Progress = None) -> ExtendedSkeleton:
    """Extend the ends of a skeleton to the boundary, so that it reaches the ends of strokes.

    First, the forks at the ends of strokes are left out, and the hooks that outlines of pixels make there: pieces
    whose radii fall as fast as into a corner of 45 degrees or more. No branch is left out, not even of a stroke on a
    blob: beyond each node of it the skeleton goes on for more than its own radius accounts for. Then each leaf that
    is inside is led on along a straight line to the middle of its end: the piece of outline between both sides of the
    stroke (see `vorotool.engines.centerlines.extended_ends`). Leaves at corners, of less than 45 degrees, stay; and so
    do single places that are left of round shapes.

    Parameters
    ----------
    skeleton : Skeleton
        Pruned or not. Its arcs inside polygons are used.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done of the pruning.

    Returns
    -------
    ExtendedSkeleton
        Branches with the places that they are extended to.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> skeleton = skeleton_exact([[0, 0], [6, 0], [6, 2], [0, 2]])
    >>> extend_ends(skeleton).flattened(0.1)[0].tolist()
    [[0.0, 1.0], [6.0, 1.0]]
    """
    check_value(skeleton, "skeleton", "Skeleton")
    inside = with_arcs(skeleton, skeleton.side == INTERIOR)
    stems = without_end_pieces(inside, threads=threads, progress=progress)
    count = int(stems.branch[-1]) + 1 if len(stems) else 0
    lines = ExtendedSkeleton(stems, np.full((count, 2, 2), np.nan))
    has_length = np.bincount(stems.branch, stems.length, count) > 0
    wanted = (stems.degree[lines.end_nodes] == 1) & has_length[:, None]
    lines = ExtendedSkeleton(stems, led_on(lines, wanted, to_middles=True))
    return ExtendedSkeleton(stems, rounded(lines)[1])


FLAT = 0.9
"""How far ahead the point half-way between shoulders is where an end is flat, as a part of the way to the outline. In a
semicircle it is at 0.7."""

SINGLE = 1.75
"""In radii of the leaf: an edge of pixels that is longer is no step, but nearly as long as the strip is wide."""

TIMES = 3
"""How often directions are taken."""


@frozen(eq=False)
class _Outlines:
    """The outline of each end: a place on a side, vertices of the polygon, a place on the other side."""

    start: Numbers  # (k + 1,) integer array: where the points of each begin
    points: Floats  # (n, 2) float64 array: from the leaf
    vertex: Numbers  # (n,) integer array: the vertices that points are, or at first places those before
    is_vertex: Booleans  # (n,) bool array: whether they are
    is_left: Booleans  # (k,) bool array: whether each turns to the left at corners that the inside goes into


def end_middles(skeleton: Skeleton, leaves: Numbers) -> Floats:
    """(k, 2) the middles of the ends of strips beyond leaves inside; NaN where there is none."""
    walks = Walks(skeleton, leaves)
    origin, arcs, at_target = skeleton.vertices[leaves], walks.arcs, walks.at_target
    sites = np.where(at_target[:, None], skeleton.sites[arcs], skeleton.sites[arcs][:, ::-1]).astype(np.intp)
    ways = walks.directions(is_smooth=skeleton.polygons.connectivity is None)
    places = np.full((len(arcs), 2), np.nan)
    table = skeleton.site_table
    own = (table.polygon[sites] == skeleton.polygon[arcs][:, None]).all(axis=1) & (ways != 0).any(axis=1)
    chosen = np.flatnonzero(own & (table.ring[sites[:, 0]] == table.ring[sites[:, 1]]))
    if len(chosen):
        outlines = _outlines(skeleton, sites[chosen], origin[chosen])
        to_middle, corners = _half_way(outlines, ways[chosen])
        if skeleton.polygons.connectivity is not None:  # of pixels: shoulders are steps
            _set_single_edges(outlines, skeleton.radius[leaves[chosen]], to_middle, corners)
        met = _met(skeleton, outlines, origin[chosen], to_middle, corners)
        is_round = dots(to_middle, to_middle) < FLAT * FLAT * dots(met - origin[chosen], met - origin[chosen])
        axis = _met(skeleton, outlines, origin[chosen], ways[chosen], corners)
        places[chosen] = np.where(is_round[:, None], axis, met)
    return places


# ---- outlines -------------------------------------------------------------------------------------
def _outlines(skeleton: Skeleton, sites: Numbers, origin: Floats) -> _Outlines:
    """Outlines in the order of their rings, from the one of two sites to the other."""
    nearest = nearest_on_segments(origin[:, None], *skeleton._ends_of(sites).transpose(2, 0, 1, 3))
    touched = nearest - origin[:, None]  # (k, 2, 2) on both sites
    polygons, table = skeleton.polygons, skeleton.site_table
    ring = table.rings(polygons, sites[:, 0])
    # what is inside is on the left of shells that go counterclockwise, and of holes that do not
    is_forward = (twice_areas(polygons.xy, polygons.ring_starts)[ring] > 0) == (table.ring[sites[:, 0]] == 0)
    order = np.where(is_forward[:, None], [1, 0], [0, 1])
    rows = np.arange(len(sites))[:, None]
    (begin, end), touched = sites[rows, order].T, touched[rows, order]
    size = np.diff(polygons.ring_starts)[ring]
    steps = (table.index[end].astype(np.intp) - table.index[begin]) % size
    count = np.maximum(steps - (table.kind[end] != EDGE), 0)
    start, outline, along = starts_of(count + 2), owners(count + 2), within(count + 2)
    vertex = polygons.ring_starts[ring][outline] + (table.index[begin][outline] + along) % size[outline]
    points = polygons.xy[vertex] - origin[outline]
    points[start[:-1]], points[start[1:] - 1] = touched[:, 0], touched[:, 1]
    is_vertex = np.ones(len(points), dtype=bool)
    is_vertex[start[:-1]] = is_vertex[start[1:] - 1] = False
    return _Outlines(start, points, vertex, is_vertex, is_forward)


# ---- shoulders ------------------------------------------------------------------------------------
def _half_way(outlines: _Outlines, ways: Floats) -> tuple[Floats, Numbers]:
    """(k, 2) points half-way between shoulders; and (k, 2) the points that both are, -1 where they are none."""
    axis = _unit(ways)
    for _ in range(TIMES):
        left = np.stack([-axis[:, 1], axis[:, 0]], axis=1)
        (one, at_one), (other, at_other) = (_shoulder(outlines, axis, side) for side in (left, -left))
        across = one - other
        normal = _unit(np.stack([across[:, 1], -across[:, 0]], axis=1))
        axis = _unit(axis + normal)
    return one / 2 + other / 2, np.stack([at_one, at_other], axis=1)


def _set_single_edges(outlines: _Outlines, radius: Floats, to_middle: Floats, corners: Numbers) -> None:
    """Take, where it is the only one, a long edge between corners that stick out."""
    way = np.diff(outlines.points, axis=0)
    turn = crosses(way[:-1], way[1:])
    outline = owners(np.diff(outlines.start))
    sticks_out = np.zeros(len(outlines.points), dtype=bool)
    sticks_out[1:-1] = outlines.is_vertex[1:-1] & (np.where(outlines.is_left[outline[1:-1]], turn, -turn) > 0)
    edge = np.flatnonzero(sticks_out[:-1] & sticks_out[1:])
    least = SINGLE * radius[outline[edge]]
    edge = edge[dots(way[edge], way[edge]) > least * least]
    edge = edge[np.bincount(outline[edge], minlength=len(radius))[outline[edge]] == 1]
    to_middle[outline[edge]] = outlines.points[edge] / 2 + outlines.points[edge + 1] / 2
    corners[outline[edge]] = np.stack([edge, edge + 1], axis=1)


def _shoulder(outlines: _Outlines, axis: Floats, side: Floats) -> tuple[Floats, Numbers]:
    """The shoulders on one side; and which points they are."""
    first, second = (_farthest(outlines, a * axis + b * side) for a, b in ((4, 3), (3, 4)))
    return outlines.points[first] / 2 + outlines.points[second] / 2, np.where(first == second, first, -1)


def _farthest(outlines: _Outlines, way: Floats) -> Numbers:
    """The point of each outline that is farthest in a direction, the first of several."""
    start, outline = outlines.start, owners(np.diff(outlines.start))
    reach = dots(outlines.points, way[outline])
    at = np.flatnonzero(reach == np.maximum.reduceat(reach, start[:-1])[outline])
    return at[np.diff(outline[at], prepend=-1) > 0]


def _unit(ways: Floats) -> Floats:
    size = norms(ways)[:, None]
    return np.divide(ways, size, out=np.zeros_like(ways), where=size > 0)


# ---- rays -----------------------------------------------------------------------------------------
def _met(skeleton: Skeleton, outlines: _Outlines, origin: Floats, way: Floats, corners: Numbers) -> Floats:
    """Where rays meet outlines first; midpoints of whole edges exactly."""
    polygons = skeleton.polygons
    edge = np.delete(np.arange(len(outlines.points)), outlines.start[1:] - 1)
    ray = owners(np.diff(outlines.start) - 1)
    at, met = first_crossings(ray, outlines.points[edge], outlines.points[edge + 1], way)
    places = np.full((len(way), 2), np.nan)
    hit = np.flatnonzero(met >= 0)
    places[hit] = origin[hit] + at[hit]
    one = edge[met[hit]]
    vertex = outlines.vertex[one]
    a, b = polygons.xy[vertex], polygons.xy[polygons.following[vertex]]
    places[hit] = np.where(a == b, a, places[hit])  # exactly on edges along an axis
    is_whole = (np.sort(corners[hit], axis=1) == np.stack([one, one + 1], axis=1)).all(axis=1)
    is_whole &= outlines.is_vertex[one] & outlines.is_vertex[np.minimum(one + 1, len(outlines.vertex) - 1)]
    places[hit[is_whole]] = a[is_whole] / 2 + b[is_whole] / 2
    return places


BACK = (0.0625, 0.125, 0.1875, 1.0)
"""In radii of the leaf: how far back directions are taken from. Nearer there are the corners of ends that are round."""


class Walks:
    """Walks from leaves to the first node that is no end of two arcs, or one radius far."""

    def __init__(self, skeleton: Skeleton, leaves: Numbers) -> None:
        self.skeleton, self.leaves = skeleton, leaves
        ends = skeleton.arcs.astype(np.intp)
        joined = np.zeros(len(skeleton.vertices), dtype=np.intp)  # the sum of the numbers of the arcs at each node
        np.add.at(joined, ends.reshape(-1), np.repeat(np.arange(len(ends)), 2))
        self.arcs = joined[leaves]
        self.at_target = ends[self.arcs, 1] == leaves
        at = self._places(ends, joined, np.outer(skeleton.radius[leaves], BACK).tolist())
        measures = skeleton.measures(at[:, 0].astype(np.intp))
        distance = np.minimum(at[:, 2], measures.length)
        parameter = measures.parameter(np.where(at[:, 1] > 0, distance, measures.length - distance))
        self.back = measures.place(parameter).reshape(len(leaves), len(BACK), 2).swapaxes(0, 1)

    def _places(self, ends: Numbers, joined: Numbers, wanted: list[list[float]]) -> Floats:
        """(4 k, 3) the arcs that places are on, whether these are gone through from their sources, and how far."""
        both, source = ends.sum(axis=1).tolist(), ends[:, 0].tolist()
        lengths, degree, others = self.skeleton.length.tolist(), self.skeleton.degree.tolist(), joined.tolist()
        found: list[tuple[int, bool, float]] = []
        for leaf, first, reaches in zip(self.leaves.tolist(), self.arcs.tolist(), wanted, strict=True):
            node, arc, far = leaf, first, 0.0
            for reach in reaches:
                while far + lengths[arc] < reach and degree[both[arc] - node] == 2:
                    far += lengths[arc]
                    node = both[arc] - node
                    arc = others[node] - arc
                found.append((arc, source[arc] == node, reach - far))
        return np.array(found, dtype=np.float64).reshape(-1, 3)

    def directions(self, *, is_smooth: bool) -> Floats:
        """(k, 2) where branches look at leaves, of any length."""
        straight = self.skeleton.vertices[self.leaves] - self.back[-1]
        if not is_smooth:
            return np.asarray(straight)
        ways = -np.diff(self.back, axis=0)
        size = norms(ways)
        is_long: Booleans = np.logical_and.reduce(size > 0)
        last, before, far = ways / np.where(is_long, size, 1)[:, :, None]
        # at 0.09375, 0.15625 and 0.59375 radii: the smaller bend of both, none if they differ in sign
        bends = crosses(before, last) / 0.0625, crosses(far, last) / 0.5
        bend = np.where(bends[0] * bends[1] > 0, np.minimum(*np.abs(bends)) * np.sign(bends[0]), 0.0)
        turned = last + 0.09375 * bend[:, None] * np.stack([-last[:, 1], last[:, 0]], axis=1)
        return np.where(is_long[:, None], turned, straight)
