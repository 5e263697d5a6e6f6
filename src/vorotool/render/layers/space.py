"""The layers of pictures of triangulations and alpha shapes in space, as seen from far away."""

from __future__ import annotations

from collections.abc import Iterable
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, Indices, ranges, starts_of
from vorotool.render.canvas.layers import (
    Layer,
    Lines,
    Makers,
    Page,
    Points,
    Polygons,
    made_layers,
)
from vorotool.render.canvas.styles import CELLS, INK
from vorotool.render.layers.mesh import site_names
from vorotool.types.alpha.space import SpaceAlphaShape
from vorotool.types.mesh.tetrahedralization import Tetrahedralization

_TO_RIGHT = 3 / sqrt(13), 2 / sqrt(13), 0.0
_UPWARDS = -4 / sqrt(221), 6 / sqrt(221), 13 / sqrt(221)
_TO_VIEWER = 2 / sqrt(17), -3 / sqrt(17), 2 / sqrt(17)
_TO_LIGHT = 1 / 3, -2 / 3, 2 / 3
_SHADES = 32


def seen(places: Floats) -> Floats:
    """Give (n, 2) places to the right and upwards, for a viewer in front, on the right and above; z goes upwards."""
    return np.stack([_along(places, _TO_RIGHT), _along(places, _UPWARDS)], axis=1)


def _along(ways: Floats, axis: tuple[float, float, float]) -> Floats:
    """Give the components of (n, 3) vectors along an axis, each sum in the same order on all machines."""
    x, y, z = ways.T
    return x * axis[0] + y * axis[1] + z * axis[2]


def space_layers(mesh: Tetrahedralization, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of a triangulation in space."""
    return _layers("hull", mesh, mesh, page, list(layers))


def surface_layers(shape: SpaceAlphaShape, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of an alpha shape in space."""
    return _layers("surface", shape, shape.family.mesh, page, list(layers))


def _layers(
    faces: str, value: Tetrahedralization | SpaceAlphaShape, mesh: Tetrahedralization, page: Page, names: list[str]
) -> list[Layer]:
    """Make layers; lines and discs get finer where points are crowded."""
    places = seen(mesh.points)
    crowd = page.spacing(len(places))
    make: Makers = {
        faces: lambda: [_shaded(faces, mesh.points, value, is_sheer=len(names) > 1)],
        "edges": lambda: [Lines("edges", places, value.edges, INK, min(max(crowd / 48, 0.1), 1.0))],
        "points": lambda: [Points("points", places, radius=min(max(crowd / 16, 0.3), 3.0))],
        "labels": lambda: [site_names(mesh, places, page)],
    }
    return made_layers(names, make)


def _shaded(name: str, points: Floats, value: Tetrahedralization | SpaceAlphaShape, *, is_sheer: bool) -> Polygons:
    """Fill the triangles that show their front, those behind first, the darker the more they turn from the light."""
    triangles: NDArray[np.int32] = getattr(value, name)
    scaled = np.ldexp(points, -int(np.frexp(np.abs(points).max(initial=0.0))[1]))  # products of sizes are doubles
    normals = _normals(scaled, triangles)
    facing = np.flatnonzero(_along(normals, _TO_VIEWER) > 0)
    middle = _along(scaled[triangles[facing]].sum(axis=1), _TO_VIEWER)
    rows = _rows_in_depth(value, scaled)[facing] if isinstance(value, SpaceAlphaShape) else np.zeros(len(facing))
    order = facing[np.lexsort((middle, rows))]
    lengths = np.sqrt((normals[order] ** 2).sum(axis=1))
    light = np.clip(_along(normals[order], _TO_LIGHT) / lengths, 0, 1)
    return Polygons(
        name,
        seen(points),
        triangles[order].reshape(-1).astype(np.int32),
        3 * np.arange(len(order) + 1),
        colors=[_shade(k / (_SHADES - 1)) for k in range(_SHADES)],
        color_of=np.rint(light * (_SHADES - 1)).astype(np.int64),
        edge=INK if name == "hull" else None,  # of a hull no line lies behind another face
        width=0.3,
        is_alone=np.ones(len(order), dtype=bool),
        is_sheer=is_sheer,
        is_sealed=name != "hull" and not is_sheer,
    )


def _normals(points: Floats, triangles: NDArray[np.int32]) -> Floats:
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    return np.cross(b - a, c - a)


def _rows_in_depth(shape: SpaceAlphaShape, points: Floats) -> Indices:
    """Number the triangles of a surface so that no line of sight meets one of a larger number behind another.

    A tetrahedron has the length of the longest row of tetrahedra behind it, each behind the next one; no such row of a
    Delaunay triangulation ends where it begins (Edelsbrunner 1990). A triangle has the number of what is in front.
    """
    family = shape.family
    towards = _along(_normals(points, family.triangles), _TO_VIEWER)
    behind, front = np.where(towards > 0, family.sides.T, family.sides.T[::-1])
    is_inner = (behind >= 0) & (front >= 0) & (towards != 0)
    source, target = behind[is_inner], front[is_inner]
    target, start = target[np.argsort(source, kind="stable")], starts_of(np.bincount(source, minlength=len(family)))
    waiting = np.bincount(target, minlength=len(family))
    row = np.zeros(len(family), dtype=np.int64)
    last, step = np.flatnonzero(waiting == 0), 0
    while len(last):
        row[last] = step
        reached, count = np.unique(target[ranges(start[last], np.diff(start)[last])], return_counts=True)
        waiting[reached] -= count
        last, step = reached[waiting[reached] == 0], step + 1
    index = shape.surface_index
    behind, front = behind[index], front[index]
    return np.where(front >= 0, row[front], row[behind] + 1)


def _shade(light: float) -> str:
    """Give the color of a face."""
    channels = (int(CELLS[0][k : k + 2], 16) for k in (1, 3, 5))
    return "#" + "".join(f"{round(channel * (0.35 + 0.65 * light)):02x}" for channel in channels)
