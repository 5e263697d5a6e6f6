"""Inputs that are open: read whole, or band by band."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vorotool.errors import InputError, UsageError, option
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.io.sources import Source, read_source, reading
from vorotool.formats.parsing.reader_options import ReadOptions, no_note
from vorotool.formats.recognition import read_recognized, recognized, refuse_for_images
from vorotool.formats.zarr.store import is_folder, is_store
from vorotool.numeric.checks import checked_flag, checked_threads
from vorotool.numeric.numbers import Flatten, checked_flatten, checked_tolerance
from vorotool.plain import plain
from vorotool.products.inputs import NAMES_WITH, known_input_format
from vorotool.types.fields import y_axis_of

if TYPE_CHECKING:
    from vorotool.convert.sites import Sites
    from vorotool.formats.images.band_reader import TiffRows, ZarrRows
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
    said = known_input_format(input_format, NAMES_WITH[geometry])
    if not isinstance(path, str | PathLike):
        raise InputError(f"{path!r} is not a path: give the name of a file; pass arrays to functions as they are")
    name = fspath(path)
    with reading(name):
        yield Opened(name, geometry, said, page, layer, open_zarr(name, said, page))


@plain
class Opened:
    """An input that is read once, whole or by its rows."""

    name: str  # the path as the user wrote it; `-` is standard input
    # what must be in it, its format, its page and its layer, as far as the caller says; as of `read`
    geometry: str | None
    # what must be in it, its format, its page and its layer, as far as the caller says; as of `read`
    said: str | None
    # what must be in it, its format, its page and its layer, as far as the caller says; as of `read`
    page: int | None
    # what must be in it, its format, its page and its layer, as far as the caller says; as of `read`
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
        told: Callable[[str], None] = no_note,
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
            flatten=checked_flatten(flatten),
            join_tolerance=None if join_tolerance is None else checked_tolerance(join_tolerance, allows_zero=True),
            **options,
        )
        if self.array is not None:
            from vorotool.formats.images.band_reader import read_rows

            refuse_for_images(given, self.layer)
            told("zarr")
            return self._turned(read_rows(self.array, max_pixels=given.max_pixels, note=given.note), given)
        content = read_source(self.name, self.layer) if self.content is None else self.content
        content = replace(content, max_sites=given.max_sites, flatten=given.flatten)
        holds, source = recognized(content, self.geometry, self.said, given.columns)
        told(source.format)
        return self._turned(read_recognized(holds, source, given), given)

    def _turned(
        self, value: Any, given: ReadOptions
    ) -> PointSet | PolygonSet | Sites | Raster | Skeleton | Offsets | VoronoiMap:
        """Give what was read with y as the caller says."""
        if given.y_axis is None:
            return value  # type: ignore[no-any-return]
        from vorotool.formats.parsing.reference_systems import with_stated_axis

        return with_stated_axis(value, self.name, given.y_axis)  # type: ignore[no-any-return]


def _member(crs: str) -> dict[str, Any]:
    """Give the ``crs`` member of GeoJSON for a name."""
    from vorotool.numeric.crs import crs_member

    member = crs_member(crs) if isinstance(crs, str) else None
    if member is None:
        raise UsageError(f"{crs!r} is not a coordinate reference system: write authority and code, such as EPSG:3857")
    return member


# ---- images that are read band by band -----------------------------------------------------------
TIFF_MAGIC = (b"II*\x00", b"MM\x00*", b"II+\x00", b"MM\x00+")


def open_tiff(name: str, input_format: str | None = None, page: int | None = None) -> TiffRows | None:
    """Open a page of a TIFF file that can be read band by band; None if it is none, or comes through a stream."""
    if input_format not in (None, "tiff") or not _begins_as_tiff(name):
        return None
    from vorotool.formats.images.band_reader import TiffRows

    rows = TiffRows(name, str(Path(name).absolute()), page)
    return rows if rows.is_plain else None


def _begins_as_tiff(name: str) -> bool:
    """Whether a file begins as a TIFF does; streams, which have one beginning only, are read whole elsewhere."""
    try:
        if stream_kind(name) is not None:
            return False
        with Path(name).open("rb") as file:
            return file.read(4) in TIFF_MAGIC
    except (OSError, ValueError):  # who reads it says why
        return False


def open_zarr(name: str, input_format: str | None = None, page: int | None = None) -> ZarrRows | None:
    """Open what is, or should be, a Zarr array: a folder that holds one, or is named or said to; None if it is none."""
    if input_format not in (None, "zarr") or not is_folder(name):
        return None
    if input_format is None and not is_store(name) and not name.rstrip(os.sep).lower().endswith(".zarr"):
        return None
    if page not in (None, 0):
        raise InputError(f"{name} has a single page: {option(f'--page {page}')} does not exist")
    from vorotool.formats.images.band_reader import ZarrRows

    return ZarrRows(name, str(Path(name).absolute()))
