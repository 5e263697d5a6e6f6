"""The alpha shapes of all radii, and what is computed of them at once (paper, section 2.3)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.delaunay.delaunay import is_of_space, triangulated
from vorotool.errors import STRICT, InputError, UsageError, VorotoolWarning, warn
from vorotool.numeric.checks import checked_threads, is_choice
from vorotool.numeric.numbers import shown_number
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import resolved
from vorotool.products.registry import is_of
from vorotool.types.alpha.complex import AlphaComplex
from vorotool.types.alpha.radii import Radius, checked_radius
from vorotool.types.arguments import check_value
from vorotool.types.mesh.triangulation import DigitalTriangulation, Triangulation
from vorotool.types.points.point_set import known_of_points
from vorotool.types.table import Table

if TYPE_CHECKING:
    from vorotool.types.alpha.space import SpaceAlphaComplex
    from vorotool.types.mesh.tetrahedralization import Tetrahedralization
    from vorotool.types.points.point_set import VolumePoints
    from vorotool.types.volumes.volume import VolumeSeeds
    from vorotool.typing import AlphaRule, MeshLike

    SpaceLike = VolumePoints | VolumeSeeds | Tetrahedralization

RULES = ("corrected", "printed")
IN_SPACE = "engines.alpha.space_shape"
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
        refuse_in_space(rule=None if rule == "corrected" else rule)
        return resolved(f"{IN_SPACE}:space_complex")(
            points, strict=strict, allow_empty=allow_empty, threads=threads, progress=progress
        )
    how: Any = {"strict": strict, "allow_empty": allow_empty, "threads": threads, "progress": progress}
    return plane_complex(points, rule=rule, **how)


def _check_rule(rule: Any) -> None:
    if not is_choice(rule, RULES):
        raise UsageError(f"rule is {shown_number(rule)}: use corrected, or printed for the rule as the paper prints it")


def plane_complex(
    points: Any, *, rule: AlphaRule, strict: bool, allow_empty: bool | None, threads: int, progress: Progress
) -> AlphaComplex:
    """Compute the family of points in the plane."""
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


def allows_empty(points: Any, allow_empty: bool | None) -> bool:
    """Tell whether too few points are no error: as the caller says, else those of an image, one of many perhaps."""
    is_image = is_of(points, "SeedSet") and points.frame is not None
    return is_image if allow_empty is None else allow_empty


def report_too_few(count: int, *, allow_empty: bool, strict: bool) -> None:
    """Refuse points that no edge can join, or warn of them; of an image without any it has been told."""
    if not count and allow_empty:
        return
    held = "1 point" if count == 1 else f"{count} points"
    where = ", all at one position" if count > 1 else ""
    reason = f"an alpha shape needs at least two distinct points, but got {held}{where}"
    refuse_or_warn(reason, "", allow_empty=allow_empty, strict=strict)


def refuse_or_warn(reason: str, advice: str, *, allow_empty: bool, strict: bool) -> None:
    """Raise or warn for a reason why there is no shape."""
    if not allow_empty:
        raise InputError(f"{reason}{advice}")
    if strict:
        raise InputError(f"{reason}{f'{advice}, or' if advice else ':'} leave out {STRICT} for an empty shape")
    warn(VorotoolWarning(f"{reason}{advice}; the shape is empty"))


def refuse_in_space(**given: Any) -> None:
    """Refuse values of parameters that apply in the plane only."""
    name = next((name for name, value in given.items() if value is not None), None)
    if name is not None:
        raise UsageError(
            f"{name}={shown_number(given[name])} is for points in the plane: leave it out for points in space"
        )


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
    return scanned_edges(family, family.reached(r), family.entered(r), checked_threads(threads), progress)


def scanned_edges(
    family: AlphaComplex, reached: int, entered: int, threads: int, progress: Progress
) -> tuple[NDArray[np.int32], NDArray[np.uint8]]:
    """Find the edges of the shape of the first `reached` ranks, and their kinds."""
    ranks = family.rank_min, family.rank_mid, family.rank_max
    return _core.alpha.shape_edges(*ranks, reached, entered, threads, progress)


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
        return resolved(f"{IN_SPACE}:space_curves")(family, progress=progress)
    if family.rule != "corrected":
        raise UsageError("curves and the automatic radius need the corrected rule: leave out rule=printed")
    count = len(family.spectrum)
    walls = family.sides, family.rank_mid
    sizes = family.mesh.areas, family.lengths
    found = _core.alpha.alpha_curves(count, family.triangle_rank, *walls, *sizes, progress)
    changes = [np.bincount(ranks, minlength=count + 1)[:count] for ranks in (family.rank_min, family.rank_max)]
    return Table(
        {
            "r": family.spectrum,
            "area": found["content"],
            "perimeter": found["border"],
            "regions": found["regions"],
            "cavities": found["cavities"],
            "edges": np.cumsum(changes[0] - changes[1], dtype=np.int32),
        }
    )


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
