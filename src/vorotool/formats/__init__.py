"""Reading and writing files."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vorotool.errors import UsageError
from vorotool.geometry.checks import checked_threads
from vorotool.geometry.frame import MAX_PIXELS

NPY_MAGIC = b"\x93NUMPY"

if TYPE_CHECKING:
    from vorotool.geometry.label_image import LabelImage
    from vorotool.geometry.points import PointSet
    from vorotool.geometry.polygons import PolygonSet
    from vorotool.geometry.raster import Raster


def read(
    path: str | PathLike[str],
    *,
    geometry: str | None = None,
    input_format: str | None = None,
    columns: str | None = None,
    page: int | None = None,
    max_pixels: int = MAX_PIXELS,
    max_sites: int | None = None,
    properties: bool = True,
    threads: int = 0,
    note: Callable[[str], None] | None = None,
) -> PointSet | PolygonSet | Raster:
    """Read points, polygons and lines, or an image.

    A plain JSON list of pairs holds points, unless ``geometry`` is polygons. GeoJSON and WKT hold either points or
    polygons and lines: what their first geometry is.

    Parameters
    ----------
    path : str or path
        The file; ``-`` is standard input.
    geometry : {"points", "polygons"}, optional
        What must be in a file that is no image; by default its content tells.
    input_format : str, optional
        csv, node, npy, geojson, wkt, json, poly, png, tiff or pnm (or another usual extension of one of these), where
        extension and content leave it unclear.
    columns : str, optional
        ``X,Y[,LABEL]`` of a point list, by name or number from 1.
    page : int, optional
        Page of an image stack, from 0.
    max_pixels, max_sites : int
        Larger inputs are refused before memory is taken.
    properties : bool
        Keep the further columns of a point list, and the properties of polygons.
    threads : int
        0 uses all.
    note : callable, optional
        Told in words what was recognised.

    Returns
    -------
    PointSet, PolygonSet or Raster

    Raises
    ------
    InputError
        If the file cannot be read; the message names the place and what to do.
    LimitError
        If it is too large.
    UsageError
        If an option is malformed, or does not fit the input.

    Examples
    --------
    >>> len(read("data/dots.csv"))
    53
    """
    from vorotool.formats.images import is_image, read_image
    from vorotool.formats.input_formats import NAMES_WITH, known_input_format
    from vorotool.formats.points import read_points
    from vorotool.formats.polygons import read_polygons, recognise
    from vorotool.formats.sources import read_source

    if geometry not in NAMES_WITH:
        raise UsageError(f"geometry is {geometry!r}: use points or polygons, or leave it out")
    input_format = known_input_format(input_format, NAMES_WITH[geometry])
    threads = checked_threads(threads)
    source = read_source(fspath(path))
    is_points = columns is not None and source.data.startswith(NPY_MAGIC)  # the one format that holds either
    if input_format in ("png", "tiff", "pnm") or (input_format in (None, "npy") and not is_points and is_image(source)):
        return read_image(source, input_format=input_format, page=page, max_pixels=max_pixels)
    has_shapes = geometry == "polygons"
    if geometry is None and columns is None:
        source, has_shapes = recognise(source, input_format)
    if has_shapes:
        if columns is not None:
            raise UsageError("--columns is for lists of points: leave it out for polygons")
        return read_polygons(source, input_format=input_format, properties=properties, max_sites=max_sites, note=note)
    return read_points(
        source,
        input_format=input_format,
        columns=columns,
        properties=properties,
        max_sites=max_sites,
        threads=threads,
        note=note,
    )


def write(
    value: Any,
    path: str | PathLike[str],
    *,
    fmt: str | None = None,
    what: str | None = None,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write a label image, a table, polygons, Voronoi cells, or the edges, triangles or table of a triangulation.

    Parameters
    ----------
    value : LabelImage, Table, PolygonSet, CellSet, Triangulation, DigitalTriangulation, AlphaShape or AlphaComplex
        What to write: images as PNG, TIFF, NPY or text, tables as CSV, JSON or NPZ, polygons as JSON, GeoJSON, WKT or
        .poly, cells as GeoJSON, CSV, JSON, NPZ or WKT, a triangulation as a table, GeoJSON, OBJ, or a file of Triangle,
        an alpha shape as a table or GeoJSON of its edges or as polygons, an alpha complex as a table.
    path : str or path
        The file, replaced atomically.
    fmt : str, optional
        Format, or a usual extension of it; by default that of the path.
    what : {"edges", "triangles", "table", "polygons", "family"}, optional
        Of a triangulation or an alpha shape; by default what the format is for, else its edges.
    precision : int, optional
        Significant digits of floating-point numbers in text; by default the shortest that reads back the same.
    threads : int
        0 uses all.

    Raises
    ------
    OutputError
        If the file cannot be written; an older one is untouched.
    UsageError
        If the value cannot be written in this format.

    Examples
    --------
    >>> import vorotool
    >>> write(vorotool.tessellate([[1, 1], [5, 3]], shape=(4, 6)), "build/labels.png")
    >>> write(vorotool.delaunay([[0, 0], [4, 0], [0, 3]]), "build/triangles.geojson", what="triangles")
    >>> write(vorotool.alpha_shape([[0, 0], [4, 0], [0, 3]], r=2.5), "build/shape.geojson")
    """
    from vorotool.formats.outputs import open_output
    from vorotool.geometry.alpha_complex import AlphaComplex
    from vorotool.geometry.alpha_shape import AlphaShape
    from vorotool.geometry.digital_triangulation import DigitalTriangulation
    from vorotool.geometry.label_image import LabelImage
    from vorotool.geometry.triangulation import Triangulation

    name = (fmt or Path(path).suffix).lower().lstrip(".")
    chosen: Any = {"tif": "tiff", "txt": "text"}.get(name, name)
    threads = checked_threads(threads)
    has_parts = isinstance(value, Triangulation | DigitalTriangulation | AlphaComplex | AlphaShape)
    if what is not None and not has_parts:
        raise UsageError(f"what={what!r} is for triangulations: leave it out with a {type(value).__name__}")
    if isinstance(value, LabelImage):
        _write_image(value, fspath(path), chosen, threads)
        return
    writer, options = _writer_of(value, chosen, what, threads)
    with open_output(fspath(path), binary=chosen == "npz") as out:
        writer(out, value, chosen, precision=precision, **options)


