"""The layers of pictures of triangulations, Voronoi cells and alpha shapes."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.alpha.alpha_hull import alpha_hull
from vorotool.engines.delaunay.cells import cell_colors
from vorotool.errors import VorotoolWarning
from vorotool.numeric.arrays import following, owners
from vorotool.render.canvas.layers import Arcs, Layer, Lines, Page, Points, Polygons, Texts, bounds_of
from vorotool.render.canvas.names import column_texts, without_empty
from vorotool.render.canvas.styles import BOUNDARY, CELLS, EDGE, FAINT, INK, PALE, SINGULAR, WHITE, cell_color
from vorotool.render.label_images.png import checked_layers
from vorotool.types.alpha.complex import CLASSES
from vorotool.types.alpha.shape import AlphaHull, AlphaShape
from vorotool.types.fields import is_up
from vorotool.types.mesh.cells import CellSet, ProximityGraph
from vorotool.types.mesh.triangulation import AnyTriangulation

LAYERS = ("cells", "triangles", "diagram", "edges", "points", "labels")
"""From below."""
OF_CELLS = ("cells", "diagram")
"""Filled cells, and their boundaries as lines."""


def mesh_layers(
    mesh: AnyTriangulation | ProximityGraph, page: Page, layers: Iterable[str], *, cells: CellSet | None = None
) -> list[Layer]:
    """Make layers of a triangulation, with cells if there are any; all gets finer where points are crowded."""
    known = LAYERS if cells is not None else tuple(name for name in LAYERS if name not in OF_CELLS)
    wanted = checked_layers(layers, known)
    corners, rings = mesh.triangles.reshape(-1), 3 * np.arange(len(mesh.triangles) + 1)
    is_sheer = "cells" in wanted  # or else triangles would hide them
    width = _line_width(len(mesh.points), page)
    made: dict[str, Layer] = {
        "triangles": Polygons("triangles", mesh.points, corners, rings, colors=[CELLS[4]], is_sheer=is_sheer),
        "edges": Lines("edges", mesh.points, mesh.edges, INK, width),
        "points": _points(mesh.points, page),
    }
    if cells is not None and "cells" in wanted:
        whole: Any = mesh.mesh if isinstance(mesh, ProximityGraph) else mesh
        colors = cell_colors(whole)
        made["cells"] = cell_polygons(cells, colors, page)
    if cells is not None and "diagram" in wanted:
        made["diagram"] = cell_lines(cells, page)
    if "labels" in wanted:
        made["labels"] = site_names(mesh, page)
    return [made[name] for name in LAYERS if name in wanted]


def cell_layers(cells: CellSet, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of cells alone, in colors that neighbors never share, which their triangulation tells."""
    from vorotool.engines.delaunay.delaunay import delaunay

    wanted = checked_layers(layers, (*OF_CELLS, "points", "labels"))
    made: list[Layer] = []
    if "cells" in wanted:
        with warnings.catch_warnings():  # that points lie on others was said where the cells were made
            warnings.simplefilter("ignore", VorotoolWarning)
            made.append(cell_polygons(cells, cell_colors(delaunay(cells.sites)), page))
    if "diagram" in wanted:
        made.append(cell_lines(cells, page))
    if "points" in wanted:
        made.append(_points(cells.sites, page))
    return [*made, site_names(cells, page)] if "labels" in wanted else made


def _points(places: NDArray[np.float64], page: Page) -> Points:
    return Points("points", places, radius=min(max(page.spacing(len(places)) / 12, 0.3), 4.0))


def site_names(sites: AnyTriangulation | ProximityGraph | CellSet, page: Page) -> Texts:
    """Ids of the sites beside these, or what the column says that the page is to have."""
    points = sites.sites if isinstance(sites, CellSet) else sites.points
    texts = column_texts(sites.properties, page.style.label_by, sites.label_array.tolist())
    size = min(max(page.spacing(len(points)) / 4, 2.0), 16.0)
    return without_empty(Texts("labels", points, texts, size=size, halo=WHITE))


def mesh_page(
    mesh: AnyTriangulation | ProximityGraph,
    *,
    width: int = 1000,
    bounds: tuple[float, float, float, float] | None = None,
) -> Page:
    """The page of a picture: with all points of a triangulation, or with other bounds."""
    up = is_up(mesh)
    return Page(bounds or bounds_of([Points("points", mesh.points)]), width=width, y_up=up)


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


def cell_page(cells: CellSet, *, width: int = 1000) -> Page:
    """The page that shows the frame of cells; y upwards where the input says so."""
    return Page(cells.frame.sides, width=width, y_up=is_up(cells))


def _line_width(count: int, page: Page) -> float:
    return min(max(page.spacing(count) / 24, 0.1), 1.5)


ALPHA_LAYERS = ("polygons", "delaunay", "interior", "boundary", "singular", "hull", "points", "labels")
"""From below."""


def alpha_layers(shape: AlphaShape, page: Page, layers: Iterable[str], *, hull: AlphaHull | None = None) -> list[Layer]:
    """Make layers of an alpha shape; lines and discs get finer where points are crowded."""
    wanted = checked_layers(layers, ALPHA_LAYERS)
    points = shape.points
    spacing = page.spacing(len(points))
    width = min(max(spacing / 16, 0.15), 2.0)
    made: dict[str, Layer] = {
        "polygons": _regions(shape),
        "delaunay": Lines("delaunay", points, shape.family.edges, PALE, width / 2),
        "interior": Lines("interior", points, _edges(shape, "interior"), FAINT, width / 2),
        "boundary": Lines("boundary", points, _edges(shape, "boundary"), BOUNDARY, width),
        "singular": Lines("singular", points, _edges(shape, "singular"), SINGULAR, width),
        "points": Points("points", points, radius=min(max(spacing / 12, 0.3), 4.0)),
    }
    if "hull" in wanted:
        hull = alpha_hull(shape) if hull is None else hull
        made["hull"] = Arcs("hull", hull.start, hull.end, hull.center, hull.ring_starts, CELLS[4], INK, width)
    if "labels" in wanted:
        made["labels"] = site_names(shape.family.mesh, page)
    return [made[name] for name in ALPHA_LAYERS if name in wanted]


def alpha_page(shape: AlphaShape, *, width: int = 1000) -> Page:
    """The page of a picture: that of the triangulation."""
    return mesh_page(shape.family.mesh, width=width)


def hull_layers(hull: AlphaHull, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of an alpha hull, and of the shape of its radius."""
    return alpha_layers(hull.shape, page, layers, hull=hull)


def hull_page(hull: AlphaHull, *, width: int = 1000) -> Page:
    """The page of a picture: that of the triangulation."""
    return alpha_page(hull.shape, width=width)


def _edges(shape: AlphaShape, name: str) -> NDArray[np.int32]:
    edges: NDArray[np.int32] = shape.family.edges[shape.edge_classes == CLASSES.index(name)]
    return edges


def _regions(shape: AlphaShape) -> Polygons:
    rings = shape.polygons
    corners = np.arange(len(rings.xy), dtype=np.int32)
    ids = [f"region-{number}" for number in range(1, len(rings) + 1)]
    first = rings.polygon_starts
    return Polygons("polygons", rings.xy, corners, rings.ring_starts, first, colors=[CELLS[4]], ids=ids)
