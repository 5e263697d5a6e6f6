"""Shapes as distances between them are measured: points, edges, and what lies inside."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.sites import as_sites
from vorotool.errors import InputError
from vorotool.numeric.checks import checked_flag
from vorotool.numeric.crs import crs_name, same_crs
from vorotool.numeric.progress import Progress
from vorotool.plain import plain
from vorotool.types.magnitude import check_magnitude
from vorotool.types.polygons.polygon_set import HOLE, LINE, PolygonSet
from vorotool.types.polygons.used_shapes import with_used_rings


@plain(eq=False)
class MeasuredShape:
    """A shape, and the same in the core."""

    polygons: PolygonSet  # what it consists of; points are lines of one vertex
    elements: NDArray[np.float64]  # (n, 2, 2) float64 array: both ends of each edge; of a point, twice the same
    # (n,) int32 array: the ring of a polygon that each bounds what is inside of; -1 for none
    ring_of: NDArray[np.int32]
    core: _core.distances.Shape

    @property
    def is_filled(self) -> bool:
        """Whether there is anything inside."""
        return bool((self.ring_of >= 0).any())


def measured_shapes(
    a: Any, b: Any, *, boundary: bool = False, progress: Progress = None
) -> tuple[MeasuredShape, MeasuredShape]:
    """Give two shapes as they are measured; arguments as of `vorotool.hausdorff`."""
    boundary = checked_flag(boundary, "boundary")
    given = [as_sites(source, name=name).polygons for source, name in ((a, "a"), (b, "b"))]
    for name, polygons in zip("ab", given, strict=True):
        if not len(polygons):
            raise InputError(
                f"invalid {name}: the shape is empty, so no distance to it exists; give a shape with geometry"
            )
    _check_crs(*given)
    check_magnitude(np.concatenate([polygons.xy for polygons in given]))
    first, second = (_measured(with_used_rings(polygons), boundary, progress) for polygons in given)
    return first, second


def _check_crs(a: PolygonSet, b: PolygonSet) -> None:
    if a.crs is not None and b.crs is not None and not same_crs(a.crs, b.crs):
        raise InputError(
            f"a and b are in different coordinate reference systems, {crs_name(a.crs)} and {crs_name(b.crs)}: "
            "reproject one of them"
        )


def _measured(polygons: PolygonSet, boundary: bool, progress: Progress) -> MeasuredShape:
    start, after = edges_of(polygons)
    elements = np.stack([polygons.xy[start], polygons.xy[after]], axis=1)
    ring = np.searchsorted(polygons.ring_starts, start, side="right") - 1
    bounds = (polygons.ring_kind != LINE) & (not boundary)
    ring_of = np.where(bounds[ring], ring, -1).astype(np.int32)
    is_hole = (polygons.ring_kind == HOLE).astype(np.int32)
    rings = np.stack([polygons.ring_polygon, is_hole], axis=1) if bounds.any() else np.empty((0, 2), np.int32)
    core = _core.distances.Shape(elements.reshape(-1, 4), ring_of, np.ascontiguousarray(rings), progress)
    return MeasuredShape(polygons, elements, ring_of, core)


def edges_of(polygons: PolygonSet) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The first and last vertices of edges: of lines all but the last start one, a lone vertex ends at itself."""
    ends_line = np.zeros(len(polygons.xy), dtype=bool)
    is_open = (polygons.ring_kind == LINE) & (np.diff(polygons.ring_starts) > 1)
    ends_line[polygons.ring_starts[1:][is_open] - 1] = True
    start = np.flatnonzero(~ends_line)
    return start, polygons.following[start]
