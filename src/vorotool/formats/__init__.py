"""Reading files: one call for all formats; and the samples that come with the package."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal, cast, overload

from vorotool.numeric.checks import MAX_PIXELS

if TYPE_CHECKING:
    from pathlib import Path

    from vorotool.numeric.numbers import Flatten
    from vorotool.types.images import Raster
    from vorotool.types.points.point_set import PointSet, VolumePoints
    from vorotool.types.polygons.polygon_set import PolygonSet
    from vorotool.types.skeleton.offsets import Offsets
    from vorotool.types.skeleton.skeleton import Skeleton
    from vorotool.types.volumes.volume import Volume
    from vorotool.types.voronoi.voronoi_map import VoronoiMap


@overload
def read(
    path: str | PathLike[str],
    *,
    geometry: Literal["volume"],
    input_format: str | None = None,
    max_pixels: int = MAX_PIXELS,
    note: Callable[[str], None] | None = None,
) -> Volume: ...
@overload
def read(
    path: str | PathLike[str],
    *,
    geometry: Literal["space"],
    input_format: str | None = None,
    columns: str | None = None,
    max_sites: int | None = None,
    properties: bool = True,
    threads: int = 0,
    note: Callable[[str], None] | None = None,
) -> VolumePoints: ...
@overload
def read(
    path: str | PathLike[str],
    *,
    geometry: Literal["points", "polygons"] | None = None,
    input_format: str | None = None,
    columns: str | None = None,
    page: int | None = None,
    max_pixels: int = MAX_PIXELS,
    max_sites: int | None = None,
    properties: bool = True,
    threads: int = 0,
    note: Callable[[str], None] | None = None,
    crs: str | None = None,
    to_crs: str | None = None,
    y_up: bool | None = None,
    layer: str | None = None,
    flatten: Flatten = None,
    join_tolerance: float | None = None,
) -> PointSet | PolygonSet | Raster | Skeleton | Offsets | VoronoiMap: ...


def read(
    path: str | PathLike[str],
    *,
    geometry: Literal["points", "polygons", "volume", "space"] | None = None,
    input_format: str | None = None,
    columns: str | None = None,
    page: int | None = None,
    max_pixels: int = MAX_PIXELS,
    max_sites: int | None = None,
    properties: bool = True,
    threads: int = 0,
    note: Callable[[str], None] | None = None,
    crs: str | None = None,
    to_crs: str | None = None,
    y_up: bool | None = None,
    layer: str | None = None,
    flatten: Flatten = None,
    join_tolerance: float | None = None,
) -> PointSet | PolygonSet | Raster | Skeleton | Offsets | VoronoiMap | Volume | VolumePoints:
    """Read a file: points, polygons and lines, an image, a volume, or a result of vorotool in JSON.

    A plain JSON list of pairs holds points, unless ``geometry`` is polygons. GeoJSON and WKT hold either points, or
    polygons and lines, by their first geometry.

    Parameters
    ----------
    path : str or path
        The file, or FILE:LAYER for a layer of it; ``-`` is standard input.
    geometry : {"points", "polygons", "volume", "space"}, optional
        Expected content of a file that is not an image; by default it is detected. A volume is all pages of a TIFF as
        slices (with the sides of the voxels from ImageJ and OME), or an NPY, Zarr or OME-Zarr array with axes z, y and
        x. Space means points with a z: a column of this name, or the third number of a position.
    input_format : str, optional
        One of csv, csv-wkt, node, npy, npz, geojson, jsonl, wkt, wkb, json, poly, gpkg, fgb, shp, kml, gpx, parquet,
        ply, obj, xyz, las, svg, dxf, png, tiff, pnm, zarr, jpeg, bmp, gif, webp and avif (or another usual extension),
        if extension and content are ambiguous.
    columns : str, optional
        Columns ``X,Y[,LABEL]`` of a point list, by name or number from 1; for points in space ``X,Y,z=Z[,LABEL]``.
    page : int, optional
        Page of an image stack, from 0; picture of an animation.
    max_pixels, max_sites : int
        Limits checked before memory is allocated; for a volume voxels are counted.
    properties : bool
        Keep the other columns of a point list, and the properties of polygons.
    threads : int
        Number of threads; 0 uses all.
    note : callable, optional
        Called with a text that describes what was recognized.
    crs : str, optional
        Coordinate reference system of points or polygons without one, such as EPSG:3857.
    to_crs : str, optional
        Coordinate reference system to transform the coordinates to.
    y_up : bool, optional
        Whether y goes upwards in the input, where that is not as usual in its format.
    layer : str, optional
        Layer to read from a file with several.
    flatten : float or "auto", optional
        Largest distance of lines from the curves of a drawing or a map; by default, or with "auto", 1/2000 of the
        diagonal of the box of each piece, and in a drawing 0.01 mm if the unit is known.
    join_tolerance : float, optional
        Largest distance between ends of lines of a DXF drawing that are joined; by default 0.005 mm, or 1/100000 of its
        extent if the unit is not known.

    Returns
    -------
    PointSet, PolygonSet, Raster, Skeleton, Offsets, VoronoiMap, Volume or VolumePoints
        The content of the file.

    Raises
    ------
    InputError
        If the file cannot be read; the message names the position and what to do.
    LimitError
        If the file is too large.
    UsageError
        If an option is malformed, or does not fit the input.

    Examples
    --------
    >>> len(read("data/dots.csv"))
    53
    """
    from vorotool.errors import UsageError
    from vorotool.formats.opening import opened
    from vorotool.numeric.checks import checked_flag, is_choice
    from vorotool.numeric.numbers import real_number, shown_number
    from vorotool.products.formats import resolved
    from vorotool.products.inputs import SPACE_READER, VOLUME_READER

    if not is_choice(geometry, (None, "points", "polygons", "volume", "space")):
        raise UsageError(f"invalid geometry {shown_number(geometry)}: expected points, polygons, volume, space or None")
    properties = checked_flag(properties, "properties")
    if max_sites is not None:
        real_number(max_sites, "max_sites")
    of_maps = {"crs": crs, "to_crs": to_crs, "layer": layer, "flatten": flatten, "join_tolerance": join_tolerance}
    if geometry == "volume":
        _refuse({"columns": columns, "page": page, "max_sites": max_sites, **of_maps}, "a volume")
        options: dict[str, Any] = {"input_format": input_format, "max_voxels": max_pixels, "note": note}
        return cast("Volume", resolved(VOLUME_READER)(path, **options))
    if geometry == "space":
        _refuse({"page": page, **of_maps}, "points in space")
        options = {"input_format": input_format, "columns": columns, "max_sites": max_sites, "note": note}
        return cast("VolumePoints", resolved(SPACE_READER)(path, **options, properties=properties, threads=threads))
    with opened(path, geometry=geometry, input_format=input_format, page=page, layer=layer) as source:
        value = source.read(
            columns=columns,
            max_pixels=max_pixels,
            max_sites=max_sites,
            properties=properties,
            threads=threads,
            note=note,
            crs=crs,
            to_crs=to_crs,
            y_up=y_up,
            flatten=flatten,
            join_tolerance=join_tolerance,
        )
    return cast("PointSet | PolygonSet | Raster | Skeleton | Offsets | VoronoiMap", value)


def _refuse(options: Mapping[str, object], holds: str) -> None:
    """Refuse options that have a value and are not for what is read."""
    from vorotool.errors import UsageError

    for name, value in options.items():
        if value is not None:
            raise UsageError(f"{name} does not apply to {holds}: leave it out")


def sample(name: str) -> Path:
    """Return the path of a sample file of the package.

    Parameters
    ----------
    name : str
        Name of a sample, with or without its extension: ``dots.csv`` or ``dots``. ``vorotool sample`` lists all.

    Returns
    -------
    Path
        The file in the package, for `read`.

    Raises
    ------
    UsageError
        If there is no such sample; the message has the names.

    Examples
    --------
    >>> import vorotool
    >>> len(vorotool.read(sample("dots.csv")))
    53
    """
    from importlib.resources import files
    from pathlib import Path

    return Path(str(files("vorotool").joinpath("samples", sample_name(name))))


def sample_name(name: str) -> str:
    """Return the full name of a sample that is named with or without its extension."""
    from difflib import get_close_matches
    from pathlib import Path

    from vorotool.errors import UsageError
    from vorotool.numeric.checks import is_choice
    from vorotool.products.samples import SAMPLES

    names = {Path(each).stem: each for each in SAMPLES} | {each: each for each in SAMPLES}
    if not is_choice(name, names):
        close = " or ".join(dict.fromkeys(names[each] for each in get_close_matches(str(name).lower(), names)))
        advice = f"did you mean {close}?" if close else f"use one of {', '.join(SAMPLES)}"
        raise UsageError(f"there is no sample {name!r}: {advice}")
    return names[name]
