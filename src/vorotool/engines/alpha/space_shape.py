"""Alpha shapes of points in space."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.alpha.alpha_complex import report_too_few
from vorotool.engines.alpha.alpha_shape import settled_radius
from vorotool.engines.delaunay.tetrahedralization import tetrahedralization
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.parallel import Progress
from vorotool.types.alpha.radii import Radius
from vorotool.types.alpha.space import SpaceAlphaComplex, SpaceAlphaShape
from vorotool.types.mesh.tetrahedralization import Tetrahedralization
from vorotool.types.table import Table


def space_complex(
    points: Any, *, strict: bool = False, allow_empty: bool | None = None, threads: int = 0, progress: Progress = None
) -> SpaceAlphaComplex:
    """Compute the alpha shapes of all radii of points in space, as `vorotool.alpha_complex` does."""
    threads = checked_threads(threads)
    if isinstance(points, Tetrahedralization):
        mesh = points
    else:
        mesh = tetrahedralization(points, strict=strict, threads=threads, progress=progress)
    if len(mesh.points) - mesh.duplicates < 2:
        report_too_few(len(mesh.points), allow_empty=bool(allow_empty), strict=strict)
    chain = mesh.edges if mesh.dimension == 1 else np.empty((0, 2), dtype=np.int32)
    cells = mesh.points, mesh.tetrahedra, mesh.neighbors, mesh.planar, chain
    return SpaceAlphaComplex(mesh, **_core.tetrahedral_alpha.space_complex(*cells, threads, progress))


def space_shape(
    points: Any,
    radius: Radius | None,
    *,
    regions: int = 1,
    strict: bool = False,
    allow_empty: bool | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> SpaceAlphaShape:
    """Compute the alpha shape of points in space for one radius, as `vorotool.alpha_shape` does."""
    family = points
    if not isinstance(points, SpaceAlphaComplex):
        family = space_complex(points, strict=strict, allow_empty=allow_empty, threads=threads, progress=progress)
    how: Any = {"strict": strict, "allow_empty": bool(allow_empty), "progress": progress}
    radius = settled_radius(family, radius, regions=regions, **how)
    return SpaceAlphaShape(family, radius, _regions(family, family.reached(radius)))


def _regions(family: SpaceAlphaComplex, reached: int) -> NDArray[np.int32]:
    """(t,) regions of tetrahedra that are joined through triangles, numbered in the order of their first ones."""
    inside = family.tetrahedron_rank < reached
    sides = family.sides
    here, there = np.append(inside, False)[sides.T]  # side -1 is none
    root = _core.graphs.connected_components(np.ascontiguousarray(sides[here & there]), len(inside))
    is_first = inside & (root == np.arange(len(root)))
    numbers = np.cumsum(is_first, dtype=np.int32) - np.int32(1)
    return np.where(inside, numbers[root], np.int32(-1))


def space_curves(family: SpaceAlphaComplex, *, progress: Progress = None) -> Table:
    """Compute measures of the alpha shapes of all radii in one sweep, as `vorotool.alpha_curves` does."""
    mesh, count = family.mesh, len(family.spectrum)
    places = len(mesh.points) - mesh.duplicates
    ranks = family.edge_min, family.triangle_min, family.tetrahedron_rank
    walls = np.ascontiguousarray(family.sides), family.triangle_min
    sizes = mesh.volumes, family.areas(family.triangles)
    found = _core.alpha.alpha_curves(count, family.tetrahedron_rank, *walls, *sizes, progress)
    parts = _core.alpha.part_counts(count, places, family.edges, family.edge_min, None)
    edges, triangles, tetrahedra = (np.cumsum(np.bincount(rank, minlength=count)[:count]) for rank in ranks)
    euler = places - edges + triangles - tetrahedra
    return Table(
        {
            "r": family.spectrum,
            "volume": found["content"],
            "area": found["border"],
            "regions": found["regions"],
            "parts": parts,
            "cavities": found["cavities"],
            "tunnels": (parts + found["cavities"] - euler).astype(np.int32),
        }
    )
