"""Local thickness between two bounds that know no skeleton: the distances of a grid of places from the outlines."""

from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from vorotool import PolygonSet
from vorotool.types.polygons.shapely_geometry import to_shapely

Floats = NDArray[np.float64]
NEAR = 1e-9


class Bounds(NamedTuple):
    """What the thickness of each pixel is at least and at most."""

    least: Floats
    most: Floats


def thickness_bounds(polygons: PolygonSet, shape: tuple[int, int], sides: tuple[float, float], step: float) -> Bounds:
    """Give bounds of the diameters of the largest discs over pixels, from discs at a grid of places.

    A disc with its center at a place of the grid, and the distance from the outline as radius, is inside. The best disc
    of all has its center within half a diagonal `h` of a place of the grid: that place is then at least its radius less
    `h` from the outline, and the pixel as near as that plus twice `h`.
    """
    (height, width), (down, across) = shape, sides
    rows, columns = np.indices(shape)
    pixels = np.stack([columns * across, rows * down], axis=-1).reshape(-1, 2).astype(float)
    x, y = np.meshgrid(np.arange(-across / 2, width * across, step), np.arange(-down / 2, height * down, step))
    grid, half = np.stack([x, y], axis=-1).reshape(-1, 2), step * np.sqrt(0.5)
    least, most = np.zeros(len(pixels)), np.zeros(len(pixels))
    for shape_of in to_shapely(polygons):
        places = grid[shapely.contains_xy(shape_of, *grid.T)]
        radius = shapely.distance(shapely.points(places), shape_of.boundary)
        own = np.flatnonzero(shapely.intersects_xy(shape_of, *pixels.T))
        apart = np.sqrt(np.square(pixels[own, None] - places[None]).sum(axis=2))
        least[own] = np.maximum(least[own], np.where(apart <= radius, radius, 0).max(axis=1, initial=0))
        wide = np.where(apart <= radius + 2 * half, radius, 0).max(axis=1, initial=0)
        most[own] = np.maximum(most[own], wide + half)
    return Bounds(2 * least.reshape(shape), 2 * most.reshape(shape))


def check_thickness(thickness: Floats, polygons: PolygonSet, sides: tuple[float, float], step: float) -> None:
    """Raise AssertionError where a thickness is not between the bounds."""
    bounds = thickness_bounds(polygons, thickness.shape, sides, step)
    assert (thickness >= bounds.least - NEAR).all(), np.argwhere(thickness < bounds.least - NEAR)[0]
    assert (thickness <= bounds.most + NEAR).all(), np.argwhere(thickness > bounds.most + NEAR)[0]