def _writer_of(value: Any, fmt: str, what: str | None, threads: int) -> tuple[Callable[..., None], dict[str, Any]]:
    """Give the function that writes a value, and its further options."""
    from vorotool.geometry.alpha_complex import AlphaComplex
    from vorotool.geometry.alpha_shape import AlphaShape
    from vorotool.geometry.cells import CellSet
    from vorotool.geometry.digital_triangulation import DigitalTriangulation
    from vorotool.geometry.polygons import PolygonSet
    from vorotool.geometry.table import Table
    from vorotool.geometry.triangulation import Triangulation

    if isinstance(value, Table):
        from vorotool.formats.tables import write_table

        return write_table, {"threads": threads}
    if isinstance(value, PolygonSet):
        from vorotool.formats.polygons import write_polygons

        return write_polygons, {}
    if isinstance(value, CellSet):
        from vorotool.formats.cell_files import write_cells

        return write_cells, {"threads": threads}
    if isinstance(value, AlphaComplex | AlphaShape):
        from vorotool.formats.alpha_files import write_shape

        return write_shape, {"what": what, "threads": threads}
    if isinstance(value, Triangulation | DigitalTriangulation):
        from vorotool.formats.mesh_files import write_mesh

        return write_mesh, {"what": what or {"ele": "triangles", "node": "table"}.get(fmt, "edges"), "threads": threads}
    raise UsageError(
        f"a {type(value).__name__} cannot be written: give a LabelImage, Table, PolygonSet, CellSet, Triangulation or "
        "AlphaShape"
    )


def _write_image(image: LabelImage, path: str, fmt: Any, threads: int) -> None:
    from vorotool.formats.label_images import write_label_image
    from vorotool.formats.outputs import open_output

    if fmt == "svg":
        raise UsageError("an SVG is a picture: write the labels as PNG or NPY, and draw them with vorotool draw")
    with open_output(path, binary=fmt != "text") as out:
        write_label_image(
            out,
            [image.labels],
            shape=image.shape,
            dtype=image.labels.dtype,
            fmt=fmt,
            largest_label=int(image.labels.max()),
            threads=threads,
        )
