"""Walks around skeletons: along each arc on both sides, from site to site."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.skeleton.clearance import SitePlaces
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Indices, connected_roots, following, mask_of, owners, ranks_of
from vorotool.numeric.curves.inverse_functions import angle_of
from vorotool.types.skeleton.segment_voronoi import EDGE
from vorotool.types.skeleton.skeleton import Skeleton


@frozen(eq=False)
class Contours:
    """Closed walks with the arcs on their left, as runs: arcs in a row that have one site on the right."""

    start: Indices  # (c + 1,) int64 array: the first run of each contour
    site: NDArray[np.int32]  # (n,) int32 array: of each run
    first_node: Indices  # (n,) int64 array: where each run begins, a place about its middle, and where it ends
    middle_node: Indices  # (n,) int64 array: where each run begins, a place about its middle, and where it ends
    last_node: Indices  # (n,) int64 array: where each run begins, a place about its middle, and where it ends
    # (n,) bool array: whether the site of the next run is a vertex at the end of this one's, or the other way round:
    # then the border goes on from one to the other without a gap
    is_joined: NDArray[np.bool_]
    point: Indices  # (n,) int64 array: a number for the place of a vertex; equal places have the same. -1 for an edge
    # (n,) int64 array: the number of the end that the site has in common with that of the next run, if both are
    # edges; else -1
    shared_point: Indices
    polygon: Indices  # (c,) int64 array: the polygon of each contour, and the connected part of the skeleton
    part: Indices  # (c,) int64 array: the polygon of each contour, and the connected part of the skeleton

    @property
    def after(self) -> Indices:
        """(n,) the run after each."""
        return following(self.start)

    @property
    def before(self) -> Indices:
        """(n,) the run before each."""
        previous = np.arange(-1, len(self.site) - 1)
        previous[self.start[:-1]] = self.start[1:] - 1
        return previous


def contours_of(skeleton: Skeleton, arcs: Indices) -> Contours:
    """Walk around some arcs of a skeleton; arcs that end in a corner (radius 0) end there, whatever they share."""
    walk = _HalfEdges(skeleton, arcs)
    order, begin = _cycles(walk)
    site = walk.site[order]
    new = np.append(True, site[1:] != site[:-1])[: len(order)]
    new[begin[:-1]] = True
    runs = np.flatnonzero(new)
    start = np.searchsorted(runs, begin)
    last = np.append(runs[1:], len(order))[: len(runs)] - 1
    after = following(start)
    ends = walk.site_points[site[runs]]
    is_edge = skeleton.site_table.kind[site[runs]] == EDGE
    shared = _shared_points(ends, ends[after])
    both = is_edge & is_edge[after]
    return Contours(
        start,
        site[runs],
        walk.tail[order[runs]],
        walk.head[order[(runs + last) // 2]],
        walk.head[order[last]],
        (shared >= 0) & (is_edge != is_edge[after]),
        np.where(is_edge, -1, ends[:, 0]),
        np.where(both, shared, -1),
        walk.polygon[order[begin[:-1]]],
        walk.part[order[begin[:-1]]],
    )


class _HalfEdges:
    """Arcs in both directions, one after the other: half-edge 2k along arc k, 2k + 1 back."""

    def __init__(self, skeleton: Skeleton, arcs: Indices) -> None:
        self.skeleton = skeleton
        ends = skeleton.arcs[arcs].astype(np.int64)
        self.tail, self.head = ends.reshape(-1), ends[:, ::-1].reshape(-1)
        self.site = skeleton.sites[arcs][:, ::-1].reshape(-1)
        self.polygon = np.repeat(skeleton.polygon[arcs].astype(np.int64), 2)
        self.site_points = site_points(skeleton)
        self.is_corner = skeleton.radius == 0
        # at corners arcs have nothing in common
        own = np.arange(len(self.tail)) + len(skeleton.vertices)
        tail, head = (
            np.where(self.is_corner[self.tail], own, self.tail),
            np.where(self.is_corner[self.head], own, self.head),
        )
        self.part = connected_roots(np.stack([tail, head], axis=1), len(skeleton.vertices) + len(own))[tail]

    def following(self) -> Indices:
        """The half-edge after each: around its head to the first one counter-clockwise, which has the same site."""
        twin = np.arange(len(self.tail)) ^ 1
        lone = self.is_corner[self.head] | (np.bincount(self.head, minlength=len(self.is_corner))[self.head] == 1)
        following = np.where(lone, twin, -1)
        points = self.site_points[self.site]
        is_edge = self.skeleton.site_table.kind[self.site] == EDGE
        none = np.full_like(points, -1)
        for into, out in (
            (self.site[:, None], self.site[:, None]),
            (np.where(is_edge[:, None], none, points), np.where(is_edge[:, None], points, none)),
            (np.where(is_edge[:, None], points, none), np.where(is_edge[:, None], none, points)),
        ):
            self._match(following, into, out)
        self._match_by_angle(following)
        return following

    def _match(self, following: Indices, into: NDArray[np.integer], out: NDArray[np.integer]) -> None:
        """Join half-edges that have no follower with others that follow none, where they meet with a common key."""
        free, open_ = _unmatched(following)
        wanted, half_edge = _keyed(self.head, into, free)
        offered, partner = _keyed(self.tail, out, open_)
        order = np.argsort(offered, kind="stable")
        offered, partner = offered[order], partner[order]
        rank = np.minimum(np.searchsorted(offered, wanted), max(len(offered) - 1, 0))
        found = np.flatnonzero(offered[rank] == wanted) if len(offered) else np.empty(0, dtype=np.int64)
        half_edge, partner = half_edge[found], partner[rank[found]]
        _, first = np.unique(half_edge, return_index=True)
        half_edge, partner = half_edge[first], partner[first]
        _, first = np.unique(partner, return_index=True)
        following[half_edge[first]] = partner[first]

    def _match_by_angle(self, following: Indices) -> None:
        """Join what is left around each node: from the way back counter-clockwise to the next way out."""
        free, open_ = _unmatched(following)
        if not free.size:
            return
        half_edge = np.concatenate([open_, free])
        is_in = np.arange(len(half_edge)) >= len(open_)
        way_out = np.where(is_in, half_edge ^ 1, half_edge)
        angle, node = self._angles_out(way_out), self.tail[way_out]
        # a way back is after the way out at its angle: that is its last choice
        order = np.lexsort((is_in, angle, node))
        is_out, node = ~is_in[order], node[order]
        ways = np.flatnonzero(is_out)
        begin, end = (np.searchsorted(node[ways], node, side=side) for side in ("left", "right"))
        next_way = np.cumsum(is_out)
        chosen = ways[np.where(next_way < end, next_way, begin)[~is_out]]
        following[half_edge[order[~is_out]]] = half_edge[order[chosen]]

    def _angles_out(self, half_edges: Indices) -> NDArray[np.float64]:
        """The direction in which each half-edge leaves: between the ways to the feet, however short the arc is."""
        places, center = SitePlaces(self.skeleton), self.skeleton.vertices[self.tail[half_edges]]
        right, left = (_unit(places.feet(self.site[k], center) - center) for k in (half_edges, half_edges ^ 1))
        x, y = (left - right).T
        return angle_of(y, -x)


def _unit(way: NDArray[np.float64]) -> NDArray[np.float64]:
    return way / np.sqrt((way * way).sum(axis=1, keepdims=True))


def _unmatched(following: Indices) -> tuple[Indices, Indices]:
    """Half-edges that have no follower, and those that follow none."""
    is_taken = mask_of(following[following >= 0], len(following))
    return np.flatnonzero(following < 0), np.flatnonzero(~is_taken)


def _keyed(node: Indices, keys: NDArray[np.integer], chosen: Indices) -> tuple[Indices, Indices]:
    """A number for each pair of a node and a key of chosen half-edges, and the half-edge."""
    columns = keys[chosen].astype(np.int64)
    numbers = (node[chosen, None] << 32) + columns
    return numbers[columns >= 0], np.broadcast_to(chosen[:, None], columns.shape)[columns >= 0]


def _cycles(walk: _HalfEdges) -> tuple[Indices, Indices]:
    """Half-edges contour by contour, each from the beginning of a run if there are several; where each begins."""
    following = walk.following()
    previous = ranks_of(following, len(following))
    starts = np.flatnonzero(walk.site != walk.site[previous]).tolist()
    step = following.tolist()
    seen = bytearray(len(step))
    order: list[int] = []
    begin = [0]
    for first in (*starts, *range(len(step))):
        if seen[first]:
            continue
        half_edge = first
        while not seen[half_edge]:
            seen[half_edge] = 1
            order.append(half_edge)
            half_edge = step[half_edge]
        begin.append(len(order))
    return np.array(order, dtype=np.int64), np.array(begin, dtype=np.int64)


def _shared_points(a: Indices, b: Indices) -> Indices:
    """The point that two sites have in common, -1 for none."""
    shared = np.full(len(a), -1)
    for i in (1, 0):
        for j in (1, 0):
            shared = np.where(a[:, i] == b[:, j], a[:, i], shared)
    return shared


def site_points(skeleton: Skeleton) -> Indices:
    """(s, 2) numbers of the places of both ends of each site; those of a vertex are equal."""
    places = skeleton.site_ends.reshape(-1, 2) + 0.0  # no -0
    if skeleton.features == "separate":
        feature = skeleton.polygons.feature
        places = np.column_stack([np.repeat(feature[skeleton.site_table.polygon], 2), places])
    _, number = np.unique(places, axis=0, return_inverse=True)
    return number.reshape(-1, 2)


def repeats(point: Indices, start: Indices) -> NDArray[np.bool_]:
    """(c,) whether each contour visits a point twice."""
    contour = owners(np.diff(start))
    known = np.flatnonzero(point >= 0)
    known = known[np.lexsort((point[known], contour[known]))]
    twice = (np.diff(point[known]) == 0) & (np.diff(contour[known]) == 0)
    return mask_of(contour[known[1:][twice]], len(start) - 1)


def cut_at_repetitions(names: list[int]) -> list[list[int]]:
    """Indices of each part of a closed walk between two visits of one name; -1 is no name."""
    parts: list[list[int]] = []
    path: list[int] = []
    at: dict[int, int] = {}
    for index, name in enumerate(names):
        if name in at:
            cut = at[name]
            parts.append(path[cut:])
            for passed in path[cut:]:
                at.pop(names[passed], None)
            del path[cut:]
        if name >= 0:
            at[name] = len(path)
        path.append(index)
    return [*parts, path]
