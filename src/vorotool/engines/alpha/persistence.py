"""Persistence of the regions of alpha shapes: how many clusters a dot pattern has (paper, section 2.3)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vorotool import _core
from vorotool.engines.alpha.alpha_complex import alpha_complex
from vorotool.engines.alpha.alpha_shape import automatic_rank, unjoined
from vorotool.engines.delaunay.delaunay import is_of_space
from vorotool.errors import InputError, UsageError
from vorotool.numeric.parallel import Progress
from vorotool.types.alpha.complex import AlphaComplex, RegionPersistence

if TYPE_CHECKING:
    from vorotool.typing import MeshLike


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
