"""Skeletons with some of their arcs or polygons, without arcs of no length, and as the core takes them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Indices, connected_roots, mask_of, norms, ranks_of
from vorotool.numeric.parallel import Progress
from vorotool.types.polygons.shapely_geometry import RingArrays
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton

PER_ARC = ("arcs", "control", "sites", "polygon", "side", "branch", "length", "error_bound")


def with_arcs(skeleton: Skeleton, kept: NDArray[np.bool_]) -> Skeleton:
    """Leave out arcs, and the nodes where then none ends; branches, which are left or left out, keep their order."""
    if kept.all():
        return skeleton
    columns: dict[str, Any] = {name: getattr(skeleton, name)[kept] for name in PER_ARC}
    nodes, ends = np.unique(columns["arcs"], return_inverse=True)
    _, branch = np.unique(columns["branch"], return_inverse=True)
    columns |= {"arcs": ends.reshape(-1, 2).astype(np.int32), "branch": branch.astype(np.int32)}
    return replace(skeleton, **columns, vertices=skeleton.vertices[nodes], radius=skeleton.radius[nodes])


def with_polygons(skeleton: Skeleton, chosen: NDArray[np.int64]) -> Skeleton:
    """Give what is inside some polygons, with the sites of these polygons."""
    polygons = skeleton.polygons
    if len(chosen) == len(polygons) and skeleton.site_table.ends is None:
        return with_arcs(skeleton, skeleton.polygon >= 0)
    number = ranks_of(chosen, len(polygons) + 1, np.int32)  # the last one is for -1
    made = with_arcs(skeleton, number[skeleton.polygon] >= 0)
    table = skeleton.site_table
    is_inside = number[table.polygon] >= 0
    if table.ends is not None:
        is_inside &= np.isnan(table.ends[:, 0, 0])
    sites = np.flatnonzero(is_inside)
    place = ranks_of(sites, len(table), np.int32)
    own = table.taken(sites)
    return replace(
        made,
        sites=place[made.sites],
        polygon=number[made.polygon],
        site_table=replace(own, polygon=number[own.polygon]),
        polygons=RingArrays.of(polygons).taken(chosen)[0].polygons(polygons, chosen),
    )


def outside_of(skeleton: Skeleton) -> Skeleton:
    """Give what is outside of all polygons, with the sites that this is made of."""
    made, table = with_arcs(skeleton, skeleton.polygon < 0), skeleton.site_table
    if table.ends is None:
        return made
    sites = np.flatnonzero(~np.isnan(table.ends[:, 0, 0]))
    place = ranks_of(sites, len(table), np.int32)
    return replace(made, sites=place[made.sites], site_table=table.taken(sites))


def with_straight_arcs(
    skeleton: Skeleton,
    places: NDArray[np.float64],
    radius: NDArray[np.float64],
    ends: NDArray[np.integer],
    sites: NDArray[np.integer],
    like: NDArray[np.integer],
) -> Skeleton:
    """Add nodes, and inside polygons straight arcs behind all others: a branch each, like another arc elsewise."""
    count = len(ends)
    vertices = np.concatenate([skeleton.vertices, places])
    return replace(
        skeleton,
        vertices=vertices,
        radius=np.concatenate([skeleton.radius, radius]),
        arcs=np.concatenate([skeleton.arcs, ends]),
        control=np.concatenate([skeleton.control, np.full((count, 2), np.nan)]),
        sites=np.concatenate([skeleton.sites, sites]),
        polygon=np.concatenate([skeleton.polygon, skeleton.polygon[like]]),
        side=np.concatenate([skeleton.side, np.full(count, INTERIOR, dtype=np.int8)]),
        branch=np.concatenate([skeleton.branch, skeleton.branch.max(initial=-1) + 1 + np.arange(count)]),
        length=np.concatenate([skeleton.length, norms(vertices[ends[:, 1]] - vertices[ends[:, 0]])]),
        error_bound=np.concatenate([skeleton.error_bound, skeleton.error_bound[like]]),
    )


def core_skeleton(skeleton: Skeleton, *, threads: int = 1, has_sites: bool = True) -> _core.skeleton.Skeleton:
    """The arrays of a skeleton, for the core; `scale` looks at no site."""
    return _core.skeleton.Skeleton(
        skeleton.vertices,
        skeleton.radius,
        skeleton.arcs,
        skeleton.control,
        skeleton.sites,
        skeleton.length,
        np.ascontiguousarray(skeleton.site_ends_on(threads).reshape(-1, 4)) if has_sites else None,
        skeleton.on_frame.view(np.uint8),
        skeleton.gap > 0,
        float(max(skeleton.vertices.max(initial=0), -skeleton.vertices.min(initial=0))),
    )


@frozen(eq=False)
class Contraction:
    """A skeleton after arcs between equal nodes were contracted."""

    skeleton: Skeleton  # the arcs that are left
    original: NDArray[np.integer]  # (a,) int array: the arc that each of them was before
    is_reversed: NDArray[np.bool_]  # (a,) bool array: whether it has changed its direction
    # (b,) int64 array: the number of each arc there was before; for a contracted arc that of an arc at its node
    number: Indices


def without_equal_nodes(skeleton: Skeleton) -> Skeleton:
    """Contract arcs whose two nodes have the same coordinates."""
    found = contraction(skeleton)
    return skeleton if found is None else found.skeleton


def contraction(skeleton: Skeleton) -> Contraction | None:
    """Contract arcs whose two nodes have the same coordinates, and number nodes and branches anew; None if none has."""
    (x, y), (source, target) = skeleton.vertices.T, skeleton.arcs.T
    equal = np.flatnonzero(x[source] == x[target])
    equal = equal[y[source[equal]] == y[target[equal]]]
    if not equal.size:
        return None
    is_equal = mask_of(equal, len(skeleton))
    count = len(skeleton.vertices)
    root = connected_roots(skeleton.arcs[is_equal], count)
    is_single = _single_places(skeleton, is_equal)
    kept = np.flatnonzero(~is_equal | is_single)
    arcs = np.where(is_single[:, None], skeleton.arcs, root[skeleton.arcs]).astype(np.int32)
    radius = skeleton.radius.copy()
    np.maximum.at(radius, root, skeleton.radius)
    columns: dict[str, Any] = {name: getattr(skeleton, name)[kept] for name in PER_ARC}
    made, row, is_reversed = _numbered(replace(skeleton, **(columns | {"arcs": arcs[kept], "radius": radius})))
    original = kept[row]
    number = ranks_of(original, len(skeleton))
    beside = np.full(count, -1)
    for end in (0, 1):
        beside[root[skeleton.arcs[kept, end]]] = number[kept]
    number = np.where(number < 0, beside[root[skeleton.arcs[:, 0]]], number)
    return Contraction(made, original, is_reversed, number)


def _single_places(skeleton: Skeleton, is_equal: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(a,) the first arc of each connected part of which nothing has a length."""
    part = connected_roots(skeleton.arcs, len(skeleton.vertices))[skeleton.arcs[:, 0]]
    has_length = mask_of(part[~is_equal], len(skeleton.vertices))
    first = mask_of(np.unique(part, return_index=True)[1], len(skeleton))
    return first & ~has_length[part]


