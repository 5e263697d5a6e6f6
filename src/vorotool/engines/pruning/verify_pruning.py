"""A check of pruned skeletons that knows both skeletons' arrays only, not what was removed by which criterion."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.common import fail, first_wrong
from vorotool.numeric.arrays import Floats, owners, ranges
from vorotool.types.arguments import check_value
from vorotool.types.skeleton.arc_measures import ArcMeasures
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.skeleton.tables import connected_roots

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
    is_part = np.zeros(len(made), dtype=bool)
    is_part[own[_is_part(made, own, skeleton, other)]] = True
    return is_part


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
        way = part.place(on_part) - whole.place(on_whole)
        right &= np.sqrt((way * way).sum(axis=1)) <= tolerance
        right &= np.abs(part.radius(on_part) - whole.radius(on_whole)) <= tolerance
    # chords give the length of a part to a fraction that does not matter for whether it is the right one
    chord = np.sqrt(np.square(part.place(np.ones(len(own))) - part.place(np.zeros(len(own)))).sum(axis=1))
    right &= (part.length >= chord - tolerance) & (part.length <= whole.length + tolerance)
    return right


def _parameter_at(arcs: ArcMeasures, place: Floats) -> Floats:
    """Where each arc is nearest to a place on it, by Newton's method from a place beside it."""
    chord, bend = arcs.target - arcs.source, arcs.source - 2 * arcs.control + arcs.target
    # the parameter of a parabola is linear across its axis, which the bend is along
    is_bent = (bend * bend).sum(axis=1) > 2.0**-20 * (chord * chord).sum(axis=1)
    across = np.where(is_bent[:, None], np.stack([-bend[:, 1], bend[:, 0]], axis=1), chord)
    u = _ratio(((place - arcs.source) * across).sum(axis=1), (chord * across).sum(axis=1))
    for _ in range(_NEWTON_STEPS):
        way = arcs.control - arcs.source
        at = arcs.source + u[:, None] * (2 * way + u[:, None] * bend)
        speed = 2 * (way + u[:, None] * bend)
        u = u + _ratio(((place - at) * speed).sum(axis=1), (speed * speed).sum(axis=1))
    return np.clip(u, 0, 1)


def _ratio(a: Floats, b: Floats) -> Floats:
    return np.divide(a, b, out=np.zeros_like(a), where=b != 0)


def check_counts(made: Skeleton, skeleton: Skeleton, name: str) -> None:
    """Raise unless a skeleton that was made of another one has as many connected parts and cycles as that."""
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
