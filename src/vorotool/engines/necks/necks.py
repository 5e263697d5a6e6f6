"""Necks of polygons: where the clearance is least along the skeleton, and the largest clearances beside."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vorotool.engines.necks.axis import Ways, clearance_flow, ways_from_necks
from vorotool.engines.necks.feet import Feet, by_width, feet_of
from vorotool.engines.skeleton_api import skeleton_exact
from vorotool.errors import UsageError, option
from vorotool.numeric.arrays import Floats, Indices
from vorotool.numeric.numbers import finite_double, shown_number
from vorotool.numeric.parallel import Progress
from vorotool.plain import plain
from vorotool.types.polygons.input_vertices import moved_feet
from vorotool.types.skeleton.necks import Necks
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton

if TYPE_CHECKING:
    from vorotool.typing import FeaturesChoice, PolygonsLike


NARROW = 0.95
"""The ratio of `necks` by default: in bends of constant width each facet has a neck above 0.99."""


def necks(
    polygons: PolygonsLike | Skeleton,
    *,
    neck: float = NARROW,
    features: FeaturesChoice = "separate",
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Necks:
    """Find the necks of polygons: the points of the skeleton where the clearance is least in both directions.

    Inside an arc of the skeleton, or at a node of two arcs, the clearance grows both ways; the disc there touches the
    boundary at two opposite places, and the cut from one to the other is the shortest anywhere near. Between parallel
    edges the clearance stays the same on a whole line: then the cut is at the middle of this. All that decides where
    there are necks, and which is narrower, is exact.

    On either side of a neck the largest clearance is looked for, as far as no narrower neck has to be passed, or one
    that is as narrow and comes before it: small bumps in a corridor do not hide the rooms beyond. Around a hole both
    ways may lead to the same place. Necks that are hardly narrower than what is beside are left out, such as those at
    each vertex of a bend of constant width.

    Parameters
    ----------
    polygons : PolygonSet, shapely geometry, GeoSeries, GeoJSON, (n, 2) array, …, a list of these, or Skeleton
        As of :func:`vorotool.skeleton_exact`, or what that has made of the inside, not pruned and without a gap.
    neck : float
        The largest ratio, of half the width to the smaller of both clearances beside, from 0 to 1: 1 gives all necks.
    features : {"separate", "together"}
        Take each feature by itself, or all of them as one drawing.
    strict, threads, progress : optional
        As for :func:`vorotool.skeleton_exact`.

    Returns
    -------
    Necks
        Polygon by polygon, by x and then by y.

    Raises
    ------
    InputError
        As for :func:`vorotool.skeleton_exact`.
    UsageError
        If the ratio is not from 0 to 1, or the skeleton is approximate, pruned, or has a gap.

    Examples
    --------
    >>> dumbbell = [[0, 0], [4, 0], [4, 1], [6, 1], [6, 0], [10, 0], [10, 4], [6, 4], [6, 3], [4, 3], [4, 4], [0, 4]]
    >>> found = necks(dumbbell)
    >>> found.xy.tolist(), found.width.tolist(), found.ratio.tolist()
    ([[5.0, 2.0]], [2.0], [0.5])
    >>> len(necks(dumbbell, neck=0.4))
    0
    """
    check_neck(neck)
    skeleton = whole_skeleton(polygons, features=features, strict=strict, threads=threads, progress=progress)
    found = found_necks(skeleton, threads=threads, progress=progress).necks
    return found.taken(found.ratio <= neck)


def check_neck(neck: float) -> None:
    """Raise UsageError unless a ratio of necks is from 0 to 1."""
    ratio = finite_double(neck, "the ratio of necks")
    if not 0 <= ratio <= 1:
        raise UsageError(f"invalid {option('--neck', 'neck=')} {shown_number(neck)}: expected a ratio from 0 to 1")


def whole_skeleton(
    polygons: PolygonsLike | Skeleton,
    *,
    features: FeaturesChoice,
    strict: bool,
    threads: int,
    progress: Progress,
) -> Skeleton:
    """Give the skeleton inside polygons, which may be given themselves."""
    if not isinstance(polygons, Skeleton):
        return skeleton_exact(polygons, features=features, strict=strict, threads=threads, progress=progress)
    is_inside = polygons.side == INTERIOR
    ends = polygons.arcs[is_inside]
    is_cut = (polygons.radius[ends] > 0) & (polygons.degree[ends] == 1)
    if polygons.gap or polygons.error_bound.any() or is_cut.any() or not is_inside.all():
        raise UsageError(
            "necks need the whole skeleton inside polygons: give the polygons, or their skeleton_exact without "
            "pruning, gap or arcs outside"
        )
    return polygons


@plain(eq=False)
class FoundNecks:
    """Necks, and where the skeleton is to be cut for each."""

    necks: Necks  # in their order
    ways: Ways
    feet: Feet  # of each, left and right of its ways


def found_necks(skeleton: Skeleton, *, threads: int = 0, progress: Progress = None) -> FoundNecks:
    """Find the necks on a whole skeleton inside polygons."""
    flow = clearance_flow(skeleton, threads=threads, progress=progress)
    ways = ways_from_necks(skeleton, flow)
    feet = feet_of(skeleton, ways)
    x, y = feet.xy.mean(axis=1).T
    order = np.lexsort((ways.arc[:, 0], y, x, skeleton.polygon[ways.arc[:, 0]]))
    ways, feet = ways.taken(order), feet.taken(order)
    clearance = np.zeros(len(flow.top))
    np.maximum.at(clearance, flow.plateau, skeleton.radius)
    beside = largest_beside(ways.top, feet.square, clearance)
    # the foot with less x first
    given = moved_feet(skeleton, feet.site, feet.xy)
    (a, b), rows = given.swapaxes(0, 1), np.arange(len(ways))
    first = ((b[:, 0] < a[:, 0]) | ((b[:, 0] == a[:, 0]) & (b[:, 1] < a[:, 1]))).astype(np.int64)
    both = np.stack([first, 1 - first], axis=1)
    made = Necks(
        skeleton,
        ways.arc[:, 0].astype(np.int32),
        feet.xy.mean(axis=1),
        feet.width,
        given[rows[:, None], both],
        feet.site[rows[:, None], both].astype(np.int32),
        beside,
    )
    return FoundNecks(made, ways, feet)


def largest_beside(top: Indices, square: Indices, clearance: Floats) -> Floats:
    """(n, 2) the largest clearance on both sides of necks as far as no narrower one has to be passed, smaller first."""
    root, largest = list(range(len(clearance))), clearance.tolist()
    beside = np.empty((len(top), 2))
    pairs = top.tolist()
    for neck in by_width(square).tolist():
        a, b = (_found(root, place) for place in pairs[neck])
        beside[neck] = sorted((largest[a], largest[b]))
        root[b] = a
        largest[a] = max(largest[a], largest[b])
    return beside


def _found(root: list[int], place: int) -> int:
    """What a place is joined to; the way there gets shorter."""
    while root[place] != place:
        root[place] = root[root[place]]
        place = root[place]
    return place
