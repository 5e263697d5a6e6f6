"""Delaunay triangulation: exact, whatever the coordinates (paper, section 2.1); and points inserted later."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vorotool import _core
from vorotool.errors import STRICT, InputError, LimitError, VerificationError, element, warn
from vorotool.numeric.checks import as_array, checked_flag, checked_threads, joined_index, whole_numbers
from vorotool.numeric.parallel import Progress, Run, running
from vorotool.products.formats import resolved
from vorotool.products.registry import is_of
from vorotool.types.arguments import check_value
from vorotool.types.mesh.triangulation import Triangulation
from vorotool.types.points.point_set import PointSet, known_of_points

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vorotool.types.mesh.tetrahedralization import Tetrahedralization
    from vorotool.types.points.point_set import VolumePoints
    from vorotool.types.volumes.volume import VolumeSeeds
    from vorotool.typing import PointsLike, SeedsLike

MOST_POINTS = 2**28
"""Half-edges, six a point, are counted in 32 bits."""
_IN_SPACE = "engines.delaunay.tetrahedralization"
"""What triangulates points in space."""


@overload
def delaunay(
    points: VolumePoints | VolumeSeeds, *, strict: bool = ..., threads: int = ..., progress: Progress = ...
) -> Tetrahedralization: ...


@overload
def delaunay(
    points: SeedsLike, *, strict: bool = ..., threads: int = ..., progress: Progress = ...
) -> Triangulation: ...


def delaunay(
    points: SeedsLike | VolumePoints | VolumeSeeds,
    *,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Triangulation | Tetrahedralization:
    """Compute the Delaunay triangulation of points: the circumcircle of each triangle is empty.

    Points in space have tetrahedra, whose circumspheres are empty.

    Every decision is exact for all finite coordinates. The result depends on the points alone: the number of threads
    does not change it, and a permutation of the points changes only their numbers.

    Parameters
    ----------
    points : PointSet, SeedSet, (n, 2) array, data frame, GeoSeries, … or VolumePoints, VolumeSeeds, (n, 3) array
        Points to triangulate; the sites of a `SeedSet` or of `VolumeSeeds`. A data frame has its x and y; for points
        in space give an array of three columns.
    strict : bool
        Refuse duplicate points.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    Triangulation
        A chain of edges without triangles if the points are collinear or fewer than three.
    Tetrahedralization
        Of points in space; triangles without tetrahedra if they lie in one plane.

    Raises
    ------
    InputError
        If a coordinate is not finite, or if `strict` and there are duplicate points.
    LimitError
        If there are more than 2^28 points, or in space more tetrahedra than 2^29.

    Warns
    -----
    VorotoolWarning
        If points are duplicates: how many. `Triangulation.first` gives the first point at each location.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.1; Guibas and Stolfi 1985; Dwyer 1987.

    Examples
    --------
    >>> mesh = delaunay([[0, 0], [4, 0], [0, 3], [1, 1]])
    >>> mesh.triangles.tolist(), mesh.hull.tolist()
    ([[0, 3, 2], [0, 1, 3], [3, 1, 2]], [0, 1, 2])
    >>> len(delaunay([[0, 0, 0], [4, 0, 0], [0, 3, 0], [0, 0, 2], [1, 1, 0.5]]).tetrahedra)
    4
    """
    if not isinstance(points, PointSet) and is_of_space(points):
        make = resolved(f"{_IN_SPACE}:tetrahedralization")
        return make(points, strict=strict, threads=threads, progress=progress)
    return triangulated(points, strict=strict, threads=threads, progress=progress)


def triangulated(points: Any, *, strict: bool = False, threads: int = 0, progress: Progress = None) -> Triangulation:
    """Triangulate points of the plane."""
    given = points if isinstance(points, PointSet) else _point_set(points)
    if len(given) > MOST_POINTS:
        raise LimitError(f"the input has {len(given)} points, more than {MOST_POINTS}: triangulate them in parts")
    threads = checked_threads(threads)
    core = _core.delaunay.DelaunayTriangulation(given.xy, threads, progress)
    arrays, known = core.arrays(threads, progress), known_of_points(given)
    mesh = Triangulation(given.xy, **arrays, **known, first_number=given.first_number, frame=given.frame)
    if mesh.duplicates:
        report_duplicates(mesh, strict=strict)
    return mesh


def _point_set(points: Any) -> PointSet:
    """Convert what holds points."""
    from vorotool.convert.points import PAIRS_OR_TRIPLES, as_points

    return as_points(points, shapes=PAIRS_OR_TRIPLES)


def is_of_space(points: Any) -> bool:
    """Tell whether points have three coordinates: by their type, or as arrays and lists of triples."""
    if type(points) is np.ndarray:
        return points.ndim == 2 and points.shape[1] == 3 and points.dtype.kind in "iuf"
    if is_of(points, "PointSet", "SeedSet", "Triangulation", "AlphaComplex"):
        return False
    if is_of(points, "VolumePoints", "VolumeSeeds", "Tetrahedralization", "SpaceAlphaComplex"):
        return True
    width: int | None = resolved("convert.volumes:row_width")(points)
    return width == 3


def report_duplicates(mesh: Triangulation | Tetrahedralization, *, strict: bool) -> None:
    """Say how many points lie on an earlier one, or refuse them."""
    what = f"{mesh.duplicates} of {len(mesh.points)} points lie on an earlier point"
    if checked_flag(strict, "strict"):
        raise InputError(f"{what}: remove the duplicates, or leave out {STRICT}")
    warn(f"{what}: only the first point at each position is triangulated")


def verify_triangulation(
    mesh: Triangulation | Tetrahedralization, *, threads: int = 0, progress: Progress = None
) -> None:
    """Check a triangulation exactly, from its arrays alone.

    The checks: indices, orientations, each directed edge once, neighbors, a convex hull traversed once, every point
    used, edges, Euler's relation, every edge locally Delaunay, fans in cocircular polygons, duplicates, chains.

    Parameters
    ----------
    mesh : Triangulation or Tetrahedralization
        A triangulation from any source, with finite points.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Raises
    ------
    VerificationError
        If a check fails; the message names the first fault.

    Examples
    --------
    >>> mesh = delaunay([[0, 0], [2, 0], [2, 1], [0, 1]])
    >>> verify_triangulation(mesh)
    >>> from dataclasses import replace
    >>> verify_triangulation(replace(mesh, triangles=mesh.triangles[:, ::-1]))
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: triangle 0 is not counter-clockwise
    """
    check_value(mesh, "mesh", "Triangulation", "Tetrahedralization")
    if not np.isfinite(mesh.points).all():
        raise VerificationError("a coordinate is not finite")
    find: Any = triangulation_fault if isinstance(mesh, Triangulation) else resolved(f"{_IN_SPACE}:fault")
    fault = find(mesh, running(threads, progress))
    if fault is not None:
        raise VerificationError(fault)


def triangulation_fault(mesh: Triangulation, run: Run) -> str | None:
    """The first fault of a triangulation of finite points, if it has any."""
    return _core.delaunay.find_fault(core_mesh(mesh), **run)


def core_mesh(mesh: Triangulation) -> _core.delaunay.Triangulation:
    """The arrays of a triangulation, for the core."""
    return _core.delaunay.Triangulation(mesh.points, mesh.triangles, mesh.neighbors, mesh.edges, mesh.hull, mesh.first)


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
    given = points if isinstance(points, PointSet) else _point_set(points)
    total = len(mesh.points) + len(given)
    if total > MOST_POINTS:
        raise LimitError(f"there would be {total} points, more than {MOST_POINTS}: triangulate them in parts")
    hints = _hints(hint, len(mesh.points), len(given))
    together = _joined(mesh, given)
    made = None
    if len(given) <= MANY * len(mesh.points):
        made = _inserted(mesh, together.xy, hints, running(threads, progress))
    if made is None:
        return delaunay(together, strict=strict, threads=threads, progress=progress)
    known = known_of_points(together)
    result = Triangulation(together.xy, **made, **known, first_number=together.first_number, frame=together.frame)
    if result.duplicates:
        report_duplicates(result, strict=strict)
    return result


def _inserted(
    mesh: Triangulation, xy: NDArray[np.float64], hints: NDArray[np.int32], run: Run
) -> dict[str, Any] | None:
    try:
        return _core.delaunay.insert_points(core_mesh(mesh), xy, hints, **run)
    except ValueError as error:
        raise InputError(f"{error}: give a triangulation that delaunay() or insert_points() returned") from None


def _hints(hint: Any, count: int, further: int) -> NDArray[np.int32]:
    if hint is None:
        return np.empty(0, dtype=np.int32)
    whole = whole_numbers(hint, "hint", np.int64)
    hints = np.broadcast_to(whole, (further,)) if np.ndim(hint) == 0 else whole
    if hints.shape != (further,):
        raise InputError(
            f"hint must be one index, or one index for each of the {further} points, but has shape {hints.shape}"
        )
    bad = np.flatnonzero((hints < 0) | (hints >= count))
    if bad.size:
        raise InputError(
            f"{element('hint', bad[0])} is {hints[bad[0]]}: it must be a point of the triangulation, 0 to {count - 1}"
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


Indices = NDArray[np.int32]


def triangulation_of(points: Any, triangles: ArrayLike) -> Triangulation:
    """Make a `Triangulation` of points and the triangles that another program has found."""
    given: PointSet = resolved("convert.points:as_points")(points)
    corners = _counter_clockwise(given.xy, _checked_triangles(triangles, len(given.xy)))
    if not len(corners):
        raise InputError("triangles is empty: vorotool.delaunay computes a triangulation of points")
    tails, heads = corners.reshape(-1), np.roll(corners, -1, axis=1).reshape(-1)
    twins = _twins(tails, heads, len(given.xy))
    hull = _hull(given.xy, tails[twins < 0], heads[twins < 0])
    across = np.where(twins < 0, -1, twins // 3).reshape(-1, 3)
    return Triangulation(
        given.xy,
        corners,
        np.roll(across, -1, axis=1),  # a side goes from its corner to the next one, and is opposite to the third
        np.sort(np.stack([tails, heads], axis=1)[(twins < 0) | (twins > np.arange(len(twins)))], axis=1),
        hull,
        _first_at_place(given.xy),
        **known_of_points(given),
        first_number=given.first_number,
    )


def _checked_triangles(triangles: ArrayLike, count: int) -> Indices:
    array = as_array(triangles, "triangles")
    if array.size == 0:
        return np.empty((0, 3), dtype=np.int32)
    if array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind not in "iu":
        raise InputError(f"triangles must be (n, 3) integers, but have shape {array.shape} and type {array.dtype}")
    bad = np.flatnonzero(((array < 0) | (array >= count)).any(axis=1))
    if bad.size:
        raise InputError(f"triangle {bad[0]} is {array[bad[0]].tolist()}: indices must be from 0 to {count - 1}")
    return array.astype(np.int32)


def _counter_clockwise(xy: NDArray[np.float64], triangles: Indices) -> Indices:
    """Turn clockwise triangles over, by exact signs."""
    signs = np.asarray(_core.kernel.orient2d(np.ascontiguousarray(xy[triangles])))
    flat = np.flatnonzero(signs == 0)
    if flat.size:
        raise InputError(f"triangle {flat[0]} has no area: its corners lie on a line")
    return np.where(signs[:, None] > 0, triangles, triangles[:, [0, 2, 1]])


def _twins(tails: Indices, heads: Indices, count: int) -> NDArray[np.int64]:
    """(3 t,) the side that runs the other way, -1 on the boundary."""
    keys = tails.astype(np.int64) * count + heads
    order = np.argsort(keys, kind="stable")
    repeated = np.flatnonzero(np.diff(keys[order]) == 0)
    if repeated.size:
        side = order[repeated[0]]
        raise InputError(f"two triangles lie on the same side of the edge {tails[side]}, {heads[side]}: they overlap")
    wanted = heads.astype(np.int64) * count + tails
    place = np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)
    return np.where(keys[order[place]] == wanted, order[place], -1)


def _hull(xy: NDArray[np.float64], tails: Indices, heads: Indices) -> Indices:
    """Follow the boundary, counter-clockwise from its lexicographically smallest vertex."""
    if len(np.unique(tails)) < len(tails):
        raise InputError("the boundary of the triangles meets itself: a triangulation fills a convex hull")
    onward = dict(zip(tails.tolist(), heads.tolist(), strict=True))
    smallest = int(tails[np.lexsort(xy[tails].T[::-1])[0]])
    hull = [smallest]
    while (following := onward[hull[-1]]) != smallest:
        hull.append(following)
    if len(hull) < len(onward):
        raise InputError("the triangles have holes or several parts: a triangulation fills a convex hull")
    return np.array(hull, dtype=np.int32)


def _first_at_place(xy: NDArray[np.float64]) -> Indices:
    """(n,) the first point at the place of each."""
    _, first, place = np.unique(xy + 0.0, axis=0, return_index=True, return_inverse=True)
    return first[place.reshape(-1)].astype(np.int32)
