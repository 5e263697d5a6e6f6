"""Inputs that are open: read whole, or band by band."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

from vorotool.errors import INPUT_FORMAT, InputError, UsageError, option
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.sources import NPY, Source, read_source, reading
from vorotool.formats.parsing.reader_options import ReadOptions, no_note, with_crs, with_stated_axis
from vorotool.formats.recognition import PICTURES, TIFF_MAGIC, image_format, recognized
from vorotool.formats.zarr.store import is_folder, is_store
from vorotool.frozen import frozen
from vorotool.numeric.checks import checked_flag, checked_threads
from vorotool.numeric.numbers import Flatten, checked_flatten, checked_tolerance
from vorotool.products.formats import resolved
from vorotool.products.inputs import INPUTS, NAMES_WITH, Holds, known_input_format
from vorotool.products.registry import is_of
from vorotool.types.fields import y_axis_of

if TYPE_CHECKING:
    from vorotool.convert.sites import Sites
    from vorotool.formats.images.image_header import TiffRows, ZarrRows
    from vorotool.types.images import Raster
    from vorotool.types.points.point_set import PointSet
    from vorotool.types.polygons.polygon_set import PolygonSet
    from vorotool.types.skeleton.offsets import Offsets
    from vorotool.types.skeleton.skeleton import Skeleton
    from vorotool.types.voronoi.voronoi_map import VoronoiMap


@contextmanager
def opened(
    path: str | PathLike[str],
    *,
    geometry: str | None,
    input_format: str | None,
    page: int | None,
    layer: str | None = None,
) -> Iterator[Opened]:
    """Open an input: errors that arise while it is open carry its name."""
    said = None if input_format is None else known_input_format(input_format, NAMES_WITH[geometry])
    if not isinstance(path, str | PathLike):
        raise InputError(f"{path!r} is not a path: give the name of a file; pass arrays to functions as they are")
    name = fspath(path)
    with reading(name):
        array = open_zarr(name, said, page) if is_folder(name) else None
        yield Opened(name, geometry, said, page, layer, array)


@frozen
class Opened:
    """An input that is read once, whole or by its rows."""

    name: str  # the path as the user wrote it; `-` is standard input
    # what must be in it, its format, its page and its layer, as far as the caller says; as of `read`
    geometry: str | None
    said: str | None
    page: int | None
    layer: str | None
    array: ZarrRows | None  # the rows of a Zarr array, which is no file
    content: Source | None = None  # what is in it, if it has been read; streams are read once

    def rows(self) -> ZarrRows | TiffRows | None:
        """Give an image that can be read band by band; None if it is none, or comes through a stream."""
        return self.array or open_tiff(self.name, self.said, self.page)

    def fetched(self) -> Opened:
        """Give the same with its content, so that it can be read again as something else."""
        return self if self.array is not None else replace(self, content=read_source(self.name, self.layer))

    def read(
        self,
        *,
        threads: int = 0,
        note: Callable[[str], None] | None = None,
        crs: str | None = None,
        to_crs: str | None = None,
        y_up: bool | None = None,
        flatten: Flatten = None,
        join_tolerance: float | None = None,
        told: Callable[[str], None] | None = None,
        **options: Any,
    ) -> PointSet | PolygonSet | Sites | Raster | Skeleton | Offsets | VoronoiMap:
        """Read all, with the options of `vorotool.read` that are not about opening it."""
        given = ReadOptions(
            page=self.page,
            threads=checked_threads(threads),
            note=note or no_note,
            crs=None if crs is None else _member(crs),
            to_crs=None if to_crs is None else _member(to_crs),
            y_axis=None if y_up is None else y_axis_of(checked_flag(y_up, "y_up")),
            flatten=None if flatten is None else checked_flatten(flatten),
            join_tolerance=None if join_tolerance is None else checked_tolerance(join_tolerance, allows_zero=True),
            **options,
        )
        if self.array is not None:
            from vorotool.formats.images.image_header import read_rows

            refuse_for_images(given, self.layer)
            if told is not None:
                told("zarr")
            value: Any = read_rows(self.array, max_pixels=given.max_pixels, note=given.note)
        else:
            content = read_source(self.name, self.layer) if self.content is None else self.content
            content = replace(content, max_sites=given.max_sites, flatten=given.flatten)
            holds, source = recognized(content, self.geometry, self.said, given.columns)
            if told is not None:
                told(source.format)
            value = read_recognized(holds, source, given)
        return value if given.y_axis is None else with_stated_axis(value, self.name, given.y_axis)


def _member(crs: str) -> dict[str, Any]:
    """Give the ``crs`` member of GeoJSON for a name."""
    from vorotool.numeric.crs import crs_member

    member = crs_member(crs) if isinstance(crs, str) else None
    if member is None:
        raise UsageError(f"{crs!r} is not a coordinate reference system: write authority and code, such as EPSG:3857")
    return member


# ---- images that are read band by band -----------------------------------------------------------
def open_tiff(name: str, input_format: str | None = None, page: int | None = None) -> TiffRows | None:
    """Open a page of a TIFF file that can be read band by band; None if it is none, or comes through a stream."""
    if input_format not in (None, "tiff") or not _begins_as_tiff(name):
        return None
    from pathlib import Path

    from vorotool.formats.images.image_header import TiffRows

    rows = TiffRows(name, str(Path(name).absolute()), page)
    return rows if rows.is_plain else None


def _begins_as_tiff(name: str) -> bool:
    """Whether a file begins as a TIFF does; streams, which have one beginning only, are read whole elsewhere."""
    try:
        if stream_kind(name) is not None:
            return False
        with open(name, "rb") as file:  # noqa: PTH123, since small jobs do without pathlib
            return file.read(4) in TIFF_MAGIC
    except (OSError, ValueError):  # who reads it says why
        return False


def open_zarr(name: str, input_format: str | None = None, page: int | None = None) -> ZarrRows | None:
    """Open a folder that is, or should be, a Zarr array: holds one, or is named or said to; None if it is none."""
    if not is_store(name) if input_format is None else input_format != "zarr":
        return None
    if page not in (None, 0):
        raise InputError(f"{name} has a single page: {option(f'--page {page}')} does not exist")
    from pathlib import Path

    from vorotool.formats.images.image_header import ZarrRows

    return ZarrRows(name, str(Path(name).absolute()))


_CRS, _TO_CRS = option("--input-crs", "crs"), option("--crs", "to_crs")
_LAYER = option("--input-layer or FILE:LAYER", "layer or FILE:LAYER")


def read_recognized(holds: Holds, source: Source, options: ReadOptions) -> Any:
    """Read what a source was recognized as: points, polygons, an image, a skeleton or offset curves."""
    if holds == "image":
        refuse_for_images(options, source.layer)
    elif source.layer is not None and "layers" not in INPUTS[source.format].has:
        raise UsageError(f"{_LAYER} applies to files with layers, but {source.name} has none: leave it out")
    readers = INPUTS[source.format].readers
    name = readers["polygons"] if holds == "sites" and "sites" not in readers else readers[holds]
    reader: Callable[[Source, ReadOptions], Any] = resolved(name)
    value = reader(source, options)
    if is_of(value, "PointRows"):
        make_set = resolved("types.points.point_set:PointSet")
        value = make_set(value.coordinates, value.labels, value.properties, **value.placed)
    if holds not in ("points", "polygons", "sites"):
        return value
    if is_of(value, "Sites"):
        return replace(value, polygons=with_crs(value.polygons, source.name, options))
    return with_crs(value, source.name, options)


def refuse_for_images(options: ReadOptions, layer: str | None) -> None:
    """Refuse what is said of points, polygons and lines where the input is an image."""
    for name, given in ((_CRS, options.crs), (_TO_CRS, options.to_crs), (_LAYER, layer)):
        if given is not None:
            raise UsageError(f"{name} applies to points, polygons and lines, but the input is an image: leave it out")


def image_source(source: Source, said: str | None = None) -> Source:
    """Give a source, which must be an image, with its format; an NPY file of two columns is one, too."""
    said = "npy" if said is None and source.data.startswith(NPY) else said
    found = said if said == "npy" and source.data.startswith(NPY) else image_format(source, said)
    if found is None:
        raise InputError(
            f"{source.name} is not an image in a supported format (PNG, TIFF, PGM, PBM, NPY, "
            f"{', '.join(PICTURES.values())}): name its format with {INPUT_FORMAT}, or convert it to PNG"
        )
    refuse_for_images(ReadOptions(), source.layer)
    return replace(source, format=found)
