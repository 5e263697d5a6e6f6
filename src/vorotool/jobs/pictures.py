"""Pictures made of layers, and the layers of any value that has a picture."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

from vorotool.errors import UsageError, VorotoolWarning
from vorotool.products.registry import parts_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.geometry.mesh.cells import CellSet
    from vorotool.render.canvas.layers import Backdrop, Layer, Page


def write_layers(out: BinaryIO, layers: Sequence[Layer], page: Page, *, fmt: str, threads: int = 0) -> None:
    """Draw layers as SVG or PNG."""
    made = _finished(layers, page)
    if fmt == "svg":
        from vorotool.render.canvas.svg import write_layers_svg

        write_layers_svg(out, made.layers, page, insets=made.insets, threads=threads)
    else:
        from vorotool.formats.images.png_writer import write_png
        from vorotool.jobs.georeference import note_page

        note_page(page)
        has_alpha = page.backdrop is None and page.style.ground is None
        shape = page.height, page.width
        write_png(out, picture_bands(layers, page), shape, rgb=True, has_alpha=has_alpha, threads=threads)


def picture_bands(layers: Sequence[Layer], page: Page) -> Iterator[NDArray[np.uint8]]:
    """Give the rows of a picture as PNG has them; see `vorotool.render.canvas.png.layer_bands`."""
    from vorotool.render.canvas.png import layer_bands

    made = _finished(layers, page)
    return layer_bands(made.layers, page, insets=made.insets)


class _Finished(NamedTuple):
    """Layers as they are drawn, and what lies over them in px of the page."""

    layers: Sequence[Layer]
    insets: Sequence[Layer]


def _finished(layers: Sequence[Layer], page: Page) -> _Finished:
    """Give layers the chosen looks, over an image with edges, and make the legend and the scale bar."""
    from vorotool.render.canvas.halos import with_halos
    from vorotool.render.canvas.insets import insets
    from vorotool.render.canvas.scaled_page import styled_layers

    styled = styled_layers(layers, page.style)
    return _Finished(styled if page.backdrop is None else with_halos(styled), insets(styled, page))


# ---- any value -----------------------------------------------------------------------------------
class Drawing(NamedTuple):
    """Layers from below, and the page that they are drawn on."""

    layers: Sequence[Layer]
    page: Page


def drawing_of(
    value: Any,
    *,
    what: str | None = None,
    layers: Sequence[str] | None = None,
    width: int = 1000,
    backdrop: Backdrop | None = None,
    styled: Callable[[Page], Page] | None = None,
) -> Drawing:
    """Make the layers of the picture of a value other than a label image."""
    from vorotool.render.canvas.layers import ImagePage

    drawn = {name: each for name, each in parts_of(value).items() if each.usual_layers}
    for kind, page_of, layers_of in _drawings() if drawn else ():
        if not isinstance(value, kind):
            continue
        chosen = what or next(iter(drawn))
        if chosen not in drawn:
            raise UsageError(f"what={what!r} is no picture of a {type(value).__name__}: use {' or '.join(drawn)}")
        page = page_of(value, width=width) if backdrop is None else ImagePage(backdrop)
        page = page if styled is None else styled(page)
        usual = [layer for layer in drawn[chosen].usual_layers if backdrop is None or layer != "polygons"]
        shown = list(layers or usual)
        if page.style.label_by is not None and "labels" not in shown:
            shown.append("labels")
        return Drawing(layers_of(value, page, shown), page)
    raise UsageError(f"there is no picture of a {type(value).__name__}: write it as a table")


def _drawings() -> list[tuple[Any, Callable[..., Page], Callable[..., list[Layer]]]]:
    """The types that there are pictures of, and what makes their pages and layers."""
    from vorotool.geometry.alpha.hull import AlphaHull
    from vorotool.geometry.alpha.shape import AlphaShape
    from vorotool.geometry.distances.distances import Distances
    from vorotool.geometry.mesh.cells import CellSet
    from vorotool.geometry.mesh.digital_triangulation import DigitalTriangulation
    from vorotool.geometry.mesh.proximity import ProximityGraph
    from vorotool.geometry.mesh.triangulation import Triangulation
    from vorotool.geometry.polygons.polygon_set import PolygonSet
    from vorotool.geometry.skeleton.discs import Discs
    from vorotool.geometry.skeleton.led_on import LedOn
    from vorotool.geometry.skeleton.necks import Necks
    from vorotool.geometry.skeleton.offsets import Offsets
    from vorotool.geometry.skeleton.parts import Parts
    from vorotool.geometry.skeleton.points_along import SkeletonPoints
    from vorotool.geometry.skeleton.skeleton import Skeleton
    from vorotool.geometry.skeleton.smooth_lines import SmoothLines
    from vorotool.geometry.voronoi.voronoi_map import VoronoiMap
    from vorotool.render.layers.alpha import alpha_layers
    from vorotool.render.layers.cells import cells_page
    from vorotool.render.layers.discs import disc_layers, disc_page
    from vorotool.render.layers.distances import distance_layers, distance_page
    from vorotool.render.layers.lines_along import line_layers
    from vorotool.render.layers.mesh import mesh_layers, mesh_page
    from vorotool.render.layers.necks import neck_layers, neck_page, part_layers, part_page
    from vorotool.render.layers.offsets import offset_layers, offset_page
    from vorotool.render.layers.points_along import point_page, skeleton_point_layers
    from vorotool.render.layers.polygons import polygon_page, shape_layers
    from vorotool.render.layers.skeleton import skeleton_layers, skeleton_page
    from vorotool.render.layers.voronoi import voronoi_layers, voronoi_page

    return [
        ((Triangulation, DigitalTriangulation, ProximityGraph), mesh_page, mesh_layers),
        (CellSet, cells_page, _cell_layers),
        (AlphaShape, lambda value, **options: mesh_page(value.family.mesh, **options), alpha_layers),
        (
            AlphaHull,
            lambda value, **options: mesh_page(value.shape.family.mesh, **options),
            lambda value, page, layers: alpha_layers(value.shape, page, layers, hull=value),
        ),
        (PolygonSet, polygon_page, shape_layers),
        (Skeleton, skeleton_page, skeleton_layers),
        ((LedOn, SmoothLines), lambda value, **options: skeleton_page(value.path, **options), line_layers),
        (SkeletonPoints, point_page, skeleton_point_layers),
        (Necks, neck_page, neck_layers),
        (Parts, part_page, part_layers),
        (Offsets, offset_page, offset_layers),
        (Discs, disc_page, disc_layers),
        (VoronoiMap, voronoi_page, voronoi_layers),
        (Distances, distance_page, distance_layers),
    ]


def _cell_layers(cells: CellSet, page: Page, layers: Sequence[str]) -> list[Layer]:
    """Cells in colors that neighbors never share, which their triangulation tells."""
    from vorotool.engines.delaunay.cells import cell_colors
    from vorotool.engines.delaunay.delaunay import delaunay
    from vorotool.render.canvas.layers import Points
    from vorotool.render.label_images.png import checked_layers
    from vorotool.render.layers.cells import cell_lines, cell_polygons
    from vorotool.render.layers.mesh import site_names

    wanted = checked_layers(layers, ("cells", "diagram", "points", "labels"))
    made: list[Layer] = []
    if "cells" in wanted:
        with warnings.catch_warnings():  # that points lie on others was said where the cells were made
            warnings.simplefilter("ignore", VorotoolWarning)
            mesh = delaunay(cells.sites)
        made.append(cell_polygons(cells, cell_colors(mesh), page))
    if "diagram" in wanted:
        made.append(cell_lines(cells, page))
    if "points" in wanted:
        made.append(Points("points", cells.sites, radius=min(max(page.spacing(len(cells)) / 12, 0.3), 4.0)))
    if "labels" in wanted:
        made.append(site_names(cells, page))
    return made
