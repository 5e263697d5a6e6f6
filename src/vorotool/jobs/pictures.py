"""Pictures: of label images, from layers, and of any value that has one."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError, VorotoolWarning
from vorotool.geometry.points.label_image import LabelImage
from vorotool.products.registry import parts_of

if TYPE_CHECKING:
    from vorotool.geometry.mesh.cells import CellSet
    from vorotool.render.canvas.layers import Backdrop, Layer, Page
    from vorotool.render.label_images.png import Names

BAND_ROWS = 256
"""Rows of a picture that are composed at a time."""

LARGEST_TABLE = 1 << 20
"""Entries that a table of colours by label may have in any case; beyond, it must be mostly used."""


def write_label_picture(
    out: BinaryIO,
    image: LabelImage,
    colours: tuple[NDArray[Any], NDArray[Any]],
    *,
    fmt: str,
    layers: Sequence[str],
    width: int = 1000,
    y_up: bool = False,
    backdrop: Backdrop | None = None,
    threads: int = 0,
) -> None:
    """Draw a label image as SVG or as a palette PNG of its own size, or over an image.

    Parameters
    ----------
    out : binary file
        Where to write.
    image : LabelImage
        With seeds, if these are drawn.
    colours : pair of (k,) integer arrays
        The labels that occur, increasing, and the colour class of each: what `region_colours` gives.
    fmt : {"png", "svg"}
        Kind of picture.
    layers : sequence of str
        Of cells, diagram (PNG), labels and seeds.
    width : int
        Pixels across an SVG.
    y_up : bool
        Draw the last row on top.
    backdrop : Backdrop, optional
        The image, whose size the picture has.
    threads : int
        0 uses all.
    """
    if y_up:
        image = image.flipped()
    if fmt == "svg":
        from vorotool.render.label_images.svg import has_numbers, write_label_svg

        by_label = dict(zip(colours[0].tolist(), colours[1].tolist(), strict=True))
        names = None if has_numbers(image.shape) else _names(image, layers, threads)
        write_label_svg(
            out, image, colour_of_label=by_label, width=width, layers=layers, backdrop=backdrop, names=names
        )
    else:
        _write_png(out, image, colours, layers, backdrop, threads)


def default_layers(image: LabelImage, layers: Sequence[str]) -> tuple[str, ...]:
    """Layers of a picture for which none are chosen: numbers in the pixels of small images, but no names in others."""
    from vorotool.render.label_images.svg import has_numbers

    return tuple(layer for layer in layers if layer != "labels" or has_numbers(image.shape))


def _names(image: LabelImage, layers: Sequence[str], threads: int) -> Names | None:
    """Labels, deep inside their objects or regions."""
    if "labels" not in layers:
        return None
    from vorotool.engines.label_images.label_places import name_places
    from vorotool.render.label_images.png import Names

    labels, places = name_places(image, threads=threads)
    return Names([str(label) for label in labels.tolist()], places)


def _write_png(
    out: BinaryIO,
    image: LabelImage,
    colours: tuple[NDArray[Any], NDArray[Any]],
    layers: Sequence[str],
    backdrop: Backdrop | None,
    threads: int,
) -> None:
    from vorotool.engines.label_images.regions import voronoi_diagram
    from vorotool.formats.images.png_writer import write_png
    from vorotool.render.canvas.palettes import picture_palette
    from vorotool.render.label_images.png import around, over_image, picture_bands

    names = _names(image, layers, threads)
    starts = range(0, image.shape[0], BAND_ROWS)
    diagram = voronoi_diagram(image, threads=threads).view(bool) if "diagram" in layers else None
    halo = None if diagram is None or backdrop is None else around(diagram)
    palette = picture_palette(int(colours[1].max(initial=0)), has_halo=names is not None or halo is not None)
    number, colour_of_number = _numbering(*colours)
    bands = picture_bands(
        (number(image.labels[row : row + BAND_ROWS]) for row in starts),
        shape=image.shape,
        palette=palette,
        colour_of_label=colour_of_number,
        diagram=None if diagram is None else (diagram[row : row + BAND_ROWS] for row in starts),
        halo=None if halo is None else (halo[row : row + BAND_ROWS] for row in starts),
        seeds=image.seeds,
        frame=image.frame,
        names=names,
        layers=layers,
    )
    if backdrop is not None:
        assert image.frame is not None  # LabelImage has filled it in
        made = over_image(bands, backdrop, palette, image.frame)
        write_png(out, [made], backdrop.pixels.shape[:2], rgb=True, threads=threads)
        return
    write_png(out, bands, image.shape, bit_depth=palette.bit_depth, palette=palette.colours, threads=threads)


def _numbering(
    labels: NDArray[Any], classes: NDArray[Any]
) -> tuple[Callable[[NDArray[Any]], NDArray[Any]], NDArray[Any]]:
    """Numbers that a table of colours is indexed by: the labels, or their ranks from 1 where labels are sparse."""
    largest = int(labels.max(initial=0))
    if largest > 4 * len(labels) + LARGEST_TABLE:
        known = np.append(0, labels)
        return lambda band: np.searchsorted(known, band), np.append(0, classes)
    by_label = np.zeros(largest + 1, classes.dtype)
    by_label[labels] = classes
    return np.asarray, by_label


def write_layers(out: BinaryIO, layers: Sequence[Layer], page: Page, *, fmt: str, threads: int = 0) -> None:
    """Draw layers as SVG or PNG.

    Parameters
    ----------
    out : binary file
        Where to write.
    layers : sequence of Layer
        What to draw, from below; over an image lines have a light edge, so that they show on dark ground, too.
    page : Page
        Where it lies.
    fmt : {"svg", "png"}
        Kind of picture.
    threads : int
        0 uses all.
    """
    from vorotool.render.canvas.scaled_page import styled_layers

    layers = styled_layers(layers, page.style)
    if page.backdrop is not None:
        from vorotool.render.canvas.layers import with_halos

        layers = with_halos(layers)
    if fmt == "svg":
        from vorotool.render.canvas.svg import write_layers_svg

        write_layers_svg(out, layers, page, threads=threads)
    else:
        from vorotool.formats.images.png_writer import write_png
        from vorotool.render.canvas.png import layer_bands

        write_png(out, layer_bands(layers, page), (page.height, page.width), rgb=True, threads=threads)


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
    y_up: bool | None = None,
    backdrop: Backdrop | None = None,
    styled: Callable[[Page], Page] | None = None,
) -> Drawing:
    """Make the layers of the picture of a value other than a label image.

    Parameters
    ----------
    value : value of the library
        A triangulation, cells, an alpha shape or hull, polygons, a skeleton, points along one, or offset curves.
    what : str, optional
        Which part, by its name in the registry of products; by default the first that is drawn.
    layers : sequence of str, optional
        Which; by default the usual ones of the part, over an image without the polygons.
    width : int
        Of the page, in px.
    y_up : bool, optional
        Draw y upwards; by default as the input is drawn.
    backdrop : Backdrop, optional
        An image to draw over, whose size the page then has.
    styled : callable, optional
        Gives the page that is drawn on for the one that it would be else.

    Raises
    ------
    UsageError
        If there is no picture of it, or no such layer.

    Examples
    --------
    >>> from vorotool import delaunay
    >>> [layer.name for layer in drawing_of(delaunay([[0, 0], [4, 0], [0, 3]])).layers]
    ['edges', 'points']
    """
    from vorotool.render.canvas.layers import ImagePage

    drawn = {name: each for name, each in parts_of(value).items() if each.usual_layers}
    for kind, page_of, layers_of in _drawings() if drawn else ():
        if not isinstance(value, kind):
            continue
        chosen = what or next(iter(drawn))
        if chosen not in drawn:
            raise UsageError(f"what={what!r} is no picture of a {type(value).__name__}: use {' or '.join(drawn)}")
        page = page_of(value, width=width, y_up=y_up) if backdrop is None else ImagePage(backdrop)
        page = page if styled is None else styled(page)
        usual = [layer for layer in drawn[chosen].usual_layers if backdrop is None or layer != "polygons"]
        return Drawing(layers_of(value, page, layers or usual), page)
    raise UsageError(f"there is no picture of a {type(value).__name__}: write it as a table")


def _drawings() -> list[tuple[Any, Callable[..., Page], Callable[..., list[Layer]]]]:
    """The types that there are pictures of, and what makes their pages and layers."""
    from vorotool.geometry.alpha.hull import AlphaHull
    from vorotool.geometry.alpha.shape import AlphaShape
    from vorotool.geometry.mesh.cells import CellSet
    from vorotool.geometry.mesh.digital_triangulation import DigitalTriangulation
    from vorotool.geometry.mesh.triangulation import Triangulation
    from vorotool.geometry.polygons.polygon_set import PolygonSet
    from vorotool.geometry.skeleton.centerline import Centerlines
    from vorotool.geometry.skeleton.offsets import Offsets
    from vorotool.geometry.skeleton.points_along import SkeletonPoints
    from vorotool.geometry.skeleton.skeleton import Skeleton
    from vorotool.render.layers.alpha import alpha_layers
    from vorotool.render.layers.cells import cells_page
    from vorotool.render.layers.mesh import mesh_layers, mesh_page
    from vorotool.render.layers.offsets import offset_layers, offset_page
    from vorotool.render.layers.points_along import point_page, skeleton_point_layers
    from vorotool.render.layers.polygons import polygon_page, shape_layers
    from vorotool.render.layers.skeleton import centerline_layers, skeleton_layers, skeleton_page

    return [
        ((Triangulation, DigitalTriangulation), mesh_page, mesh_layers),
        (CellSet, cells_page, _cell_layers),
        (AlphaShape, lambda value, **options: mesh_page(value.family.mesh, **options), alpha_layers),
        (
            AlphaHull,
            lambda value, **options: mesh_page(value.shape.family.mesh, **options),
            lambda value, page, layers: alpha_layers(value.shape, page, layers, hull=value),
        ),
        (PolygonSet, polygon_page, shape_layers),
        (Skeleton, skeleton_page, skeleton_layers),
        (
            Centerlines,
            lambda value, **options: skeleton_page(value.path, **options),
            centerline_layers,
        ),
        (SkeletonPoints, point_page, skeleton_point_layers),
        (Offsets, offset_page, offset_layers),
    ]


def _cell_layers(cells: CellSet, page: Page, layers: Sequence[str]) -> list[Layer]:
    """Cells in colours that neighbours never share, which their triangulation tells."""
    from vorotool.engines.delaunay.cells import cell_colours
    from vorotool.engines.delaunay.delaunay import delaunay
    from vorotool.render.canvas.layers import Points
    from vorotool.render.label_images.png import checked_layers
    from vorotool.render.layers.cells import cell_lines, cell_polygons

    wanted = checked_layers(layers, ("cells", "diagram", "points"))
    made: list[Layer] = []
    if "cells" in wanted:
        with warnings.catch_warnings():  # that points lie on others was said where the cells were made
            warnings.simplefilter("ignore", VorotoolWarning)
            mesh = delaunay(cells.sites)
        made.append(cell_polygons(cells, cell_colours(mesh), page))
    if "diagram" in wanted:
        made.append(cell_lines(cells, page))
    if "points" in wanted:
        made.append(Points("points", cells.sites, radius=min(max(page.spacing(len(cells)) / 12, 0.3), 4.0)))
    return made
