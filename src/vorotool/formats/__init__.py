"""Reading files: one call for all formats."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

from vorotool.errors import InputError, UsageError
from vorotool.geometry.pixel_frame import MAX_PIXELS

NPY_MAGIC = b"\x93NUMPY"

if TYPE_CHECKING:
    from vorotool.geometry.points.point_set import PointSet
    from vorotool.geometry.points.raster import Raster
    from vorotool.geometry.polygons.polygon_set import PolygonSet
    from vorotool.geometry.skeleton.offsets import Offsets
    from vorotool.geometry.skeleton.skeleton import Skeleton


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
    crs: str | None = None,
) -> PointSet | PolygonSet | Raster | Skeleton | Offsets:
    """Read points, polygons and lines, an image, or a skeleton or offset curves that were written as JSON.

    A plain JSON list of pairs holds points, unless ``geometry`` is polygons. GeoJSON and WKT hold either points or
    polygons and lines: what their first geometry is.

    Parameters
    ----------
    path : str or path
        The file; ``-`` is standard input.
    geometry : {"points", "polygons"}, optional
        What must be in a file that is no image; by default its content tells.
    input_format : str, optional
        One of csv, node, npy, geojson, wkt, json, poly, png, tiff, pnm, zarr, jpeg, bmp, gif, webp and avif (or another
        usual extension of one), where extension and content leave it unclear.
    columns : str, optional
        ``X,Y[,LABEL]`` of a point list, by name or number from 1.
    page : int, optional
        Page of an image stack, from 0; picture of an animation.
    max_pixels, max_sites : int
        Larger inputs are refused before memory is taken.
    properties : bool
        Keep the further columns of a point list, and the properties of polygons.
    threads : int
        0 uses all.
    note : callable, optional
        Told in words what was recognised.
    crs : str, optional
        The coordinate reference system of points or polygons that name none, such as EPSG:3857.

    Returns
    -------
    PointSet, PolygonSet, Raster, Skeleton or Offsets
        What is in the file.

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
    from vorotool.formats.io.sources import reading
    from vorotool.formats.parsing.format_names import NAMES_WITH, known_input_format
    from vorotool.geometry.checks import checked_threads

    if geometry not in NAMES_WITH:
        raise UsageError(f"geometry is {geometry!r}: use points or polygons, or leave it out")
    input_format = known_input_format(input_format, NAMES_WITH[geometry])
    threads = checked_threads(threads)
    if not isinstance(path, str | PathLike):
        raise InputError(f"{path!r} is no path: give the name of a file; arrays need not be read")
    name = fspath(path)
    with reading(name):
        return _read(
            name,
            geometry=geometry,
            input_format=input_format,
            columns=columns,
            page=page,
            max_pixels=max_pixels,
            max_sites=max_sites,
            properties=properties,
            threads=threads,
            note=note,
            crs=None if crs is None else _declared(crs),
        )


def _declared(crs: str) -> dict[str, Any]:
    """Give the ``crs`` member of GeoJSON for a name."""
    from vorotool.geometry.crs import crs_member

    member = crs_member(crs)
    if member is None:
        raise UsageError(f"{crs!r} names no coordinate reference system: write authority and code, such as EPSG:3857")
    return member


def _read(
    name: str,
    *,
    geometry: str | None,
    input_format: str | None,
    columns: str | None,
    page: int | None,
    max_pixels: int,
    max_sites: int | None,
    properties: bool,
    threads: int,
    note: Callable[[str], None] | None,
    crs: Any,
) -> PointSet | PolygonSet | Raster | Skeleton | Offsets:
    """Read a file with options that have been checked."""
    from vorotool.formats.images.band_reader import is_zarr, open_rows, read_rows
    from vorotool.formats.images.reader import is_image, read_image
    from vorotool.formats.io.sources import read_source
    from vorotool.formats.parsing.format_names import IMAGE_NAMES

    if is_zarr(name, input_format):
        _refuse_crs(crs)
        rows = open_rows(name, input_format=input_format, page=page)
        assert rows is not None
        return read_rows(rows, max_pixels=max_pixels)
    source = read_source(name)
    if geometry is None and input_format in (None, "json"):
        from vorotool.formats.results.offset_json import read_offsets, says_offsets
        from vorotool.formats.results.skeleton_json import read_skeleton, says_skeleton

        if says_skeleton(source.data):
            return read_skeleton(source, properties=properties, max_sites=max_sites, note=note)
        if says_offsets(source.data):
            return read_offsets(source, properties=properties, max_sites=max_sites, note=note)
    is_points = columns is not None and source.data.startswith(NPY_MAGIC)  # the one format that holds either
    is_said = input_format in IMAGE_NAMES.values() and input_format != "npy"
    if is_said or (input_format in (None, "npy") and not is_points and is_image(source)):
        _refuse_crs(crs)
        return read_image(source, input_format=input_format, page=page, max_pixels=max_pixels, note=note)
    from vorotool.formats.points.reader import read_points
    from vorotool.formats.polygons.reader import read_polygons, recognise

    has_shapes = geometry == "polygons"
    if geometry is None and columns is None:
        source, has_shapes = recognise(source, input_format)
    if has_shapes:
        if columns is not None:
            raise UsageError("--columns is for lists of points: leave it out for polygons")
        return read_polygons(
            source, input_format=input_format, properties=properties, max_sites=max_sites, note=note, crs=crs
        )
    return read_points(
        source,
        input_format=input_format,
        columns=columns,
        properties=properties,
        max_sites=max_sites,
        threads=threads,
        note=note,
        crs=crs,
    )


def _refuse_crs(crs: Any) -> None:
    if crs is not None:
        raise UsageError("--input-crs is for points, polygons and lines, but the input is an image: leave it out")
