"""The smallest distance between points, lines and polygons."""

from __future__ import annotations

from typing import Any

from vorotool import _core
from vorotool.engines.distances.measured_shape import measured_shapes
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.progress import Progress
from vorotool.types.distances.distances import Distances, PlacePair


def distance(a: Any, b: Any, *, boundary: bool = False, threads: int = 0, progress: Progress = None) -> Distances:
    """Compute the smallest distance between two shapes, and the closest pair of points.

    Parameters
    ----------
    a, b, boundary, threads, progress : optional
        As for `vorotool.hausdorff`.

    Returns
    -------
    Distances
        Result with `Distances.smallest`. A distance of 0, where the shapes meet, is decided exactly; others are right
        to a few ulp of the coordinates. The first of several equally close pairs of edges is taken.

    Raises
    ------
    InputError
        As for `vorotool.hausdorff`.

    See Also
    --------
    hausdorff : The largest distance from a place of one to the other.

    Examples
    --------
    >>> import vorotool
    >>> found = vorotool.distance(["LINESTRING (0 0, 8 0)"], ["LINESTRING (3 4, 6 2)", "POINT (1 5)"])
    >>> found.smallest
    PlacePair(distance=2.0, on_a=(6.0, 0.0), on_b=(6.0, 2.0))
    """
    first, second = measured_shapes(a, b, boundary=boundary, progress=progress)
    found = _core.distances.closest_places(first.core, second.core, checked_threads(threads), progress)
    return Distances(None, None, PlacePair(*found), (first.polygons, second.polygons), boundary)
