"""Twigs that a skeleton had before it was pruned: ends of the skeleton are told with all twigs, or not at all.

Around a junction the site on the left of each arc is that on the right of the next one. Where these are different edges
with a corner between them, the twig into that corner was pruned: as the disc of the junction touches both, it was the
straight line there. Where several convex corners are between them, all near the disc, a part of a round end was pruned.
Its own junctions are not known; they are near this one, and the twigs are as good from here.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.round_ends import NEAR
from vorotool.geometry.skeleton import EDGE, INTERIOR, Skeleton

Floats = NDArray[np.float64]
Numbers = NDArray[np.intp]
Booleans = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class _Sides:
    """Edges on one side of arcs around junctions that are on the other side of no arc there.

    Parameters
    ----------
    node, arc, site, vertex : (k,) integer array
        The junction, the arc, the edge, and the vertex where that begins.
    """

    node: Numbers
    arc: Numbers
    site: Numbers
    vertex: Numbers

    def __getitem__(self, chosen: NDArray[np.generic]) -> _Sides:
        return _Sides(*(values[chosen] for values in self.__dict__.values()))


@dataclass(frozen=True, eq=False)
class _Found:
    """Twigs that were pruned: where from, into which corner, and the sites left and right, looking there."""

    node: Numbers
    arc: Numbers
    corner: Numbers
    sites: Numbers


def with_pruned_twigs(skeleton: Skeleton) -> Skeleton:
    """Add the twigs that were pruned beside arcs that are left, behind all arcs; branches end where these begin.

    Parameters
    ----------
    skeleton : Skeleton
        Its arcs inside polygons are looked at. One that was not pruned is given back as it is.

    Examples
    --------
    >>> from vorotool import prune, skeleton_exact
    >>> skeleton = prune(skeleton_exact([[0, 0], [20, 0], [21, 4], [1, 4]]), scale=1.3)
    >>> made = with_pruned_twigs(skeleton)
    >>> len(skeleton), sorted(made.vertices[made.arcs[len(skeleton) :, 1]].tolist())
    (3, [[1.0, 4.0], [20.0, 0.0]])
    """
    if not len(skeleton):
        return skeleton
    found = _found(skeleton, *_sides(skeleton))
    return _with_twigs(skeleton, found) if len(found.node) else skeleton


def _sides(skeleton: Skeleton) -> tuple[_Sides, _Sides]:
    """Where gaps begin, counterclockwise around junctions: on the left of an arc; and where they end."""
    table, polygons = skeleton.site_table, skeleton.polygons
    inside = np.flatnonzero((skeleton.side == INTERIOR) & (skeleton.arcs[:, 0] != skeleton.arcs[:, 1]))
    degree = np.bincount(skeleton.arcs[inside].reshape(-1), minlength=len(skeleton.vertices))
    node = skeleton.arcs[inside].T.reshape(-1).astype(np.intp)
    arc = np.concatenate([inside, inside])
    left, right = (skeleton.sites[inside][:, order].T.reshape(-1).astype(np.intp) for order in ([0, 1], [1, 0]))
    keys = [node * len(table) + site for site in (left, right)]
    made = []
    for site, own, others in ((left, *keys), (right, *keys[::-1])):
        maybe = np.flatnonzero((degree[node] > 1) & (table.kind[site] == EDGE))
        chosen = maybe[~np.isin(own[maybe], others)]
        ring = polygons.polygon_start[table.polygon[site[chosen]]] + table.ring[site[chosen]]
        vertex = polygons.ring_start[ring] + table.index[site[chosen]]
        made.append(_Sides(node[chosen], arc[chosen], site[chosen], vertex.astype(np.intp)))
    return made[0], made[1]


def _found(skeleton: Skeleton, begins: _Sides, ends: _Sides) -> _Found:
    """Twigs in all gaps between near edges with convex corners between them, whichever way their rings go."""
    following = skeleton.polygons.following.astype(np.intp)
    before = np.empty_like(following)
    before[following] = np.arange(len(following))
    ends = ends[np.argsort(ends.node * len(following) + ends.vertex, kind="stable")]
    both = [_walked(skeleton, begins, ends, step, back) for step, back in ((following, before), (before, following))]
    return _Found(
        *(np.concatenate(columns) for columns in zip(*(found.__dict__.values() for found in both), strict=True))
    )


def _walked(skeleton: Skeleton, begins: _Sides, ends: _Sides, step: Numbers, back: Numbers) -> _Found:
    """Go from edge to edge from where each gap begins, while corners turn to the left, to where it ends."""
    xy, count, is_forward = skeleton.polygons.xy, len(step), bool(step[0] == skeleton.polygons.following[0])
    keys = np.append(ends.node * count + ends.vertex, -1)  # none is at the last place
    end_of = np.full(len(begins.node), -1)
    gap, edge = np.arange(len(begins.node)), begins.vertex
    rows = [np.empty((4, 0), dtype=np.intp)]  # the gap, the corner, and the edges before and behind it
    while len(gap):
        onward = step[edge]
        corner = onward if is_forward else edge
        is_convex = _turns_left(xy[back[corner]], xy[corner], xy[step[corner]])
        gap, edge, onward, corner = (values[is_convex] for values in (gap, edge, onward, corner))
        rows.append(np.stack([gap, corner, edge, onward]))
        key = begins.node[gap] * count + onward
        at = np.searchsorted(keys[:-1], key)
        is_end = keys[at] == key
        end_of[gap[is_end]] = at[is_end]
        on = np.flatnonzero(~is_end & (onward != begins.vertex[gap]))  # no more than once around
        on = on[_is_near(skeleton, begins.node[gap[on]], onward[on])]
        gap, edge = gap[on], onward[on]
    gap, corner, edge, onward = np.concatenate(rows, axis=1)
    known = np.flatnonzero(end_of[gap] >= 0)
    gap, corner, edge, onward = gap[known], corner[known], edge[known], onward[known]
    between, end = _sites_of_edges(skeleton), end_of[gap]
    right = np.where(edge == begins.vertex[gap], begins.site[gap], between[edge])
    left = np.where(onward == ends.vertex[end], ends.site[end], between[onward])
    return _Found(begins.node[gap], begins.arc[gap], corner, np.stack([left, right], axis=1))


def _turns_left(a: Floats, b: Floats, c: Floats) -> Booleans:
    (ux, uy), (vx, vy) = (b - a).T, (c - b).T
    is_left: Booleans = ux * vy - uy * vx > 0
    return is_left


def _is_near(skeleton: Skeleton, node: Numbers, edge: Numbers) -> Booleans:
    """Whether edges are no farther from nodes than a disc there reaches whose junction is near."""
    xy, place = skeleton.polygons.xy, skeleton.vertices[node]
    a, b = xy[edge], xy[skeleton.polygons.following[edge]]
    way, size = b - a, np.square(b - a).sum(axis=1)
    part = np.divide(((place - a) * way).sum(axis=1), size, out=np.zeros(len(edge)), where=size > 0)
    off = a + np.clip(part, 0, 1)[:, None] * way - place
    most = (1 + NEAR) * skeleton.radius[node]
    is_near: Booleans = np.square(off).sum(axis=1) <= most * most
    return is_near


def _sites_of_edges(skeleton: Skeleton) -> Numbers:
    """(n,) the site of the edge that begins at each vertex."""
    polygons, table = skeleton.polygons, skeleton.site_table
    sites = np.flatnonzero(table.kind == EDGE)
    ring = polygons.polygon_start[table.polygon[sites]] + table.ring[sites]
    found = np.zeros(len(polygons.xy), dtype=np.intp)
    found[polygons.ring_start[ring] + table.index[sites]] = sites
    return found


def _with_twigs(skeleton: Skeleton, found: _Found) -> Skeleton:
    """Straight lines into corners, each a branch; those that they leave are parted."""
    count, nodes = len(found.node), len(skeleton.vertices)
    is_parted = np.zeros(nodes, dtype=bool)
    is_parted[found.node] = True
    begins = (np.diff(skeleton.branch, prepend=-1) != 0) | is_parted[skeleton.arcs[:, 0]]
    branch = np.cumsum(begins) - 1
    corners = skeleton.polygons.xy[found.corner]
    way = corners - skeleton.vertices[found.node]
    return replace(
        skeleton,
        vertices=np.concatenate([skeleton.vertices, corners]),
        radius=np.concatenate([skeleton.radius, np.zeros(count)]),
        arcs=np.concatenate([skeleton.arcs, np.stack([found.node, nodes + np.arange(count)], axis=1)]),
        control=np.concatenate([skeleton.control, np.full((count, 2), np.nan)]),
        sites=np.concatenate([skeleton.sites, found.sites]),
        polygon=np.concatenate([skeleton.polygon, skeleton.polygon[found.arc]]),
        side=np.concatenate([skeleton.side, np.full(count, INTERIOR, dtype=np.int8)]),
        branch=np.concatenate([branch, branch.max(initial=-1) + 1 + np.arange(count)]),
        length=np.concatenate([skeleton.length, np.sqrt((way * way).sum(axis=1))]),
        error_bound=np.concatenate([skeleton.error_bound, skeleton.error_bound[found.arc]]),
    )
