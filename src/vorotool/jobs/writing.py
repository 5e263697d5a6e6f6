"""Writing any value of the library: pictures are drawn, all else goes into files of its own kind."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from vorotool.errors import UsageError
from vorotool.geometry.numbers import shown_number, whole_number
from vorotool.geometry.pixel_frame import MAX_SIDE

if TYPE_CHECKING:
    from vorotool.geometry.points.label_image import LabelImage

PICTURE_FORMATS = ("svg", "png")


def write(
    value: Any,
    path: str | PathLike[str],
    *,
    fmt: str | None = None,
    what: str | None = None,
    flatten: float | None = None,
    precision: int | None = None,
    layers: Sequence[str] | None = None,
    width: int | None = None,
    y_up: bool | None = None,
    threads: int = 0,
) -> None:
    """Write a value in any format that has a place for it, or draw it.

    Parameters
    ----------
    value : value of the library
        What to write: a `LabelImage` as PNG, TIFF, NPY or text, a `Table` as CSV, JSON or NPZ, a `PolygonSet` as JSON,
        GeoJSON, WKT or .poly, a `CellSet` as GeoJSON, CSV, JSON, NPZ or WKT, a `Triangulation` or a
        `DigitalTriangulation` as a table, GeoJSON, OBJ, or a file of Triangle, an `AlphaShape` as a table or GeoJSON of
        its edges or as polygons, an `AlphaComplex` as a table, a `Skeleton` as JSON, CSV, GeoJSON, WKT, NPZ or GraphML,
        `Offsets` as JSON, CSV, GeoJSON, WKT or NPZ, and `SkeletonPoints` as a table, GeoJSON or WKT. All but tables and
        an `AlphaComplex` are drawn as SVG or PNG, and an `AlphaHull` too; the PNG of a `LabelImage` holds its labels.
    path : str or path
        The file, replaced atomically.
    fmt : str, optional
        Format, or a usual extension of it; by default that of the path.
    what : str, optional
        Of a triangulation or an alpha shape ``edges``, ``triangles``, ``table``, ``polygons`` or ``family``, by default
        what the format is for, else its edges; of a skeleton ``skeleton`` (the default), ``elements``, ``branches`` or
        ``table``; of points along one ``points`` (the default) or ``transects``; of a label image ``colour``, its
        picture as PNG.
    flatten : float, optional
        Of a skeleton or offsets in formats without curves: how far lines may be from them.
    precision : int, optional
        Significant digits of floating-point numbers in text; by default the shortest that reads back the same.
    layers : sequence of str, optional
        Of a picture, as the command line has them.
    width : int, optional
        Of a picture, in px; by default 1000. The PNG of a label image has its own size.
    y_up : bool, optional
        Draw y upwards; by default as the input is drawn.
    threads : int
        0 uses all.

    Raises
    ------
    OutputError
        If the file cannot be written; an older one is untouched.
    UsageError
        If the value cannot be written in this format, or an option is not for it.
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
    from vorotool import formats
    from vorotool.geometry.checks import checked_threads

    name = (fmt or Path(path).suffix).lower().lstrip(".")
    if name not in PICTURE_FORMATS or _is_image_of_labels(value, name, what):
        given = {"layers": layers, "width": width, "y_up": y_up}
        for option, chosen in given.items():
            if chosen is not None:
                raise UsageError(f"{option} is for pictures: use fmt='svg' or fmt='png', or leave it out")
        formats.write(value, path, fmt=fmt, what=what, flatten=flatten, precision=precision, threads=threads)
        return
    for option, number in (("flatten", flatten), ("precision", precision)):
        if number is not None:
            raise UsageError(f"{option} is for numbers in text: leave it out of pictures")
    if width is not None and not 0 <= whole_number(width, "width") <= MAX_SIDE:
        raise UsageError(f"width is {shown_number(width)}: give a number of pixels up to {MAX_SIDE}")
    _draw(value, _Picture(fspath(path), name, what, layers, width, y_up, checked_threads(threads)))


class _Picture(NamedTuple):
    """What is wanted of a picture."""

    path: str
    fmt: str
    what: str | None
    layers: Sequence[str] | None
    width: int | None
    y_up: bool | None
    threads: int


def _is_image_of_labels(value: Any, fmt: str, what: str | None) -> bool:
    from vorotool.geometry.points.label_image import LabelImage

    return isinstance(value, LabelImage) and fmt == "png" and what is None


def _draw(value: Any, wanted: _Picture) -> None:
    from vorotool.formats.io.atomic_output import open_output
    from vorotool.geometry.pixel_frame import MAX_PIXELS
    from vorotool.geometry.points.label_image import LabelImage
    from vorotool.jobs.pictures import drawing_of, write_layers
    from vorotool.render.canvas.png import check_picture_size

    if isinstance(value, LabelImage):
        _draw_labels(value, wanted)
        return
    drawing = drawing_of(value, what=wanted.what, layers=wanted.layers, width=wanted.width or 1000, y_up=wanted.y_up)
    if wanted.fmt == "png":
        check_picture_size(drawing.page, MAX_PIXELS)
    with open_output(wanted.path, binary=wanted.fmt == "png") as out:
        write_layers(out, drawing.layers, drawing.page, fmt=wanted.fmt, threads=wanted.threads)


def _draw_labels(image: LabelImage, wanted: _Picture) -> None:
    from vorotool.engines.label_images.object_colours import object_colours
    from vorotool.formats.io.atomic_output import open_output
    from vorotool.jobs.pictures import write_label_picture

    if wanted.what not in (None, "colour", "color"):
        raise UsageError(f"what={wanted.what!r} is no picture of a LabelImage: use colour, or leave it out")
    if wanted.fmt == "png" and wanted.width is not None:
        raise UsageError("the PNG of a label image has its own size: leave width out, or use fmt='svg'")
    seeds = ("seeds",) if image.seeds is not None else ()
    colours = object_colours(image, threads=wanted.threads)
    with open_output(wanted.path, binary=wanted.fmt == "png") as out:
        write_label_picture(
            out,
            image,
            colours,
            fmt=wanted.fmt,
            layers=wanted.layers or ("cells", *seeds),
            width=wanted.width or 1000,
            y_up=bool(wanted.y_up),
            threads=wanted.threads,
        )
