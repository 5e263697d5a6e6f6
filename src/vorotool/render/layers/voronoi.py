"""The layers of a picture of a Voronoi map."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.numeric.arrays import Indices
from vorotool.render.canvas.layers import (
    CurvedPolygons,
    Curves,
    Layer,
    Lines,
    Makers,
    Page,
    Points,
    Polygons,
    Texts,
    column_texts,
    made_layers,
    name_size,
    without_empty,
)
from vorotool.render.canvas.styles import EDGE, INK, WHITE, cell_color
from vorotool.render.layers.mesh import cell_ids
from vorotool.render.layers.polygons import name_places, polygon_layers
from vorotool.types.voronoi.tables import neighbor_pairs, site_shapes
from vorotool.types.voronoi.voronoi_map import VoronoiMap


def voronoi_layers(cells: VoronoiMap, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make filled cells, all that bounds them, sites and names; lines and discs get finer where cells are small."""
    spacing = page.spacing(len(cells))
    width = min(max(spacing / 24, 0.1), 1.5)
    curves = cache(lambda: replace(_curves(cells), width=width))
    make: Makers = {
        "cells": lambda: [_filled(cells, curves(), width)],
        "edges": lambda: [curves()],
        "objects": lambda: _objects(cells, width, min(max(spacing / 12, 0.3), 4.0)),
        "labels": lambda: [_names(cells, page)],
    }
    return made_layers(layers, make)


def map_colors(cells: VoronoiMap) -> NDArray[np.uint32]:
    """(s,) color class of each cell, from 1: cells that share a border never have the same one."""
    a, b = np.ascontiguousarray(neighbor_pairs(cells)[0].T.astype(np.uint32))
    return _core.graphs.color_graph(len(cells), a, b, None)


def _curves(cells: VoronoiMap) -> Curves:
    """All arcs, with their control points after the vertices."""
    bent = np.flatnonzero(cells.is_parabola)
    control = np.full(len(cells.arcs), -1, dtype=np.int32)
    control[bent] = len(cells.vertices) + np.arange(len(bent))
    points = np.concatenate([cells.vertices, cells.control[bent]])
    circles = (cells.center, cells.mixed_arcs.is_left) if cells.is_circle.any() else (None, None)
    return Curves("edges", points, cells.arcs, control, INK, center=circles[0], is_left=circles[1])


def _filled(cells: VoronoiMap, curves: Curves, width: float) -> CurvedPolygons:
    arc, is_back = np.abs(cells.ring_arcs) - 1, cells.ring_arcs < 0
    colors = map_colors(cells)
    return CurvedPolygons(
        "cells",
        curves.points,
        cells.arcs[arc, is_back.astype(int)],
        cells.ring_starts,
        cells.polygon_starts,
        [cell_color(c) for c in range(int(colors.max(initial=0)) + 1)],
        colors[cells.cell_of_polygon],
        cell_ids(np.arange(1, len(cells) + 1), cells.components),
        EDGE,
        width,
        curves=curves,
        along=cells.ring_arcs,
    )


def _objects(cells: VoronoiMap, width: float, radius: float) -> list[Layer]:
    """Sites: areas through which half of their cells is seen, lines and outlines, and discs."""
    polygons = cells.polygons
    made: list[Layer] = []
    areas = polygon_layers(polygons, width, name="object-areas")[0]
    assert isinstance(areas, Polygons)
    if len(areas.corners):
        made.append(replace(areas, colors=[WHITE], is_sheer=True))
    goes_on = ~polygons.ends_line
    pairs = np.stack([np.flatnonzero(goes_on), polygons.following[goes_on]], axis=1).astype(np.int32)
    if len(pairs):
        made.append(Lines("objects", polygons.xy, pairs, INK, max(width, 0.2)))
    first = polygons.ring_starts[polygons.polygon_starts[:-1]]
    is_lone = polygons.is_line & (np.diff(polygons.ring_starts)[polygons.polygon_starts[:-1]] == 1)
    if is_lone.any():
        name = "object-points" if len(pairs) else "objects"
        made.append(Points(name, polygons.xy[first[is_lone]], radius=radius))
    return made


def _names(cells: VoronoiMap, page: Page) -> Texts:
    """Ids of the sites on these, else their labels, or what the column says that the page is to have."""
    own = cells.labels.tolist() if cells.ids is None else cells.ids
    texts = column_texts(cells.properties, page.style.label_by, own)
    places, site, dimension = _places_of_names(cells)
    size, is_centered = name_size(page, len(cells)), bool((dimension > 0).any())
    if is_centered:  # points are discs: their names stand above
        places[dimension == 0, 1] += page.distance(0.9 * size) * (1 if page.y_up else -1)
    return without_empty(
        Texts("labels", places, [texts[k] for k in site.tolist()], size=size, halo=WHITE, is_centered=is_centered)
    )


def _places_of_names(cells: VoronoiMap) -> tuple[NDArray[np.float64], Indices, NDArray[np.integer]]:
    """Inside the largest polygon of each site, in the middle of its longest line, or at a point; sites, dimensions."""
    import shapely

    site, parts = np.arange(len(cells)), site_shapes(cells)
    while (shapely.get_type_id(parts) > shapely.GeometryType.POLYGON).any():
        parts, index = shapely.get_parts(parts, return_index=True)
        site = site[index]
    places, chosen = name_places(parts, site)
    return places, site[chosen], shapely.get_dimensions(parts[chosen])
