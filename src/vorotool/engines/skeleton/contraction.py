"""Skeletons without arcs that rounding leaves no length of."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.skeleton.core_skeleton import core_skeleton
from vorotool.numeric.arrays import Indices
from vorotool.plain import plain
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.skeleton.tables import connected_roots


@plain(eq=False)
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
    source, target = skeleton.vertices[skeleton.arcs].swapaxes(0, 1)
    is_equal = (source == target).all(axis=1)
    if not is_equal.any():
        return None
    count = len(skeleton.vertices)
    root = connected_roots(skeleton.arcs[is_equal], count)
    is_single = _single_places(skeleton, is_equal)
    kept = np.flatnonzero(~is_equal | is_single)
    arcs = np.where(is_single[:, None], skeleton.arcs, root[skeleton.arcs]).astype(np.int32)
    radius = skeleton.radius.copy()
    np.maximum.at(radius, root, skeleton.radius)
    made, row, is_reversed = _numbered(_with(skeleton, kept, arcs=arcs, radius=radius))
    original = kept[row]
    number = np.full(len(skeleton), -1)
    number[original] = np.arange(len(original))
    beside = np.full(count, -1)
    for end in (0, 1):
        beside[root[skeleton.arcs[kept, end]]] = number[kept]
    number = np.where(number < 0, beside[root[skeleton.arcs[:, 0]]], number)
    return Contraction(made, original, is_reversed, number)


def _single_places(skeleton: Skeleton, is_equal: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(a,) the first arc of each connected part of which nothing has a length."""
    part = connected_roots(skeleton.arcs, len(skeleton.vertices))[skeleton.arcs[:, 0]]
    has_length = np.zeros(len(skeleton.vertices), dtype=bool)
    has_length[part[~is_equal]] = True
    first = np.zeros(len(skeleton), dtype=bool)
    first[np.unique(part, return_index=True)[1]] = True
    return first & ~has_length[part]


def _with(skeleton: Skeleton, kept: Indices, *, arcs: NDArray[np.int32], radius: NDArray[np.float64]) -> Skeleton:
    """Some arcs, which end at other nodes."""
    names = ("control", "sites", "polygon", "side", "branch", "length", "error_bound")
    columns: dict[str, Any] = {name: getattr(skeleton, name)[kept] for name in names}
    return replace(skeleton, **columns, arcs=arcs[kept], radius=radius)


def _numbered(skeleton: Skeleton) -> tuple[Skeleton, NDArray[np.int32], NDArray[np.bool_]]:
    """Number nodes and branches anew, and tell of each arc which it was, and whether it is reversed."""
    group = np.where(skeleton.polygon < 0, len(skeleton.polygons), skeleton.polygon).astype(np.int32)
    everything = slice(0, len(skeleton)), slice(0, len(skeleton.vertices))
    # pruning leaves out nothing that is shorter than 0
    length = _core.pruning.Criterion.length
    left: dict[str, Any] = _core.pruning.prune_skeleton(core_skeleton(skeleton), *everything, length, 0.0, group, None)
    original, is_reversed = left.pop("original"), left.pop("is_reversed") != 0
    for name in ("polygon", "side", "error_bound"):
        left[name] = getattr(skeleton, name)[original]
    sites = skeleton.sites[original]
    left["sites"] = np.where(is_reversed[:, None], sites[:, ::-1], sites)
    return replace(skeleton, **left), original, is_reversed
