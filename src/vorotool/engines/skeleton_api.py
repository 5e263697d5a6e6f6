"""Skeletons of polygons: exact ones (paper, section 3.2), and approximate ones (section 3.1)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vorotool.engines.sampled_skeleton.approximate import SamplingOptions
from vorotool.engines.sampled_skeleton.per_feature import approximation
from vorotool.engines.skeleton.diagrams import (
    diagram_of_all,
    is_of_single_features,
    skeleton_in,
    skeleton_inside,
)
from vorotool.engines.skeleton.exact import Frame, check_features, check_skeleton_options
from vorotool.engines.skeleton.open_border import check_border
from vorotool.geometry.arguments.boxes import as_extent
from vorotool.geometry.arguments.polygons import as_polygons
from vorotool.geometry.box import Box
from vorotool.geometry.checks import checked_flag, checked_threads
from vorotool.geometry.magnitude import check_lengths
from vorotool.geometry.progress import Progress
from vorotool.geometry.skeleton.skeleton import Skeleton

if TYPE_CHECKING:
    from vorotool.typing import FeaturesChoice, PolygonsLike, Sampling, Side


def skeleton_exact(
    polygons: PolygonsLike,
    *,
    side: Side = "interior",
    features: FeaturesChoice = "separate",
    gap: float = 0.0,
    complete: bool = True,
    frame: Box | Frame | None = None,
    border: Box | Frame | None = None,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Skeleton:
    """Compute the skeleton of polygons: where the nearest place on the boundary is not one alone.

    The polygons are placed on a lattice of 31 bits, and from there on every decision is exact: the Voronoi diagram of
    the vertices and open edges is made, and of its edges those between an edge and its own end are deleted. With holes
    the result is exact just the same. What is inside a feature, one item of the input with all its parts, is what it
    would be if there were no others: they may touch it, overlap it, or lie in it. What is outside is of all features.
    The skeleton of crack outlines goes through corners that pixels hang together at: see :func:`vorotool.outlines`.

    Parameters
    ----------
    polygons : PolygonSet, shapely geometry, GeoSeries, GeoDataFrame, GeoJSON, (n, 2) array, …, or a list of these
        An array is the shell of one polygon; a mapping has ``shell`` and ``holes``, or ``line``. Of a list each item is
        one feature, and so is each row.
    side : {"interior", "exterior", "both"}
        Inside polygons, outside all of them, or both.
    features : {"separate", "together"}
        Take each feature by itself, or all of them, and open lines among them, as boundaries of one diagram.
    gap : float
        Shorten each edge by so much at both ends, as the paper does (Figure 10): then nothing leads to the corners,
        and the result is no longer exact. The new ends go to the nearest points of the lattice.
    complete : bool
        With a gap, add the straight lines that lead from the skeleton to the corners.
    frame : Box or (x, y, w, h), optional
        Rectangle that arcs outside are cut by; by default the bounds and a tenth of their larger side around them.
    border : Box or (x, y, w, h), optional
        Rectangle that cuts the polygons, such as that of an image: where their edges are on its border they go on
        beyond it. These edges are no sites, so that the skeleton is that of the rest of the outline, cut by the
        rectangle: it runs to the border, and does not fork into the corners there. For what is inside features, each
        by itself, without a gap.
    strict : bool
        Refuse polygons that would be repaired.
    threads : int
        0 uses all.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    Skeleton
        Without arcs where there is no such side.

    Raises
    ------
    InputError
        If a coordinate is not finite or beyond the border, an edge is not longer than twice the gap, or `strict` and
        something would be repaired.
    UsageError
        If the side, the gap, the frame or the border is none, or there is a border with another side, with features
        together or with a gap.
    LimitError
        If there are too many vertices.

    Warns
    -----
    VorotoolWarning
        If polygons were repaired, or none has an inside and that is asked for.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 3.2.

    Examples
    --------
    >>> skeleton = skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]])
    >>> float(skeleton.radius.max()), round(float(skeleton.length.sum()), 9)
    (1.0, 7.656854249)
    >>> skeleton_exact([[0, 1], [4, 1], [4, 3], [0, 3]], border=(0, 0, 4, 4)).vertices.tolist()
    [[0.0, 2.0], [4.0, 2.0]]
    """
    frame = None if frame is None else as_extent(frame, "frame")
    border = None if border is None else as_extent(border, "border")
    check_skeleton_options(side, gap, frame)
    check_features(features)
    check_lengths(frame or (), "frame's coordinate")
    given = as_polygons(polygons)
    check_border(given, border, side=side, features=features, gap=gap)
    common: dict[str, Any] = {"threads": checked_threads(threads), "progress": progress}
    if is_of_single_features(side, features):
        return skeleton_inside(given, gap, complete=complete, border=border, strict=strict, **common).skeleton
    diagram = diagram_of_all(given, gap, features=features, interior_only=side == "interior", strict=strict, **common)
    return skeleton_in(diagram, side=side, features=features, complete=complete, frame=frame, **common)


def skeleton_approx(
    polygons: PolygonsLike,
    *,
    step: float | None = None,
    tolerance: float | None = None,
    sampling: Sampling | None = None,
    side: Side = "interior",
    features: FeaturesChoice = "separate",
    complete: bool | None = None,
    frame: Box | Frame | None = None,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Skeleton:
    """Approximate the skeleton of polygons by the Voronoi diagram of samples, with a certified error of every arc.

    The edges are sampled, and each seed has the labels of the edges that it is on. Of the Voronoi diagram of the seeds,
    the edges between seeds with a label in common are deleted, and those that the polygons cross. All that is decided
    exactly. No point of an arc is farther from the exact skeleton than its `error_bound`. What is inside a feature is
    what it would be if there were no others, as of :func:`skeleton_exact`; what is outside is of all features.

    Parameters
    ----------
    polygons : PolygonSet, shapely geometry, GeoSeries, GeoDataFrame, GeoJSON, (n, 2) array, …, or a list of these
        An array is the shell of one polygon; a mapping has ``shell`` and ``holes``, or ``line``. Of a list each item is
        one feature, and so is each row.
    step : float
        Between samples, in input units.
    tolerance : float
        Instead of a step: edges are sampled as finely as it takes for all error bounds to be at most this. The bounds
        are from approximate to exact; where corners of nearly 180 degrees have nearly invisible branches, the exact
        skeleton may be farther away.
    sampling : {"paper", "symmetric"}
        Every edge from its first end, the last gap being between h/2 and 3h/2, as the paper prints it (by default with
        a step); or the same distances from each corner on all of its edges (always with a tolerance).
    side : {"interior", "exterior", "both"}
        Inside polygons, outside all of them, or both.
    features : {"separate", "together"}
        Take each feature by itself, or all of them, and open lines among them, as boundaries of one diagram.
    complete : bool, optional
        Join corners under 180 degrees by a line along the bisector to the first arc; by default with a tolerance.
    frame : Box or (x, y, w, h), optional
        Rectangle that arcs outside are cut by; by default the bounds and a tenth of their larger side around them.
    strict : bool
        Refuse polygons that would be repaired.
    threads : int
        0 uses all.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    Skeleton
        Of straight arcs. Radii are clearances: distances from the polygons. Error bounds are NaN where nothing is
        proved, which is so in a few places where edges are much nearer to each other than samples.

    Raises
    ------
    InputError
        If a coordinate is not finite, or `strict` and something would be repaired.
    UsageError
        If the step or the tolerance is none, or both or neither is given; of the other options likewise.
    LimitError
        If there are too many seeds, or the tolerance cannot be met.

    Warns
    -----
    VorotoolWarning
        If polygons were repaired, or none has an inside and that is asked for.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 3.1.

    Examples
    --------
    >>> skeleton = skeleton_approx([[0, 0], [8, 0], [8, 3], [0, 3]], step=0.5)
    >>> bool(skeleton.error_bound.max() < 0.2), round(float(skeleton.radius.max()), 6)
    (True, 1.5)
    """
    options = SamplingOptions(step, tolerance, sampling)
    frame = None if frame is None else as_extent(frame, "frame")
    check_skeleton_options(side, 0, frame)
    check_features(features)
    check_lengths(frame or (), "frame's coordinate")
    complete = (tolerance is not None) if complete is None else checked_flag(complete, "complete")
    return approximation(
        as_polygons(polygons),
        options,
        side=side,
        features=features,
        complete=complete,
        frame=frame,
        strict=strict,
        threads=checked_threads(threads),
        progress=progress,
    ).skeleton
