"""The layers of pictures of triangulations, Voronoi cells and alpha shapes, in the plane and in space from far away."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.alpha.alpha_hull import alpha_hull
from vorotool.engines.delaunay.cells import cell_colors
from vorotool.errors import VorotoolWarning
from vorotool.numeric.arrays import Floats, Indices, following, owners, ranges, starts_of
from vorotool.render.canvas.layers import (
    Arcs,
    Layer,
    Lines,
    Makers,
    Page,
    Points,
    Polygons,
    Texts,
    column_texts,
    made_layers,
    without_empty,
)
from vorotool.render.canvas.styles import BOUNDARY, CELLS, EDGE, FAINT, INK, PALE, SINGULAR, WHITE, cell_color
from vorotool.types.alpha.complex import CLASSES
from vorotool.types.alpha.shape import AlphaHull, AlphaShape
from vorotool.types.alpha.space import SpaceAlphaShape
from vorotool.types.mesh.cells import CellSet, ProximityGraph
from vorotool.types.mesh.tetrahedralization import Tetrahedralization
from vorotool.types.mesh.triangulation import AnyTriangulation

OF_CELLS = ("cells", "diagram")
"""Filled cells, and their boundaries as lines."""


def mesh_layers(
    mesh: AnyTriangulation | ProximityGraph, page: Page, layers: Iterable[str], *, cells: CellSet | None = None
) -> list[Layer]:
    """Make layers of a triangulation, with cells if there are any; all gets finer where points are crowded."""
    names = list(layers)
    corners, rings = mesh.triangles.reshape(-1), 3 * np.arange(len(mesh.triangles) + 1)
    is_sheer = "cells" in names  # or else triangles would hide them
    whole: Any = mesh.mesh if isinstance(mesh, ProximityGraph) else mesh
    make: Makers = {}
    if cells is not None:
        make["cells"] = lambda: [cell_polygons(cells, cell_colors(whole), page)]
    make["triangles"] = lambda: [
        Polygons("triangles", mesh.points, corners, rings, colors=[CELLS[4]], is_sheer=is_sheer)
    ]
    if cells is not None:
        make["diagram"] = lambda: [cell_lines(cells, page)]
    make["edges"] = lambda: [Lines("edges", mesh.points, mesh.edges, INK, _line_width(len(mesh.points), page))]
    return made_layers(names, make | _site_layers(mesh, mesh.points, page))


def cell_layers(cells: CellSet, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of cells alone, in colors that neighbors never share, which their triangulation tells."""
    from vorotool.engines.delaunay.delaunay import delaunay

    def filled() -> list[Layer]:
        with warnings.catch_warnings():  # that points lie on others was said where the cells were made
            warnings.simplefilter("ignore", VorotoolWarning)
            return [cell_polygons(cells, cell_colors(delaunay(cells.sites)), page)]

    make: Makers = {"cells": filled, "diagram": lambda: [cell_lines(cells, page)]}
    return made_layers(layers, make | _site_layers(cells, cells.sites, page))


def _site_layers(sites: AnyTriangulation | ProximityGraph | CellSet, places: NDArray[np.float64], page: Page) -> Makers:
    """Make discs, which get smaller where points are crowded, and their names."""
    radius = min(max(page.spacing(len(places)) / 12, 0.3), 4.0)
    return {
        "points": lambda: [Points("points", places, radius=radius)],
        "labels": lambda: [site_names(sites, places, page)],
    }


def site_names(
    sites: AnyTriangulation | Tetrahedralization | ProximityGraph | CellSet, points: NDArray[np.float64], page: Page
) -> Texts:
    """Ids of the sites beside these, or what the column says that the page is to have."""
    texts = column_texts(sites.properties, page.style.label_by, sites.label_array.tolist())
    size = min(max(page.spacing(len(points)) / 4, 2.0), 16.0)
    return without_empty(Texts("labels", points, texts, size=size, halo=WHITE))


def cell_polygons(cells: CellSet, colors: NDArray[np.unsignedinteger], page: Page) -> Polygons:
    """Fill cells; their outlines get finer where cells are small."""
    rings, polygons, of_cells = cells.nesting
    counts = np.diff(of_cells)
    return Polygons(
        "cells",
        cells.coordinates,
        np.arange(len(cells.coordinates), dtype=np.int32),
        rings,
        polygons,
        [cell_color(c) for c in range(int(colors.max(initial=0)) + 1)],
        np.asarray(colors)[owners(counts)],
        cell_ids(cells.label_array, counts),
        EDGE,
        _line_width(len(cells), page),
    )


def cell_ids(labels: NDArray[np.integer], counts: NDArray[np.integer]) -> list[str]:
    """Name the polygons of cells: those of a cell of several are numbered."""
    parts = [(label, count) for label, count in zip(labels.tolist(), counts.tolist(), strict=True) if count]
    return [f"cell-{label}" + (f"-{k + 1}" if count > 1 else "") for label, count in parts for k in range(count)]


def cell_lines(cells: CellSet, page: Page) -> Lines:
    """Draw the boundaries of cells as lines, each side once where two cells share it."""
    _, index = np.unique(cells.coordinates, axis=0, return_inverse=True)
    rings = cells.nesting.rings
    first = np.full(int(index.max(initial=-1)) + 1, len(index), dtype=np.int32)
    np.minimum.at(first, index.reshape(-1), np.arange(len(index), dtype=np.int32))
    number = first[index.reshape(-1)]  # coincident vertices have that of the first one
    sides = np.unique(np.sort(np.stack([number, number[following(rings)]], axis=1), axis=1), axis=0)
    return Lines("diagram", cells.coordinates, sides, INK, _line_width(len(cells), page))


def _line_width(count: int, page: Page) -> float:
    return min(max(page.spacing(count) / 24, 0.1), 1.5)


def alpha_layers(shape: AlphaShape, page: Page, layers: Iterable[str], *, hull: AlphaHull | None = None) -> list[Layer]:
    """Make layers of an alpha shape; lines and discs get finer where points are crowded."""
    points = shape.points
    width = min(max(page.spacing(len(points)) / 16, 0.15), 2.0)

    def edges(name: str, color: str, width: float) -> Callable[[], list[Layer]]:
        return lambda: [
            Lines(name, points, shape.family.edges[shape.edge_classes == CLASSES.index(name)], color, width)
        ]

    def filled() -> list[Layer]:
        own = alpha_hull(shape) if hull is None else hull
        return [Arcs("hull", own.start, own.end, own.center, own.ring_starts, CELLS[4], INK, width)]

    make: Makers = {
        "polygons": lambda: [_regions(shape)],
        "delaunay": lambda: [Lines("delaunay", points, shape.family.edges, PALE, width / 2)],
        "interior": edges("interior", FAINT, width / 2),
        "boundary": edges("boundary", BOUNDARY, width),
        "singular": edges("singular", SINGULAR, width),
        "hull": filled,
    }
    return made_layers(layers, make | _site_layers(shape.family.mesh, points, page))


def hull_layers(hull: AlphaHull, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of an alpha hull, and of the shape of its radius."""
    return alpha_layers(hull.shape, page, layers, hull=hull)


def _regions(shape: AlphaShape) -> Polygons:
    rings = shape.polygons
    corners = np.arange(len(rings.xy), dtype=np.int32)
    ids = [f"region-{number}" for number in range(1, len(rings) + 1)]
    first = rings.polygon_starts
    return Polygons("polygons", rings.xy, corners, rings.ring_starts, first, colors=[CELLS[4]], ids=ids)


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
