"""Insertion of points into a triangulation that is there already (paper, section 2.1)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.points import as_points
from vorotool.engines.delaunay.delaunay import MOST_POINTS, core_mesh, delaunay, report_duplicates
from vorotool.errors import InputError, LimitError
from vorotool.numeric.checks import checked_threads, joined_index, whole_numbers
from vorotool.numeric.parallel import Progress
from vorotool.types.arguments import check_value
from vorotool.types.mesh.triangulation import Triangulation
from vorotool.types.points.point_set import PointSet, known_of_points

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vorotool.typing import PointsLike

MANY = 0.25
"""Of the points there are: more further ones are triangulated sooner along with these, from the beginning."""


def insert_points(
    mesh: Triangulation,
    points: PointsLike,
    *,
    hint: ArrayLike | None = None,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Triangulation:
    """Insert points into a Delaunay triangulation, exactly and locally.

    The result is that of `delaunay` for all the points, array by array. Each point is searched for by a walk over the
    triangles, and edges around it are flipped until all circles are empty (Lawson 1977): for m points that takes time
    in proportion to m, as a rule, and the arrays of the result have to be copied besides. Points outside the hull are
    inserted as well.

    All is triangulated anew where the arrays would not stay as they are: if a point lies outside the bounds of those
    that there are, on which the order of the triangles depends; if three points or more share a cell of the grid of
    2^16 by 2^16 over these bounds, near a change; if there are no triangles yet. So it is if the points are more than a
    quarter of those that there are, which is sooner done.

    Parameters
    ----------
    mesh : Triangulation
        Made by `delaunay` or by this function; it stays as it is.
    points : PointSet, SeedSet, (m, 2) array, data frame, GeoSeries, …
        They get the numbers after those of `mesh`.
    hint : int or (m,) array-like of int, optional
        A point of `mesh`, by index, that is near to the further ones, or to each: the walk begins there. Without it the
        order of the triangles tells where to begin, in time O(log n).
    strict : bool
        Refuse duplicate points.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    Triangulation
        Labels go on after the largest one unless `points` brings its own; of further columns, what is not known is
        None.

    Raises
    ------
    InputError
        If a coordinate is not finite, a hint is no point, `mesh` is found not to be a triangulation made by this
        library, or `strict` and a point lies on another.
    LimitError
        If there are more than 2^28 points.

    Warns
    -----
    VorotoolWarning
        If points are duplicates: how many of all.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.1; Ohya, Iri and Murota 1984; Lawson 1977.

    Examples
    --------
    >>> mesh = delaunay([[0, 0], [4, 0], [0, 3]])
    >>> insert_points(mesh, [[1, 1]]).triangles.tolist()
    [[0, 3, 2], [0, 1, 3], [3, 1, 2]]
    """
    check_value(mesh, "mesh", "Triangulation")
    given = as_points(points)
    total = len(mesh.points) + len(given)
    if total > MOST_POINTS:
        raise LimitError(f"there would be {total} points, more than {MOST_POINTS}: triangulate them in parts")
    hints = _hints(hint, len(mesh.points), len(given))
    together = _joined(mesh, given)
    made = None
    if len(given) <= MANY * len(mesh.points):
        made = _inserted(mesh, together.xy, hints, checked_threads(threads), progress)
    if made is None:
        return delaunay(together, strict=strict, threads=threads, progress=progress)
    known = known_of_points(together)
    result = Triangulation(together.xy, **made, **known, first_number=together.first_number, frame=together.frame)
    report_duplicates(result, strict=strict)
    return result


def _inserted(
    mesh: Triangulation, xy: NDArray[np.float64], hints: NDArray[np.int32], threads: int, progress: Progress
) -> dict[str, Any] | None:
    try:
        return _core.delaunay.insert_points(core_mesh(mesh), xy, hints, threads, progress)
    except ValueError as error:
        raise InputError(f"{error}: give a triangulation that delaunay() or insert_points() returned") from None


def _hints(hint: Any, count: int, further: int) -> NDArray[np.int32]:
    if hint is None:
        return np.empty(0, dtype=np.int32)
    hints = np.broadcast_to(whole_numbers(hint, "hint", np.int64), (further,) if np.ndim(hint) == 0 else np.shape(hint))
    if hints.shape != (further,):
        raise InputError(
            f"hint must be one index, or one index for each of the {further} points, but has shape {hints.shape}"
        )
    bad = np.flatnonzero((hints < 0) | (hints >= count))
    if bad.size:
        raise InputError(
            f"hint {bad[0] + 1} is {hints[bad[0]]}: it must be a point of the triangulation, 0 to {count - 1}"
        )
    return np.ascontiguousarray(hints, dtype=np.int32)


def _joined(mesh: Triangulation, given: PointSet) -> PointSet:
    """All points, and what is known of each."""
    labels = None
    if mesh.labels is not None or given.labels is not None:
        old = mesh.label_array
        new = given.labels if given.labels is not None else given.label_array + old.max(initial=0)
        labels = np.concatenate([old, new])
    properties = {}
    for name in dict.fromkeys([*mesh.properties, *given.properties]):
        old_values = mesh.properties.get(name, [None] * len(mesh.points))
        properties[name] = [*old_values, *given.properties.get(name, [None] * len(given))]
    xy = np.concatenate([mesh.points, given.xy])
    index = joined_index(mesh.index, len(mesh.points), given.index, len(given))
    return PointSet(xy, labels, properties, mesh.y_axis, mesh.crs, mesh.first_number, index, mesh.frame)
