"""Writing any value of the library: pictures are drawn, all else goes into files of its own kind."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property, partial
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from vorotool.errors import UsageError
from vorotool.formats.io.descriptors import stream_kind
from vorotool.jobs.job import Results
from vorotool.jobs.options import Options
from vorotool.jobs.picture_world import world_of_value
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target
from vorotool.numeric.checks import MAX_PIXELS
from vorotool.numeric.coordinates import writing
from vorotool.numeric.numbers import Flatten, checked_flatten, shown_number, whole_number
from vorotool.products.formats import PICTURES, format_named
from vorotool.products.registry import VOLUME_PRODUCTS, Product, chosen_part, is_of, parts_of, write_product
from vorotool.render.drawing import Picture, Plot, World, check_layers, drawn_part, looks_of
from vorotool.types.fields import Record, is_up, with_y_axis, y_axis_of
from vorotool.types.pixels import MAX_SIDE


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
    from vorotool.numeric.checks import checked_flag, checked_threads

    path, flatten = _checked_path(path), checked_flatten(flatten)
    if not isinstance(fmt, str | None):
        raise UsageError(f"invalid fmt {shown_number(fmt)}: expected the name of a format, such as csv")
    legend, scale_bar = checked_flag(legend, "legend"), checked_flag(scale_bar, "scale_bar")
    name = fmt or Path(path).suffix
    if not name:
        raise UsageError(
            f"{path!r} has no extension, by which the format is chosen: add one, such as .csv, or give fmt"
        )
    chosen = format_named(name) or name.lower().removeprefix(".")
    if y_up is not None and isinstance(value, Record):
        value = with_y_axis(value, y_axis_of(checked_flag(y_up, "y_up")))
    looks: dict[str, Any] = {"color": color, "line_width": line_width, "background": background}
    numbers = {"flatten": flatten, "decimals": decimals, "precision": precision}
    pictured = {"layers": layers, "width": width, **looks, "label_by": label_by}
    pictured |= {"legend": legend or None, "scale_bar": scale_bar or None}
    o = Options(
        "write",
        threads=checked_threads(threads),
        **numbers,
        **{"layers": layers, "width": width, "y_up": y_up, "with_columns": with_columns, "max_pixels": MAX_PIXELS},
        **{"label_by": label_by, "legend": legend, "scale_bar": scale_bar},
        **looks_of(**looks),
    )
    is_labels = is_of(value, "LabelImage") and chosen == "png" and what in (None, "labels")
    if is_of(value, "LabelVolume", "Volume"):
        _check_volume(value, chosen, {"what": None if what == "labels" else what, **numbers, **pictured})
        _write(_Value(o, value, VOLUME_PRODUCTS["labels"]), path, chosen)
    elif chosen in PICTURES and not is_labels:
        for option, given in numbers.items():
            if given is not None:
                raise UsageError(f"{option} applies to numbers in text: leave it out for pictures")
        if width is not None and not 0 <= whole_number(width, "width") <= MAX_SIDE:
            raise UsageError(f"width is {shown_number(width)}: give a number of pixels up to {MAX_SIDE}")
        _write(_Value(o, value, _drawn(value, chosen, what, pictured)), path, chosen)
    else:
        for option, given in pictured.items():
            if given is not None:
                picture = "what='color'" if is_labels else "fmt='svg' or fmt='png'"
                raise UsageError(f"{option} applies to pictures: use {picture}, or leave it out")
        product = _part(value, chosen, what, flatten)
        if chosen == "gpkg" and stream_kind(path) is None:
            from vorotool.formats.gis.geopackage import check_layers

            check_layers(path, (product.what,), overwrite=overwrite)
        _write(_Value(o, value, product), path, chosen)


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
    tolerance = checked_flatten(flatten)
    with writing(columns=with_columns):
        return _geojson(value, _part(value, "geojson", what, tolerance), tolerance)


def _geojson(value: Any, product: Product, flatten: float | None = None) -> dict[str, Any]:
    """Give a result as GeoJSON."""
    import io

    import orjson

    from vorotool.numeric.length_units import own_unit

    out = io.BytesIO()
    with writing(coordinate_unit=own_unit(value)):
        write_product(out, value, product, "geojson", flatten=flatten)
    return orjson.loads(out.getvalue())


def feature_collection(value: Any) -> dict[str, Any]:
    """Give a value as a feature collection of GeoJSON: as `to_geojson` does, of triangulations the triangles."""
    if any("geojson" in each.written for each in parts_of(value).values()):
        return to_geojson(value, what="triangles" if is_of(value, "Triangulation", "DigitalTriangulation") else None)
    return _geojson(value, Product("", data=("geojson",)))


def _part(value: Any, fmt: str, what: str | None, flatten: float | None) -> Product:
    """Choose what is written; only curves are flattened."""
    if flatten is not None and not any(each.is_curved for each in parts_of(value).values()):
        raise UsageError(f"flatten applies to skeletons and offsets: leave it out with a {type(value).__name__}")
    return chosen_part(value, fmt, what)


def _drawn(value: Any, fmt: str, what: str | None, given: Mapping[str, Any]) -> Product:
    """Choose what a picture shows."""
    if is_of(value, "LabelImage"):
        if what not in (None, "color", "colour", "labels"):
            raise UsageError(f"what={what!r} is not a picture of a LabelImage: use color, or leave it out")
        if fmt == "png" and given["width"] is not None:
            raise UsageError("the PNG of a label image has its own size: leave width out, or use fmt='svg'")
        return parts_of(value)["labels" if what == "labels" else "color"]
    if not is_of(value, "RegionPersistence"):
        return drawn_part(value, what)
    if fmt != "svg":
        raise UsageError("the plot of a RegionPersistence is drawn as SVG: use fmt='svg'")
    if given["layers"] is not None:
        raise UsageError("layers apply to pictures of shapes, but this is a plot: leave them out")
    return parts_of(value)["persistence"]


def _check_volume(value: Any, fmt: str, options: Mapping[str, object]) -> None:
    """Refuse formats that hold no volume, and options of others."""
    name, formats = type(value).__name__, VOLUME_PRODUCTS["labels"].data
    if fmt not in formats:
        raise UsageError(f"a {name} cannot be written as {fmt!r}: use one of {', '.join(formats)}")
    for option, given in options.items():
        if given is not None:
            raise UsageError(f"{option} does not apply to volumes: leave it out with a {name}")


class _Value(Results):
    """A value of the library, of which one result is written."""

    def __init__(self, options: Options, value: Any, product: Product) -> None:
        super().__init__(Run("write", quiet=True, verbose=False, stats=None), options)
        self._value = value
        self.products = {product.what: product}

    def value(self, what: str) -> Any:
        """Give the value."""
        return self._value

    @cached_property
    def world(self) -> World:
        """Where it lies."""
        return world_of_value(self.run, self.options, self._value)

    def check(self, target: Target) -> None:
        """Refuse layers that a picture has not, and a picture that is too large."""
        if target.fmt in PICTURES and self.is_picture(target):
            drawing = self.drawing(target.what, target.fmt)
            if not isinstance(drawing, Plot):
                check_layers(self.options.looks, drawing.names)
            if target.fmt == "png":
                drawing.check(self.options.max_pixels)

    def drawing(self, what: str, fmt: str) -> Picture:
        """Prepare the picture."""
        value, o = self._value, self.options
        if is_of(value, "LabelImage"):
            from vorotool.engines.label_images.regions import object_colors
            from vorotool.render.label_images.picture import label_picture

            colors = object_colors(value, threads=o.threads)
            y_up = is_up(value) if o.y_up is None else o.y_up
            return label_picture(value, colors, self.products[what], self.wanted, y_up=y_up)
        if is_of(value, "RegionPersistence"):
            from vorotool.render.pages.plots import write_persistence_svg

            shown: Any = {"regions": value.table(), "suggested": value.suggested, "width": o.width or 1000}
            return Plot(partial(write_persistence_svg, **shown))
        return super().drawing(what, fmt)

    def write_store(self, target: Target, rules: Mapping[str, Any]) -> None:
        """Write an image or a volume to a Zarr store."""
        from vorotool.formats.zarr.writer import write_zarr

        value, is_labels = self._value, not is_of(self._value, "Volume")
        values = value.labels if is_labels else value.values
        write_zarr(target.path, values, grid=value.grid, is_labels=is_labels, threads=self.options.threads)


def _write(results: _Value, path: str, fmt: str) -> None:
    """Check and write the one result."""
    from vorotool.numeric.length_units import own_unit

    o, target = results.options, Target(next(iter(results.products)), path, fmt)
    how = {"columns": o.with_columns, "precision": o.precision, "threads": o.threads}
    with writing(o.decimals, coordinate_unit=own_unit(results.value(target.what)), **how):
        results.check(target)
        results.write(target, inputs=())
