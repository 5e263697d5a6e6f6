"""Pruning of skeletons: side branches whose significance is below a threshold are removed."""

from __future__ import annotations

from dataclasses import replace
from decimal import Decimal, localcontext
from functools import partial
from itertools import pairwise, starmap
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.skeleton.parts import core_skeleton, groups_of, pruned_part
from vorotool.errors import UsageError
from vorotool.numeric.arrays import Floats, owners, starts_of
from vorotool.numeric.checks import available_threads, checked_threads, is_choice
from vorotool.numeric.curves.inverse_functions import inverse_sine
from vorotool.numeric.numbers import distinct, finite_double, shown_number
from vorotool.numeric.parallel import Progress, in_threads
from vorotool.types.arguments import check_value
from vorotool.types.skeleton.skeleton import CRITERIA, ArcProfiles, CriticalValues, Skeleton

if TYPE_CHECKING:
    from vorotool.typing import Criterion


PART = 1 << 15
"""Arcs of a part or more: what is made of them stays in the cache."""

MASK_PRUNING = ("scale", 1.5)
"""Of outlines of pixels: see `default_pruning_for_masks`."""


def prune(
    skeleton: Skeleton,
    *,
    angle: float | None = None,
    chord: float | None = None,
    scale: float | None = None,
    length: float | None = None,
    ratio: float | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> Skeleton:
    """Prune the pieces of a skeleton whose significance is below a threshold.

    A piece hangs on a place p if it is all that the skeleton has beyond p. It goes if what the criterion tells of it is
    below the threshold, so that pieces may end inside an arc, which is cut there. No order of peeling is chosen: what
    is left for a higher threshold is a part of what is left for a lower one.

    Cycles, and what leads from one to another or to the frame, stay. A component without these keeps at least one
    place, as an arc of length 0: its end on the frame, if it has one; else where the angle or the chord is largest (of
    several the one with the largest radius),
    for `scale` the center of the largest disc, for `length` and `ratio` the middle of the longest path between leaves.
    "Beyond" is away from that place.

    Parameters
    ----------
    skeleton : Skeleton
        What to prune.
    angle : float
        In degrees, 0 to 180: pieces go in which centers see their two nearest places on the boundary under smaller
        angles: the separation angle, or twice the object angle.
    chord : float
        Pieces go in which these two places are less than this apart.
    scale : float
        At least 1: with all discs enlarged by this factor, pieces go whose discs lie in the disc of the place they hang
        on. This is the case for whole arcs or not at all, so that no arc is cut.
    length : float
        Pieces that hang on a junction go if their longest path to a leaf is shorter. No branch is cut.
    ratio : float
        Pieces that hang on a junction go if their longest path to a leaf is shorter than this many radii of the
        junction's disc. It is a measure without a unit that needs neither the boundary nor what else hangs there:
        the branch to a corner of 90 degrees has 1.41 if the disc of its junction touches both edges.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    Skeleton
        A part of the skeleton, with the same sites and polygons. It is connected where the skeleton is.

    Raises
    ------
    UsageError
        If not exactly one threshold is passed, or it is invalid.

    References
    ----------
    Angle: Attali and Montanvert, "Modeling noise for a better simplification of skeletons", ICIP 1996; Foskey, Lin and
    Manocha, "Efficient computation of a simplified medial axis", 2003. Chord: Malandain and Fernandez-Vidal,
    "Euclidean skeletons", Image and Vision Computing 16, 1998. Scale: after Giesen, Miklos, Pauly and Wormser, "The
    scale axis transform", SoCG 2009. Length and ratio: the extended distance function of Liu, Chambers, Letscher and
    Ju, "Extended grassfire transform on medial axes of 2D shapes", Computer-Aided Design 43, 2011, at junctions.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> skeleton = skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]])
    >>> pruned = prune(skeleton, angle=100)
    >>> pruned.vertices.tolist(), pruned.length.tolist()
    ([[1.0, 1.0], [3.0, 1.0]], [2.0])
    >>> len(prune(skeleton, scale=1.4)), len(prune(skeleton, scale=1.5))
    (5, 1)
    """
    check_value(skeleton, "skeleton", "Skeleton")
    given = {"angle": angle, "chord": chord, "scale": scale, "length": length, "ratio": ratio}
    thresholds = {name: value for name, value in given.items() if value is not None}
    if len(thresholds) != 1:
        raise UsageError(f"expected one threshold, but got {len(thresholds)}: give one of {', '.join(CRITERIA)}")
    ((criterion, threshold),) = thresholds.items()
    threshold = finite_double(threshold, criterion)
    check_threshold(criterion, threshold)
    compared = half_tangent(threshold) if criterion == "angle" else float(threshold)
    group = groups_of(skeleton)
    threads = checked_threads(threads) or available_threads()
    core = core_skeleton(skeleton, threads=threads, has_sites=criterion != "scale")
    tasks = [
        partial(pruned_part, skeleton, core, group, part, _core.pruning.Criterion[criterion], compared)
        for part in independent_parts(skeleton, group)
    ]
    made = [left for left, _, _ in in_threads(tasks, threads, progress)]
    columns: dict[str, Any] = {name: np.concatenate([part[name] for part in made]) for name in made[0]}
    part = owners([len(part["branch"]) for part in made])
    columns["arcs"] += starts_of([len(part["radius"]) for part in made]).astype(np.int32)[part, None]
    columns["branch"] += starts_of([int(part["branch"].max(initial=-1)) + 1 for part in made]).astype(np.int32)[part]
    return replace(skeleton, **columns)


def independent_parts(skeleton: Skeleton, group: NDArray[np.int32]) -> list[tuple[slice, slice]]:
    """Arcs and nodes of parts of a skeleton that have nothing in common; one if its groups are in no such order."""
    step = np.diff(group)
    starts = np.flatnonzero(step != 0) + 1
    wanted = np.searchsorted(starts, np.arange(PART, len(group), PART))
    inner = distinct(starts[wanted[wanted < len(starts)]])
    ends = skeleton.arcs.reshape(-1)
    cuts = np.concatenate([[0], inner])
    arcs = [*cuts.tolist(), len(group)]
    nodes = [0, len(skeleton.vertices)]
    if len(inner) and (step >= 0).all():
        least, most = np.minimum.reduceat(ends, 2 * cuts), np.maximum.reduceat(ends, 2 * cuts)
        if (least[1:] > most[:-1]).all():
            nodes[1:1] = least[1:].tolist()
    if len(nodes) < len(arcs):
        arcs = [0, len(group)]
    return list(zip(starmap(slice, pairwise(arcs)), starmap(slice, pairwise(nodes)), strict=True))


def critical_values(skeleton: Skeleton, criterion: Criterion, *, progress: Progress = None) -> CriticalValues:
    """Compute the smallest threshold that removes each point of a skeleton.

    Parameters
    ----------
    skeleton : Skeleton
        Of what.
    criterion : {"angle", "chord", "scale", "length", "ratio"}
        See `prune`.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    CriticalValues
        Of each arc and each vertex.

    Raises
    ------
    UsageError
        If the criterion is unknown.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> skeleton = skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]])
    >>> critical_values(skeleton, "ratio").most.round(9).tolist()
    [1.414213562, 1.414213562, 1.414213562, 1.414213562, inf]
    """
    check_value(skeleton, "skeleton", "Skeleton")
    if not is_choice(criterion, CRITERIA):
        raise UsageError(f"unknown criterion {shown_number(criterion)}: choose one of {', '.join(CRITERIA)}")
    ends, most, kept_arc, kept_place = _core.pruning.critical_values(
        core_skeleton(skeleton, has_sites=criterion != "scale"), _core.pruning.Criterion[criterion], progress
    )
    if criterion == "angle":
        ends, most = _doubled_degrees(ends), _doubled_degrees(most)
    return CriticalValues(criterion, ends, most, kept_arc, kept_place)


def arc_profiles(skeleton: Skeleton) -> ArcProfiles:
    """Compute the two nearest boundary points along each arc.

    Parameters
    ----------
    skeleton : Skeleton
        Of any side.

    Returns
    -------
    ArcProfiles
        One row an arc, in the order of the skeleton.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> arc_profiles(skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]])).kind.tolist()
    [0, 0, 0, 0, 0]
    """
    check_value(skeleton, "skeleton", "Skeleton")
    return ArcProfiles(*_core.pruning.arc_profiles(core_skeleton(skeleton)))


def default_pruning_for_masks() -> tuple[str, float]:
    """Name the criterion and the threshold that outlines of pixels are pruned by where nothing else is asked for."""
    return MASK_PRUNING


def check_threshold(criterion: str, threshold: float) -> None:
    """Raise UsageError for what is no threshold of a criterion."""
    least, most = {"angle": (0.0, 180.0), "scale": (1.0, np.inf)}.get(criterion, (0.0, np.inf))
    if not (least <= threshold <= most and np.isfinite(threshold)):
        limits = f"from {least:g} to {most:g}" if np.isfinite(most) else f"from {least:g}"
        raise UsageError(f"{criterion} is {shown_number(threshold)}: use a number {limits}")


_PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494")


def half_tangent(degrees: float) -> float:
    """Tangent of half an angle of at most 180 degrees, rounded once: libraries of functions differ in the last bit."""
    if degrees == 180:
        return np.inf
    with localcontext() as context:
        context.prec = 50
        x = Decimal(float(degrees)) * _PI / 360
        sine = cosine = Decimal(0)
        term = Decimal(1)
        for k in range(80):  # x^80 / 80! is below 1e-100
            if k % 2:
                sine += term if k % 4 == 1 else -term
            else:
                cosine += term if k % 4 == 0 else -term
            term *= x / (k + 1)
        return float(sine / cosine)


def _doubled_degrees(tangent: Floats) -> Floats:
    """Twice the angles of tangents, in degrees."""
    is_steep = tangent > 1
    with np.errstate(divide="ignore"):
        smaller = np.where(is_steep, 1 / tangent, tangent)
    angle = inverse_sine(smaller / np.sqrt(1 + smaller * smaller))
    return np.asarray(np.where(np.isinf(tangent), np.inf, 360 / np.pi * np.where(is_steep, np.pi / 2 - angle, angle)))
