"""Junctions that a short branch joins are made one (``>-<`` becomes ``><``)."""

from __future__ import annotations

import heapq
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.skeleton.parts import PER_ARC, core_skeleton
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, Indices, norms, ranges, ranks_of
from vorotool.types.arguments import check_value
from vorotool.types.skeleton.segment_voronoi import EDGE
from vorotool.types.skeleton.skeleton import Skeleton

SNAP = 2.0**-30
"""Of an arc: what is cut as near to its end is cut there."""


def join_junctions(skeleton: Skeleton) -> Skeleton:
    """Merge junctions joined by branches shorter than the radius at the largest of them.

    A junction is a node where more than two arcs end. The largest one, of equally large ones that with the smallest
    (x, y), takes all that paths of junctions shorter than its radius lead to: they are in its disc. The others follow
    by size, with what is left. So no order of merging is chosen, and a row of side branches is not drawn into one place
    as a whole. The branches of these paths vanish; they never go around a hole, since a disc has none, and other
    branches between the same junctions stay as loops: there are as many connected parts, cycles and ends as before.

    The junction keeps its place and radius. Each branch that ended at another one is led to it by a straight arc, from
    where the branch is as far from its old end as that is from the new one: at most half of what the radii of both have
    beyond that distance, so that the arc is covered by the discs at its ends, and at most a third of the branch. Sites
    of such an arc are edges, at an end of which the nearest place may be; its radius is linear between its ends, and
    its `error_bound` tells how far it may be from the skeleton.

    Parameters
    ----------
    skeleton : Skeleton
        Mostly one that is pruned: side branches that do not matter have junctions as well.

    Returns
    -------
    Skeleton
        The same one if no branch is that short.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> skeleton = skeleton_exact([[0, 0], [5, 0], [5, 4], [0, 4]])
    >>> joined = join_junctions(skeleton)
    >>> sorted(skeleton.degree.tolist()), sorted(joined.degree[joined.degree != 2].tolist())
    ([1, 1, 1, 1, 3, 3], [1, 1, 1, 1, 4])
    >>> joined.vertices[joined.degree == 4].tolist()
    [[2.0, 2.0]]
    """
    check_value(skeleton, "skeleton", "Skeleton")
    branches = Branches.of(skeleton)
    place, vanishes = merged_junctions(skeleton, branches)
    if not vanishes.any():
        return skeleton
    return _led(skeleton, branches, place, vanishes)


@frozen(eq=False)
class Branches:
    """Where branches begin and end."""

    first: Indices  # (b,) int64 array: their arcs
    last: Indices  # (b,) int64 array: their arcs
    ends: Indices  # (2, b) int64 array: their nodes
    length: Floats  # (b,) float64 array: of them

    @classmethod
    def of(cls, skeleton: Skeleton) -> Branches:
        """Find them."""
        first = skeleton.branch_starts
        last = np.append(first, len(skeleton))[1:] - 1
        length = np.add.reduceat(skeleton.length, first) if len(first) else np.empty(0)
        return cls(first, last, skeleton.branch_ends.astype(np.int64), length)

    def short(self, skeleton: Skeleton) -> Indices:
        """Numbers of those that are shorter than the larger radius of the two junctions that they join."""
        a, b = self.ends
        can_move = (skeleton.degree > 2) & (skeleton.radius > 0) & ~skeleton.touches_frame
        larger = np.maximum(skeleton.radius[a], skeleton.radius[b])
        return np.flatnonzero(can_move[a] & can_move[b] & (a != b) & (self.length < larger))


def merged_junctions(skeleton: Skeleton, branches: Branches) -> tuple[Indices, NDArray[np.bool_]]:
    """(v,) the node that each node is merged into, mostly itself, and (b,) which branches vanish."""
    place, vanishes = np.arange(len(skeleton.vertices)), np.zeros(len(branches.first), dtype=bool)
    short = branches.short(skeleton)
    nodes = np.unique(branches.ends[:, short])
    x, y = skeleton.vertices[nodes].T
    nodes = nodes[np.lexsort((y, x, -skeleton.radius[nodes]))]
    rank = ranks_of(nodes, len(skeleton.vertices))
    beside: list[list[tuple[float, int, int]]] = [[] for _ in range(len(nodes))]
    pairs = rank[branches.ends[:, short]].T.tolist()
    for (a, b), length, branch in zip(pairs, branches.length[short].tolist(), short.tolist(), strict=True):
        beside[a].append((length, b, branch))
        beside[b].append((length, a, branch))
    owner = [-1] * len(nodes)
    for center, radius in enumerate(skeleton.radius[nodes].tolist()):
        if owner[center] < 0:
            owner[center] = center
            vanishes[_taken(center, radius, beside, owner)] = True
    place[nodes] = nodes[owner]
    return place, vanishes


