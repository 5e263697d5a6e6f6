"""A check of pruned skeletons that knows both skeletons' arrays only, not what was removed by which criterion."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.common import fail, first_wrong
from vorotool.numeric.arrays import Floats, connected_roots, dots, mask_of, norms, owners, ranges
from vorotool.numeric.lazy import shapely
from vorotool.types.arguments import check_value
from vorotool.types.skeleton.arc_measures import ArcMeasures
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.skeleton.tables import branch_table

PRECISION = 2.0**-40
"""Of the largest coordinate: how far places may be from the arc that they are a part of. A place on an arc is computed
with a dozen roundings of 2^-53; between the ends of an arc with a far control point it may move along by more."""

_NEWTON_STEPS = 3
"""From a place within a thousandth of the arc, each squares the error."""

_INSIDE = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Where arcs are looked at, by the parameter of the Bezier curve."""


def verify_pruning(pruned: Skeleton, skeleton: Skeleton) -> None:
    """Check that a skeleton is a pruned version of another.

    Each arc is a part of an arc between the same sites: five places on it, its radii and its length. There are as many
    connected parts as before, and as many independent cycles, on each side of each polygon.

    Parameters
    ----------
    pruned, skeleton : Skeleton
        The pruned and the original skeleton.

    Raises
    ------
    VerificationError
        If a check fails; the message names the first fault.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from vorotool import prune, skeleton_exact
    >>> skeleton = skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]])
    >>> pruned = prune(skeleton, chord=1)
    >>> verify_pruning(pruned, skeleton)
    >>> verify_pruning(replace(pruned, radius=pruned.radius + 1), skeleton)
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: arc 0 of the pruned skeleton is not a part of an arc between sites 4 and 7
    """
    check_value(pruned, "pruned", "Skeleton")
    check_value(skeleton, "skeleton", "Skeleton")
    check_counts(pruned, skeleton, "pruned")
    if (at := first_wrong(~are_parts(pruned, skeleton))) is not None:
        left, right = sorted(pruned.sites[at].tolist())
        fail(f"arc {at} of the pruned skeleton is not a part of an arc between sites {left} and {right}")


def are_parts(made: Skeleton, skeleton: Skeleton) -> NDArray[np.bool_]:
    """(a,) whether each arc of a skeleton is a part of an arc of another one, between the same sites."""
    own, other = _candidates(made, skeleton)
    return mask_of(own[_is_part(made, own, skeleton, other)], len(made))


def _candidates(pruned: Skeleton, skeleton: Skeleton) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Pairs of arcs of both skeletons that are between the same sites."""
    count = len(skeleton.site_table)

    def keys(sites: NDArray[np.int32]) -> NDArray[np.int64]:
        low, high = np.sort(sites.astype(np.int64), axis=1).T
        return np.asarray(low * count + high)

    known = keys(skeleton.sites)
    order = np.argsort(known, kind="stable")
    wanted = keys(pruned.sites)
    first = np.searchsorted(known[order], wanted)
    number = np.searchsorted(known[order], wanted, side="right") - first
    return owners(number), order[ranges(first, number)]


def _is_part(pruned: Skeleton, own: NDArray[np.intp], skeleton: Skeleton, other: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Of each pair whether the first arc lies on the second."""
    part, whole = pruned.measures(own), skeleton.measures(other)
    largest = float(np.abs(skeleton.vertices).max(initial=0.0)) + float(np.abs(skeleton.polygons.xy).max(initial=0.0))
    tolerance = PRECISION * (largest + np.abs(np.nan_to_num(skeleton.control[other])).max(axis=1, initial=0.0))
    u0, u1 = (_parameter_at(whole, part.place(np.full(len(own), end))) for end in (0.0, 1.0))
    right: NDArray[np.bool_] = skeleton.is_parabola[other] | ~pruned.is_parabola[own]
    for t in _INSIDE:
        on_part, on_whole = np.full(len(own), t), u0 + t * (u1 - u0)
        right &= norms(part.place(on_part) - whole.place(on_whole)) <= tolerance
        right &= np.abs(part.radius(on_part) - whole.radius(on_whole)) <= tolerance
    # chords give the length of a part to a fraction that does not matter for whether it is the right one
    chord = norms(part.place(np.ones(len(own))) - part.place(np.zeros(len(own))))
    right &= (part.length >= chord - tolerance) & (part.length <= whole.length + tolerance)
    return right


def _parameter_at(arcs: ArcMeasures, place: Floats) -> Floats:
    """Where each arc is nearest to a place on it, by Newton's method from a place beside it."""
    chord, bend = arcs.target - arcs.source, arcs.source - 2 * arcs.control + arcs.target
    # the parameter of a parabola is linear across its axis, which the bend is along
    is_bent = dots(bend, bend) > 2.0**-20 * dots(chord, chord)
    across = np.where(is_bent[:, None], np.stack([-bend[:, 1], bend[:, 0]], axis=1), chord)
    u = _ratio(dots(place - arcs.source, across), dots(chord, across))
    for _ in range(_NEWTON_STEPS):
        way = arcs.control - arcs.source
        at = arcs.source + u[:, None] * (2 * way + u[:, None] * bend)
        speed = 2 * (way + u[:, None] * bend)
        u = u + _ratio(dots(place - at, speed), dots(speed, speed))
    return np.clip(u, 0, 1)


def _ratio(a: Floats, b: Floats) -> Floats:
    return np.divide(a, b, out=np.zeros_like(a), where=b != 0)


def check_counts(made: Skeleton, skeleton: Skeleton, name: str) -> None:
    """Raise unless a skeleton that was made of another one has as many connected parts and cycles as that."""
    if len(made.polygons) != len(skeleton.polygons):
        fail(f"the {name} skeleton has another number of polygons: {len(made.polygons)}, not {len(skeleton.polygons)}")
    counts = [_counts(value) for value in (skeleton, made)]
    for what, before, after in zip(("connected parts", "cycles"), *counts, strict=True):
        if (at := first_wrong(before != after)) is not None:
            where = f"in polygon {at}" if at < len(skeleton.polygons) else "outside"
            fail(f"the {name} skeleton has {after[at]} {what} {where}, not {before[at]}")


def _counts(skeleton: Skeleton) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Connected parts and independent cycles in each polygon, the last ones outside."""
    groups = len(skeleton.polygons) + 1
    polygon = np.where(skeleton.polygon < 0, groups - 1, skeleton.polygon)
    of_node = np.full(len(skeleton.vertices), -1)
    of_node[skeleton.arcs] = polygon[:, None]
    used = of_node >= 0
    roots = connected_roots(skeleton.arcs, len(of_node)) == np.arange(len(of_node))
    parts = np.bincount(of_node[used & roots], minlength=groups)
    cycles = np.bincount(polygon, minlength=groups) - np.bincount(of_node[used], minlength=groups) + parts
    return parts, cycles


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
    on_part = mask_of(joined.arcs[is_part], len(joined.vertices))
    any_node = _places(skeleton, skeleton.degree > 0)
    on_part |= np.array([node in any_node for node in _rows(joined)], dtype=bool)
    a, b = joined.arcs.T
    leads = (is_junction[a] & on_part[b]) | (is_junction[b] & on_part[a])
    length = norms(joined.vertices[b] - joined.vertices[a])
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
