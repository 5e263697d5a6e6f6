"""Small holes and regions of alpha shapes: which there are, by exact comparison of areas."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.numeric.numbers import nearest_double
from vorotool.numeric.progress import Progress
from vorotool.types.alpha.complex import AlphaComplex
from vorotool.types.mesh.triangulation import Triangulation


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