def _taken(center: int, radius: float, beside: list[list[tuple[float, int, int]]], owner: list[int]) -> list[int]:
    """Give a junction those that shorter paths than a radius lead to, and tell the branches of these."""
    branches: list[int] = []
    paths = [(length, other, branch) for length, other, branch in beside[center] if length < radius]
    heapq.heapify(paths)
    while paths:
        far, node, branch = heapq.heappop(paths)
        if owner[node] >= 0:
            continue
        owner[node] = center
        branches.append(branch)
        for length, other, further in beside[node]:
            if owner[other] < 0 and far + length < radius:
                heapq.heappush(paths, (far + length, other, further))
    return branches


# ---- how branches are led to their new ends -------------------------------------------------------
@frozen(eq=False)
class _Cuts:
    """Where branches that are moved at one end are left for a straight arc."""

    end: int  # 0: the beginnings of branches; 1: their ends
    branch: Indices  # (k,) int64 array: which, and the arc that is the first, or the last, that is left
    arc: Indices  # (k,) int64 array: which, and the arc that is the first, or the last, that is left
    parameter: Floats  # (k,) float64 array: where on it
    junction: Indices  # (k,) int64 array: the new end

    @classmethod
    def at(cls, end: int, skeleton: Skeleton, branches: Branches, place: Indices, vanishes: NDArray[np.bool_]) -> _Cuts:
        """Find those at one end of all branches."""
        old = branches.ends[end]
        branch = np.flatnonzero((place[old] != old) & ~vanishes)
        old, new = old[branch], place[old[branch]]
        moved = norms(skeleton.vertices[new] - skeleton.vertices[old])
        room = (skeleton.radius[new] + skeleton.radius[old] - moved) / 2
        taken = np.minimum(np.minimum(moved, room), branches.length[branch] / 3)
        first, last = branches.first[branch], branches.last[branch]
        arc, distance = _along(skeleton, (first, last)[end], (last, first)[end], taken)
        measures = skeleton.measures(arc)
        u = measures.parameter(distance if end == 0 else measures.length - distance)
        is_first, is_last = u <= SNAP, u >= 1 - SNAP
        if end == 0:
            goes_on = is_last & (arc < last)
            arc, u = arc + goes_on, np.where(is_first | goes_on, 0.0, u)
        else:
            goes_on = is_first & (arc > first)
            arc, u = arc - goes_on, np.where(is_last | goes_on, 1.0, u)
        return cls(end, branch, arc, u, new)


def _along(skeleton: Skeleton, begin: Indices, stop: Indices, far: Floats) -> tuple[Indices, Floats]:
    """Which arc is so far along branches from one end, and how far that is along it; one branch matters to no other."""
    arcs, rests = [], []
    for arc, last, distance in zip(begin.tolist(), stop.tolist(), far.tolist(), strict=True):
        step, at, rest = 1 if last >= arc else -1, arc, distance
        while at != last and rest > (length := float(skeleton.length[at])):
            at, rest = at + step, rest - length
        arcs.append(at)
        rests.append(rest)
    arc_numbers = np.array(arcs, dtype=np.int64)
    return arc_numbers, np.minimum(np.array(rests, dtype=np.float64), skeleton.length[arc_numbers])


def _led(skeleton: Skeleton, branches: Branches, place: Indices, vanishes: NDArray[np.bool_]) -> Skeleton:
    """Leave branches out, and lead the others to the junctions that are left."""
    cuts = [_Cuts.at(end, skeleton, branches, place, vanishes) for end in (0, 1)]
    kept = np.ones(len(skeleton), dtype=bool)
    counts = branches.last - branches.first + 1
    kept[ranges(branches.first[vanishes], counts[vanishes])] = False
    for cut, begin in zip(cuts, (branches.first[cuts[0].branch], cuts[1].arc + 1), strict=True):
        stop = cut.arc if cut.end == 0 else branches.last[cut.branch] + 1
        kept[ranges(begin, stop - begin)] = False
    columns, nodes = _with_cuts(skeleton, cuts, branches)
    own = np.flatnonzero(kept)
    spokes = [_spokes(skeleton, cut, columns, at, place) for cut, at in zip(cuts, nodes, strict=True)]
    order = np.argsort(np.concatenate([4 * own + 2, *(4 * cut.arc + 1 + 2 * cut.end for cut in cuts)]), kind="stable")
    made: dict[str, Any] = {
        name: np.concatenate([columns[name][own], *(each[name] for each in spokes)])[order] for name in spokes[0]
    }
    _, made["branch"] = np.unique(made["branch"], return_inverse=True)
    used, first_use, ends = np.unique(made["arcs"], return_index=True, return_inverse=True)
    by_use = np.argsort(first_use, kind="stable")
    number = np.empty(len(used), dtype=np.int32)
    number[by_use] = np.arange(len(used))
    made |= {"arcs": number[ends.reshape(-1, 2)], "branch": made["branch"].reshape(-1).astype(np.int32)}
    return replace(skeleton, **made, vertices=columns["vertices"][used[by_use]], radius=columns["radius"][used[by_use]])


