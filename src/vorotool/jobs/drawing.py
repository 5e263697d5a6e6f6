"""Pictures of results that were written before: what the file holds decides."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, BinaryIO

from vorotool.errors import InputError, Kind, Message, UsageError
from vorotool.formats.gis.feature_table import Features
from vorotool.formats.images.image_header import read_rows
from vorotool.formats.images.label_images import label_image_of
from vorotool.formats.io.sources import NPY, Source, read_source, reading
from vorotool.formats.opening import image_source, open_zarr, read_recognized
from vorotool.formats.parsing.json import is_table
from vorotool.formats.parsing.reader_options import ReadOptions, with_stated_axis
from vorotool.formats.recognition import has_no_rows, image_format, recognized
from vorotool.formats.zarr.store import is_folder
from vorotool.jobs.inputs import JobInput, check_column, note_other_size
from vorotool.jobs.job import Results
from vorotool.jobs.options import Options
from vorotool.jobs.picture_world import world_of, world_of_polygons
from vorotool.jobs.pixel_sizes import size_of_file
from vorotool.jobs.refusals import check_drawn_layers, refuse
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target
from vorotool.jobs.units import PixelSize
from vorotool.numeric.length_units import unit_of
from vorotool.products.inputs import DRAWN_NAMES, Holds, known_input_format
from vorotool.products.registry import PRODUCTS, Product
from vorotool.render.canvas.layers import Backdrop
from vorotool.types.fields import y_axis_of
from vorotool.types.images import LabelImage, Raster
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.offsets import Offsets
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.voronoi.voronoi_map import VoronoiMap

if TYPE_CHECKING:
    from vorotool.render.drawing import Picture

_SKELETONS = PRODUCTS["skeleton-exact"]
_COLORED = PRODUCTS["tessellate"]["color"].layers
LABEL_LAYERS = {
    fmt: [layer for layer in layers if layer not in ("objects", "seeds")] for fmt, layers in _COLORED.items()
}
"""A label image from a file has no seeds."""

Lined = Skeleton | Offsets | VoronoiMap | PolygonSet
"""What is drawn in layers of lines and areas."""


class DrawnInput(Results):
    """The picture of one input."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        super().__init__(run, options)
        self._given = given
        with reading(given.path), run.phase("read"):
            self._value = _read(run, options, given)

    def check(self, target: Target) -> None:
        """Refuse what cannot be drawn, and prepare what is."""
        if isinstance(self._value, LabelImage):
            self._check_labels(self._value, target.fmt)
        else:
            self._check_layers(self._value, target.fmt)
        if target.fmt != "html":
            self._picture = self._prepared(target.fmt)
        super().check(target)

    def drawing(self, what: str, fmt: str) -> Picture:
        """Give the picture, of which nothing is computed again."""
        return self._picture

    def _prepared(self, fmt: str) -> Picture:
        from vorotool.render.drawing import drawing_of
        from vorotool.render.label_images.picture import label_picture

        if isinstance(self._value, LabelImage):
            return label_picture(
                self._value, self._colors, _label_product(fmt), self.wanted, y_up=bool(self.options.y_up)
            )
        return drawing_of(self._value, _described(self._value)[1], self.wanted, fmt)

    def write_page(self, out: BinaryIO) -> None:
        """Write a page that shows labels."""
        from vorotool.engines.label_images.regions import region_table
        from vorotool.render.pages.html import write_labels_html

        assert isinstance(self._value, LabelImage)  # there are no pages of others
        table = region_table(self._value, threads=self.options.threads)
        write_labels_html(out, self._value, self._colors, table, y_up=bool(self.options.y_up))

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        if isinstance(self._value, LabelImage):
            return {"shape": self._value.shape, "colors": int(self._colors[1].max(initial=0))}
        return _described(self._value)[2]

    def _check_labels(self, image: LabelImage, fmt: str) -> None:
        from vorotool.engines.label_images.regions import object_colors
        from vorotool.render.label_images.svg import check_size

        run, o = self.run, self.options
        of_lines = ("frame", "scale", "drawing_unit", "aspect", "extent")
        refuse(o, of_lines, "applies to shapes, but the input is a label image")
        if fmt == "png":
            refuse(o, ["width"], "applies to SVG: the PNG of a label image has the size of the image")
        check_drawn_layers(o, fmt, "a label image", LABEL_LAYERS.get(fmt, ()), _label_product(fmt).usual_layers)
        check_column(o.label_by, {})
        note_other_size(run, o, self._given, image.shape)
        self.backdrop, self._value, size = self._given.backdrop, _objects(run, image), _size(o)
        if size is not None and size.is_auto:
            size = size_of_file(image.grid, o)
        with run.phase("color"):
            self._colors = object_colors(self._value, threads=o.threads)
        if fmt == "html":
            check_size(image.shape, "HTML")
        self.world = world_of(run, o, frame=image.frame.box, size=size)

    def _check_layers(self, value: Lined, fmt: str) -> None:
        run, o = self.run, self.options
        kind, product, _ = _described(value)
        if fmt == "html":
            raise UsageError(f"a page shows cells or labels, but the input is {kind}: use -f svg or -f png")
        check_drawn_layers(o, fmt, kind, product.layers[fmt], product.usual_layers)
        refuse(o, ["page"], f"applies to images, but the input is {kind}")
        if not len(value):
            run.warn(f"the picture is empty: the input ({kind}) has nothing to draw")
        polygons = value if isinstance(value, PolygonSet) else value.polygons
        run.crs = polygons.crs
        check_column(o.label_by, (value if isinstance(value, VoronoiMap) else polygons).properties)
        if o.overlay is not None:
            refuse(o, ["frame"], "sets what a picture shows, but a picture over an image shows the image")
        size = _size(o)
        if size is not None and size.is_auto:
            if unit_of(value) is None:
                raise UsageError("the input states no unit: give --pixel-size with a unit, such as 0.325um")
            size = None
        self.world = world_of_polygons(run, o, polygons, size=size, is_cut=False)
        self.backdrop = _placed(run, o, self._given, value)


