"""A check of joined junctions that knows both skeletons' arrays only, not which junctions were merged."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.common import fail, first_wrong
from vorotool.engines.pruning.verify_pruning import PRECISION, are_parts, check_counts
from vorotool.types.arguments import check_value
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.skeleton.tables import branch_table


def verify_joining(joined: Skeleton, skeleton: Skeleton) -> None:
    """Check that a skeleton is another one with nearby junctions merged.

    Each arc is a part of an arc between the same sites, or it is straight, ends at a junction that there was with the
    same radius, is no longer than the radii at its ends together, and goes on from such a part or from a node that
    there was. There are as many connected parts, cycles and ends. Each junction that there was is still one, or in the
    disc of one that is at least as large; and no two are left that a branch joined that is shorter than the larger
    radius.

    Parameters
    ----------
    joined, skeleton : Skeleton
        The skeleton with merged junctions, and the original one.

    Raises
    ------
    VerificationError
        If a check fails; the message names the first fault.

    Examples
    --------
    >>> from vorotool import join_junctions, skeleton_exact
    >>> skeleton = skeleton_exact([[0, 0], [5, 0], [5, 4], [0, 4]])
    >>> verify_joining(join_junctions(skeleton), skeleton)
    >>> verify_joining(skeleton, skeleton)
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: branch 4 is 1.0 long, but the junctions that it joins are not merged
    """
    check_value(joined, "joined", "Skeleton")
    check_value(skeleton, "skeleton", "Skeleton")
    check_counts(joined, skeleton, "joined")
    ends, expected = (int(np.count_nonzero(value.degree == 1)) for value in (joined, skeleton))
    if ends != expected:
        fail(f"the joined skeleton has {ends} ends, not {expected}")
    left = _places(joined, joined.degree > 2)
    _check_arcs(joined, skeleton)
    _check_junctions(joined, skeleton, left)


def _places(skeleton: Skeleton, chosen: NDArray[np.bool_]) -> set[tuple[float, float, float]]:
    """Places and radii of nodes."""
    return set(zip(*skeleton.vertices[chosen].T.tolist(), skeleton.radius[chosen].tolist(), strict=True))


def _check_arcs(joined: Skeleton, skeleton: Skeleton) -> None:
    """Raise unless arcs are parts of arcs, or lead to a junction within the discs at their ends."""
    is_part = are_parts(joined, skeleton)
    known = _places(skeleton, skeleton.degree > 2)
    is_junction = np.array([node in known for node in _rows(joined)], dtype=bool)
    on_part = np.zeros(len(joined.vertices), dtype=bool)
    on_part[joined.arcs[is_part]] = True
    any_node = _places(skeleton, skeleton.degree > 0)
    on_part |= np.array([node in any_node for node in _rows(joined)], dtype=bool)
    a, b = joined.arcs.T
    leads = (is_junction[a] & on_part[b]) | (is_junction[b] & on_part[a])
    way = joined.vertices[b] - joined.vertices[a]
    length = np.sqrt((way * way).sum(axis=1))
    tolerance = PRECISION * float(
        np.abs(joined.vertices).max(initial=0.0) + np.abs(skeleton.polygons.xy).max(initial=0.0)
    )
    covered = length <= joined.radius[a] + joined.radius[b] + tolerance
    right = leads & covered & ~joined.is_parabola & (np.abs(joined.length - length) <= tolerance)
    if (at := first_wrong(~(is_part | right))) is not None:
        fail(f"arc {at} of the joined skeleton is not a part of an arc, and does not lead to a former junction")


def _rows(skeleton: Skeleton) -> list[tuple[float, float, float]]:
    return list(zip(*skeleton.vertices.T.tolist(), skeleton.radius.tolist(), strict=True))


def _check_junctions(joined: Skeleton, skeleton: Skeleton, left: set[tuple[float, float, float]]) -> None:
    """Raise unless junctions are left or in the disc of a larger one, and none are left that should be one."""
    nodes, rows = np.flatnonzero(skeleton.degree > 2), _rows(skeleton)
    is_left = np.zeros(len(skeleton.vertices), dtype=bool)
    is_left[nodes] = [rows[k] in left for k in nodes.tolist()]
    gone = nodes[~is_left[nodes]]
    if len(gone):
        import shapely

        own = np.flatnonzero(joined.degree > 2)
        tree = shapely.STRtree(shapely.points(skeleton.vertices[gone]))
        near = tree.query(shapely.points(joined.vertices[own]), predicate="dwithin", distance=joined.radius[own])
        held = np.zeros(len(gone), dtype=bool)
        larger = joined.radius[own[near[0]]] >= skeleton.radius[gone[near[1]]]
        held[near[1][larger]] = True
        if (at := first_wrong(~held)) is not None:
            place = tuple(skeleton.vertices[gone[at]].tolist())
            fail(f"the junction at {place} is missing, but lies in no disc of a larger remaining junction")
    table = branch_table(skeleton, threads=1)
    a, b = skeleton.branch_ends
    may_move = ~skeleton.touches_frame & (skeleton.radius > 0)
    larger = np.maximum(skeleton.radius[a], skeleton.radius[b])
    stays = is_left[a] & is_left[b] & may_move[a] & may_move[b] & (a != b) & (table["length"] < larger)
    if (at := first_wrong(stays)) is not None:
        fail(f"branch {at} is {table['length'][at]} long, but the junctions that it joins are not merged")
