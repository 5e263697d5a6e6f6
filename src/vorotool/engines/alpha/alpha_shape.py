"""One alpha shape, and the choice of its radius (paper, section 2.3)."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.alpha.alpha_complex import (
    IN_SPACE,
    allows_empty,
    alpha_complex,
    alpha_curves,
    plane_complex,
    refuse_in_space,
    refuse_or_warn,
    scanned_edges,
)
from vorotool.engines.delaunay.delaunay import is_of_space
from vorotool.errors import InputError, UsageError, option
from vorotool.numeric.arrays import ranges, starts_of
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.numbers import nearest_double, real_number, shown_number, whole_number
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import resolved
from vorotool.types.alpha.complex import AlphaComplex, RegionPersistence
from vorotool.types.alpha.radii import Radius, checked_radius
from vorotool.types.alpha.shape import AlphaShape
from vorotool.types.mesh.triangulation import DigitalTriangulation, Triangulation
from vorotool.types.polygons.polygon_set import HOLE, SHELL, PolygonSet

if TYPE_CHECKING:
    from vorotool.engines.alpha.alpha_complex import SpaceLike
    from vorotool.types.alpha.space import SpaceAlphaComplex, SpaceAlphaShape
    from vorotool.typing import AlphaRule, MeshLike, RealLike

CONVEX_HULL = f"for the convex hull use {option('-r inf', 'r=inf')}"
"""Advice where a radius without end is meant."""

GIVE_R = f": give r itself{option(' (-r)', '')}"
"""Advice where no radius can be chosen."""


def chosen_radius(r: Any, alpha: Any, automatic: bool = False) -> Radius | None:
    """Give the radius that was asked for; None for the automatic one."""
    ways = {option("-r", "r"): r is not None, option("--alpha", "alpha"): alpha is not None}
    ways[option("--auto", "auto")] = automatic
    named = [name for name, is_given in ways.items() if is_given]
    if len(named) > 1:
        raise UsageError(f"{' and '.join(named)} each set the radius: give only one of {', '.join(ways)}")
    if alpha is not None:
        value = real_number(alpha, "alpha")
        if not value < 0:
            hint = CONVEX_HULL
            if value > 0:
                radius = shown_number(1 / value)
                hint = f"for the alphashape package's {shown_number(value)} use {option(f'-r {radius}', f'r={radius}')}"
            raise UsageError(f"alpha must be negative (α = −1/r): {hint}")
        return checked_radius(-1 / value)
    return None if r is None else checked_radius(r)


@overload
def alpha_shape(
    points: SpaceAlphaComplex | SpaceLike,
    *,
    r: RealLike | None = ...,
    alpha: RealLike | None = ...,
    regions: int = ...,
    strict: bool = ...,
    allow_empty: bool | None = ...,
    threads: int = ...,
    progress: Progress = ...,
) -> SpaceAlphaShape: ...


@overload
def alpha_shape(
    points: AlphaComplex | DigitalTriangulation | MeshLike,
    *,
    r: RealLike | None = ...,
    alpha: RealLike | None = ...,
    regions: int = ...,
    hole_threshold: RealLike | None = ...,
    region_threshold: RealLike | None = ...,
    rule: AlphaRule = ...,
    strict: bool = ...,
    allow_empty: bool | None = ...,
    threads: int = ...,
    progress: Progress = ...,
) -> AlphaShape: ...


def alpha_shape(
    points: AlphaComplex | DigitalTriangulation | MeshLike | SpaceAlphaComplex | SpaceLike,
    *,
    r: RealLike | None = None,
    alpha: RealLike | None = None,
    regions: int = 1,
    hole_threshold: RealLike | None = None,
    region_threshold: RealLike | None = None,
    rule: AlphaRule = "corrected",
    strict: bool = False,
    allow_empty: bool | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> AlphaShape | SpaceAlphaShape:
    """Compute the alpha shape of points for one radius: classified edges, regions and polygons.

    The default radius is the smallest r whose shape is one region that contains every point. Points in space have
    tetrahedra, whose surface is closed, and singular triangles and edges.

    Parameters
    ----------
    points : AlphaComplex, PointSet, SeedSet, Triangulation, (n, 2) array, data frame, GeoSeries, …
        Points, or a complex to compute several shapes from. Points in space, as for `alpha_complex`.
    r : float or Fraction, optional
        The radius, in input units.
    alpha : float or Fraction, optional
        The paper's α = -1/r, negative.
    regions : int
        Largest number of regions allowed by the automatic choice of the radius.
    hole_threshold, region_threshold : number, optional
        Cavities of at most the first area are filled; then regions of at most the second area are dropped. In the
        plane only.
    rule, strict : optional
        As for `alpha_complex`.
    allow_empty : bool, optional
        As for `alpha_complex`; also return the shape of isolated points where the automatic choice finds no triangle.
    threads, progress : optional
        As for `alpha_complex`.

    Returns
    -------
    AlphaShape
        The shape, with its radius, edges, regions and polygons.
    SpaceAlphaShape
        Of points in space.

    Raises
    ------
    InputError
        If there are fewer than two distinct points, or the automatic choice finds no triangle, unless `allow_empty`.
    UsageError
        If r is not positive, alpha is not negative, or more than one of r, alpha and ``regions`` is passed.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.3.

    Examples
    --------
    >>> shape = alpha_shape([[0, 0], [2, 0], [2, 2], [0, 2], [9, 1]])
    >>> round(shape.r, 3), shape.region_count, shape.area
    (3.571, 1, 11.0)
    >>> cube = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> shape = alpha_shape(cube)
    >>> round(shape.r, 3), round(shape.volume, 9), shape.area, len(shape.surface)
    (0.866, 1.0, 6.0, 12)
    """
    radius = chosen_radius(r, alpha)
    if is_of_space(points):
        own = None if rule == "corrected" else rule
        refuse_in_space(hole_threshold=hole_threshold, region_threshold=region_threshold, rule=own)
        how: dict[str, Any] = {"strict": strict, "allow_empty": allow_empty, "threads": threads, "progress": progress}
        return resolved(f"{IN_SPACE}:space_shape")(points, radius, regions=regions, **how)
    if isinstance(points, AlphaComplex):
        family = points
    else:
        wanted: Any = {"rule": rule, "strict": strict, "allow_empty": allow_empty}
        family = plane_complex(points, **wanted, threads=threads, progress=progress)
    empty = allows_empty(points, allow_empty)
    radius = settled_radius(family, radius, regions=regions, strict=strict, allow_empty=empty, progress=progress)
    reached, entered = family.reached(radius), family.entered(radius)
    thresholds = _threshold(hole_threshold, "hole_threshold"), _threshold(region_threshold, "region_threshold")
    index, kind = scanned_edges(family, reached, entered, checked_threads(threads), progress)
    return _shape(family, radius, reached, (index, kind), thresholds, progress)


def settled_radius(
    family: AlphaComplex | SpaceAlphaComplex,
    given: Radius | None,
    *,
    regions: int,
    strict: bool,
    allow_empty: bool,
    progress: Progress,
) -> Radius:
    """Return the radius that is given, or the automatic one; one of isolated points only where there is none."""
    if given is not None:
        if regions != 1:
            raise UsageError("regions applies to the automatic radius: leave out r and alpha")
        return given
    if (reason := unjoined(family)) is None:
        return family.radius_from(automatic_rank(family, regions=regions, progress=progress))
    if len(family.edges):  # else it has been told that there are too few points
        refuse_or_warn(reason, GIVE_R, allow_empty=allow_empty, strict=strict)
    return float(np.nextafter(family.spectrum[0] * (1 - family.doubt), 0)) if len(family.spectrum) else 1.0


def unjoined(family: AlphaComplex | SpaceAlphaComplex) -> str | None:
    """Say why no radius gives a region that holds every point; None where one does."""
    if family.covered < len(family.spectrum):
        return None
    count = len(family.points) - family.mesh.duplicates
    if isinstance(family, AlphaComplex):
        where, what = " on a line", "triangle"
    else:
        where, what = " in a plane" if family.mesh.dimension == 2 else " on a line", "tetrahedron"
    few = {0: "no points span", 1: "one point spans", 2: "two points span"}
    held = few.get(count, f"{count} points{where} span")
    if isinstance(family, AlphaComplex) and len(family.mesh.triangles):
        held = "a point is on"
    return f"{held} no {what}, so no radius gives a region that holds all points"


def _threshold(value: Any, name: str) -> Fraction | None:
    if value is None:
        return None
    number = real_number(value, name)
    if not 0 <= number < float("inf"):
        raise UsageError(f"{name} is {shown_number(value)}: give an area of at least 0")
    return Fraction(number)


def _shape(
    family: AlphaComplex,
    r: Radius,
    reached: int,
    scanned: tuple[NDArray[np.int32], NDArray[np.uint8]],
    thresholds: tuple[Fraction | None, Fraction | None],
    progress: Progress,
) -> AlphaShape:
    index, kind = scanned
    inside = family.triangle_rank < reached
    component = _core.alpha.connected_triangles(inside.view(np.uint8), family.sides, progress)
    if thresholds != (None, None):
        inside = fill_and_drop(family, inside, component, *thresholds, progress)
        component = _core.alpha.connected_triangles(inside.view(np.uint8), family.sides, progress)
        index, kind = _reclassified(family, inside, index[kind == 1])
    region = np.where(inside, component, np.int32(-1))
    cavities = int(component[~inside].max(initial=-1)) + 1
    polygons = _polygons(family, region, progress)
    return AlphaShape(family, r, index, kind, region, polygons, cavities, thresholds != (None, None))


def _reclassified(
    family: AlphaComplex, inside: NDArray[np.bool_], singular: NDArray[np.int32]
) -> tuple[NDArray[np.int32], NDArray[np.uint8]]:
    """Boundary edges of other triangles, and the singular ones that are still on none."""
    count = np.append(inside, False)[family.sides].sum(axis=1)
    kind = np.where(count == 1, np.uint8(2), np.uint8(0))
    kind[singular[count[singular] == 0]] = 1
    index = np.flatnonzero(kind).astype(np.int32)
    return index, kind[index]


def _polygons(family: AlphaComplex, region: NDArray[np.int32], progress: Progress) -> PolygonSet:
    """One polygon a region, traced along directed sides of triangles that have the region on their left."""
    mesh = family.mesh
    across = np.append(region, np.int32(-1))[mesh.neighbors]
    t, k = np.nonzero((region[:, None] >= 0) & (across < 0)) if len(region) else (np.empty(0, np.intp),) * 2
    a = np.ascontiguousarray(mesh.triangles[t, (k + 1) % 3], dtype=np.int32)
    b = np.ascontiguousarray(mesh.triangles[t, (k + 2) % 3], dtype=np.int32)
    vertex, start, of, is_hole = _core.alpha.trace_rings(mesh.points, a, b, np.ascontiguousarray(region[t]), progress)
    order = np.lexsort((is_hole, of))  # a shell, then its holes
    sizes = np.diff(start)[order]
    kinds = np.where(is_hole[order], HOLE, SHELL).astype(np.int8)
    count = int(region.max(initial=-1)) + 1
    return PolygonSet(
        mesh.points[vertex[ranges(start[order], sizes)]],
        starts_of(sizes),
        kinds,
        of[order],
        ids=list(range(1, count + 1)),
        y_axis=mesh.y_axis,
        crs=mesh.crs,
    )


def automatic_rank(family: AlphaComplex | SpaceAlphaComplex, *, regions: int = 1, progress: Progress = None) -> int:
    """Give the first rank whose shape has at most so many regions, which contain every point."""
    if whole_number(regions, "regions") < 1:
        raise UsageError(f"regions is {shown_number(regions)}: use 1 or more")
    if (reason := unjoined(family)) is not None:
        raise InputError(f"{reason}{GIVE_R}")
    covered = family.covered
    found = np.flatnonzero(alpha_curves(family, progress=progress)["regions"][covered:] <= regions)
    return covered + int(found[0])


def fill_and_drop(
    family: AlphaComplex,
    inside: NDArray[np.bool_],
    component: NDArray[np.int32],
    hole_threshold: Fraction | None,
    region_threshold: Fraction | None,
    progress: Progress = None,
) -> NDArray[np.bool_]:
    """Fill holes of at most one area, then drop regions of at most another."""
    mesh = family.mesh
    if hole_threshold is not None:
        holes = np.where(inside, np.int32(-1), component)
        inside = inside | _in_small(mesh, holes, hole_threshold)
        component = _core.alpha.connected_triangles(inside.view(np.uint8), family.sides, progress)
    if region_threshold is not None:
        regions = np.where(inside, component, np.int32(-1))
        inside = inside & ~_in_small(mesh, regions, region_threshold)
    return inside


def _in_small(mesh: Triangulation, component: NDArray[np.int32], threshold: Fraction) -> NDArray[np.bool_]:
    """(t,) whether each triangle is in a component (from 0) of at most this area."""
    chosen = component >= 0
    numbers = component[chosen]
    areas = np.bincount(numbers, weights=mesh.areas[chosen])
    # A triangle's area is off by about 1e-15 times the product of two sides at most, a sum of n terms by n 2^-53 of it.
    corners = mesh.points[mesh.triangles[chosen]]
    limit = nearest_double(threshold)
    with np.errstate(over="ignore", invalid="ignore"):
        extent = np.ptp(corners, axis=1).max(axis=1, initial=0.0)
        scale = np.bincount(numbers, weights=extent * extent)
        doubt = 2.0**-48 * (8 + np.bincount(numbers)) * scale + 2.0**-1000  # what underflows is far less
        small = areas < limit - doubt
        unclear = ~(np.abs(areas - limit) > doubt)
    for number in np.flatnonzero(unclear).tolist():
        small[number] = _exact_area(mesh, component == number) <= threshold
    result = np.zeros(len(component), dtype=bool)
    result[chosen] = small[numbers]
    return result


def _exact_area(mesh: Triangulation, chosen: NDArray[np.bool_]) -> Fraction:
    total = Fraction(0)
    for triangle in mesh.points[mesh.triangles[chosen]].tolist():
        (ax, ay), (bx, by), (cx, cy) = ((Fraction(x), Fraction(y)) for x, y in triangle)
        total += (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return total / 2


def persistence(
    points: AlphaComplex | MeshLike,
    *,
    strict: bool = False,
    allow_empty: bool | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> RegionPersistence:
    """Compute the radii at which regions of the alpha shapes are born and merge with older ones.

    Equal radii are recognized exactly. The diagonals of cocircular polygons in the triangulation affect only the counts
    of triangles.

    Parameters
    ----------
    points : AlphaComplex, PointSet, SeedSet, Triangulation, (n, 2) array, data frame, GeoSeries, …
        Points, or a complex, which is used unchanged.
    strict, allow_empty, threads, progress : optional
        As for `alpha_complex`.

    Returns
    -------
    RegionPersistence
        One row per region; collinear points have no region.

    Raises
    ------
    InputError
        As for `alpha_complex`.
    UsageError
        If the rule of the complex is the printed one, whose edges do not match its triangles.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.3; Edelsbrunner, Letscher and Zomorodian 2002.

    Examples
    --------
    >>> found = persistence([[0, 0], [2, 0], [0, 2], [9, 0], [12, 0], [9, 3]])
    >>> found.table()["into"].tolist(), found.suggested, round(found.apart_until, 3)
    ([None, 1], 2, 4.876)
    """
    if isinstance(points, AlphaComplex):
        family = points
    elif is_of_space(points):
        raise InputError("persistence needs points in the plane; alpha_curves counts the parts of points in space")
    else:
        family = alpha_complex(points, strict=strict, allow_empty=allow_empty, threads=threads, progress=progress)
    if family.rule != "corrected":
        raise UsageError("persistence needs the corrected rule: leave out rule=printed")
    mesh = family.mesh
    ranks = family.triangle_rank, family.rank_max
    found = _core.alpha.region_persistence(
        len(family.spectrum), len(mesh.points), mesh.triangles, *ranks, family.sides, mesh.areas, progress
    )
    radius = np.append(family.spectrum, np.inf)
    return RegionPersistence(
        radius[found["birth"]],
        radius[found["death"]],
        found["into"],
        found["vertices"],
        found["triangles"],
        found["area"],
        _joined(family, progress),
    )


def _joined(family: AlphaComplex, progress: Progress) -> float:
    if unjoined(family) is None:
        return float(family.spectrum[automatic_rank(family, progress=progress)])
    return float(family.spectrum.max(initial=0.0))