def _numbered(skeleton: Skeleton) -> tuple[Skeleton, NDArray[np.int32], NDArray[np.bool_]]:
    """Number nodes and branches anew, and tell of each arc which it was, and whether it is reversed."""
    everything = slice(0, len(skeleton)), slice(0, len(skeleton.vertices))
    core, length = core_skeleton(skeleton), _core.pruning.Criterion.length
    # pruning leaves out nothing that is shorter than 0
    left, original, is_reversed = pruned_part(skeleton, core, groups_of(skeleton), everything, length, 0.0, None)
    return replace(skeleton, **left), original, is_reversed


def groups_of(skeleton: Skeleton) -> NDArray[np.int32]:
    """(a,) the polygon of each arc; their number outside."""
    return np.where(skeleton.polygon < 0, len(skeleton.polygons), skeleton.polygon).astype(np.int32)


def pruned_part(
    skeleton: Skeleton,
    core: _core.skeleton.Skeleton,
    group: NDArray[np.int32],
    part: tuple[slice, slice],
    criterion: _core.pruning.Criterion,
    threshold: float,
    progress: Progress,
) -> tuple[dict[str, Any], NDArray[np.int32], NDArray[np.bool_]]:
    """Prune some arcs and nodes: arrays of a skeleton, and of each arc which it was, and whether it is reversed."""
    arcs, _ = part
    left: dict[str, Any] = _core.pruning.prune_skeleton(core, *part, criterion, threshold, group, progress)
    original, is_reversed = left.pop("original"), left.pop("is_reversed") != 0
    for name in ("polygon", "side", "error_bound"):
        left[name] = getattr(skeleton, name)[arcs][original]
    sites = skeleton.sites[arcs][original]
    left["sites"] = np.where(is_reversed[:, None], sites[:, ::-1], sites)
    return left, original, is_reversed
