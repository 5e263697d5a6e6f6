"""The Hausdorff distance of points, lines and polygons."""

from __future__ import annotations

from typing import Any

from vorotool import _core
from vorotool.engines.distances.inner_places import farthest_inner_place
from vorotool.engines.distances.measured_shape import MeasuredShape, measured_shapes
from vorotool.numeric.checks import checked_flag, checked_threads
from vorotool.numeric.progress import Progress
from vorotool.types.distances.distances import Distances, PlacePair


def hausdorff(
    a: Any,
    b: Any,
    *,
    boundary: bool = False,
    directed: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Distances:
    """Compute the Hausdorff distance between two shapes.

    All places count, inside edges and polygons as well: nothing is sampled. Candidates on edges are the places where
    the nearest edge changes; inside polygons, the vertices of the Voronoi diagram of the other shape.

    Parameters
    ----------
    a, b : object
        Points, lines and polygons, mixed as they come, as `vorotool.voronoi` takes them: an (n, 2) array is n points.
        Each argument is one shape.
    boundary : bool
        Whether polygons stand for their outlines, as in `shapely.hausdorff_distance`; by default they are filled.
    directed : bool
        Compute only the distance from a to b: `Distances.from_b` is None.
    threads : int
        Number of threads; 0 uses all. The result does not depend on it.
    progress : callable, optional
        Called with the fraction done of each part of the work.

    Returns
    -------
    Distances
        The `distance`, and for both directions the farthest place with the nearest place of the other shape. Distances
        and places are right to a few ulp of the coordinates. Of several equally far places the first vertex is taken,
        if one is a vertex; a place on an edge is taken before one inside a polygon.

    Raises
    ------
    InputError
        If a shape is empty, the coordinate reference systems differ, or coordinates are out of range.

    See Also
    --------
    distance : The smallest distance.

    Notes
    -----
    `shapely.hausdorff_distance` measures from vertices only: for the two lines below it gives 1. All that lies inside a
    shell and in none of its holes, each by the even-odd rule, and all edges belong to a polygon.

    Examples
    --------
    >>> import vorotool
    >>> found = vorotool.hausdorff(["LINESTRING (0 0, 8 0)"], ["LINESTRING (0 0, 0 1, 8 1, 8 0)"])
    >>> found.distance, found.from_a.on_a, found.from_a.on_b
    (1.0, (4.0, 0.0), (4.0, 1.0))
    >>> ring = "POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0), (1 1, 8 1, 8 8, 1 8, 1 1))"
    >>> vorotool.hausdorff(["POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0))"], [ring]).from_a
    PlacePair(distance=3.5, on_a=(4.5, 4.5), on_b=(4.5, 1.0))
    """
    threads = checked_threads(threads)
    first, second = measured_shapes(a, b, boundary=boundary, progress=progress)
    there = farthest(first, second, threads, progress)
    back = None
    if not checked_flag(directed, "directed"):
        far = farthest(second, first, threads, progress)
        back = PlacePair(far.distance, far.on_b, far.on_a)
    return Distances(there, back, None, (first.polygons, second.polygons), boundary)


def farthest(of: MeasuredShape, other: MeasuredShape, threads: int, progress: Progress = None) -> PlacePair:
    """Find the place of a shape that is farthest from another one: that place, and the nearest one of the other."""
    found = PlacePair(*_core.distances.farthest_place(of.core, other.core, threads, progress))
    inner = farthest_inner_place(of, other, found.distance, threads) if of.is_filled else None
    return inner or found
