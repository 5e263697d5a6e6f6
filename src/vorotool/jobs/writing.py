"""Writing any value of the library: pictures are drawn, all else goes into files of its own kind."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from vorotool.errors import UsageError
from vorotool.formats.io.descriptors import stream_kind
from vorotool.jobs.checked_columns import check_column
from vorotool.jobs.picture_style import Looks, check_layers, looks_of, styled_page
from vorotool.jobs.picture_world import world_of, world_of_value
from vorotool.jobs.units import PixelSize
from vorotool.numeric.numbers import Flatten, checked_flatten, shown_number, whole_number
from vorotool.products.formats import FORMATS, PICTURES, format_named
from vorotool.products.registry import Product, is_of, parts_of
from vorotool.products.writing import chosen_part, write_product
from vorotool.types.axis import is_up, y_axis_of
from vorotool.types.fields import Record, with_y_axis
from vorotool.types.pixel_frame import MAX_SIDE
from vorotool.types.spacing import SQUARE

if TYPE_CHECKING:
    from vorotool.types.alpha.persistence import RegionPersistence
    from vorotool.types.points.label_image import LabelImage


def write(
    value: Any,
    path: str | PathLike[str],
    *,
    fmt: str | None = None,
    what: str | None = None,
    flatten: Flatten = None,
    decimals: int | None = None,
    precision: int | None = None,
    layers: Sequence[str] | None = None,
    width: int | None = None,
    y_up: bool | None = None,
    color: Mapping[str, str] | None = None,
    line_width: Mapping[str, float] | None = None,
    background: str | None = None,
    label_by: str | None = None,
    with_columns: Sequence[str] | None = None,
    legend: bool = False,
    scale_bar: bool = False,
    overwrite: bool = False,
    threads: int = 0,
) -> None:
    """Write a result to a file, in any format that can hold it, or as a picture.

    Parameters
    ----------
    value : value of the library
        Any result of the library, in the formats of its command. The PNG of a `LabelImage` holds its labels. A
        `LabelVolume` or a `Volume` is written as TIFF, a stack described like its input (see `VoxelGrid`), NPY or Zarr.
    path : str or path
        The file, replaced atomically.
    fmt : str, optional
        Format, or a usual extension of it; by default from the extension of the path.
    what : str, optional
        Part to write, as for ``--what``. Triangulation: ``edges``, ``triangles`` or ``table``; alpha shape: ``edges``,
        ``polygons``, ``complex``, ``general``, ``points`` or ``table``; skeleton: ``skeleton``, ``elements``,
        ``branches`` or ``table``; points along a skeleton: ``points`` or ``transects``; label image: ``labels`` or
        ``color``, its picture as PNG. By default what the format is for, else the first.
    flatten : float or "auto", optional
        Largest distance of lines from curves in formats without curves; by default, or with "auto", by their size.
    decimals : int, optional
        Decimals of coordinates; polygons stay valid. By default as many as are needed to read back the same values.
    precision : int, optional
        Significant digits of other floating-point numbers in text; by default the shortest that read back the same.
    layers : sequence of str, optional
        Layers of a picture, as on the command line.
    width : int, optional
        Width of a picture, in px; by default 1000. The PNG of a label image has the size of the image.
    y_up : bool, optional
        Whether y goes upwards; by default as for the input.
    color : mapping of str to str, optional
        Colors of layers of a picture, by layer name: ``#rrggbb``, or names as in CSS; for areas with many colors,
        such as cells, the color of their borders.
    line_width : mapping of str to float, optional
        Line widths of layers of a picture, in px; 0 draws no line.
    background : str, optional
        Background color of a picture, or ``"none"``; by default white.
    label_by : str, optional
        Column of the properties that names objects or sites in a picture, instead of their ids; a path with dots leads
        into objects.
    with_columns : sequence of str, optional
        Columns of the input that rows about parts of features, such as branches, are to have; rows about several, such
        as edges, have them as ``COLUMN_a`` and ``COLUMN_b``.
    legend, scale_bar : bool
        Draw a legend of the layers, and a scale bar, in corners of a picture.
    overwrite : bool
        Replace a GeoPackage that has layers other than the one written.
    threads : int
        Number of threads; 0 uses all.

    Raises
    ------
    OutputError
        If the file cannot be written, or is a GeoPackage with other layers; an existing file is untouched.
    UsageError
        If the value cannot be written in this format, or an option does not apply to it.
    LimitError
        If a PNG picture would be too large.

    Examples
    --------
    >>> import vorotool
    >>> write(vorotool.tessellate([[1, 1], [5, 3]], shape=(4, 6)), "build/labels.png")
    >>> write(vorotool.delaunay([[0, 0], [4, 0], [0, 3]]), "build/triangles.geojson", what="triangles")
    >>> write(vorotool.alpha_shape([[0, 0], [4, 0], [0, 3]], r=2.5), "build/shape.geojson")
    >>> write(vorotool.skeleton_exact([[0, 0], [4, 0], [0, 3]]), "build/skeleton.svg")
    """
    from vorotool.formats.text.feature_collection import unit_member
    from vorotool.numeric.checks import checked_flag, checked_threads
    from vorotool.numeric.coordinate_grid import coordinates_written
    from vorotool.numeric.input_unit import own_unit
    from vorotool.types.identity import columns_wanted

    path, flatten = _checked_path(path), checked_flatten(flatten)
    if not isinstance(fmt, str | None):
        raise UsageError(f"invalid fmt {shown_number(fmt)}: expected the name of a format, such as csv")
    legend, scale_bar = checked_flag(legend, "legend"), checked_flag(scale_bar, "scale_bar")
    name = fmt or Path(path).suffix
    chosen = format_named(name) or name.lower().removeprefix(".")
    threads = checked_threads(threads)
    if y_up is not None and isinstance(value, Record):
        value = with_y_axis(value, y_axis_of(checked_flag(y_up, "y_up")))
    looks = looks_of(color=color, line_width=line_width, background=background)
    looks = looks._replace(label_by=label_by, has_legend=legend, has_scale_bar=scale_bar)
    styles: dict[str, object] = {
        "color": color,
        "line_width": line_width,
        "background": background,
        "label_by": label_by,
    }
    styles |= {"legend": legend or None, "scale_bar": scale_bar or None}
    if is_of(value, "LabelVolume", "Volume"):
        from vorotool.jobs.volume_writing import write_volume_value

        more = {"what": None if what == "labels" else what, "flatten": flatten}
        more |= {"decimals": decimals, "precision": precision}
        write_volume_value(value, fspath(path), chosen, {**more, "layers": layers, "width": width, **styles}, threads)
        return
    if chosen not in PICTURES or (is_of(value, "LabelImage") and chosen == "png" and what in (None, "labels")):
        for option, given in {"layers": layers, "width": width, **styles}.items():
            if given is not None:
                raise UsageError(f"{option} is for pictures: use fmt='svg' or fmt='png', or leave it out")
        product = _part(value, chosen, what, flatten)
        if chosen == "gpkg" and stream_kind(fspath(path)) is None:
            from vorotool.formats.features.geopackage import check_layers

            check_layers(fspath(path), (product.what,), overwrite=overwrite)
        with coordinates_written(decimals), columns_wanted(with_columns), unit_member(own_unit(value)):
            _write_data(value, fspath(path), chosen, product, flatten, precision, threads)
        return
    for option, number in (("flatten", flatten), ("decimals", decimals), ("precision", precision)):
        if number is not None:
            raise UsageError(f"{option} is for numbers in text: leave it out of pictures")
    if width is not None and not 0 <= whole_number(width, "width") <= MAX_SIDE:
        raise UsageError(f"width is {shown_number(width)}: give a number of pixels up to {MAX_SIDE}")
    _draw(value, _Picture(fspath(path), chosen, what, layers, width, y_up, looks, threads))


def _checked_path(path: Any) -> str:
    """Give the name of a file."""
    if not isinstance(path, str | PathLike):
        raise UsageError(f"invalid path {shown_number(path)}: expected the name of a file, such as cells.geojson")
    name = fspath(path)
    if not isinstance(name, str):
        raise UsageError(f"invalid path {name!r}: expected text")
    return name


def to_geojson(
    value: Any,
    *,
    what: str | None = None,
    flatten: Flatten = None,
    with_columns: Sequence[str] | None = None,
) -> dict[str, Any]:
    """Return a value as GeoJSON, with its ids and properties.

    Parameters
    ----------
    value : value of the library
        Polygons, cells, a triangulation, an alpha shape or hull, a skeleton, points along one, offsets or centerlines.
    what, flatten, with_columns : optional
        As for `write`.

    Returns
    -------
    dict
        A feature collection, ready for `json.dumps`.

    Raises
    ------
    UsageError
        If the value cannot be written as GeoJSON.

    Examples
    --------
    >>> import vorotool
    >>> square = vorotool.skeleton_exact([[0, 0], [4, 0], [4, 4], [0, 4]])
    >>> to_geojson(square)["features"][0]["geometry"]
    {'type': 'LineString', 'coordinates': [[0, 0], [2, 2]]}
    """
    import io

    import orjson

    from vorotool.formats.text.feature_collection import unit_member
    from vorotool.numeric.input_unit import own_unit
    from vorotool.types.identity import columns_wanted

    out, tolerance = io.BytesIO(), checked_flatten(flatten)
    with columns_wanted(with_columns), unit_member(own_unit(value)):
        write_product(out, value, _part(value, "geojson", what, tolerance), "geojson", flatten=tolerance)
    made: dict[str, Any] = orjson.loads(out.getvalue())
    return made


def _part(value: Any, fmt: str, what: str | None, flatten: float | None) -> Product:
    """Choose what is written; only curves are flattened."""
    if flatten is not None and not any(each.is_curved for each in parts_of(value).values()):
        raise UsageError(f"flatten is for skeletons and offsets: leave it out with a {type(value).__name__}")
    return chosen_part(value, fmt, what)


def _write_data(
    value: Any, path: str, fmt: str, product: Product, flatten: float | None, precision: int | None, threads: int
) -> None:
    from vorotool.formats.io.atomic_output import open_output

    if fmt == "zarr":
        from vorotool.formats.zarr.arrays import write_zarr

        write_zarr(path, value.labels, grid=value.grid, threads=threads)
        return
    with open_output(path, binary=not FORMATS[fmt].is_text) as out:
        write_product(out, value, product, fmt, flatten=flatten, precision=precision, threads=threads, path=path)


class _Picture(NamedTuple):
    """What is wanted of a picture."""

    path: str
    fmt: str
    what: str | None
    layers: Sequence[str] | None
    width: int | None
    y_up: bool | None
    looks: Looks
    threads: int


def _draw(value: Any, wanted: _Picture) -> None:
    from vorotool.formats.io.atomic_output import open_output
    from vorotool.jobs.pictures import drawing_of, write_layers
    from vorotool.render.canvas.png import check_picture_size
    from vorotool.types.pixel_frame import MAX_PIXELS

    if is_of(value, "LabelImage"):
        _draw_labels(value, wanted)
        return
    if is_of(value, "RegionPersistence"):
        _draw_plot(value, wanted)
        return
    world = world_of_value(value, wanted.looks, is_paper=wanted.width is None)
    drawing = drawing_of(
        value,
        what=wanted.what,
        layers=wanted.layers,
        width=wanted.width or 1000,
        styled=partial(styled_page, looks=wanted.looks, world=world, fmt=wanted.fmt),
    )
    check_layers(wanted.looks, [layer.name for layer in drawing.layers])
    if wanted.fmt == "png":
        check_picture_size(drawing.page, MAX_PIXELS)
    with open_output(wanted.path, binary=wanted.fmt == "png") as out:
        write_layers(out, drawing.layers, drawing.page, fmt=wanted.fmt, threads=wanted.threads)


def _draw_plot(found: RegionPersistence, wanted: _Picture) -> None:
    from vorotool.formats.io.atomic_output import open_output
    from vorotool.render.pages.persistence_plot import write_persistence_svg

    if wanted.fmt != "svg":
        raise UsageError("the plot of a RegionPersistence is drawn as SVG: use fmt='svg'")
    if wanted.layers is not None:
        raise UsageError("layers are for pictures of shapes, but this is a plot: leave them out")
    with open_output(wanted.path, binary=False) as out:
        write_persistence_svg(out, found.table(), found.suggested, width=wanted.width or 1000)


def _draw_labels(image: LabelImage, wanted: _Picture) -> None:
    from vorotool.engines.label_images.object_colors import object_colors
    from vorotool.formats.io.atomic_output import open_output
    from vorotool.jobs.label_pictures import LabelPicture, default_layers, site_texts

    if wanted.what not in (None, "color", "colour", "labels"):
        raise UsageError(f"what={wanted.what!r} is no picture of a LabelImage: use color, or leave it out")
    if wanted.fmt == "png" and wanted.width is not None:
        raise UsageError("the PNG of a label image has its own size: leave width out, or use fmt='svg'")
    usual = parts_of(image)["labels" if wanted.what == "labels" else "color"].usual_layers
    shown = [layer for layer in default_layers(image, usual) if layer != "seeds" or image.seeds is not None]
    colors = object_colors(image, threads=wanted.threads)
    chosen, label_by = list(wanted.layers or shown), wanted.looks.label_by
    columns = {} if image.seeds is None else image.seeds.properties
    check_column(label_by, columns, "label_by")
    if label_by is not None and "labels" not in chosen:
        chosen.append("labels")
    assert image.frame is not None  # LabelImage has filled it in
    world = world_of(None, wanted.looks, frame=image.frame.box, size=_pixel_size(image))
    picture = LabelPicture(
        image,
        colors,
        chosen,
        wanted.looks.style(world.scale_bar),
        width=wanted.width or 1000,
        y_up=is_up(image) if wanted.y_up is None else wanted.y_up,
        texts=None if label_by is None or image.seeds is None else site_texts(image.seeds, label_by),
        threads=wanted.threads,
    )
    check_layers(wanted.looks, picture.layers)
    with open_output(wanted.path, binary=wanted.fmt == "png") as out:
        picture.write(out, wanted.fmt)


def _pixel_size(image: LabelImage) -> PixelSize | None:
    """The width of a pixel, if the image says it of one that is a square, or of its distances."""
    grid = image.grid
    if image.sides != SQUARE:
        return PixelSize(image.sides.lengths[-1], grid.unit if grid is not None and grid.has(image.sides) else None)
    return PixelSize(grid.width, grid.unit) if grid is not None and grid.is_size and grid.is_square else None
