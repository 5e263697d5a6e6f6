"""Delaunay triangulation: exact, whatever the coordinates (paper, section 2.1)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vorotool import _core
from vorotool.convert.points import as_points
from vorotool.errors import STRICT, InputError, LimitError, VerificationError, warn
from vorotool.numeric.checks import checked_flag, checked_threads
from vorotool.numeric.parallel import Progress
from vorotool.types.arguments import check_value
from vorotool.types.mesh.triangulation import Triangulation
from vorotool.types.points.point_set import known_of_points

if TYPE_CHECKING:
    from vorotool.typing import SeedsLike

MOST_POINTS = 2**28
"""Half-edges, six a point, are counted in 32 bits."""


def delaunay(points: SeedsLike, *, strict: bool = False, threads: int = 0, progress: Progress = None) -> Triangulation:
    """Compute the Delaunay triangulation of points: the circumcircle of each triangle is empty.

    Every decision is exact for all finite coordinates. The result depends on the points alone: the number of threads
    does not change it, and a permutation of the points changes only their numbers.

    Parameters
    ----------
    points : PointSet, SeedSet, (n, 2) array, data frame, GeoSeries, …
        Points to triangulate; the sites of a `SeedSet`.
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

    Raises
    ------
    InputError
        If a coordinate is not finite, or if `strict` and there are duplicate points.
    LimitError
        If there are more than 2^28 points.

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
    """
    given = as_points(points)
    if len(given) > MOST_POINTS:
        raise LimitError(f"the input has {len(given)} points, more than {MOST_POINTS}: triangulate them in parts")
    threads = checked_threads(threads)
    core = _core.delaunay.DelaunayTriangulation(given.xy, threads, progress)
    arrays, known = core.arrays(threads, progress), known_of_points(given)
    mesh = Triangulation(given.xy, **arrays, **known, first_number=given.first_number, frame=given.frame)
    report_duplicates(mesh, strict=strict)
    return mesh


def report_duplicates(mesh: Triangulation, *, strict: bool) -> None:
    """Say how many points lie on an earlier one, or refuse them."""
    count = mesh.duplicates
    if not count:
        return
    what = f"{count} of {len(mesh.points)} points lie on an earlier point"
    if checked_flag(strict, "strict"):
        raise InputError(f"{what}: remove the duplicates, or leave out {STRICT}")
    warn(f"{what}: only the first point at each position is triangulated")


def verify_triangulation(mesh: Triangulation, *, threads: int = 0, progress: Progress = None) -> None:
    """Check a triangulation exactly, from its arrays alone.

    The checks: indices, orientations, each directed edge once, neighbors, a convex hull traversed once, every point
    used, edges, Euler's relation, every edge locally Delaunay, fans in cocircular polygons, duplicates, chains.

    Parameters
    ----------
    mesh : Triangulation
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
    check_value(mesh, "mesh", "Triangulation")
    if not np.isfinite(mesh.points).all():
        raise VerificationError("a coordinate is not finite")
    fault = triangulation_fault(mesh, checked_threads(threads), progress)
    if fault is not None:
        raise VerificationError(fault)


def triangulation_fault(mesh: Triangulation, threads: int, progress: Progress) -> str | None:
    """The first fault of a triangulation of finite points, if it has any."""
    return _core.delaunay.find_fault(core_mesh(mesh), threads, progress)


def core_mesh(mesh: Triangulation) -> _core.delaunay.Triangulation:
    """The arrays of a triangulation, for the core."""
    return _core.delaunay.Triangulation(mesh.points, mesh.triangles, mesh.neighbors, mesh.edges, mesh.hull, mesh.first)
