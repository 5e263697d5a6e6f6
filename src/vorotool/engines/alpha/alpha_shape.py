"""Alpha shapes: the whole family at once, one shape, and the choice of the radius (paper, section 2.3)."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.alpha.few_points import (
    GIVE_R,
    allows_empty,
    least_ranks,
    radius_below_all,
    refuse_or_warn,
    report_too_few,
    unjoined,
)
from vorotool.engines.delaunay.delaunay import is_of_space, triangulated
from vorotool.errors import InputError, UsageError, option
from vorotool.numeric.arrays import ranges, starts_of
from vorotool.numeric.checks import checked_threads, is_choice
from vorotool.numeric.numbers import nearest_double, real_number, shown_number, whole_number
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import resolved
from vorotool.types.alpha.complex import AlphaComplex
from vorotool.types.alpha.radii import Radius, checked_radius
from vorotool.types.alpha.shape import AlphaShape
from vorotool.types.arguments import check_value
from vorotool.types.mesh.triangulation import DigitalTriangulation, Triangulation
from vorotool.types.points.point_set import known_of_points
from vorotool.types.polygons.polygon_set import HOLE, SHELL, PolygonSet
from vorotool.types.table import Table

if TYPE_CHECKING:
    from vorotool.types.alpha.space import SpaceAlphaComplex, SpaceAlphaShape
    from vorotool.types.mesh.tetrahedralization import Tetrahedralization
    from vorotool.types.points.point_set import VolumePoints
    from vorotool.types.volumes.volume import VolumeSeeds
    from vorotool.typing import AlphaRule, MeshLike, RealLike

    SpaceLike = VolumePoints | VolumeSeeds | Tetrahedralization

RULES = ("corrected", "printed")
_IN_SPACE = "engines.alpha.space_shape"
"""What does the same for points in space."""


@overload
def alpha_complex(
    points: SpaceLike,
    *,
    strict: bool = ...,
    allow_empty: bool | None = ...,
    threads: int = ...,
    progress: Progress = ...,
) -> SpaceAlphaComplex: ...


@overload
def alpha_complex(
    points: DigitalTriangulation | MeshLike,
    *,
    rule: AlphaRule = ...,
    strict: bool = ...,
    allow_empty: bool | None = ...,
    threads: int = ...,
    progress: Progress = ...,
) -> AlphaComplex: ...


def alpha_complex(
    points: DigitalTriangulation | MeshLike | SpaceLike,
    *,
    rule: AlphaRule = "corrected",
    strict: bool = False,
    allow_empty: bool | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> AlphaComplex | SpaceAlphaComplex:
    """Compute the alpha shapes of all radii: the interval of radii of each Delaunay edge.

    Of points in space it has the intervals of edges, triangles and tetrahedra.

    Every decision is exact: which edges are Gabriel edges, which radii are equal, and the order of the radii. Radii are
    correctly rounded. The diagonals of cocircular polygons in the triangulation do not affect the result.

    Parameters
    ----------
    points : PointSet, SeedSet, Triangulation, DigitalTriangulation, (n, 2) array, data frame, GeoSeries, …
        At least two distinct points, unless `allow_empty`. A triangulation is used unchanged; for a digital one only
        the edges are right. Points in space: VolumePoints, VolumeSeeds, Tetrahedralization or an (n, 3) array.
    rule : {"corrected", "printed"}
        ``printed`` follows the paper's text, which is wrong where an edge is no Gabriel edge; intervals are open.
    strict : bool
        Refuse duplicate points, and fewer than two distinct points in any case.
    allow_empty : bool, optional
        Return an empty family if there are fewer than two distinct points; default for the seeds of an image, so that
        one nearly empty image does not stop a batch.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    AlphaComplex
        The edges, each with its interval of radii.
    SpaceAlphaComplex
        Of points in space.

    Raises
    ------
    InputError
        If there are fewer than two distinct points, unless `allow_empty`, or a coordinate is not finite.
    UsageError
        If the rule is unknown, or ``printed`` for points in space, of which the text has none.

    Warns
    -----
    VorotoolWarning
        If the family is empty because there is one distinct point; an image without any is reported when it is read.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.3; Edelsbrunner, Kirkpatrick and Seidel 1983.

    Examples
    --------
    The paper's rule puts the edge from (0, 0) to (4, 0) in the shape from r = 2 on; no empty disc shows that:

    >>> points = [[0, 0], [4, 0], [2, 1], [2, -5]]
    >>> for rule in ("corrected", "printed"):
    ...     family = alpha_complex(points, rule=rule)
    ...     edge = family.edges.tolist().index([0, 1])
    ...     print(rule, family.r_min[edge], family.r_max[edge])
    corrected 2.5 2.9
    printed 2.0 2.9
    """
    _check_rule(rule)
    if is_of_space(points):
        _refuse_in_space(rule=None if rule == "corrected" else rule)
        made: SpaceAlphaComplex = resolved(f"{_IN_SPACE}:space_complex")(
            points, strict=strict, allow_empty=allow_empty, threads=threads, progress=progress
        )
        return made
    how: Any = {"strict": strict, "allow_empty": allow_empty, "threads": threads, "progress": progress}
    return _plane_complex(points, rule=rule, **how)


def _check_rule(rule: Any) -> None:
    if not is_choice(rule, RULES):
        raise UsageError(f"rule is {rule!r}: use corrected, or printed for the rule as the paper prints it")


def _plane_complex(
    points: Any, *, rule: AlphaRule, strict: bool, allow_empty: bool | None, threads: int, progress: Progress
) -> AlphaComplex:
    _check_rule(rule)
    threads = checked_threads(threads)
    if isinstance(points, DigitalTriangulation):
        mesh, edges, sides = linked_digital(points)
    else:
        if isinstance(points, Triangulation):
            mesh = points
        else:
            mesh = triangulated(points, strict=strict, threads=threads, progress=progress)
        edges, sides = _edges_and_sides(mesh, threads, progress)
    if len(mesh.points) - mesh.duplicates < 2:
        report_too_few(len(mesh.points), allow_empty=allows_empty(points, allow_empty), strict=strict)
    core_rule = _core.alpha.AlphaRule[rule]
    arrays = _core.alpha.alpha_complex(mesh.points, mesh.triangles, edges, sides, core_rule, threads, progress)
    return AlphaComplex(mesh, edges, sides, rule=rule, **arrays)


def _refuse_in_space(**given: Any) -> None:
    name = next((name for name, value in given.items() if value is not None), None)
    if name is not None:
        raise UsageError(f"{name}={given[name]!r} is for points in the plane: leave it out for points in space")


def _edges_and_sides(
    mesh: Triangulation, threads: int, progress: Progress
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    if not len(mesh.triangles):
        return mesh.edges, np.full(mesh.edges.shape, -1, dtype=np.int32)
    return _core.alpha.edges_of_triangles(mesh.triangles, mesh.neighbors, threads, progress)


def alpha_edges(
    family: AlphaComplex, r: Radius, *, threads: int = 0, progress: Progress = None
) -> tuple[NDArray[np.int32], NDArray[np.uint8]]:
    """Return the edges of the alpha shape of one radius, by one scan of the family.

    Parameters
    ----------
    family : AlphaComplex
        The shapes of all radii.
    r : float or Fraction
        The radius, positive; infinity gives the hull.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    edge_index : (k,) int32 array
        Edges of the family that are singular or boundary, increasing.
    kind : (k,) uint8 array
        1 for singular edges, 2 for boundary edges.

    Examples
    --------
    >>> family = alpha_complex([[0, 0], [4, 0], [0, 3]])
    >>> index, kind = alpha_edges(family, 2)
    >>> family.edges[index].tolist(), kind.tolist()
    ([[0, 2], [0, 1]], [1, 1])
    """
    check_value(family, "family", "AlphaComplex")
    r = checked_radius(r)
    return _scan(family, family.reached(r), family.entered(r), checked_threads(threads), progress)


def _scan(
    family: AlphaComplex, reached: int, entered: int, threads: int, progress: Progress
) -> tuple[NDArray[np.int32], NDArray[np.uint8]]:
    ranks = family.rank_min, family.rank_mid, family.rank_max
    return _core.alpha.shape_edges(*ranks, reached, entered, threads, progress)


CONVEX_HULL = f"for the convex hull use {option('-r inf', 'r=inf')}"
"""Advice where a radius without end is meant."""


def chosen_radius(r: Any, alpha: Any, automatic: bool = False) -> Radius | None:
    """Give the radius that was asked for; None for the automatic one."""
    given = {"r": r is not None, "alpha": alpha is not None, "auto": automatic}
    named = [name for name, is_given in given.items() if is_given]
    if len(named) > 1:
        raise UsageError(f"{' and '.join(named)} each set the radius: give only one of r, alpha and auto")
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
        _refuse_in_space(hole_threshold=hole_threshold, region_threshold=region_threshold, rule=own)
        how: dict[str, Any] = {"strict": strict, "allow_empty": allow_empty, "threads": threads, "progress": progress}
        made: SpaceAlphaShape = resolved(f"{_IN_SPACE}:space_shape")(points, radius, regions=regions, **how)
        return made
    if isinstance(points, AlphaComplex):
        family = points
    else:
        wanted: Any = {"rule": rule, "strict": strict, "allow_empty": allow_empty}
        family = _plane_complex(points, **wanted, threads=threads, progress=progress)
    reason = unjoined(family) if radius is None else None
    if reason is not None:
        if len(family):  # else it has been told that there are too few points
            refuse_or_warn(reason, GIVE_R, allow_empty=allows_empty(points, allow_empty), strict=strict)
        radius, reached, entered = radius_below_all(family), 0, 0
    elif radius is None:
        reached = automatic_rank(family, regions=regions, progress=progress) + 1
        radius = family.radius_from(reached - 1)
        entered = reached
    elif regions != 1:
        raise UsageError("regions applies to the automatic radius: leave out r and alpha")
    else:
        reached, entered = family.reached(radius), family.entered(radius)
    thresholds = _threshold(hole_threshold, "hole_threshold"), _threshold(region_threshold, "region_threshold")
    index, kind = _scan(family, reached, entered, checked_threads(threads), progress)
    return _shape(family, radius, reached, (index, kind), thresholds, progress)


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


def automatic_rank(family: AlphaComplex, *, regions: int = 1, progress: Progress = None) -> int:
    """Give the first rank whose shape has at most so many regions, which contain every point."""
    if whole_number(regions, "regions") < 1:
        raise UsageError(f"regions is {shown_number(regions)}: use 1 or more")
    if (reason := unjoined(family)) is not None:
        raise InputError(f"{reason}{GIVE_R}")
    covered = int(least_ranks(family).max(initial=0))
    found = np.flatnonzero(alpha_curves(family, progress=progress)["regions"][covered:] <= regions)
    return covered + int(found[0])


def alpha_curves(family: AlphaComplex | SpaceAlphaComplex, *, progress: Progress = None) -> Table:
    """Compute area, perimeter and counts of the alpha shapes of all radii in one sweep.

    Row k holds from radius k of the spectrum to the next one; below the first radius all points are isolated.

    Parameters
    ----------
    family : AlphaComplex or SpaceAlphaComplex
        The shapes of all radii, by the corrected rule.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    Table
        ``r, area, perimeter, regions, cavities, edges``: the area of the triangles, the length of the boundary edges,
        the regions (triangles joined through edges), the bounded components of their complement, and the number of
        singular and boundary edges.

        In space ``r, volume, area, regions, parts, cavities, tunnels``: the volume of the tetrahedra, the area of their
        surface, the regions (tetrahedra joined through triangles), the parts (all that is joined through edges, single
        points too), the bounded components of the complement of the shape, singular triangles included, and its
        tunnels, by Euler's relation.

    Raises
    ------
    UsageError
        If the rule is the printed one, whose edges do not match its triangles.

    Examples
    --------
    >>> curves = alpha_curves(alpha_complex([[0, 0], [4, 0], [0, 3]]))
    >>> curves["r"].tolist(), curves["area"].tolist(), curves["edges"].tolist()
    ([1.5, 2.0, 2.5], [0.0, 0.0, 6.0], [1, 2, 3])
    """
    check_value(family, "family", "AlphaComplex", "SpaceAlphaComplex")
    if not isinstance(family, AlphaComplex):
        in_space: Table = resolved(f"{_IN_SPACE}:space_curves")(family, progress=progress)
        return in_space
    if family.rule != "corrected":
        raise UsageError("curves and the automatic radius need the corrected rule: leave out rule=printed")
    curves = _core.alpha.alpha_curves(
        len(family.spectrum),
        family.triangle_rank,
        family.rank_min,
        family.rank_mid,
        family.rank_max,
        family.sides,
        family.mesh.areas,
        family.lengths,
        progress,
    )
    return Table({"r": family.spectrum, **curves})


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


def linked_digital(found: DigitalTriangulation) -> tuple[Triangulation, NDArray[np.int32], NDArray[np.int32]]:
    """Link edges of a digital triangulation, those of its triangles too, with the triangles on their two sides."""
    points = found.points
    turn = _core.kernel.orient2d(np.ascontiguousarray(points[found.triangles]))
    triangles = np.ascontiguousarray(found.triangles[turn > 0])
    edges = np.unique(np.concatenate([np.sort(found.edges, axis=1), found.sides]), axis=0).astype(np.int32)
    count = len(points)
    keys = edges[:, 0].astype(np.int64) * count + edges[:, 1]
    sides = np.full((len(edges), 2), -1, dtype=np.int32)
    for k in range(3):
        a, b = triangles[:, (k + 1) % 3].astype(np.int64), triangles[:, (k + 2) % 3].astype(np.int64)
        edge = np.searchsorted(keys, np.minimum(a, b) * count + np.maximum(a, b))
        left = np.where(a < b, 0, 1)
        for t, (e, side) in enumerate(zip(edge.tolist(), left.tolist(), strict=True)):
            held = int(sides[e, side])
            if held < 0 or _is_nearer(points, triangles, held, int(triangles[t, k])):
                sides[e, side] = t
    mesh = Triangulation(
        points,
        triangles,
        np.full(triangles.shape, -1, dtype=np.int32),
        edges,
        np.empty(0, np.int32),
        np.arange(count, dtype=np.int32),
        **known_of_points(found),
    )
    return mesh, edges, sides


def _is_nearer(points: NDArray[np.float64], triangles: NDArray[np.int32], held: int, corner: int) -> bool:
    """Whether a corner is strictly inside the circle of the triangle that an edge has so far."""
    four = np.ascontiguousarray(points[[*triangles[held], corner]][None])
    return bool(_core.kernel.incircle(four)[0] > 0)