def _with_cuts(
    skeleton: Skeleton, cuts: list[_Cuts], branches: Branches
) -> tuple[dict[str, NDArray[Any]], list[Indices]]:
    """Columns of the arcs and nodes where arcs are cut, with new nodes, and the node at each cut."""
    names = ("vertices", "radius", *PER_ARC)
    columns: dict[str, NDArray[Any]] = {name: getattr(skeleton, name).copy() for name in names}
    span = np.tile([0.0, 1.0], (len(skeleton), 1))
    for cut in cuts:
        span[cut.arc, cut.end] = cut.parameter
    parts = np.flatnonzero((span != [0.0, 1.0]).any(axis=1))
    made = _core.pruning.part_geometry(core_skeleton(skeleton), parts.astype(np.int32), *span[parts].T.copy())
    columns["control"][parts], columns["length"][parts] = made["control"], made["length"]
    row = ranks_of(parts, len(skeleton))
    nodes = []
    for cut in cuts:
        outer = branches.first[cut.branch] if cut.end == 0 else branches.last[cut.branch]
        node = skeleton.arcs[cut.arc, cut.end].astype(np.int64)
        is_new = (cut.parameter != cut.end) | (cut.arc == outer)  # others are inside of their branch alone
        copies = np.flatnonzero(is_new)
        at = np.where(cut.parameter != cut.end, row[cut.arc], -1)[copies]
        name = ("first", "last")[cut.end]
        places, radius = skeleton.vertices[node[copies]].copy(), skeleton.radius[node[copies]].copy()
        places[at >= 0], radius[at >= 0] = made[name][at[at >= 0]], made[f"{name}_radius"][at[at >= 0]]
        node[copies] = len(columns["vertices"]) + np.arange(len(copies))
        columns["vertices"] = np.concatenate([columns["vertices"], places])
        columns["radius"] = np.concatenate([columns["radius"], radius])
        columns["arcs"][cut.arc, cut.end] = node
        nodes.append(node)
    return columns, nodes


def _spokes(
    skeleton: Skeleton, cut: _Cuts, columns: dict[str, NDArray[Any]], node: Indices, place: Indices
) -> dict[str, NDArray[Any]]:
    """Straight arcs between cuts and junctions, in the direction of their branches."""
    length = norms(columns["vertices"][cut.junction] - columns["vertices"][node])
    bound = np.zeros(len(place))
    for end in (0, 1):
        np.maximum.at(bound, skeleton.arcs[:, end], skeleton.error_bound)
    ends = np.stack([cut.junction, node] if cut.end == 0 else [node, cut.junction], axis=1)
    made = {name: getattr(skeleton, name)[cut.arc] for name in ("polygon", "side", "branch")}
    own = np.maximum(skeleton.error_bound[cut.arc], bound[cut.junction])
    return {
        **made,
        "arcs": ends.astype(np.int32),
        "control": np.full((len(ends), 2), np.nan),
        "sites": _edges_at(skeleton, skeleton.sites[cut.arc]),
        "length": length,
        # no place of it is farther from the nearer of its ends, which are on the skeleton
        "error_bound": own + np.nextafter(length, np.inf) / 2,
    }


def _edges_at(skeleton: Skeleton, sites: NDArray[np.int32]) -> NDArray[np.int32]:
    """Sites, where they are vertices the edges that begin there: those in one ring with the same index."""
    table = skeleton.site_table
    vertex = table.vertices(skeleton.polygons)
    edge = np.full(len(skeleton.polygons.xy), -1, dtype=np.int32)
    is_edge = table.kind == EDGE
    if table.ends is not None:
        is_edge &= np.isnan(table.ends[:, 0, 0])
    edge[vertex[is_edge]] = np.flatnonzero(is_edge)
    beside = edge[vertex[sites]]
    return np.where((table.kind[sites] == EDGE) | (beside < 0), sites, beside).astype(np.int32)