def _label_product(fmt: str) -> Product:
    return PRODUCTS["tessellate"]["labels" if fmt == "svg" else "color"]


def _read(run: Run, o: Options, given: JobInput) -> LabelImage | Lined:
    """Read whatever is drawn: its content tells what it is, where the options do not."""
    said = None if o.input_format is None else known_input_format(o.input_format, DRAWN_NAMES)
    array = open_zarr(given.path, said, o.page) if is_folder(given.path) else None
    if array is not None:
        return label_image_of(read_rows(array, max_pixels=o.max_pixels), given.path)
    source = read_source(given.path, o.input_layer)
    holds: Holds
    if source.data.startswith(NPY):  # of two columns, too: points are not drawn
        holds, source = "image", image_source(source, said)
    elif source.data.strip() or image_format(source, said):
        holds, source = recognized(source, said=said)
    elif has_no_rows(source):
        holds, source = "polygons", replace(source, format="wkt")
    else:
        raise InputError(f"{source.name} is empty, so there is nothing to draw; check the program that wrote it")
    if holds == "points":
        if not (_is_empty_collection(source) or is_table(source.document)):
            raise InputError(
                f"{source.name} cannot be drawn: give a label image, the JSON of a skeleton, of offset curves or of a "
                "Voronoi map, or polygons and lines (GeoJSON, WKT, JSON, .poly, SVG, DXF); draw other results with "
                "the command that computes them and -f svg"
            )
        holds = "polygons"  # whose reader says more of tables
    y_axis = None if o.y_up is None else y_axis_of(o.y_up)
    how: dict[str, Any] = {"page": o.page, "max_pixels": o.max_pixels, "note": partial(_note, run)}
    options = ReadOptions(y_axis=y_axis, properties=o.label_by is not None, **how)
    value = read_recognized(holds, source, options)
    if options.y_axis is not None:
        value = with_stated_axis(value, source.name, options.y_axis)
    return replace(label_image_of(value, source.name), grid=value.grid) if isinstance(value, Raster) else value


def _is_empty_collection(source: Source) -> bool:
    """Whether it is a list, GeoJSON or a layer that does not tell what it is of, since there is nothing in it."""
    document = source.document
    if document is None:  # a list that was not parsed
        return b"".join(source.data.split()) == b"[]"
    if isinstance(document, Features):
        return not document.is_table and all(each is None or each.is_empty for each in document.geometry)
    features = document.get("features") if isinstance(document, dict) else None
    return isinstance(features, list) and not any(isinstance(each, dict) and each.get("geometry") for each in features)


def _note(run: Run, message: str) -> None:
    """Say what was left out; pictures have no lengths, so that these are in degrees, or may be, says nothing."""
    if Message.of(message).kind not in (Kind.DEGREES, Kind.UNNAMED_CRS):
        run.note(message)


def _objects(run: Run, image: LabelImage) -> LabelImage:
    """The objects of a mask, numbered as other commands number them; label images stay."""
    from vorotool.engines.tessellation.raster_objects import objects_of_mask

    objects = objects_of_mask(image.labels)
    if objects is None:
        return image
    if image.labels.dtype.itemsize > 1:  # in which labels are written, too
        value = int(image.labels.max())
        run.note(f"{value} is the only value besides 0, and read as a mask: each of its objects is drawn separately")
    return LabelImage(objects, image.frame, grid=image.grid)


def _size(o: Options) -> PixelSize | None:
    """Return what lengths are measured by, or refuse it where no picture has any."""
    scale = o.looks.scale
    if o.pixel_size is not None and not o.looks.scale_bar and not (scale is not None and scale.is_ratio):
        raise UsageError("--pixel-size applies to lengths: add --scale-bar or --scale 1:N, or leave it out")
    return o.pixel_size


def _placed(run: Run, o: Options, given: JobInput, value: Lined) -> Backdrop | None:
    """Give the image of ``--overlay`` in the coordinates of what is drawn."""
    backdrop = given.backdrop
    if backdrop is None:
        return None
    from vorotool.jobs.second_files import side_of_backdrop

    run.coordinates = unit_of(value) if getattr(value, "polygons", value).crs is None else None
    return replace(backdrop, side=side_of_backdrop(run, o, backdrop.grid))


def _described(value: Lined) -> tuple[str, Product, dict[str, Any]]:
    """What it is called, what wrote it, and how much it is."""
    if isinstance(value, Skeleton):
        return "arcs of a skeleton", _SKELETONS["skeleton"], {"arcs": len(value), "nodes": len(value.vertices)}
    if isinstance(value, VoronoiMap):
        return "a Voronoi map", PRODUCTS["voronoi"]["cells"], {"cells": len(value), "arcs": len(value.arcs)}
    if isinstance(value, Offsets):
        return "offset curves", _SKELETONS["offset"], {"shapes": len(value), "pieces": len(value.site)}
    return (
        "polygons or lines",
        _SKELETONS["shape"],
        {"polygons": int((~value.is_line).sum()), "lines": int(value.is_line.sum())},
    )
