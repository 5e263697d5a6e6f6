"""Skeletons of polygons: exact ones (paper, section 3.2), and approximate ones (section 3.1)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vorotool.convert.polygons import as_polygons
from vorotool.engines.sampled_skeleton.approximate import SamplingOptions, Wanted
from vorotool.engines.sampled_skeleton.per_feature import approximation
from vorotool.engines.skeleton.diagrams import (
    diagram_of_all,
    is_of_single_features,
    skeleton_in,
    skeleton_inside,
)
from vorotool.engines.skeleton.exact import check_border, check_features, check_skeleton_options
from vorotool.numeric.checks import checked_flag, checked_threads
from vorotool.numeric.parallel import Progress, running
from vorotool.types.box import Box, Extent, as_extent, check_lengths
from vorotool.types.skeleton.skeleton import Skeleton

if TYPE_CHECKING:
    from vorotool.typing import FeaturesChoice, PolygonsLike, Sampling, Side


def skeleton_exact(
    polygons: PolygonsLike,
    *,
    side: Side = "interior",
    features: FeaturesChoice = "separate",
    gap: float = 0.0,
    complete: bool = True,
    frame: Box | Extent | None = None,
    border: Box | Extent | None = None,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Skeleton:
    """Compute the exact skeleton of polygons: the points with more than one nearest boundary point.

    The polygons are rounded to a lattice of 31 bits; after that every decision is exact. The skeleton is the Voronoi
    diagram of the vertices and open edges without the Voronoi edges between an edge and its own end; this holds with
    holes too. The interior skeleton of a feature, one item of the input with all its parts, ignores all other features:
    they may touch it, overlap it, or lie in it. The exterior skeleton is that of all features. The skeleton of crack
    outlines passes through corners where pixels touch: see :func:`vorotool.outlines`.

    Parameters
    ----------
    polygons : PolygonSet, shapely geometry, GeoSeries, GeoDataFrame, GeoJSON, (n, 2) array, …, or a list of these
        An array is the shell of one polygon; a mapping has ``shell`` and ``holes``, or ``line``. Each item of a list is
        one feature, and so is each row.
    side : {"interior", "exterior", "both"}
        Inside polygons, outside all of them, or both.
    features : {"separate", "together"}
        Treat each feature by itself, or all features, open lines included, as boundaries of one diagram.
    gap : float
        Length by which each edge is shortened at both ends, as in the paper (Figure 10): no branch then leads to a
        corner, and the result is no longer exact. The new ends are rounded to the lattice.
    complete : bool
        With a gap, add the straight lines from the skeleton to the corners.
    frame : Box or (x, y, w, h), optional
        Rectangle that clips the exterior arcs; by default that of the image, or the bounds, widened by a tenth.
    border : Box or (x, y, w, h), optional
        Rectangle that cuts off the polygons, such as that of an image: polygons with edges on its border continue
        beyond it. These edges are not sites: the skeleton is that of the rest of the outline, clipped to the rectangle.
        It runs to the border and does not fork into the corners there. Only for the interior of separate features,
        without a gap.
    strict : bool
        Refuse polygons that need repair.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    Skeleton
        The skeleton, without arcs where the polygons have no such side.

    Raises
    ------
    InputError
        If a coordinate is not finite or beyond the border, an edge is at most twice the gap long, or if `strict` and a
        polygon needs repair.
    UsageError
        If the side, the gap, the frame or the border is invalid, or a border is combined with another side, with
        features together or with a gap.
    LimitError
        If there are too many vertices.

    Warns
    -----
    VorotoolWarning
        If polygons were repaired, or the interior is requested and no polygon has one.

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
    run = running(threads, progress)
    if is_of_single_features(side, features):
        return skeleton_inside(given, gap, complete=complete, border=border, strict=strict, **run).skeleton
    diagram = diagram_of_all(given, gap, features=features, interior_only=side == "interior", strict=strict, **run)
    return skeleton_in(diagram, side=side, features=features, complete=complete, frame=frame, **run)


def skeleton_approx(
    polygons: PolygonsLike,
    *,
    step: float | None = None,
    tolerance: float | None = None,
    sampling: Sampling | None = None,
    side: Side = "interior",
    features: FeaturesChoice = "separate",
    complete: bool | None = None,
    frame: Box | Extent | None = None,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Skeleton:
    """Approximate the skeleton of polygons by the Voronoi diagram of samples, with an error bound for each arc.

    The edges are sampled, and each sample has the labels of the edges it lies on. Voronoi edges between samples with a
    common label are deleted, and so are those that cross the polygons. These decisions are exact. No point of an arc is
    farther from the exact skeleton than its `error_bound`. The interior skeleton of a feature ignores all other
    features, as in :func:`skeleton_exact`; the exterior skeleton is that of all features.

    Parameters
    ----------
    polygons : PolygonSet, shapely geometry, GeoSeries, GeoDataFrame, GeoJSON, (n, 2) array, …, or a list of these
        An array is the shell of one polygon; a mapping has ``shell`` and ``holes``, or ``line``. Each item of a list is
        one feature, and so is each row.
    step : float
        Distance between samples, in input units.
    tolerance : float
        Largest error bound, instead of a step: edges are sampled finely enough to meet it. The bounds are distances
        from the approximate to the exact skeleton; at corners of nearly 180 degrees, whose branches are nearly
        invisible, the exact skeleton may be farther away.
    sampling : {"paper", "symmetric"}
        Sample every edge from its first end, the last gap being between h/2 and 3h/2, as in the paper (default with a
        step); or at the same distances from each corner on all of its edges (always with a tolerance).
    side : {"interior", "exterior", "both"}
        Inside polygons, outside all of them, or both.
    features : {"separate", "together"}
        Treat each feature by itself, or all features, open lines included, as boundaries of one diagram.
    complete : bool, optional
        Join corners under 180 degrees to the first arc by a line along the bisector; default with a tolerance.
    frame : Box or (x, y, w, h), optional
        Rectangle that clips the exterior arcs; by default that of the image, or the bounds, widened by a tenth.
    strict : bool
        Refuse polygons that need repair.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    Skeleton
        The skeleton, with straight arcs. Radii are clearances: distances from the polygons. Error bounds are NaN where
        nothing is proved: in a few places where edges are much nearer to each other than samples.

    Raises
    ------
    InputError
        If a coordinate is not finite, or if `strict` and a polygon needs repair.
    UsageError
        If the step, the tolerance or another option is invalid, or not exactly one of step and tolerance is passed.
    LimitError
        If there are too many seeds, or the tolerance cannot be met.

    Warns
    -----
    VorotoolWarning
        If polygons were repaired, or the interior is requested and no polygon has one.

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
    wanted = Wanted(side, frame, complete, threads=checked_threads(threads), progress=progress)
    return approximation(as_polygons(polygons), options, wanted, features=features, strict=strict).skeleton
